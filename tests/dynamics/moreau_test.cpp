// SPDX-License-Identifier: MIT
#include "dynamics/disc/methods/moreau.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "dynamics/disc/gate.h"
#include "tests/support/numbers.h"
#include "tests/support/ride.h"
#include "tests/support/scenes.h"

namespace gatewalk::dynamics {
namespace {

using test::at_rest;
using test::Draw;
using test::kEps;
using test::Ride;

GateParams moreau(GateParams p, double step = 0.004) {
  p.run.method = "moreau";
  p.run.step = step;
  return p;
}

// ---- Hits: the law at mid-step, to round-off ----

/// The contact point in the middle of a step without forces.
Touch at_mid_step(const GateParams& p, const GateState& s, Side side) {
  const double half = 0.5 * p.run.step;
  BodyState mid = s.body;
  mid.x += half * mid.vx;
  mid.y += half * mid.vy;
  return nearest(p, side, mid, s.beams[side].theta + half * s.beams[side].omega);
}

/// A disc and two rods in random motion; at the midpoint of a first step the disc overlaps the
/// given number of rods.
GateState overlapping(const GateParams& p, Draw& draw, int rods) {
  for (;;) {
    GateState s = at_rest(draw.uniform(-24, 24), draw.uniform(15, 50), draw.uniform(-15, 15),
                          draw.uniform(-15, 15));
    for (BeamState& b : s.beams) b = {draw.uniform(-1.5, 1.5), draw.uniform(-1, 1), false};
    int deep = 0;
    for (const Side side : {kLeft, kRight}) deep += at_mid_step(p, s, side).gap <= 0.0;
    if (deep == rods) return s;
  }
}

// At any depth, a closing contact is hit; an opening contact is left alone, and so is the other
// beam. 500 and more of side, tip and pin each way.
TEST(Moreau, OnlyAContactThatClosesIsHit) {
  GateParams p = moreau(test::free_rods());
  p.contact.tip_restitution = 0.9;
  Draw draw(1);
  std::array<std::array<int, 3>, 2> seen{};  // closing or opening; by ContactKind
  const auto fewest = [](const std::array<int, 3>& n) { return std::min({n[0], n[1], n[2]}); };
  while (fewest(seen[0]) < 500 || fewest(seen[1]) < 500) {
    const GateState start = overlapping(p, draw, 1);
    const Side side = at_mid_step(p, start, kLeft).gap <= 0.0 ? kLeft : kRight,
               other = side == kLeft ? kRight : kLeft;
    const Touch t = at_mid_step(p, start, side);
    const double u = gap_rate(t, start.body, start.beams[side]);
    const double e = t.kind == ContactKind::tip ? 0.9 : 0.8;
    Ride ride(p, start);
    ride.step();
    ++seen[u >= 0.0][static_cast<int>(t.kind)];
    ASSERT_EQ(ride.s.beams[other].omega, start.beams[other].omega);
    // Rates up to 21 + 25 m/s, levers up to 25 m.
    ASSERT_NEAR(gap_rate(t, ride.s.body, ride.s.beams[side]), u >= 0.0 ? u : -e * u,
                64 * kEps * 50);
  }
}

// A disc that leans on a beam with a stiff spring: the impulse acts on I + h d/2 + h^2 k/4. With e
// = 0 no normal speed is left, whatever the spring does in the step.
TEST(Moreau, ImpulseKnowsTheImplicitSpring) {
  GateParams p = moreau(test::study(50.0));
  p.beams.stiffness_left = 1e7;
  p.forces.drag = 5.0;
  p.contact.restitution = 0.0;
  GateState s = at_rest(-10.0, 19.975, 0.0, 15.0);
  s.beams[kLeft] = {1e-4, -0.01, false};
  Ride ride(p, s);
  BodyState mid = s.body;
  mid.y += 0.002 * 15.0;
  const Touch t = nearest(p, kLeft, mid, 1e-4 - 0.002 * 0.01);
  ASSERT_LT(t.gap, 0.0);
  ride.step(3.0);
  EXPECT_NEAR(gap_rate(t, ride.s.body, ride.s.beams[kLeft]), 0.0, 64 * kEps * 15);
}

// ---- Energy ----

// Equal restitutions cannot create energy; Newton's law with different ones can. 20000 double hits
// without forces.
TEST(Moreau, OnlyDifferentRestitutionsCreateEnergyInDoubleHits) {
  for (const bool equal : {true, false}) {
    GateParams p = moreau(test::free_rods());
    p.contact.restitution = equal ? 0.5 : 1.0;
    p.contact.tip_restitution = equal ? 0.5 : 0.0;
    Draw draw(1);
    int created = 0;
    double most = 0.0;
    for (int i = 0; i < 20'000; ++i) {
      Ride ride(p, overlapping(p, draw, 2));
      const double before = energy(p, ride.s);
      ride.step();
      const double rise = energy(p, ride.s) - before;
      created += rise > 64 * kEps * 500;
      most = std::max(most, rise);
      ASSERT_GE(ride.watch.energy_created, rise);
    }
    if (equal) {
      EXPECT_EQ(created, 0);
    } else {
      EXPECT_GT(created, 0);
    }
  }
}

// The header's statement about a contact that opens by itself, u- = h F / (2 (1 + e) m), under a
// force F that closes it: held back to -e u-, the contact gains (1 - e) / (8 (1 + e)) (h F)^2 / m.
// On a joint pin.
TEST(Moreau, ClosingForceOnAnOpeningContactCreatesALittle) {
  GateParams p = moreau(test::free_rods());
  p.forces.propulsion = 6.0;
  const double kick = 0.004 * 6.0, u = kick / (2 * 1.8);
  Ride ride(p, at_rest(-25.0, 20.1, 0.0, -u));  // 0.1 m deep
  ride.step();
  EXPECT_NEAR(ride.s.body.vy, 0.8 * u, 4 * kEps);
  const double gain = 0.2 / (8 * 1.8) * kick * kick;
  EXPECT_NEAR(ride.watch.energy_created, gain, 4 * kEps * 6.0 * 20.1);
  EXPECT_EQ(ride.watch.impacts, 1);
}

}  // namespace
}  // namespace gatewalk::dynamics
