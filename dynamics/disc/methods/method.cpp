// SPDX-License-Identifier: MIT
#include "dynamics/disc/methods/method.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "dynamics/disc/methods/event.h"
#include "dynamics/disc/methods/moreau.h"
#include "dynamics/disc/methods/paper.h"
#include "dynamics/disc/methods/penalty.h"
#include "dynamics/disc/methods/stable.h"

namespace gatewalk::dynamics {

std::span<const std::string_view> method_names() {
  static constexpr std::array<std::string_view, 6> names{"paper", "stable",  "moreau",
                                                         "event", "penalty", "auto"};
  return names;
}

std::unique_ptr<Method> make_method(const GateParams& params) {
  validate(params);
  if (params.run.method == "paper") return std::make_unique<PaperMethod>(params);
  if (params.run.method == "moreau") return std::make_unique<MoreauMethod>(params);
  if (params.run.method == "event") return std::make_unique<EventMethod>(params);
  if (params.run.method == "penalty") return std::make_unique<PenaltyMethod>(params);
  if (params.run.method == "auto")
    throw InvalidParameter("run.method",
                           "run.method = \"auto\" is no method yet: choose_method "
                           "(dynamics/disc/study/choice.h) makes it one");
  return std::make_unique<StableMethod>(params);
}

void Watch::motion(const GateParams& p, const GateState& s, double dt) {
  ++steps;
  const double speed = std::sqrt(s.body.vx * s.body.vx + s.body.vy * s.body.vy);
  max_speed = std::max(max_speed, speed);
  double fastest_beam = 0.0;
  for (const Side side : {kLeft, kRight}) {
    max_theta[side] = std::max(max_theta[side], std::abs(s.beams[side].theta));
    fastest_beam = std::max(fastest_beam, std::abs(s.beams[side].omega));
  }
  // Half a radius is far less than what passes through a beam, and far more than any step in the
  // paper's scenes.
  fast_steps += (speed + fastest_beam * p.beams.length) * dt > 0.5 * p.body.radius;
}

void Watch::penetration(const GateParams& p, const GateState& s) {
  for (const Side side : {kLeft, kRight}) {
    const double theta = s.beams[side].theta;
    if (!out_of_reach(p, side, s.body, theta))
      max_penetration = std::max(max_penetration, -nearest(p, side, s.body, theta).gap);
  }
}

namespace {

/// Cubic Hermite interpolation at time t between two moments dt apart.
struct Interpolation {
  double wb, da, db, rate, ra, rb;
  Interpolation(double dt, double t) {
    const double z = t / dt, z2 = z * z, z3 = z2 * z;
    wb = 3 * z2 - 2 * z3;
    da = dt * (z - 2 * z2 + z3);
    db = dt * (z3 - z2);
    rate = 6 * (z - z2) / dt;
    ra = 1 - 4 * z + 3 * z2;
    rb = 3 * z2 - 2 * z;
  }
  void mix(double xa, double va, double xb, double vb, double& x, double& v) const {
    x = xa + wb * (xb - xa) + da * va + db * vb;
    v = rate * (xb - xa) + ra * va + rb * vb;
  }
  void mix(const BodyState& a, const BodyState& b, BodyState& s) const {
    mix(a.x, a.vx, b.x, b.vx, s.x, s.vx);
    mix(a.y, a.vy, b.y, b.vy, s.y, s.vy);
  }
};

}  // namespace

GateState interpolated(const GateState& a, const GateState& b, double dt, double t) {
  const Interpolation at(dt, t);
  GateState s = b;
  at.mix(a.body, b.body, s.body);
  for (const Side side : {kLeft, kRight})
    at.mix(a.beams[side].theta, a.beams[side].omega, b.beams[side].theta, b.beams[side].omega,
           s.beams[side].theta, s.beams[side].omega);
  return s;
}

std::array<BeamState, 2> mixed(const std::array<BeamState, 2>& a, const std::array<BeamState, 2>& b,
                               double fraction) {
  std::array<BeamState, 2> m = b;
  for (const Side side : {kLeft, kRight}) {
    m[side].theta = a[side].theta + fraction * (b[side].theta - a[side].theta);
    m[side].omega = a[side].omega + fraction * (b[side].omega - a[side].omega);
  }
  return m;
}

double back_to_exit(const GateParams& p, const GateState& before, GateState& s, double dt) {
  // Bisection: 50 halvings of a step reach rounding error, and the end of the last bracket is
  // outside.
  const GateState after = s;
  double inside = 0.0, beyond = dt;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (inside + beyond);
    BodyState there;
    Interpolation(dt, middle).mix(before.body, after.body, there);
    (outside(p, there) ? beyond : inside) = middle;
  }
  if (beyond < dt) s = interpolated(before, after, dt, beyond);
  return beyond;
}

double energy(const GateParams& p, const GateState& s) {
  const BeamState &l = s.beams[kLeft], &r = s.beams[kRight];
  const double body = p.body.mass * (s.body.vx * s.body.vx + s.body.vy * s.body.vy);
  const double beams = p.beams.inertia() * (l.omega * l.omega + r.omega * r.omega);
  const double joints =
      p.beams.stiffness_left * l.theta * l.theta + p.beams.stiffness_right * r.theta * r.theta;
  return 0.5 * (body + beams + joints);
}

double EnergyLedger::balance(const GateState& s) const {
  return energy(p_, s) - p_.forces.propulsion * (s.body.y - y0_) - random_work_;
}

}  // namespace gatewalk::dynamics
