// SPDX-License-Identifier: MIT
#include "dynamics/disc/study/meaning.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "dynamics/base/random.h"
#include "dynamics/disc/landscape.h"
#include "dynamics/disc/methods/method.h"
#include "dynamics/disc/random_force.h"
#include "tests/support/ride.h"

namespace gatewalk::dynamics {
namespace {

/// The paper's gate with beams too short to be in the way.
GateParams open_gate() {
  GateParams p;
  p.beams.length = 5.0;
  return p;
}

TEST(Meaning, SpeedAndPassageAreThoseOfABodyInTheOpen) {
  GateParams p = open_gate();
  p.forces.random = 0.0;
  p.run.method = "event";
  const BodyState start{0.0, 0.0, 0.0, 15.0};
  const Meaning m = meaning_of(p, start);
  EXPECT_DOUBLE_EQ(m.top_speed, 8.0 / 0.06);
  EXPECT_DOUBLE_EQ(1.0 - std::exp(-m.top_speed_time * 0.06 / 1.0), 0.95);
  test::Ride ride(p, test::at_rest(start.x, start.y, start.vx, start.vy));
  ride.go(m.passage);
  EXPECT_NEAR(ride.s.body.y, p.run.traverse_y, 1e-9);
  EXPECT_NEAR(ride.s.body.vy, m.passage_speed, 1e-9);
  EXPECT_DOUBLE_EQ(m.passages_waited, 12.0 / m.passage);
  EXPECT_DOUBLE_EQ(m.draws_per_length, 50.0 * m.passage / 3.0);  // 60 m are 3 body lengths
  EXPECT_DOUBLE_EQ(m.push_per_weight, 8.0 / 9.80665);

  p.forces.propulsion = 0.0;  // stops after 15/0.06 m, short of 300 m
  EXPECT_TRUE(std::isfinite(meaning_of(p, start).passage));
  p.run.traverse_y = 300.0;
  EXPECT_TRUE(std::isinf(meaning_of(p, start).passage));
  p.forces.drag = 0.0;
  EXPECT_DOUBLE_EQ(meaning_of(p, start).passage, 20.0);
  EXPECT_TRUE(std::isinf(meaning_of(p, start).top_speed));
}

TEST(Meaning, NoiseShakesTheBodyAsFarAsItsRunsSay) {
  GateParams p = open_gate();
  p.beams.joint_x = 1e6;
  p.forces.drag = 0.7;
  for (const double seconds : {0.013, 0.05, 3.0}) {  // less than a hold, holds and a part, many
    double squares = 0.0;
    constexpr int kTrials = 4000;
    for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
      RandomForce force(p.forces, Random(Purpose::gate, {7, 0, trial}));
      double x = 0.0, v = 0.0, left = seconds;
      while (left > 1e-12) {  // x'' = f/M - (D/M) x', a step per hold
        const double f = force.value(), dt = std::min(left, force.left()), c = p.forces.drag;
        const double rise = (1.0 - std::exp(-c * dt)) / c;
        x += rise * v + f * (dt - rise) / c;
        v = std::exp(-c * dt) * v + f * rise;
        force.pass(dt);
        left -= dt;
      }
      squares += x * x;
    }
    const double seen = std::sqrt(squares / kTrials);
    EXPECT_NEAR(shaken_sideways(p, seconds) / seen, 1.0, 4.0 / std::sqrt(2.0 * kTrials)) << seconds;
  }
  // Long runs: the spread of white noise of the same power, sqrt(T / f) Rm / D; and holds in
  // groups.
  EXPECT_NEAR(shaken_sideways(p, 1e5) / (std::sqrt(1e5 / 50.0) * 40.0 / 0.7), 1.0, 1e-4);
}

TEST(Meaning, BeamsResistAsTheirEnergyRises) {
  GateParams p;
  const BeamsOnTheMiddle beams = beams_on_the_middle(p);
  double most = 0.0;
  for (double y = 15.0; y < 60.0; y += 1e-3)
    most = std::max(most, (beam_energy(p, 0, y + 1e-4) - beam_energy(p, 0, y - 1e-4)) / 2e-4);
  EXPECT_NEAR(beams.resistance, most, 1e-4 * most);
  EXPECT_GT(most, p.forces.propulsion);
  // Where the beams are held, their resistance equals the propulsion.
  double y = 15.0;
  while (forward_deflection(p, kLeft, 0, y) < beams.held_angle) y += 1e-5;
  EXPECT_NEAR((beam_energy(p, 0, y + 1e-4) - beam_energy(p, 0, y - 1e-4)) / 2e-4,
              p.forces.propulsion, 1e-2);

  p.forces.propulsion = 1.01 * beams.resistance;
  EXPECT_TRUE(std::isnan(beams_on_the_middle(p).held_angle));
  EXPECT_EQ(beams_on_the_middle(open_gate()).resistance, 0.0);
  p.beams.joint_x = 9.0;  // narrower than the disc
  EXPECT_TRUE(std::isinf(beams_on_the_middle(p).resistance));
}

// How to measure damping: from two swings and the time between them, d = 2 I ln(A1/A2) / T.
TEST(Meaning, ABeamRingsDownAsItsDampingSays) {
  GateParams p = test::quiet_gate();
  p.run.method = "event";
  const RingDown r = ring_down(p, kLeft);
  test::Ride ride(p, test::let_go(0.5));
  ride.go(r.period);
  const BeamState beam = ride.s.beams[kLeft];
  EXPECT_NEAR(beam.theta, 0.5 * r.kept, 1e-9);
  EXPECT_NEAR(beam.omega, 0.0, 1e-9);  // a swing's end
  const double inertia = p.beams.inertia(), log_ratio = std::log(0.5 / beam.theta);
  EXPECT_NEAR(2.0 * inertia * log_ratio / r.period, p.beams.damping, 1e-6);
  EXPECT_NEAR(inertia * (std::pow(2.0 * std::numbers::pi, 2) + log_ratio * log_ratio) /
                  (r.period * r.period),
              p.beams.stiffness_left, 1e-5);
  EXPECT_NEAR(std::exp(-r.period / r.half * std::log(2.0)), r.kept, 1e-12);
}

TEST(Meaning, ABeamInOilCreeps) {
  GateParams p = test::quiet_gate();
  p.beams.damping = 12000.0;
  p.run.method = "event";
  const RingDown r = ring_down(p, kLeft);
  EXPECT_TRUE(std::isinf(r.period));
  test::Ride ride(p, test::let_go(0.5));
  ride.go(10.0);
  const double before = ride.s.beams[kLeft].theta;
  ride.go(r.half);
  EXPECT_NEAR(ride.s.beams[kLeft].theta / before, 0.5, 1e-6);
  EXPECT_NEAR(r.half, std::log(2.0) * p.beams.damping / p.beams.stiffness_left, 1e-3 * r.half);
  p.beams.stiffness_left = 0.0;
  EXPECT_TRUE(std::isinf(ring_down(p, kLeft).half));
}

TEST(Meaning, IsThatOfATwinInOtherUnits) {
  GateParams p, twin;
  const double l = 0.0061, m = 0.09, t = 0.3;
  const double energy = m * l * l / (t * t);
  twin.body = {p.body.mass * m, p.body.radius * l};
  twin.beams.length *= l;
  twin.beams.mass *= m;
  twin.beams.stiffness_left *= energy;
  twin.beams.stiffness_right *= energy;
  twin.beams.damping *= energy * t;
  twin.beams.joint_x *= l;
  twin.beams.joint_y *= l;
  twin.forces = {p.forces.propulsion * m * l / (t * t), p.forces.random * m * l / (t * t),
                 p.forces.random_rate / t, p.forces.drag * m / t};
  twin.run.step *= t;
  twin.run.time_limit *= t;
  twin.run.traverse_y *= l;
  const Meaning a = meaning_of(p, {0, 0, 0, 15}), b = meaning_of(twin, {0, 0, 0, 15 * l / t});
  EXPECT_NEAR(b.passage / t, a.passage, 1e-9 * a.passage);
  EXPECT_NEAR(b.shaken / l, a.shaken, 1e-9 * a.shaken);
  EXPECT_NEAR(b.beams.held_angle, a.beams.held_angle, 1e-6);
  EXPECT_NEAR(b.passages_waited, a.passages_waited, 1e-9);
  EXPECT_NEAR(b.draws_per_length, a.draws_per_length, 1e-9);
}

}  // namespace
}  // namespace gatewalk::dynamics
