// SPDX-License-Identifier: MIT
#include "dynamics/disc/methods/stable.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "dynamics/disc/ensemble.h"
#include "dynamics/disc/gate.h"
#include "tests/support/long.h"
#include "tests/support/measured.h"
#include "tests/support/mirror.h"
#include "tests/support/near_singular.h"
#include "tests/support/numbers.h"
#include "tests/support/ride.h"
#include "tests/support/scenes.h"

namespace gatewalk::dynamics {
namespace {

using test::Draw;
using test::kEps;
using test::kPi;
using test::measured;
using test::Ride;
using test::same_bits;
using test::usual_or_full;

GateState at_rest(double x, double y, double vx = 0.0, double vy = 0.0) {
  GateState s;
  s.body = {x, y, vx, vy};
  return s;
}

// ---- Free motion ----

// S1: the flow is exact, 100 steps round 100 times.
TEST(Stable, FreeBeamFollowsItsClosedForm) {
  GateParams p;
  p.forces.propulsion = 0.0;
  GateState s;
  s.beams[kLeft] = {0.5, 0.3, false};
  s.beams[kRight] = {-0.4, 0.0, false};
  Ride ride(p, s);
  EXPECT_NEAR(ride.go(2.0), 2.0, 1e-12);
  const double wd = std::sqrt(400.0 / p.beams.inertia() - 1.44);
  const auto theta = [&](double theta0, double omega0) {
    return std::exp(-2.4) *
           (theta0 * std::cos(2 * wd) + (omega0 + 1.2 * theta0) / wd * std::sin(2 * wd));
  };
  const double error = std::max(std::abs(ride.s.beams[kLeft].theta - theta(0.5, 0.3)),
                                std::abs(ride.s.beams[kRight].theta - theta(-0.4, 0.0)));
  EXPECT_LE(error, 100 * kEps);
  measured({.requirement = 1,
            .method = "stable",
            .what = "free beam after 2 s, error",
            .figure = error,
            .unit = "rad",
            .limit = 1e-8});
  EXPECT_EQ(ride.watch.impacts, 0);
}

// S2: without damping a free beam keeps its energy over 12 s.
TEST(Stable, FreeBeamKeepsItsEnergyWithoutDamping) {
  GateParams p;
  p.forces.propulsion = 0.0;
  p.beams.damping = 0.0;
  GateState s;
  s.beams[kLeft] = {0.5, 0.0, false};
  Ride ride(p, s);
  const double before = energy(p, ride.s);
  ride.go(12.0);
  // 600 steps, each of which rounds angle and speed by an eps or so.
  const double error = std::abs(energy(p, ride.s) / before - 1.0);
  EXPECT_LE(error, 600 * 4 * kEps);
  measured({.requirement = 2,
            .method = "stable",
            .what = "energy of an undamped beam after 12 s",
            .figure = error,
            .limit = 1e-6});
}

TEST(Stable, FreeBodyFollowsItsClosedForm) {
  GateParams p = test::free_rods();
  p.forces.propulsion = 2.0;
  p.forces.drag = 0.5;
  p.body.mass = 2.0;
  p.beams.joint_x = 1e4;
  p.beams.joint_y = 1e4;
  p.run.traverse_y = 2e4;
  Ride ride(p, at_rest(1.0, -2.0, 3.0, 4.0));
  ride.go(2.0, -6.0);
  const double g = 0.25, rise = (1 - std::exp(-2 * g)) / g, fall = (2 - rise) / g;
  const double tolerance = 100 * 16 * kEps;  // 100 steps, numbers up to 10
  EXPECT_NEAR(ride.s.body.x, 1.0 + 3.0 * rise - 3.0 * fall, tolerance);
  EXPECT_NEAR(ride.s.body.y, -2.0 + 4.0 * rise + 1.0 * fall, tolerance);
  EXPECT_NEAR(ride.s.body.vx, 3.0 * std::exp(-2 * g) - 3.0 * rise, tolerance);
  EXPECT_NEAR(ride.s.body.vy, 4.0 * std::exp(-2 * g) + 1.0 * rise, tolerance);
}

// ---- Single hits ----

// S3 in a gate: 135/59, 750/59, 97.2/59.
TEST(Stable, TangentialHitOfTheKnownAnswers) {
  GateParams p = test::free_rods();
  p.run.step = 0.004;
  Ride ride(p, at_rest(-10.0, 19.97, 0.0, 15.0));
  ride.step();
  EXPECT_EQ(ride.watch.impacts, 1);
  EXPECT_NEAR(ride.s.body.vy, 750.0 / 59, 32 * kEps);
  EXPECT_EQ(ride.s.body.vx, 0.0);
  EXPECT_NEAR(ride.s.beams[kLeft].omega, 97.2 / 59, 16 * kEps);
  EXPECT_EQ(ride.s.beams[kRight].omega, 0.0);
  // The hit is where the gap is zero, to 1e-10 R: 2 ms before, 2 ms after.
  EXPECT_NEAR(ride.s.body.y, 20.0 + 0.002 * 750 / 59, 1e-9);
  EXPECT_NEAR(ride.s.beams[kLeft].theta, 0.002 * 97.2 / 59, 1e-9 / 15);
}

// S5 in a gate: beams that overlap so that the disc meets both 15 m from their joints.
TEST(Stable, SymmetricDoubleHitOfTheKnownAnswers) {
  GateParams p = test::free_rods();
  p.beams.joint_x = 15.0;
  Ride ride(p, at_rest(0.0, 19.97, 0.0, 15.0));
  ride.step();
  EXPECT_NEAR(ride.s.body.vy, 10.78125, 64 * kEps);
  EXPECT_NEAR(ride.s.beams[kLeft].omega, 1.51875, 16 * kEps);
  test::measured_double_hit("stable", ride.s.body.vy, ride.s.beams[kLeft].omega,
                            ride.s.beams[kRight].omega);
  EXPECT_TRUE(same_bits(ride.s.beams[kLeft].omega, ride.s.beams[kRight].omega));
  EXPECT_TRUE(same_bits(ride.s.beams[kLeft].theta, ride.s.beams[kRight].theta));
  EXPECT_EQ(ride.s.body.vx, 0.0);
}

TEST(Stable, RestitutionIsTheRatioOfNormalSpeeds) {
  for (const double e : {0.1, 0.3, 0.8, 1.0}) {
    GateParams p = test::free_rods();
    p.contact.restitution = e;
    Ride ride(p, at_rest(-10.0, 19.97, 2.0, 15.0));
    ride.step();
    ASSERT_EQ(ride.watch.impacts, 1);
    // 2 ms into the step the disc has moved by 4 mm, to r = 15.004; the hit is found to 1e-10 R.
    const double u = ride.s.body.vy - 15.004 * ride.s.beams[kLeft].omega;
    EXPECT_NEAR(u, -15.0 * e, 1e-9) << e;
    EXPECT_EQ(ride.s.body.vx, 2.0) << e;
  }
}

TEST(Stable, PlasticHitLeavesNoNormalSpeed) {
  GateParams p = test::free_rods();
  p.run.step = 0.004;
  p.contact.restitution = 0.0;
  Ride ride(p, at_rest(-10.0, 19.97, 2.0, 15.0));
  ride.step();
  EXPECT_GE(ride.watch.impacts, 1);
  // The beam turns under the disc for 2 ms more, omega^2 R = 11 m/s^2 and 2 omega v_x = 4 m/s^2.
  EXPECT_NEAR(gap_rate(ride.touch(kLeft), ride.s.body, ride.s.beams[kLeft]), 0.0, 0.03);
}

// The free end is elastic whatever the restitution of the side.
TEST(Stable, TipHitKeepsTheEnergy) {
  GateParams p = test::free_rods();
  p.contact.restitution = 0.0;
  Ride ride(p, at_rest(15.0, 25.0, -12.0, 3.0));
  ride.s.beams[kRight].theta = 1.5;  // out of the way
  const double before = energy(p, ride.s);
  while (ride.watch.impacts == 0 && ride.watch.steps < 1000) ride.step();
  ASSERT_EQ(ride.watch.impacts, 1);
  ASSERT_NE(ride.s.beams[kLeft].omega, 0.0);
  EXPECT_NEAR(energy(p, ride.s), before, 16 * kEps * before);
}

// ---- S6: Zeno ----

/// A disc dropped upwards onto something that does not move: F = 6 N, first hit at v0 = 2 m/s after
/// t0 = 1/3 s; flight n lasts 2 t0 e^n, all of them t0 (1 + e) / (1 - e).
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
  /// The first hit, counted from 0, whose impulse (1 + e) M v0 e^n is below the threshold, which is
  /// lower for nearly elastic hits (methods/hybrid.h).
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

/// Steps until the left contact is held, or the limit is over; returns the time.
double time_until_held(Ride& ride, double limit) {
  const auto time = [&] { return static_cast<double>(ride.watch.steps) * ride.p.run.step; };
  while (!ride.s.beams[kLeft].held && time() < limit) ride.step();
  return time();
}

/// Straight below the left joint: the pin does not move at all.
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
      // Seen at the end of the step in which it happens. Hits are found to 1e-12 R and each error
      // lives on in the flights after it: far below 1e-6 s.
      EXPECT_GE(t, hold - 1e-6);
      EXPECT_LE(t, hold + step + 1e-6);
      EXPECT_EQ(ride.watch.impacts, last + 1);
      EXPECT_EQ(ride.watch.forced_holds, 0);
      if (step == GateParams{}.run.step) error = std::max(error, std::abs(t / b.zeno_time() - 1.0));
      unforeseen = std::max(unforeseen, std::abs(ride.watch.impacts - (last + 1)));
      // Zeno's remainder: what the hold cuts off.
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

// The printed numbers of S6: 9 t0 at e = 0.8, the threshold is reached at impact 21.
TEST(Zeno, NumbersOfTheKnownAnswers) {
  const Bouncing b{0.8, 0.004, 0.04};
  EXPECT_NEAR(b.zeno_time(), 3.0, 1e-12);
  EXPECT_EQ(b.last_hit(), 21);
}

// Without a threshold every flight is flown until a step holds more hits than a method can bear;
// then contact is forced. With 50 hits in one step, its 49 flights are over 49 times as long as the
// next; less than (step / 49) / (1 - e) is left to bounce. Small e needs no force: before 50 hits
// the disc leaves at no more than what counts as rest.
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

// Beams of 10^6 kg do not move either: recoil 10^-6 of the disc's speed. Two tips share each
// impulse, which comes below the threshold as if that were twice as high.
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

/// What a trial's contacts showed at the ends of its steps, and where it left the gate.
struct Contacts {
  int held_steps = 0;
  double gap = 0.0, rate = 0.0, overlap = 0.0;                 // held contacts; any contact
  double pull = 0.0;                                           // N, held contacts
  double exit_gap = 0.0, exit_rate = 0.0, exit_overlap = 0.0;  // the same in the exit state
  double exit_speed = 0.0;  // m/s, of the disc and of the points of beams that it touches there
};

Contacts contacts_of_trial(const GateParams& p, int trial) {
  Contacts c;
  RandomForce force(p.forces, Random(Purpose::gate, {1, 0, static_cast<std::uint64_t>(trial)}));
  Ride ride(p, {});
  while (!outside(p, ride.s.body) && static_cast<double>(ride.watch.steps) * p.run.step < 12.0) {
    const double f = force.value();
    force.pass(ride.step(f));
    const bool left = outside(p, ride.s.body);
    const auto most = [left](double& within, double& at_exit, double value) {
      double& worst = left ? at_exit : within;
      worst = std::max(worst, value);
    };
    if (left) c.exit_speed = std::hypot(ride.s.body.vx, ride.s.body.vy);
    const auto held = held_of(ride.s);
    if (!left && (held[kLeft] || held[kRight])) {
      const auto push = contact_forces(p, ride.s, {ride.touch(kLeft), ride.touch(kRight)}, f, held,
                                       bilateral_impulses);
      for (const Side side : {kLeft, kRight})
        if (held[side]) c.pull = std::max(c.pull, -push[side]);
    }
    for (const Side side : {kLeft, kRight}) {
      const Touch t = ride.touch(side);
      const BeamState& beam = ride.s.beams[side];
      most(c.overlap, c.exit_overlap, -t.gap);
      if (left && (beam.held || t.gap < 0.0)) c.exit_speed += std::abs(beam.omega) * p.beams.length;
      if (!beam.held) continue;
      ++c.held_steps;
      most(c.gap, c.exit_gap, std::abs(t.gap));
      most(c.rate, c.exit_rate, std::abs(gap_rate(t, ride.s.body, beam)));
    }
  }
  return c;
}

/// The exit state lies within a step, on a cubic through the step's ends. A disc leaves by a side
/// straight above or below a joint, where it may just roll from the beam's side onto the joint: its
/// acceleration along n jumps by as much as v^2 / R. Of a jump a, at the worst place in the step h,
/// a cubic misses a h^2 / 61 in position and a h / 12 in velocity.
void expect_interpolated(const GateParams& p, const Contacts& c) {
  const double jump = c.exit_speed * c.exit_speed / p.body.radius, h = p.run.step;
  EXPECT_LE(c.exit_gap, 1e-9 * p.body.radius + jump * h * h / 61);
  EXPECT_LE(c.exit_overlap, 1e-9 * p.body.radius + jump * h * h / 61);
  EXPECT_LE(c.exit_rate, 1e-9 + jump * h / 12);
}

// Requirement 6: along whole trials, held contacts stay shut and at rest, others stay open.
TEST(Stable, HeldContactsNeitherDriftNorClose) {
  std::vector<Contacts> seen(200);
  tbb::parallel_for(0, 200, [&](int trial) {
    GateParams p = test::study(trial % 2 ? 50.0 : 10.0);
    p.forces.random = trial % 4 < 2 ? 10.0 : 60.0;
    seen[trial] = contacts_of_trial(p, trial);
  });
  int held_steps = 0;
  double gap = 0.0, pull = 0.0;
  for (const Contacts& c : seen) {
    held_steps += c.held_steps;
    gap = std::max(gap, c.gap);
    pull = std::max(pull, c.pull);
    EXPECT_LE(c.gap, 1e-9 * 10.0);
    EXPECT_LE(c.rate, 1e-9);
    EXPECT_LE(c.overlap, 1e-9 * 10.0);
    expect_interpolated(GateParams{}, c);
  }
  EXPECT_GT(held_steps, 10'000);
  // Forces only push, but whether there is one is asked at mid-step: at the end a contact may be
  // held half a step too long, by what its force falls in that time. Measured 24 N at Rm = 60 N.
  EXPECT_LE(pull, 40.0);
  test::measured_held("stable", gap / 10.0, pull, held_steps);
}

/// The disc leans with 30 N on a heavy beam that stands upright.
GateState leaning(const GateParams& p) {
  GateState s = at_rest(-15.0, 40.0);
  s.beams[kLeft] = {kPi / 2, 0.0, true};
  s.beams[kRight] = {-1.5, 0.0, false};
  s.body.x = p.body.radius - p.beams.joint_x;
  return s;
}

TEST(Stable, ContactIsReleasedWhenItsForceWouldPull) {
  GateParams p = test::free_rods();
  p.beams.mass = 1e6;
  Ride ride(p, leaning(p));
  ride.go(0.4, -30.0);
  EXPECT_TRUE(ride.s.beams[kLeft].held);
  EXPECT_NEAR(ride.touch(kLeft).gap, 0.0, 1e-12);
  ride.go(0.4, 30.0);
  EXPECT_FALSE(ride.s.beams[kLeft].held);
  measured({.requirement = 6,
            .method = "stable",
            .what = "contacts still held when drawn apart",
            .figure = ride.s.beams[kLeft].held ? 1.0 : 0.0,
            .unit = "contacts",
            .limit = 0.0});
  EXPECT_EQ(ride.watch.impacts, 0);
  // From then on it is free: 30 N for 0.4 s, less what the push gave the beam, 3.6e-6 of that.
  EXPECT_NEAR(ride.s.body.vx, 12.0, 1e-4);
  EXPECT_NEAR(ride.touch(kLeft).gap, 0.5 * 30.0 * 0.16, 1e-4);
}

// Sliding along a beam that it pushes, without hits: the midpoint rule is of second order.
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

/// Pieces of a step, half a radian or e-fold each, that a beam of this stiffness needs.
double pieces_of(const GateParams& p, double stiffness) {
  const double inertia = p.beams.inertia();
  const double rate = std::max(std::sqrt(stiffness / inertia), p.beams.damping / inertia);
  return std::exp2(std::max(0.0, std::ceil(std::log2(p.run.step * rate / 0.5))));
}

// Alone everything is in closed form: both beams are looked at once at the end, and a stiff beam
// swings in one piece, to the last bit.
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

// Beside a tip, 0.26 m away: both beams in each piece, whether they would swing or creep.
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

// Pressed against the beam: the contact at start, middle and end of each piece, then both beams.
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

// A disc that slides along a held beam onto its joint: there the contact force jumps. Against steps
// of 0.04 ms, worst over six places in the step, measured 3.1e-5 m and 0.006 m/s; in one piece
// 9e-4 m and 0.11 m/s.
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

// ---- Energy ----

// S7: over 10^4 trials each. What is left is the midpoint rule's error in constrained motion; it
// grows with the speed at which the disc slides along the beams, and so with Rm. Of a disc that has
// up to 430, 920 and 1370 J, limits about four times what was measured:
//     0.004 s: 9e-6, 3e-5, 6e-5 J    0.02 s: 1.3e-3, 4.7e-3, 8e-3 J
TEST(EnergyLedger, StableCreatesNoEnergy) {
  struct Limit {
    double step, random, created;
  };
  for (const Limit& limit :
       {Limit{0.004, 10.0, 4e-5}, Limit{0.004, 40.0, 1.2e-4}, Limit{0.004, 60.0, 2.5e-4},
        Limit{0.02, 10.0, 5e-3}, Limit{0.02, 40.0, 2e-2}, Limit{0.02, 60.0, 3e-2}}) {
    SCOPED_TRACE(testing::Message() << "Rm = " << limit.random << ", step " << limit.step);
    GateParams p = test::study(10.0);
    p.forces.random = limit.random;
    p.run.step = limit.step;
    const GateTally tally = run_gate_trials(p, {}, 1, {0, 10'000});
    EXPECT_LE(tally.health.worst_energy_created, limit.created);
    if (limit.step == GateParams{}.run.step)
      measured({.requirement = 5,
                .method = "stable",
                .what = "energy created in a trial, default",
                .figure = tally.health.worst_energy_created,
                .unit = "J",
                .cases = tally.trials});
    EXPECT_TRUE(tally.health.clean());
    EXPECT_LE(tally.health.worst_penetration, 1e-9 * p.body.radius);
  }
}

// Mean over the same 2000 trials at three steps.
TEST(EnergyLedger, StablesErrorFallsWithTheStep) {
  std::vector<double> mean;
  for (const double step : {0.004, 0.002, 0.001}) {
    GateParams p = test::study(10.0);
    p.forces.random = 40.0;
    p.run.step = step;
    const auto method = make_method(p);
    std::vector<double> created(2000);
    tbb::parallel_for(0, 2000, [&](int trial) {
      RandomForce force(p.forces, Random(Purpose::gate, {1, 0, static_cast<std::uint64_t>(trial)}));
      created[trial] = run_gate(p, *method, {}, force).watch.energy_created;
    });
    double sum = 0.0;
    for (const double c : created) sum += c;
    mean.push_back(sum / 2000);
  }
  // Measured 3.4 and 3.0; the midpoint rule's second order is the least.
  const double order = std::min(std::log2(mean[0] / mean[1]), std::log2(mean[1] / mean[2]));
  EXPECT_GT(order, 2.0);
  measured({.requirement = 5,
            .method = "stable",
            .what = "order of the energy's error in the step",
            .figure = order,
            .limit = 0.9,
            .at_least = true,
            .cases = 2000});
}

// ---- S8: mirror images ----

GateRun outcome(const GateParams& p, const Method& method, const BodyState& start, int trial,
                double sign) {
  const Stream stream{3, 0, static_cast<std::uint64_t>(trial)};
  RandomForce force(p.forces, Random(Purpose::gate, stream), sign);
  return run_gate(p, method, start, force);
}

// Equal and unequal beams, weak and strong noise, from the middle and from anywhere.
TEST(Mirror, StableGivesTheSameBits) {
  const int kTrials = usual_or_full(10'000, 100'000);
  std::vector<GateRun> seen(kTrials), mirror(kTrials);
  std::vector<GateParams> scenes;
  for (const double right : {300.0, 500.0}) {
    for (const double noise : {10.0, 40.0}) {
      GateParams p = test::study(noise == 10.0 ? 10.0 : 50.0);
      p.beams.stiffness_right = right;
      p.forces.random = noise;
      scenes.push_back(p);
    }
  }
  for (std::size_t k = 0; k < scenes.size(); ++k) {
    const GateParams p = scenes[k], m = test::mirrored(p);
    const auto method = make_method(p), mirrored_method = make_method(m);
    tbb::parallel_for(0, kTrials / 4, [&](int i) {
      const int trial = static_cast<int>(k) * (kTrials / 4) + i;
      Draw draw(static_cast<std::uint64_t>(trial));
      BodyState start;
      if (trial % 2)
        start = {draw.uniform(-15, 15), 0.0, draw.uniform(-10, 10), draw.uniform(0, 20)};
      seen[trial] = outcome(p, *method, start, trial, 1.0);
      mirror[trial] = outcome(m, *mirrored_method, test::mirrored(start), trial, -1.0);
    });
  }
  for (int trial = 0; trial < kTrials && !HasFatalFailure(); ++trial) {
    SCOPED_TRACE(trial);
    test::expect_mirror_images(mirror[trial], seen[trial]);
  }
  test::measured_mirror("stable", kTrials, 100'000);
}

// ---- S9: limits ----

// Free rods, elastic: the disc bounces between two rods and loses nothing.
TEST(Limits, FreeRodsKeepTheEnergy) {
  GateParams p = test::free_rods();
  p.contact.restitution = 1.0;
  p.contact.impulse_threshold = 0.0;
  Draw draw(1);
  std::int64_t impacts = 0;
  for (int i = 0; i < 500; ++i) {
    GateState s = at_rest(draw.uniform(-20, 20), 0.0, draw.uniform(-5, 5), draw.uniform(5, 20));
    s.beams[kLeft].omega = draw.uniform(-0.5, 0.1);
    s.beams[kRight].omega = draw.uniform(-0.5, 0.1);
    Ride ride(p, s);
    const double before = energy(p, ride.s);
    ride.go(4.0);
    impacts += ride.watch.impacts;
    if (ride.watch.forced_holds > 0) continue;  // a hold is inelastic
    // Hits change energy by rounding only; 1000 steps.
    ASSERT_NEAR(energy(p, ride.s), before, 1e-12 * before) << i;
  }
  EXPECT_GT(impacts, 500);
}

// k = 10^9 N m/rad, 512 pieces a step. Law: a spring never holds more than the work of propulsion.
TEST(Limits, StiffBeamsAreARigidWall) {
  GateParams p = test::study(50.0);
  p.forces.random = 0.0;
  p.beams.stiffness_left = p.beams.stiffness_right = 1e9;
  for (const double x : {0.0, -10.0}) {
    SCOPED_TRACE(x);
    Ride fall(p, at_rest(x, 0.0));
    fall.go(12.0);
    const double most = std::sqrt(2 * 7.0 * 20.1 / 1e9);
    EXPECT_GT(fall.watch.impacts, 0);
    EXPECT_LE(fall.watch.max_theta[kLeft], most);
    EXPECT_LE(fall.watch.max_theta[kRight], most);
    EXPECT_LE(fall.s.body.y, 20.0 + 25.0 * most);
    // Let go near by it settles: k theta = F r, half of F for each of two tips. d = 1000 N m s/rad
    // damps disc and beams together at d / 2 (I + M r^2), 1.5 / s or more: e^-18 in 12 s.
    GateParams damped = p;
    damped.beams.damping = 1000.0;
    Ride settle(damped, at_rest(x, 19.99));
    settle.go(12.0);
    const double r = x + 25.0, share = x == 0.0 ? 3.5 : 7.0;
    EXPECT_NEAR(settle.s.body.y, 20.0 + share * r * r / 1e9, 1e-6);
    EXPECT_NEAR(settle.s.body.vy, 0.0, 1e-6);
    // k = 10^12 N m/rad would be too fast for a light beam, but not for one of 10^4 kg.
    damped.beams.mass = 1e4;
    damped.beams.stiffness_left = damped.beams.stiffness_right = 1e12;
    Ride wall(damped, at_rest(x, 19.99));
    wall.go(12.0);
    const double error = std::abs(wall.s.body.y - (20.0 + share * r * r / 1e12));
    EXPECT_LE(error, 1e-6);
    measured({.requirement = 9,
              .method = "stable",
              .what = "place of rest at a wall, k = 1e12",
              .figure = error,
              .unit = "m",
              .limit = 1e-6});
  }
}

TEST(Limits, BeamsTooStiffForTheStepAreRefused) {
  // 1024 pieces of a step of 0.02 s may turn a beam's phase by 0.5 each: rates up to 25 600 / s.
  const double inertia = GateParams{}.beams.inertia(), rate = 1024 * 0.5 / 0.02;
  const auto refused = [](const GateParams& p) {
    try {
      (void)StableMethod(p);
    } catch (const InvalidParameter& e) {
      return e.key();
    }
    return std::string();
  };
  GateParams p;
  p.beams.stiffness_left = 0.999 * rate * rate * inertia;
  EXPECT_EQ(refused(p), "");
  p.beams.stiffness_right = 1.001 * rate * rate * inertia;
  EXPECT_EQ(refused(p), "run.step_s");
  p = {};
  p.beams.damping = 0.999 * rate * inertia;
  EXPECT_EQ(refused(p), "");
  p.beams.damping = 1.001 * rate * inertia;
  EXPECT_EQ(refused(p), "run.step_s");
  p.run.step = 0.01;
  EXPECT_EQ(refused(p), "");
}

TEST(Limits, NothingMovesWithoutForces) {
  GateParams p;
  p.forces.propulsion = p.forces.random = 0.0;
  const StableMethod method(p);
  // Apart, touching a beam, touching both tips, touching a joint.
  for (const BodyState& start :
       {BodyState{3, 5}, BodyState{-10, 20}, BodyState{0, 20}, BodyState{-25, 20}}) {
    RandomForce force(p.forces, Random(Purpose::gate, {}));
    const GateRun run = run_gate(p, method, start, force);
    EXPECT_EQ(run.outcome, Outcome::trapped);
    EXPECT_EQ(run.exit.x, start.x);
    EXPECT_EQ(run.exit.y, start.y);
    EXPECT_EQ(run.exit.vx, 0.0);
    EXPECT_EQ(run.exit.vy, 0.0);
    EXPECT_EQ(run.watch.max_theta[kLeft], 0.0);
    EXPECT_EQ(run.watch.max_theta[kRight], 0.0);
  }
}

TEST(Limits, PlasticAndElasticTrialsAreHealthy) {
  for (const double e : {0.0, 1.0}) {
    GateParams p = test::study(10.0);
    p.contact.restitution = p.contact.tip_restitution = e;
    p.forces.random = 40.0;
    const GateTally tally = run_gate_trials(p, {}, 1, {0, 500});
    EXPECT_TRUE(tally.health.clean()) << e;
    EXPECT_LE(tally.health.worst_energy_created, 5e-3) << e;
    std::vector<Contacts> seen(500);  // the same trials, looked at after every step
    tbb::parallel_for(0, 500, [&](int trial) { seen[trial] = contacts_of_trial(p, trial); });
    for (const Contacts& c : seen) {
      EXPECT_LE(c.overlap, 1e-9 * p.body.radius) << e;
      expect_interpolated(p, c);
    }
  }
}

// ---- S10: time reversal ----

// Elastic, no damping, no drag: turned round, the disc finds its way back through up to ten hits.
// Each is found to 1e-12 R or so and stretches the errors before it. Measured 2.4e-12.
TEST(Reversal, ReturnsToTheStart) {
  GateParams p = test::study(0.0);
  p.run.step = 0.004;
  p.forces.random = 0.0;
  p.contact.restitution = 1.0;
  p.contact.impulse_threshold = 0.0;
  int rides = 0;
  double worst = 0.0;
  for (const double x : {-18.0, -12.0, -6.0, 5.0, 11.0, 17.0}) {
    const GateState start = at_rest(x, 5.0, 0.3, 12.0);
    Ride ride(p, start);
    while (ride.watch.impacts < 10 && ride.watch.steps < 1000) ride.step();
    if (outside(p, ride.s.body) || ride.watch.forced_holds > 0) continue;
    const auto steps = ride.watch.steps;
    for (int i = 0; i < 10; ++i) ride.step();
    const auto turn = [](GateState& s) {
      s.body.vx = -s.body.vx;
      s.body.vy = -s.body.vy;
      for (BeamState& b : s.beams) b.omega = -b.omega;
    };
    const auto there = ride.watch.impacts;
    EXPECT_GE(there, 4);
    turn(ride.s);
    for (int i = 0; i < steps + 10; ++i) ride.step();
    turn(ride.s);
    EXPECT_EQ(ride.watch.impacts, 2 * there);
    ++rides;
    worst = std::max(
        {worst, std::abs(ride.s.body.x - start.body.x), std::abs(ride.s.body.y - start.body.y),
         std::abs(ride.s.body.vx - start.body.vx), std::abs(ride.s.body.vy - start.body.vy),
         std::abs(ride.s.beams[kLeft].theta), std::abs(ride.s.beams[kRight].theta),
         std::abs(ride.s.beams[kLeft].omega), std::abs(ride.s.beams[kRight].omega)});
  }
  EXPECT_EQ(rides, 6);
  EXPECT_LE(worst, 1e-10);
  measured({.requirement = 10,
            .method = "stable",
            .what = "distance from the start on return",
            .figure = worst,
            .unit = "m, m/s, rad",
            .limit = 1e-6,
            .cases = rides});
}

// ---- S11, S12, S14: near-singular starts ----

void expect_no_trouble(test::Near near) {
  const int kStarts = usual_or_full(25'000, 200'000);
  const GateParams p;
  const StableMethod method(p);
  std::vector<test::Trouble> seen(kStarts);
  tbb::parallel_for(0, kStarts, [&](int i) {
    Draw draw(static_cast<std::uint64_t>(near) * 1'000'000 + static_cast<std::uint64_t>(i));
    const GateState start = test::near_singular(near, p, draw);
    seen[i] = test::trouble(p, method, start, draw);
  });
  test::measured_trouble("stable", p, seen);
  for (int i = 0; i < kStarts; ++i) {
    ASSERT_EQ(seen[i].not_finite, 0) << "start " << i;
    // Up to 1e-10 R the method calls contact.
    ASSERT_LE(seen[i].overlap, 1e-9 * p.body.radius) << "start " << i;
  }
}

TEST(NearSingular, CentreCloseToTheJointsCircle) { expect_no_trouble(test::Near::joint); }
TEST(NearSingular, LeverCloseToZero) { expect_no_trouble(test::Near::lever); }
TEST(NearSingular, TipNormalThroughTheJoint) { expect_no_trouble(test::Near::tip); }
TEST(NearSingular, HandOverAtTheTip) { expect_no_trouble(test::Near::handover); }
TEST(NearSingular, AlmostNoSpeedAcross) { expect_no_trouble(test::Near::grazing); }

// S14: a disc that flies past the tip or joint of a beam, closest approach R (1 +- delta): a hit if
// and only if it comes closer than R, and the impulse goes to zero with delta as sqrt(delta).
TEST(Grazing, HitsOnlyBelowTheRadius) {
  GateParams p = test::free_rods();
  p.contact.impulse_threshold = 0.0;
  p.beams.joint_x = 1000.0;
  p.beams.joint_y = 1000.0;
  p.run.traverse_y = 2000.0;
  p.run.step = 0.0005;  // chord below R by delta lasts 2 sqrt(2 delta) R / v: 28 ms at delta 1e-4
  for (const double delta : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
    for (const double side : {1.0, -1.0}) {
      SCOPED_TRACE(testing::Message() << "R (1 " << (side > 0 ? "+ " : "- ") << delta << ')');
      // Straight up past the tip, which is at (-975, 1000).
      const double x = -975.0 + p.body.radius * (1 + side * delta);
      Ride ride(p, at_rest(x, 990.0, 0.0, 10.0));
      ride.go(2.0);
      if (side > 0) {
        EXPECT_EQ(ride.watch.impacts, 0);
        EXPECT_EQ(ride.s.body.vx, 0.0);
      } else {
        EXPECT_GE(ride.watch.impacts, 1);
        // u = v cos(angle), sin(angle) = 1 - delta: at most v sqrt(2 delta); J <= 2 M u, along n.
        const double u = 10.0 * std::sqrt(2 * delta);
        EXPECT_GT(ride.s.body.vx, 0.0);
        EXPECT_LE(ride.s.body.vx, 2 * u);
        EXPECT_NEAR(ride.s.body.vy, 10.0, 2 * u * std::sqrt(2 * delta));
      }
    }
  }
}

TEST(NearSingular, CentreOnTheJoint) {
  const GateParams p;
  const StableMethod method(p);
  Draw draw(1);
  // An impossible start, inside a beam: it must come back finite, whatever it does.
  for (const double x : {-25.0, -10.0, 0.0})
    EXPECT_EQ(test::trouble(p, method, at_rest(x, 30.0), draw).not_finite, 0) << x;
}

// Scenes from corner to corner: soft and stiff, light and heavy, plastic and elastic.
TEST(Stable, RunsAnySceneItAccepts) {
  const int kScenes = usual_or_full(6000, 100'000);
  struct Seen {
    bool refused = false, broken = false, finite = true, light = false, clean = true;
    double overlap = 0.0, created = 0.0, seconds = 0.0;
  };
  std::vector<Seen> seen(kScenes);
  tbb::parallel_for(0, kScenes, [&](int i) {
    Draw draw(static_cast<std::uint64_t>(i));
    const auto maybe_zero = [&](double low, double high) {
      return draw.below(5) == 0 ? 0.0 : draw.log_uniform(low, high);
    };
    GateParams p;
    p.body.mass = draw.log_uniform(1e-3, 1e3);
    p.beams.mass = draw.log_uniform(1e-6, 1e3);
    p.beams.stiffness_left = maybe_zero(1e-3, 1e9);
    p.beams.stiffness_right = maybe_zero(1e-3, 1e9);
    p.beams.damping = maybe_zero(1e-3, 1e6);
    p.forces.propulsion = maybe_zero(1e-1, 1e2) * p.body.mass;
    p.forces.random = maybe_zero(1e-1, 1e2) * p.body.mass;
    p.forces.drag = maybe_zero(1e-3, 1e2);
    p.contact.restitution = draw.below(4) == 0 ? draw.below(2) : draw.uniform(0, 1);
    p.contact.tip_restitution = draw.below(4) == 0 ? draw.below(2) : draw.uniform(0, 1);
    p.contact.impulse_threshold = maybe_zero(1e-4, 1.0);
    p.run.time_limit = 2.0;
    try {
      const auto method = make_method(p);
      RandomForce force(p.forces, Random(Purpose::gate, {1, 0, static_cast<std::uint64_t>(i)}));
      const double began = test::thread_seconds();
      const GateRun run = run_gate(p, *method, {draw.uniform(-20, 20), 0, 0, 15}, force);
      const double seconds = test::thread_seconds() - began;
      const double speed = std::max(15.0, run.watch.max_speed);
      const double energy = p.body.mass * speed * speed;
      const BodyState& b = run.exit;
      Health health;
      add_run(health, p, run);
      seen[i] = {false,
                 run.outcome == Outcome::broken,
                 std::isfinite(b.x + b.y + b.vx + b.vy),
                 p.beams.mass < p.body.mass,
                 health.clean(),
                 run.watch.max_penetration,
                 run.watch.energy_created / energy,
                 seconds};
    } catch (const InvalidParameter& e) {
      EXPECT_EQ(e.key(), "run.step_s");
      seen[i].refused = true;
    }
  });
  int refused = 0, broken = 0, escaped = 0, hung = 0, deep = 0, created = 0;
  double slowest = 0.0;
  for (const Seen& s : seen) {
    refused += s.refused;
    broken += s.broken;
    escaped += !s.finite && !s.broken;
    hung += s.seconds > 10.0;
    slowest = std::max(slowest, s.seconds);
  }
  test::measured_scenes("stable", {kScenes, refused, broken, escaped, hung, slowest});
  EXPECT_EQ(broken, 0);
  EXPECT_EQ(escaped, 0);
  EXPECT_LE(slowest, 10.0);
  for (int i = 0; i < kScenes; ++i) {
    EXPECT_LE(seen[i].overlap, 1e-6 * 10.0)
        << i;  // requirement 11's bar; next to all keep a tighter one
    deep += seen[i].overlap > 1e-9 * 10.0;
    // A light beam that a heavy disc holds may whip round its joint faster than any step follows;
    // then energy appears (and Health says so). A beam as heavy as the disc does not, but for a few
    // scenes in a hundred thousand.
    if (seen[i].light) continue;
    created += seen[i].created > 1e-5;
    EXPECT_TRUE(seen[i].created <= 1e-4 || !seen[i].clean) << i;
  }
  const bool full = kScenes == 100'000;  // measured; none among the ordinary ones
  EXPECT_LE(deep, full ? 6 : 0);
  EXPECT_LE(created, full ? 18 : 0);
  EXPECT_LT(refused, kScenes / 4);
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
  // Seen first after a step.
  EXPECT_NEAR(ride.watch.max_theta[kLeft], 0.3, 0.3 * 4.4 * 4.4 / 2 * h * h);
  EXPECT_NEAR(ride.watch.max_speed, 5.0 * std::exp(-0.06 * h), 1e-12);
  EXPECT_EQ(ride.watch.steps, 250);
}

// ---- The way out ----

// A straight line: only rounding, of 25 m in each of 125 steps.
TEST(Stable, StopsWhereTheBodyLeavesTheGate) {
  GateParams p = test::free_rods();
  p.run.step = 0.004;
  Ride ride(p, at_rest(20.0, 0.0, 10.0, 0.0));
  const double passed = ride.go(1.0);
  EXPECT_TRUE(outside(ride.p, ride.s.body));
  EXPECT_NEAR(ride.s.body.x, 25.0, 4 * 25 * kEps);
  EXPECT_NEAR(passed, 0.5, 125 * 25 * kEps);
  EXPECT_EQ(ride.watch.steps, 126);  // 0.5 s are 125 steps; rounding leaves the way out to the next
}

// Under drag and force the way is no cubic, but over one step all but. y'''' <= D^2 (F + D v),
// which is 2.3 m/s^4 at 2 m/s downwards; a cubic misses y'''' h^4 / 384 in position and y'''' h^3 /
// 125 in velocity: 1.5e-12 m and 1.2e-9 m/s at 0.004 s.
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

// Below the left joint, 5 m/s upwards: the pin is hit after 2 ms, e = 0.8. The disc leaves by the
// side before or after that, within the same step; what was not yet must not be seen.
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

// A free beam may swing many times in the step in which the disc leaves: 4.4 rad here. Its state
// then is its closed form at that moment; 4.4 rad are known to as many eps.
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
