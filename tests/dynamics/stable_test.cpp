// SPDX-License-Identifier: MIT
#include "dynamics/disc/methods/stable.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dynamics/disc/gate.h"
#include "tests/support/measured.h"
#include "tests/support/numbers.h"
#include "tests/support/ride.h"
#include "tests/support/scenes.h"

namespace gatewalk::dynamics {
namespace {

using test::at_rest;
using test::kEps;
using test::measured;
using test::Ride;
using test::same_bits;

// ---- Single hits ----

TEST(Stable, PlasticHitLeavesNoNormalSpeed) {
  GateParams p = test::free_rods();
  p.run.step = 0.004;
  p.contact.restitution = 0.0;
  Ride ride(p, at_rest(-10.0, 19.97, 2.0, 15.0));
  ride.step();
  EXPECT_GE(ride.watch.impacts, 1);
  // The beam turns under the disc for another 2 ms: omega^2 R = 11 m/s^2 and 2 omega v_x = 4 m/s^2.
  EXPECT_NEAR(gap_rate(ride.touch(kLeft), ride.s.body, ride.s.beams[kLeft]), 0.0, 0.03);
}

// ---- Zeno: infinitely many hits in a finite time ----

/// A disc driven upwards onto something that does not move: F = 6 N, first hit at v0 = 2 m/s after
/// t0 = 1/3 s; flight n lasts 2 t0 e^n, all flights together t0 (1 + e) / (1 - e).
struct Bouncing {
  double e, step, threshold;
  static constexpr double v0 = 2.0, force = 6.0, t0 = v0 / force;

