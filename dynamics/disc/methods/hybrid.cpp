// SPDX-License-Identifier: MIT
#include "dynamics/disc/methods/hybrid.h"

namespace gatewalk::dynamics {

std::array<Touch, 2> touches(const GateParams& p, const GateState& s, std::array<bool, 2> wanted) {
  std::array<Touch, 2> t{};
  for (const Side side : {kLeft, kRight})
    if (wanted[side]) t[side] = nearest(p, side, s.body, s.beams[side].theta);
  return t;
}

std::array<Touch, 2> touches(const GateParams& p, const GateState& s, std::array<bool, 2> wanted,
                             const std::array<Touch, 2>& nearby) {
  std::array<Touch, 2> t{};
  for (const Side side : {kLeft, kRight})
    if (wanted[side])
      t[side] = nearest(p, side, s.body, nearby[side].beam.turned_to(s.beams[side].theta));
  return t;
}

void fly(const GateParams& p, const GateFlow& flow, double force_x, const Push& push,
         GateState& s) {
  flow.body.apply(s.body, force_x / p.body.mass + push.ax,
                  p.forces.propulsion / p.body.mass + push.ay);
  flow.left.apply(s.beams[kLeft], push.beta[kLeft]);
  flow.right.apply(s.beams[kRight], push.beta[kRight]);
}

void fly(const GateParams& p, const GateLaw& law, double dt, double force_x, GateState& s) {
  BodyFlow(law.drag, dt).apply(s.body, force_x / p.body.mass, p.forces.propulsion / p.body.mass);
  for (const Side side : {kLeft, kRight})
    if (!at_rest(s.beams[side])) law.beams[side].over(dt).apply(s.beams[side], 0.0);
}

std::array<Touch, 2> put_back(const GateParams& p, GateState& s, std::array<bool, 2> contacts,
                              std::array<Touch, 2> touch) {
  if (!contacts[kLeft] && !contacts[kRight]) return touch;
  for (int iteration = 0; iteration < 12; ++iteration) {
    const std::array<double, 2> gap{contacts[kLeft] ? touch[kLeft].gap : 0.0,
                                    contacts[kRight] ? touch[kRight].gap : 0.0};
    if (std::max(std::abs(gap[kLeft]), std::abs(gap[kRight])) <= 1e-13 * p.body.radius) break;
    // Shift along the mass metric: the 2 x 2 system of impulses with gaps in place of rates.
    const auto shift = bilateral_impulses(coupling(p, touch), gap, contacts);
    const Push by(p, touch, shift);
    s.body.x += by.ax;
    s.body.y += by.ay;
    for (const Side side : {kLeft, kRight}) s.beams[side].theta += by.beta[side];
    touch = touches(p, s, contacts, touch);
  }
  const std::array<double, 2> rate{gap_rate(touch[kLeft], s.body, s.beams[kLeft]),
                                   gap_rate(touch[kRight], s.body, s.beams[kRight])};
  apply_impulses(p, touch, bilateral_impulses(coupling(p, touch), rate, contacts), s);
  return touch;
}

}  // namespace gatewalk::dynamics
