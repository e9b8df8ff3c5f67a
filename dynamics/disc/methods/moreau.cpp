// SPDX-License-Identifier: MIT
#include "dynamics/disc/methods/moreau.h"

#include "dynamics/disc/methods/march.h"

namespace gatewalk::dynamics {

// With v_m = (v + v+)/2:  M (v+ - v) = h F - h D v_m + J n, so that
//     v+ = ((M - h D/2) v + h F + J n) / (M + h D/2),
// and with theta_m = theta + (h/2) omega_m:  I (omega+ - omega) = -h k theta_m - h d omega_m - l J,
//     omega+ = ((I - h d/2 - h^2 k/4) omega - h k theta - l J) / (I + h d/2 + h^2 k/4).
// Limit k -> inf: omega+ = -omega - 4 theta / h, a beam that no impulse moves.
MoreauMethod::Step::Step(const GateParams& p, double step)
    : h(step), mass(p.body.mass + 0.5 * h * p.forces.drag) {
  v_to_v = (p.body.mass - 0.5 * h * p.forces.drag) / mass;
  v_per_N = h / mass;
  for (const Side side : {kLeft, kRight}) {
    const double k = p.beams.stiffness(side);
    const double implicit = 0.5 * h * p.beams.damping + 0.25 * h * h * k;
    inertia[side] = p.beams.inertia() + implicit;
    w_to_w[side] = (p.beams.inertia() - implicit) / inertia[side];
    w_per_rad[side] = h * k / inertia[side];
  }
}

double MoreauMethod::advance(GateState& s, double force_x, double duration, EnergyLedger& ledger,
                             Watch& watch) const {
  const Spell spell(p_, duration);
  const Step step = spell.usual ? usual_ : Step(p_, spell.step);
  return march(
      p_, spell, s, force_x, ledger, watch,
      [&](GateState& state) { one_step(state, force_x, step, watch); },
      [](const GateState&) { return 0.0; });
}

void MoreauMethod::one_step(GateState& s, double force_x, const Step& step, Watch& watch) const {
  const double half = 0.5 * step.h;
  BodyState body = s.body;  // at mid-step in position, free motion's end in velocity
  body.x += half * s.body.vx;
  body.y += half * s.body.vy;
  body.vx = step.v_to_v * s.body.vx + step.v_per_N * force_x;
  body.vy = step.v_to_v * s.body.vy + step.v_per_N * p_.forces.propulsion;
  std::array<BeamState, 2> beams = s.beams;
  ++watch.evaluations;

  std::array<Touch, 2> touch{};
  std::array<bool, 2> active{};
  for (const Side side : {kLeft, kRight}) {
    BeamState& beam = beams[side];
    beam.theta += half * s.beams[side].omega;
    beam.omega =
        step.w_to_w[side] * s.beams[side].omega - step.w_per_rad[side] * s.beams[side].theta;
    if (out_of_reach(p_, side, body, beam.theta)) continue;
    touch[side] = nearest(p_, side, body, beam.theta);
    ++watch.evaluations;
    active[side] = touch[side].gap <= 0.0;
  }
  for (const Side side : {kLeft, kRight}) watch.counted[side] = watch.counted[side] && active[side];

  if (active[kLeft] || active[kRight]) {
    std::array<double, 2> b{}, before{};
    for (const Side side : {kLeft, kRight}) {
      if (!active[side]) continue;
      const double e = touch[side].kind == ContactKind::tip ? p_.contact.tip_restitution
                                                            : p_.contact.restitution;
      before[side] = gap_rate(touch[side], s.body, s.beams[side]);
      b[side] = gap_rate(touch[side], body, beams[side]) + e * before[side];
    }
    const Touch &l = touch[kLeft], &r = touch[kRight];
    const Coupling w{compliance(step.mass, step.inertia[kLeft], l.lever),
                     compliance(step.mass, step.inertia[kRight], r.lever),
                     (l.nx * r.nx + l.ny * r.ny) / step.mass};
    const auto impulse = unilateral_impulses(w, b, active);
    body.vx += (impulse[kLeft] * l.nx + impulse[kRight] * r.nx) / step.mass;
    body.vy += (impulse[kLeft] * l.ny + impulse[kRight] * r.ny) / step.mass;
    for (const Side side : {kLeft, kRight}) {
      beams[side].omega -= impulse[side] * touch[side].lever / step.inertia[side];
      watch.impulse[side] += impulse[side];
      watch.impacts += impulse[side] > 0.0 && !watch.counted[side];
      watch.counted[side] = watch.counted[side] || impulse[side] > 0.0;
    }
    for (const Side side : {kLeft, kRight}) {
      if (!active[side])
        continue;  // an impulse does work on the mean of both rates (midpoint rule)
      watch.hit_loss -=
          0.5 * impulse[side] * (before[side] + gap_rate(touch[side], body, beams[side]));
    }
  }

  s.body.x = body.x + half * body.vx;
  s.body.y = body.y + half * body.vy;
  s.body.vx = body.vx;
  s.body.vy = body.vy;
  for (const Side side : {kLeft, kRight}) {
    s.beams[side].theta = beams[side].theta + half * beams[side].omega;
    s.beams[side].omega = beams[side].omega;
  }
}

}  // namespace gatewalk::dynamics
