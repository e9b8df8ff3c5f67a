// SPDX-License-Identifier: MIT
#include "dynamics/disc/methods/method.h"

#include <gtest/gtest.h>

#include <typeinfo>

#include "dynamics/disc/methods/event.h"
#include "dynamics/disc/methods/moreau.h"
#include "dynamics/disc/methods/paper.h"
#include "dynamics/disc/methods/penalty.h"
#include "dynamics/disc/methods/stable.h"
#include "tests/support/numbers.h"
#include "tests/support/scenes.h"

namespace gatewalk::dynamics {
namespace {

using test::kEps;

TEST(Method, IsMadeByItsName) {
  GateParams p;
  p.run.method = "paper";
  EXPECT_NE(dynamic_cast<const PaperMethod*>(make_method(p).get()), nullptr);
  p.run.method = "stable";
  EXPECT_NE(dynamic_cast<const StableMethod*>(make_method(p).get()), nullptr);
  p.run.method = "moreau";
  EXPECT_NE(dynamic_cast<const MoreauMethod*>(make_method(p).get()), nullptr);
  p.run.method = "event";
  EXPECT_NE(dynamic_cast<const EventMethod*>(make_method(p).get()), nullptr);
  p.run.method = "penalty";
  EXPECT_NE(dynamic_cast<const PenaltyMethod*>(make_method(p).get()), nullptr);
  EXPECT_EQ(method_names().size(), 6u);  // these five and "auto"
  p.run.method = "euler";
  EXPECT_THROW((void)make_method(p), InvalidParameter);
}

// A scene may have method "auto", but it must be resolved before a run.
TEST(Method, AutoIsAValidNameAndNoMethod) {
  GateParams p;
  p.run.method = "auto";
  EXPECT_NO_THROW(validate(p));
  try {
    (void)make_method(p);
    FAIL() << "auto was made";
  } catch (const InvalidParameter& e) {
    EXPECT_EQ(e.key(), "run.method");
    EXPECT_NE(std::string(e.what()).find("choose_method"), std::string::npos) << e.what();
  }
}

TEST(Method, IsNotMadeForAnInvalidScene) {
  for (const std::string_view name : method_names()) {
    GateParams p;
    p.run.method = name;
    p.body.mass = -1.0;
    EXPECT_THROW((void)make_method(p), InvalidParameter) << name;
  }
}

TEST(Outside, IsBeyondASideOrTheFarEnd) {
  const GateParams p;
  EXPECT_FALSE(outside(p, {0, 0}));
  EXPECT_FALSE(outside(p, {-25, 60}));   // on the border is inside
  EXPECT_FALSE(outside(p, {25, -100}));  // no exit at the bottom
  EXPECT_TRUE(outside(p, {0, 60.001}));
  EXPECT_TRUE(outside(p, {-25.001, 5}));
  EXPECT_TRUE(outside(p, {25.001, 5}));
}

// Eq. (14) and the kinetic energies: 1/2 (2 * 25 + 125/6 (4 + 9) + 300 * 0.01 + 500 * 0.04).
TEST(Energy, AddsUpItsParts) {
  GateParams p = test::study(10.0);
  p.body.mass = 2.0;
  GateState s;
  s.body = {7, 8, 3, 4};
  s.beams[kLeft] = {0.1, 2.0, false};
  s.beams[kRight] = {-0.2, -3.0, false};
  const double expected = 0.5 * (50 + 62.5 / 3 * 13 + 3 + 20);
  EXPECT_NEAR(energy(p, s), expected, 8 * kEps * expected);
}

// The ledger subtracts the work of the propulsion (8 N) and of the lateral force.
TEST(EnergyLedger, KnowsTheWorkOfBothForces) {
  GateParams p = test::free_rods();
  p.forces.propulsion = 8.0;
  GateState s;
  s.body = {1, 2, 0, 0};
  EnergyLedger ledger(p, s);
  Watch w;
  s.body = {4, 3, 0, 0};  // 3 m along x under 5 N, 1 m along y under 8 N: 23 J
  s.body.vx = std::sqrt(2 * 23.0);
  ledger.step(s, 5.0, 0.02, w);
  EXPECT_NEAR(w.energy_created, 0.0, 8 * kEps * 23);
  s.body.x = 5;
  s.body.vx = std::sqrt(2 * 20.0);  // 1 m against 2 N: 21 J are expected, 1 J is lost
  ledger.step(s, -2.0, 0.02, w);
  EXPECT_NEAR(w.energy_created, 0.0, 8 * kEps * 23);
}

// The created energy is the rise above the lowest balance so far, and the largest such rise.
TEST(EnergyLedger, RemembersTheLargestRise) {
  const GateParams p = test::free_rods();
  GateState s;
  const auto set_energy = [&](double joule) { s.body.vy = std::sqrt(2 * joule); };
  set_energy(10);
  EnergyLedger ledger(p, s);
  Watch w;
  const double balance[] = {9, 6, 8, 7, 5, 5.5}, created[] = {0, 0, 2, 2, 2, 2};
  for (int i = 0; i < 6; ++i) {
    set_energy(balance[i]);
    ledger.step(s, 0.0, 0.02, w);
    EXPECT_NEAR(w.energy_created, created[i], 16 * kEps * 10) << i;
  }
}

TEST(Watch, KeepsTheLargestOfEachState) {
  const GateParams p;
  Watch w;
  GateState s;
  s.body = {1, 2, 3, -4};
  s.beams = {BeamState{-0.3, 0.0, false}, BeamState{0.1, 0.0, false}};
  w.state(p, s, 0.004);
  s.body = {1, 2, 1, 1};
  s.beams = {BeamState{0.2, 0.0, false}, BeamState{0.4, 0.0, false}};
  w.state(p, s, 0.004);
  EXPECT_EQ(w.steps, 2);
  EXPECT_EQ(w.max_speed, 5.0);
  EXPECT_EQ(w.max_theta, (std::array<double, 2>{0.3, 0.4}));
  EXPECT_EQ(w.fast_steps, 0);
}

// Half a radius, 5 m, in a step of 0.004 s is 1250 m/s for the disc and the tip of the faster beam
// together.
TEST(Watch, CountsStepsThatCanMissAHit) {
  const GateParams p;
  const auto fast = [&](double vy, double left, double right, double dt) {
    Watch w;
    GateState s;
    s.body.vy = vy;
    s.beams[kLeft].omega = left;
    s.beams[kRight].omega = right;
    w.state(p, s, dt);
    return w.fast_steps == 1;
  };
  EXPECT_FALSE(fast(-1249, 0, 0, 0.004));
  EXPECT_TRUE(fast(-1251, 0, 0, 0.004));
  EXPECT_FALSE(fast(-1251, 0, 0, 0.002));
  EXPECT_FALSE(fast(1000, 1, -9.9, 0.004));
  EXPECT_TRUE(fast(1000, 1, -10.1, 0.004));
  EXPECT_TRUE(fast(1000, 10.1, 0, 0.004));
}

// A disc of 10 m under beams at rest on y = 30 m.
TEST(Watch, PenetrationIsTheDeepestGap) {
  const GateParams p;
  Watch w;
  const auto look = [&](double y) {
    GateState s;
    s.body.x = -12.0;
    s.body.y = y;
    w.state(p, s, 0.004);
    return w.max_penetration;
  };
  EXPECT_EQ(look(15.0), 0.0);
  EXPECT_EQ(look(20.5), 0.5);
  EXPECT_EQ(look(20.25), 0.5);
}

}  // namespace
}  // namespace gatewalk::dynamics
