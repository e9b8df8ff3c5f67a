// SPDX-License-Identifier: MIT
#include "dynamics/disc/methods/penalty.h"

#include <fmt/core.h>

#include <limits>
#include <numbers>
#include <utility>

#include "dynamics/disc/methods/march.h"

namespace gatewalk::dynamics {
namespace {

constexpr double kMostDamping = 4.0;  // largest zeta; more leaves no room for two contacts at once

/// -ln e for a spring and damper that only push. With zeta = sin(a), their force is zero when w_d t
/// = pi - 2 a, where the speed has fallen by the factor exp(-tan(a) (pi - 2 a)). In the limit a ->
/// pi/2 the result is 2; beyond, with zeta = cosh(b), it is 2 b coth(b).
double loss(double zeta) {
  if (zeta < 1.0) {
    const double a = std::asin(zeta);
    return std::tan(a) * (std::numbers::pi - 2.0 * a);
  }
  const double b = std::acosh(zeta);
  return b > 0.0 ? 2.0 * b / std::tanh(b) : 2.0;
}

/// The damping ratio for restitution e: the solution of loss(zeta) = -ln e. `loss` increases with
/// zeta.
double damping_ratio(double e) {
  if (e <= std::exp(-loss(kMostDamping))) return kMostDamping;
  const double wanted = -std::log(e);
  double low = 0.0, high = kMostDamping;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (loss(middle) < wanted ? low : high) = middle;
  }
  return low;
}

}  // namespace

// x'' = -w^2 x - 2 zeta w x' multiplies its two modes by e^(-(zeta +- sqrt(zeta^2 - 1)) w h) in a
// step: product r^2, r = e^(-zeta w h), and sum 2 r cos(w_d h). Semi-implicit Euler with a spring K
// and a damper C has product 1 - h C and sum 2 - h C - h^2 K; equating both gives C and K.
PenaltyMethod::Spring PenaltyMethod::spring(double restitution, double w, double h) {
  const double zeta = damping_ratio(restitution);
  const double r = std::exp(-zeta * w * h);
  const double phase = w * h * std::sqrt(std::abs(1.0 - zeta * zeta));
  const double sum = 2.0 * r * (zeta < 1.0 ? std::cos(phase) : std::cosh(phase));
  return {(1.0 + r * r - sum) / (h * h), (1.0 - r * r) / h};
}

PenaltyMethod::Springs::Springs(const GateParams& p, double h) {
  const double w = 2.0 * std::numbers::pi / (kContactSteps * p.run.step);
  side = spring(p.contact.restitution, w, h);
  tip = spring(p.contact.tip_restitution, w, h);
}

double penalty_bound(const GateParams& p) {
  constexpr double kW = 2.0 * std::numbers::pi / PenaltyMethod::kContactSteps;
  const auto share = [](const PenaltyMethod::Spring& c) { return c.stiffness + 2.0 * c.damping; };
  const auto contact = [&](double e) { return share(PenaltyMethod::spring(e, kW, 1.0)); };
  const double room =
      4.0 - 2.0 * std::fmax(contact(p.contact.restitution), contact(p.contact.tip_restitution));
  // Solves h^2 K + 2 h C = room for h without cancellation.
  const auto longest = [room](double k, double c) {
    return k > 0.0 || c > 0.0 ? room / (c + std::sqrt(c * c + k * room))
                              : std::numeric_limits<double>::infinity();
  };
  const double stiffest = std::fmax(p.beams.stiffness_left, p.beams.stiffness_right);
  return std::fmin(longest(stiffest / p.beams.inertia(), p.beams.damping / p.beams.inertia()),
                   longest(0.0, p.forces.drag / p.body.mass));
}

PenaltyMethod::PenaltyMethod(const GateParams& p) : p_(p), usual_(p, p.run.step) {
  const double bound = penalty_bound(p);
  if (p.run.step <= bound) return;
  throw InvalidParameter(
      "run.step_s",
      fmt::format("run.step_s = {:.6g} is not permitted for these beams and contacts, from "
                  "beams.stiffness_left_Nm_per_rad, beams.stiffness_right_Nm_per_rad, "
                  "beams.damping_Nms_per_rad, beams.mass_kg, forces.drag_Ns_per_m, "
                  "contact.restitution and contact.tip_restitution; method penalty permits at most "
                  "{:.6g} s",
                  p.run.step, bound));
}

double PenaltyMethod::advance(GateState& s, double force_x, double duration, EnergyLedger& ledger,
                              Watch& watch) const {
  const Spell spell(p_, duration);
  const double h = spell.step;
  const Springs springs = spell.usual ? usual_ : Springs(p_, h);
  const double inertia = p_.beams.inertia();
  std::array<Touch, 2> touch;    // contact points now; gap >= 0 means out of reach
  std::array<double, 2> mass{};  // kg, effective mass of each contact

  const auto look = [&](const GateState& now) {
    for (const Side side : {kLeft, kRight}) {
      touch[side] = {};
      if (out_of_reach(p_, side, now.body, now.beams[side].theta)) continue;
      touch[side] = nearest(p_, side, now.body, now.beams[side].theta);
      mass[side] = 1.0 / compliance(p_.body.mass, inertia, touch[side].lever);
      ++watch.evaluations;
    }
  };
  const auto one_step = [&](GateState& now) {
    ++watch.evaluations;
    std::array<double, 2> force{};
    for (const Side side : {kLeft, kRight}) {
      const Touch& t = touch[side];
      const bool counted = std::exchange(watch.counted[side], t.gap < 0.0);
      if (t.gap >= 0.0) continue;
      const double u = gap_rate(t, now.body, now.beams[side]);
      const Spring& spring = springs.of(t);
      force[side] = std::fmax(0.0, -mass[side] * (spring.stiffness * t.gap + spring.damping * u));
      watch.impacts += !counted;
    }
    const Touch &l = touch[kLeft], &r = touch[kRight];
    BodyState& body = now.body;
    const double contact_x = force[kLeft] * l.nx + force[kRight] * r.nx;
    const double contact_y = force[kLeft] * l.ny + force[kRight] * r.ny;
    body.vx += h * (force_x - p_.forces.drag * body.vx + contact_x) / p_.body.mass;
    body.vy += h * (p_.forces.propulsion - p_.forces.drag * body.vy + contact_y) / p_.body.mass;
    body.x += h * body.vx;
    body.y += h * body.vy;
    for (const Side side : {kLeft, kRight}) {
      BeamState& beam = now.beams[side];
      const double k = p_.beams.stiffness(side);
      beam.omega -= h *
                    (k * beam.theta + p_.beams.damping * beam.omega +  // Eq. (3)
                     touch[side].lever * force[side]) /
                    inertia;
      beam.theta += h * beam.omega;
    }
  };
  // Semi-implicit Euler conserves v^2 + K q (q - h v) of a spring K, not v^2 + K q^2, where q - h v
  // is the previous position. The conserved quantity shows whether energy appears.
  const auto stored = [&](const GateState& now) {
    look(now);
    std::array<double, 2> elastic{};
    for (const Side side : {kLeft, kRight}) {
      const Touch& t = touch[side];
      if (t.gap >= 0.0) continue;
      const double u = gap_rate(t, now.body, now.beams[side]);
      elastic[side] = 0.5 * mass[side] * springs.of(t).stiffness * t.gap * (t.gap - h * u);
    }
    return elastic[kLeft] + elastic[kRight];
  };
  look(s);
  return march(p_, spell, s, force_x, ledger, watch, one_step, stored);
}

}  // namespace gatewalk::dynamics
