// SPDX-License-Identifier: MIT
#pragma once
/// Starts beside a beam at which a contact formula is nearly singular.

#include <array>
#include <cmath>

#include "dynamics/disc/methods/method.h"
#include "tests/support/numbers.h"

namespace gatewalk::test {

enum class Near {
  joint,  // the disc touches the joint pin, or nearly
  lever,  // the disc touches the beam's side so close to the joint that the lever is nearly zero
  /// the disc touches the free end, with the normal nearly through the joint: (13) divides by zero
  tip,
  handover,  // the disc touches where tangential and tip contact meet
  grazing,   // the disc touches any point, or nearly, with almost no speed across
};

/// 1 + delta for delta from 1e-15 to 1e-3.
inline double just_above_one(Draw& draw) { return 1.0 + draw.log_uniform(1e-15, 1e-3); }

/// The disc's centre at distance `dist` from the point `r` along the beam, with n turned by `turn`
/// from the beam, in the beam's own frame.
inline dynamics::BodyState beside(const dynamics::BeamState& b, double r, double turn, double dist,
                                  Draw& draw) {
  const double angle = b.theta + turn;
  return {r * std::cos(b.theta) + dist * std::cos(angle),
          r * std::sin(b.theta) + dist * std::sin(angle), draw.uniform(-15, 15),
          draw.uniform(-15, 15)};
}

inline dynamics::BodyState placed(Near near, const dynamics::GateParams& p,
                                  const dynamics::BeamState& b, Draw& draw) {
  const double dist = p.body.radius * just_above_one(draw), length = p.beams.length;
  switch (near) {
    case Near::joint:
      return beside(b, 0.0, draw.uniform(kPi / 2, 3 * kPi / 2), dist, draw);
    case Near::lever:
      return beside(b, draw.log_uniform(1e-15, 1.0), draw.sign() * kPi / 2, dist, draw);
    case Near::tip:
      return beside(b, length, draw.sign() * draw.log_uniform(1e-15, 1e-1), dist, draw);
    case Near::handover:
      return beside(b, length + draw.sign() * draw.log_uniform(1e-15, 1e-2), draw.sign() * kPi / 2,
                    dist, draw);
    case Near::grazing:
      break;
  }
  const bool tip = draw.below(3) == 0;
  const double r = tip ? length : draw.uniform(0.0, length);
  const double turn = draw.sign() * (tip ? draw.uniform(0.0, kPi / 2) : kPi / 2);
  dynamics::BodyState s = beside(b, r, turn, dist, draw);
  // Any speed along the beam, almost none across: n.v = l omega + u.
  const double nx = std::cos(b.theta + turn), ny = std::sin(b.theta + turn);
  const double across = r * std::sin(turn) * b.omega + draw.sign() * draw.log_uniform(1e-15, 1e-3);
  const double along = draw.uniform(-15, 15);
  s.vx = across * nx - along * ny;
  s.vy = across * ny + along * nx;
  return s;
}

/// Both beams anywhere and in motion, with the disc beside one of them and overlapping neither.
inline dynamics::GateState near_singular(Near near, const dynamics::GateParams& p, Draw& draw) {
  using namespace dynamics;
  for (;;) {
    GateState s;
    const Side side = draw.coin() ? kLeft : kRight, other = side == kLeft ? kRight : kLeft;
    s.beams[side] = {draw.uniform(-1.2, 1.2), draw.uniform(-1, 1), false};
    s.beams[other] = {draw.uniform(-1.2, 1.2), draw.uniform(-1, 1), false};
    const BodyState local = placed(near, p, s.beams[side], draw);
    const double inwards = side == kLeft ? 1.0 : -1.0;
    s.body = {inwards * (local.x - p.beams.joint_x), local.y + p.beams.joint_y, inwards * local.vx,
              local.vy};
    if (!outside(p, s.body) && nearest(p, side, s.body, s.beams[side].theta).gap >= 0.0 &&
        nearest(p, other, s.body, s.beams[other].theta).gap >= 0.0)
      return s;
  }
}

/// What a method did with one such start.
struct Trouble {
  int not_finite = 0;
  double overlap = 0.0;  // m
  std::int64_t evaluations = 0;
};

/// Runs `start` for three holds of random force, with five checks in each.
inline Trouble trouble(const dynamics::GateParams& p, const dynamics::Method& method,
                       const dynamics::GateState& start, Draw& draw) {
  using namespace dynamics;
  Trouble t;
  GateState s = start;
  Watch watch;
  EnergyLedger ledger(p, s);
  for (int hold = 0; hold < 3 && !outside(p, s.body); ++hold) {
    const double force = 40 * draw.uniform(-2, 2);
    for (int i = 0; i < 5 && !outside(p, s.body); ++i) {
      (void)method.advance(s, force, 0.004, ledger, watch);
      double sum = s.body.x + s.body.y + s.body.vx + s.body.vy;
      for (const Side side : {kLeft, kRight}) {
        t.overlap = std::fmax(t.overlap, -nearest(p, side, s.body, s.beams[side].theta).gap);
        sum += s.beams[side].theta + s.beams[side].omega;
      }
      t.not_finite += !std::isfinite(sum);
    }
  }
  t.evaluations = watch.evaluations;
  return t;
}

}  // namespace gatewalk::test