  [[nodiscard]] GateParams scene() const {
    GateParams p = test::free_rods();
    p.forces.propulsion = force;
    p.contact.restitution = p.contact.tip_restitution = e;
    p.contact.impulse_threshold = threshold;
    p.run.step = step;
    return p;
  }
  [[nodiscard]] double zeno_time() const { return t0 * (1 + e) / (1 - e); }
  /// The first hit, counted from 0, whose impulse (1 + e) M v0 e^n is below the threshold. The
  /// threshold is lower for nearly elastic hits (methods/hybrid.h).
  [[nodiscard]] int last_hit() const {
    const double least = threshold * step / 0.004 * std::min(1.0, (1.0 - e) / 0.05);
    int n = 0;
    while ((1 + e) * v0 * std::pow(e, n) >= least) ++n;
    return n;
  }
  [[nodiscard]] double time_of(int hit) const {
    return t0 * (1 + 2 * e * (1 - std::pow(e, hit)) / (1 - e));
  }
};

/// Steps until the left contact is held or the limit is over; returns the time.
double time_until_held(Ride& ride, double limit) {
  const auto time = [&] { return static_cast<double>(ride.watch.steps) * ride.p.run.step; };
  while (!ride.s.beams[kLeft].held && time() < limit) ride.step();
  return time();
}

/// Straight below the left joint, a pin that does not move.
const GateState kBelowThePin = at_rest(-25.0, 20.0 - 1.0 / 3);

TEST(Zeno, BouncingEndsInAHoldAtThePredictedHit) {
  double error = 0.0, slowest = 0.0;  // of Zeno's time at the default step, relative; s of CPU
  std::int64_t unforeseen = 0, scenes = 0;
  for (const double step : {0.02, 0.004, 0.001}) {
    for (const double e : {0.1, 0.3, 0.5, 0.8, 0.9, 0.95, 0.99}) {
      SCOPED_TRACE(testing::Message() << "e = " << e << ", step = " << step);
      const double began = test::thread_seconds();
      const Bouncing b{e, step, 0.04};
      Ride ride(b.scene(), kBelowThePin);
      const int last = b.last_hit();
      const double hold = b.time_of(last);
      const double t = time_until_held(ride, 2 * b.zeno_time());
      EXPECT_TRUE(ride.s.beams[kLeft].held);
      // The hold is seen at the end of its step. Hits are found to 1e-12 R, and each error persists
      // in later flights: far below 1e-6 s.
      EXPECT_GE(t, hold - 1e-6);
      EXPECT_LE(t, hold + step + 1e-6);
      EXPECT_EQ(ride.watch.impacts, last + 1);
      EXPECT_EQ(ride.watch.forced_holds, 0);
      if (step == GateParams{}.run.step) error = std::max(error, std::abs(t / b.zeno_time() - 1.0));
      unforeseen = std::max(unforeseen, std::abs(ride.watch.impacts - (last + 1)));
      // The remainder of Zeno's series, which the hold cuts off.
      EXPECT_NEAR(b.zeno_time() - hold, 2 * b.t0 * std::pow(e, last + 1) / (1 - e), 1e-9);

      ride.go(1.0);
      EXPECT_EQ(ride.watch.impacts, last + 1);
      EXPECT_TRUE(ride.s.beams[kLeft].held);
      EXPECT_NEAR(ride.s.body.y, 20.0, 1e-9 * ride.p.body.radius);
      EXPECT_NEAR(ride.s.body.vy, 0.0, 1e-9);
      EXPECT_EQ(ride.s.body.x, -25.0);
      EXPECT_LE(ride.watch.max_penetration, 1e-9 * ride.p.body.radius);
      slowest = std::max(slowest, test::thread_seconds() - began);
      ++scenes;
    }
  }
  EXPECT_LE(slowest, 10.0);
  measured({.requirement = 4,
            .method = "stable",
            .what = "Zeno time, relative error, default, from 0.33 m",
            .figure = error,
            .limit = 1e-6,
            .cases = scenes / 3});
  measured({.requirement = 4,
            .method = "stable",
            .what = "hits off the predicted number",
            .figure = static_cast<double>(unforeseen),
            .unit = "hits",
            .limit = 0.0,
            .cases = scenes});
  measured({.requirement = 4,
            .method = "stable",
            .what = "slowest scene, CPU time",
            .figure = slowest,
            .unit = "s",
            .limit = 10.0,
            .cases = scenes});
}

// By hand: all flights last 9 t0 at e = 0.8, and the threshold is reached at hit 21.
TEST(Zeno, NumbersOfTheKnownAnswers) {
  const Bouncing b{0.8, 0.004, 0.04};
  EXPECT_NEAR(b.zeno_time(), 3.0, 1e-12);
  EXPECT_EQ(b.last_hit(), 21);
}

// Without a threshold every flight is simulated until a step holds more hits than the method
// allows; then contact is forced. With 50 hits in one step, the 49 flights in it are over 49 times
// as long as the next one, so less than (step / 49) / (1 - e) of bouncing is left. For small e no
// force is needed: before 50 hits the disc leaves at a speed that counts as rest.
TEST(Zeno, EndsWithoutAThreshold) {
  for (const double e : {0.1, 0.5, 0.8, 0.95, 0.99}) {
    SCOPED_TRACE(e);
    const Bouncing b{e, 0.004, 0.0};
    Ride ride(b.scene(), kBelowThePin);
    const double t = time_until_held(ride, 2 * b.zeno_time());
    EXPECT_NEAR(t, b.zeno_time(), b.step * (1 + 1 / (49 * (1 - e))));
    const int forced = std::pow(e, 50) < 1e-12 ? 0 : 1;
    EXPECT_EQ(ride.watch.forced_holds, forced);
    ride.go(1.0);
    EXPECT_EQ(ride.watch.forced_holds, forced);
    EXPECT_NEAR(ride.s.body.y, 20.0, 1e-9 * ride.p.body.radius);
    EXPECT_NEAR(ride.s.body.vy, 0.0, 1e-9);
  }
}

// Beams of 10^6 kg hardly move either: their recoil is 10^-6 of the disc's speed. Two tips share
// each impulse, so it falls below the threshold as if the threshold were twice as high.
TEST(Zeno, HeavyBeamsBehaveAsTheWall) {
  for (const double x : {-10.0, 0.0}) {  // the left beam's side, both tips
    SCOPED_TRACE(x);
    const int beams = x == 0.0 ? 2 : 1;
    GateParams p = Bouncing{0.8, 0.004, 0.04}.scene();
    p.beams.mass = 1e6;
    const Bouncing b{0.8, 0.004, 0.04 * beams};
    Ride ride(p, at_rest(x, 20.0 - 1.0 / 3));
    const double t = time_until_held(ride, 8.0);
    EXPECT_TRUE(ride.s.beams[kLeft].held);
    EXPECT_EQ(ride.watch.impacts, beams * (b.last_hit() + 1));
    const double hold = b.time_of(b.last_hit());
    EXPECT_GE(t, hold - 1e-4);
    EXPECT_LE(t, hold + b.step + 1e-4);
    ride.go(1.0);
    EXPECT_NEAR(ride.touch(kLeft).gap, 0.0, 1e-9 * p.body.radius);
    EXPECT_NEAR(ride.s.body.vy, 0.0, 1e-4);
    if (beams == 2) {
      EXPECT_TRUE(same_bits(ride.s.beams[kLeft].omega, ride.s.beams[kRight].omega));
    }
  }
}

// ---- Constraints ----

// The disc slides along a beam that it pushes, without hits: the midpoint rule is of second order.
TEST(Stable, ConstraintIsSecondOrder) {
  const auto at = [](double step) {
    GateParams p = test::study(10.0);
    p.beams.stiffness_right = 0.0;
    p.run.step = step;
    const double theta = 0.3, r = 12.0;
    GateState s;
    s.body.x = -p.beams.joint_x + r * std::cos(theta) + p.body.radius * std::sin(theta);
    s.body.y = p.beams.joint_y + r * std::sin(theta) - p.body.radius * std::cos(theta);
    s.body.vx = 4.0;
    s.body.vy = 8.0;
    const double v_n = -std::sin(theta) * s.body.vx + std::cos(theta) * s.body.vy;
    s.beams[kLeft] = {theta, v_n / r, true};  // Eq. (10)
    s.beams[kRight] = {1.5, 0.0, false};      // out of the way
    Ride ride(p, s);
    ride.go(0.4);
    EXPECT_TRUE(ride.s.beams[kLeft].held);
    EXPECT_EQ(ride.watch.impacts, 0);
    return ride.s;
  };
  const GateState exact = at(0.02 / 1280);
  double last = 0.0;
  for (const int n : {5, 10, 20, 40}) {
    const GateState s = at(0.02 / n);
    const double error = std::hypot(s.body.x - exact.body.x, s.body.y - exact.body.y);
    if (last > 0.0) {
      EXPECT_NEAR(std::log2(last / error), 2.0, 0.1) << n;
    }
    last = error;
  }
}

// ---- Pieces of a step ----

/// The number of pieces of a step, half a radian or e-fold each, for a beam of this stiffness.
double pieces_of(const GateParams& p, double stiffness) {
  const double inertia = p.beams.inertia();
  const double rate = std::max(std::sqrt(stiffness / inertia), p.beams.damping / inertia);
  return std::exp2(std::max(0.0, std::ceil(std::log2(p.run.step * rate / 0.5))));
}

// Without contact everything is in closed form: both beams are evaluated once, at the end, and a
// stiff beam swings in one piece, to the last bit.
TEST(Pieces, FreeBeamOutOfReachNeedsOne) {
  GateParams p;
  p.beams.stiffness_left = 1e8;
  ASSERT_GT(pieces_of(p, 1e8), 32.0);
  GateState s = at_rest(0.0, -200.0);
  s.beams[kLeft] = {0.1, 0.2, false};
  Ride ride(p, s);
  ride.step();
  EXPECT_EQ(ride.watch.evaluations, 2);
  BeamState beam = s.beams[kLeft];
  GateLaw(p).over(p.run.step).left.apply(beam, 0.0);
  EXPECT_TRUE(same_bits(ride.s.beams[kLeft].theta, beam.theta));
  EXPECT_TRUE(same_bits(ride.s.beams[kLeft].omega, beam.omega));
  for (int i = 0; i < 50; ++i) ride.step(30.0);
  EXPECT_EQ(ride.watch.evaluations, 51 * 2);
}

// Beside a tip, 0.26 m away: both beams are evaluated in each piece, whether they swing or creep.
TEST(Pieces, FreeBeamWithinReachNeedsItsOwn) {
  for (const double stiffness : {400.0, 1e6, 1e8}) {
    for (const double damping : {50.0, 1e4}) {
      SCOPED_TRACE(testing::Message() << "k = " << stiffness << ", d = " << damping);
      GateParams p;
      p.beams.length = 10.0;
      p.beams.stiffness_left = stiffness;
      p.beams.damping = damping;
      Ride ride(p, at_rest(-8.0, 22.5));
      ride.step();
      EXPECT_EQ(static_cast<double>(ride.watch.evaluations), 2 * pieces_of(p, stiffness));
    }
  }
}

// Pressed against the beam: the contact is evaluated at start, middle and end of each piece, then
// both beams.
TEST(Pieces, HeldBeamNeedsItsOwn) {
  for (const double stiffness : {400.0, 1e6, 1e8}) {
    for (const double damping : {50.0, 1e4}) {
      SCOPED_TRACE(testing::Message() << "k = " << stiffness << ", d = " << damping);
      GateParams p;
      p.beams.stiffness_left = stiffness;
      p.beams.damping = damping;
      GateState s = at_rest(-10.0, 20.0);
      s.beams[kLeft].held = true;
      Ride ride(p, s);
      ride.step();
      EXPECT_TRUE(ride.s.beams[kLeft].held);
      EXPECT_EQ(static_cast<double>(ride.watch.evaluations), 5 * pieces_of(p, stiffness));
    }
  }
}

// A held beam turns by at most 0.05 rad in a piece: 0.12 rad take 4.
TEST(Pieces, HeldBeamThatTurnsFastNeedsMore) {
  GateParams p = test::free_rods();
  GateState s = at_rest(-10.0, 20.0, 0.0, 90.0);
  s.beams[kLeft] = {0.0, 6.0, true};
  p.forces.propulsion = 2000.0;  // so that it stays in contact
  Ride ride(p, s);
  ride.step();
  EXPECT_TRUE(ride.s.beams[kLeft].held);
  EXPECT_GT(ride.s.beams[kLeft].omega, 5.0);
  EXPECT_EQ(ride.watch.evaluations, 4 * 5);
}

// A disc that slides along a held beam onto its joint, where the contact force jumps. Compared with
// steps of 0.04 ms, worst over six places in the step: measured 3.1e-5 m and 0.006 m/s; in one
// piece 9e-4 m and 0.11 m/s.
TEST(Pieces, ContactThatChangesItsKindNeedsTheShortest) {
  const auto slid = [](double r, double step, std::int64_t least_evaluations) {
    GateParams p = test::study(10.0);
    p.run.step = step;
    const double theta = 1.1, omega = 1.0, slide = 20.0;
    const double x = r * std::cos(theta) + 10.0 * std::sin(theta);  // from the joint
    const double y = r * std::sin(theta) - 10.0 * std::cos(theta);
    GateState s = at_rest(x - 25.0, y + 30.0, -slide * std::cos(theta) - omega * y,
                          -slide * std::sin(theta) + omega * x);
    s.beams[kLeft] = {theta, omega, true};
    Ride ride(p, s);
    EXPECT_EQ(ride.touch(kLeft).kind, ContactKind::interior);
    ride.go(0.02);
    EXPECT_EQ(ride.touch(kLeft).kind, ContactKind::pin);
    EXPECT_GE(ride.watch.evaluations, least_evaluations);
    return ride.s.body;
  };
  for (const double r : {0.02, 0.07, 0.12, 0.19, 0.26, 0.33}) {
    SCOPED_TRACE(r);
    const BodyState exact = slid(r, 0.02 / 512, 512 * 2);
    const BodyState b = slid(r, 0.02, 5 * 5);  // tried in 1, 1/2 ... 1/16 of the step
    EXPECT_LE(std::hypot(b.x - exact.x, b.y - exact.y), 1e-4);
    EXPECT_LE(std::hypot(b.vx - exact.vx, b.vy - exact.vy), 0.02);
  }
}

// ---- Watch ----

TEST(Stable, WatchKeepsTheLargest) {
  GateParams p;
  const double h = p.run.step;
  p.forces.propulsion = 0.0;
  GateState s;
  s.beams[kLeft].theta = -0.3;
  s.beams[kRight].omega = 2.0;
  s.body.vx = 3.0;
  s.body.vy = -4.0;
  Ride ride(p, s);
  double right = 0.0;
  for (int i = 0; i < 250; ++i) {
    ride.step();
    right = std::max(right, std::abs(ride.s.beams[kRight].theta));
  }
  EXPECT_EQ(ride.watch.max_theta[kRight], right);
  EXPECT_GT(right, 0.2);
  // The watch first records after a step.
  EXPECT_NEAR(ride.watch.max_theta[kLeft], 0.3, 0.3 * 4.4 * 4.4 / 2 * h * h);
  EXPECT_NEAR(ride.watch.max_speed, 5.0 * std::exp(-0.06 * h), 1e-12);
  EXPECT_EQ(ride.watch.steps, 250);
}

// ---- The exit ----

// Under drag and force the path is nearly a cubic over one step. y'''' <= D^2 (F + D v), which is
// 2.3 m/s^4 at 2 m/s downwards; a cubic is off by y'''' h^4 / 384 in position and y'''' h^3 / 125
// in velocity: 1.5e-12 m and 1.2e-9 m/s at 0.004 s.
TEST(Stable, LeavesACurvedFlightOnTheBorder) {
  GateParams p = test::free_rods();
  p.forces.propulsion = 8.0;
  p.forces.drag = 0.5;
  const BodyState start{3.0, 45.0, 6.0, -2.0};
  const double g = 0.5, a = 8.0;  // s^-1, m/s^2
  const auto moved = [&](double v, double acceleration, double t) {
    const double rise = (1 - std::exp(-g * t)) / g;
    return v * rise + acceleration * (t - rise) / g;
  };
  double inside = 0.0, beyond = 10.0;  // s
  for (int i = 0; i < 60; ++i) {
    const double t = 0.5 * (inside + beyond);
    (start.y + moved(start.vy, a, t) > p.run.traverse_y ? beyond : inside) = t;
  }
  for (const double h : {0.004, 0.02}) {
    SCOPED_TRACE(h);
    p.run.step = h;
    Ride ride(p, {start, {}});
    ride.s.beams[kLeft].theta = ride.s.beams[kRight].theta = -1.5;  // out of the way
    const double passed = ride.go(10.0), miss = 2.3 * std::pow(h, 4) / 384;
    EXPECT_NEAR(passed, beyond, miss / 11.0);  // at 11 m/s
    EXPECT_NEAR(ride.s.body.y, p.run.traverse_y, 4 * 60 * kEps);
    EXPECT_GT(ride.s.body.y, p.run.traverse_y);
    EXPECT_NEAR(ride.s.body.x, start.x + moved(start.vx, 0.0, beyond), 2 * miss);
    const double decay = std::exp(-g * beyond);
    EXPECT_NEAR(ride.s.body.vy, start.vy * decay + a * (1 - decay) / g, 2.3 * std::pow(h, 3) / 125);
  }
}

// Below the left joint, 5 m/s upwards: the disc hits the pin after 2 ms, e = 0.8. It leaves by the
// side before or after the hit, within the same step; a hit after the exit must not be seen.
TEST(Stable, LeavesBeforeOrAfterAHitInTheSameStep) {
  for (const double vx : {-1.0, -0.3}) {
    SCOPED_TRACE(vx);
    Ride ride(test::free_rods(), at_rest(-25.0 + 0.001, 20.0 - 0.01, vx, 5.0));
    const double passed = ride.step(), when = 0.001 / -vx;  // 1 ms, 3.3 ms
    const bool after = when > 0.002;
    EXPECT_TRUE(outside(ride.p, ride.s.body));
    // The hit, 1 mm or less beside the joint, turns the way by at most 2e-4 of 1.3 ms * 9 m/s.
    EXPECT_NEAR(passed, when, after ? 1e-5 : 4 * 25 * kEps);
    EXPECT_EQ(ride.watch.impacts, after ? 1 : 0);
    EXPECT_NEAR(ride.s.body.vy, after ? -4.0 : 5.0, 1e-3);
    EXPECT_NEAR(ride.s.body.y, after ? 20.0 - 4.0 * (when - 0.002) : 19.995,
                after ? 1e-4 : 5 * 4 * 25 * kEps);
  }
}

// A free beam may swing many times in the step in which the disc leaves: 4.4 rad here. Its exit
// state must be its closed form at that moment, known to 4.4 eps.
TEST(Stable, LeavesWithFreeBeamsInClosedForm) {
  GateParams p = test::free_rods();
  p.beams.stiffness_left = 1e6;
  p.beams.damping = 50.0;
  GateState s = at_rest(24.9, -50.0, 10.0, 0.0);  // at the side after 10 ms
  s.beams[kLeft] = {0.1, 3.0, false};
  Ride ride(p, s);
  const double passed = ride.step();
  EXPECT_TRUE(outside(ride.p, ride.s.body));
  EXPECT_NEAR(passed, 0.01, 4 * 25 * kEps);
  BeamState beam = s.beams[kLeft];
  GateLaw(p).beams[kLeft].over(passed).apply(beam, 0.0);
  EXPECT_NEAR(ride.s.beams[kLeft].theta, beam.theta, 16 * kEps * 0.1);
  EXPECT_NEAR(ride.s.beams[kLeft].omega, beam.omega, 16 * kEps * 22.0);
  EXPECT_EQ(ride.watch.energy_created, 0.0);
}

}  // namespace
}  // namespace gatewalk::dynamics
