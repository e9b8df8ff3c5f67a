// SPDX-License-Identifier: MIT
#include "dynamics/disc/methods/paper.h"

#include <algorithm>
#include <limits>

namespace gatewalk::dynamics {

double euler_bound(const GateParams& p) {
  const double k = std::max(p.beams.stiffness_left, p.beams.stiffness_right);
  const double d = p.beams.damping, inertia = p.beams.inertia();
  const double spread = d * d - 4.0 * k * inertia;
  if (spread >= 0.0)
    return d > 0.0 ? 4.0 * inertia / (d + std::sqrt(spread))
                   : std::numeric_limits<double>::infinity();
  return d / k;
}

double PaperMethod::advance(GateState& s, double force_x, double duration, EnergyLedger& ledger,
                            Watch& watch) const {
  const double dt = p_.run.step;
  const auto steps = std::max<long>(1, std::lround(duration / dt));
  for (long i = 1; i <= steps; ++i) {
    collide(s, watch);
    euler(s, force_x, dt, watch);
    watch.unstable_steps += beyond_bound_;
    ledger.step(s, force_x, dt, watch);
    watch.state(p_, s, dt);
    if (!std::isfinite(s.body.vx + s.body.vy) || outside(p_, s.body))
      return static_cast<double>(i) * dt;
  }
  return static_cast<double>(steps) * dt;
}

void PaperMethod::collide(GateState& s, Watch& watch) const {
  for (const Side side : {kLeft, kRight}) {
    BeamState& beam = s.beams[side];
    if (!beam.held && out_of_reach(p_, side, s.body, beam.theta)) continue;
    const Touch t = nearest(p_, side, s.body, beam.theta);
    ++watch.evaluations;
    if (t.kind == ContactKind::pin) {  // Eq. (5) would need the root of a negative number
      if (t.gap < 0.0) ++watch.undefined_contacts;
      beam.held = false;
      continue;
    }
    const double u = gap_rate(t, s.body, beam);
    if (beam.held || t.gap >= 0.0 || u >= 0.0) continue;
    const double e = t.kind == ContactKind::tip ? p_.contact.tip_restitution  // Eq. (6)
                                                : p_.contact.restitution;     // Eq. (5)
    const double impulse = impact_impulse(p_.body.mass, p_.beams.inertia(), t.lever, u, e);
    s.body.vx += impulse * t.nx / p_.body.mass;
    s.body.vy += impulse * t.ny / p_.body.mass;
    beam.omega -= impulse * t.lever / p_.beams.inertia();
    ++watch.impacts;
    watch.impulse[side] += impulse;
    watch.hit_loss -=
        impulse * (u + 0.5 * impulse * compliance(p_.body.mass, p_.beams.inertia(), t.lever));
    if (impulse < p_.contact.impulse_threshold && t.lever != 0.0) {
      beam.held = true;  // set the beam's velocity to satisfy
      beam.omega = (t.nx * s.body.vx + t.ny * s.body.vy) / t.lever;
    }
  }
}

void PaperMethod::euler(GateState& s, double force_x, double dt, Watch& watch) const {
  std::array<double, 2> force{0.0, 0.0};
  std::array<Touch, 2> t{};
  if (s.beams[kLeft].held || s.beams[kRight].held) {
    t = {nearest(p_, kLeft, s.body, s.beams[kLeft].theta),
         nearest(p_, kRight, s.body, s.beams[kRight].theta)};
    watch.evaluations += 2;
    std::array<bool, 2> held{s.beams[kLeft].held, s.beams[kRight].held};
    force = contact_forces(p_, s, t, force_x, held, bilateral_impulses);
    // A force that would pull releases its contact; the other contact is then solved alone.
    const bool pulls_left = held[kLeft] && force[kLeft] < 0.0;
    const bool pulls_right = held[kRight] && force[kRight] < 0.0;
    if (pulls_left || pulls_right) {
      held = {held[kLeft] && !pulls_left, held[kRight] && !pulls_right};
      force = contact_forces(p_, s, t, force_x, held, unilateral_impulses);
      for (const Side side : {kLeft, kRight}) s.beams[side].held = held[side];
    }
  }
  const double ax = (force_x - p_.forces.drag * s.body.vx +
                     (force[kLeft] * t[kLeft].nx + force[kRight] * t[kRight].nx)) /
                    p_.body.mass;
  const double ay = (p_.forces.propulsion - p_.forces.drag * s.body.vy +
                     (force[kLeft] * t[kLeft].ny + force[kRight] * t[kRight].ny)) /
                    p_.body.mass;
  s.body.x += s.body.vx * dt;
  s.body.y += s.body.vy * dt;
  s.body.vx += ax * dt;
  s.body.vy += ay * dt;
  for (const Side side : {kLeft, kRight}) {
    BeamState& beam = s.beams[side];
    const double k = p_.beams.stiffness(side);
    const double beta = (-k * beam.theta - p_.beams.damping * beam.omega -  // Eq. (3)
                         t[side].lever * force[side]) /
                        p_.beams.inertia();
    beam.theta += beam.omega * dt;
    beam.omega += beta * dt;
  }
}

}  // namespace gatewalk::dynamics
