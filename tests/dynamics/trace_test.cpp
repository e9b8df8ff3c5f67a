// SPDX-License-Identifier: MIT
#include "dynamics/disc/trace.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dynamics/disc/ensemble.h"
#include "tests/support/numbers.h"
#include "tests/support/scenes.h"

namespace gatewalk::dynamics {
namespace {

using test::kEps;
using test::same_bits;

GateTrace trace(const GateParams& p, std::int64_t trial, const BodyState& start = {}) {
  RandomForce force = gate_force(p, 1, trial);
  return trace_gate(p, *make_method(p), start, force);
}

class Trace : public testing::TestWithParam<const char*> {
 protected:
  GateParams p = [] {
    GateParams study = test::study(10.0);
    study.run.method = GetParam();
    study.run.step = default_step(study);
    if (study.run.method == "penalty") study.run.step = 5e-4;
    return study;
  }();
};

// Recording a trace does not change the run.
TEST_P(Trace, IsTheRunItself) {
  for (const std::int64_t trial : {0, 1, 2, 6}) {
    const GateRun run = run_gate_trial(p, *make_method(p), {}, 1, trial);
    const GateTrace t = trace(p, trial);
    EXPECT_EQ(t.run.outcome, run.outcome);
    EXPECT_TRUE(same_bits(t.run.exit.x, run.exit.x) && same_bits(t.run.exit.vy, run.exit.vy));
    const GateState& last = t.samples.back().state;
    EXPECT_TRUE(same_bits(last.body.x, run.exit.x) && same_bits(last.body.vy, run.exit.vy));
    EXPECT_EQ(static_cast<std::int64_t>(t.samples.size()), run.watch.steps + 1);
    EXPECT_NEAR(t.samples.back().time, run.seconds, 1e-9);
  }
}

// Energy at the start plus work equals the energy present plus the energy lost, and the lost energy
// never decreases.
TEST_P(Trace, EnergyIsAccountedFor) {
  const bool sound =
      p.run.method == "stable" || p.run.method == "event" || p.run.method == "moreau";
  const GateTrace t = trace(p, 0);
  const double at_start = t.samples.front().energy.mechanical();
  double worst_gain = 0.0, lost = 0.0;
  for (const TraceSample& s : t.samples) {
    const Energies& e = s.energy;
    EXPECT_NEAR(at_start + e.propulsion_work + e.random_work, e.mechanical() + e.lost, 1e-9);
    worst_gain = std::max(worst_gain, lost - e.lost);
    lost = std::max(lost, e.lost);
  }
  // The springs of penalty return energy; all other methods agree with the run's own watch.
  if (p.run.method != "penalty") {
    EXPECT_NEAR(worst_gain, t.run.watch.energy_created, 1e-9);
  }
  if (sound) {
    EXPECT_LE(worst_gain, 0.01);
    EXPECT_GT(t.samples.back().energy.hit_loss, 1.0);
    EXPECT_LT(t.samples.back().energy.hit_loss, t.samples.back().energy.lost);
  }
}

// Before the first contact only propulsion and random force push the body; then the beams push
// back.
TEST_P(Trace, ForcesOfTheBeams) {
  const GateTrace t = trace(p, 0);
  double pushed_back = 0.0;
  std::size_t free_steps = 0;
  for (const TraceSample& s : t.samples) {
    if (s.state.body.y < 19.0 && s.time < 2.0) {
      ++free_steps;
      EXPECT_NEAR(s.beam_force[0], 0.0, 1e-8) << s.time;
      EXPECT_NEAR(s.beam_force[1], 0.0, 1e-8) << s.time;
      EXPECT_EQ(s.contact[kLeft], ContactMode::free);
    }
    pushed_back = std::min(pushed_back, s.beam_force[1]);
  }
  EXPECT_GT(free_steps, 50u);
  EXPECT_LT(pushed_back, -7.0);
}

INSTANTIATE_TEST_SUITE_P(Methods, Trace,
                         testing::Values("stable", "event", "moreau", "paper", "penalty"),
                         [](const auto& method) { return std::string(method.param); });

// A hit on one beam in the middle of a free flight: (1 - e^2)/2 mu u^2, and the impulse (1 + e) mu
// u.
TEST(TraceOfOneHit, HasItsImpulseAndItsLoss) {
  for (const char* method : {"stable", "event", "paper"}) {
    GateParams p = test::free_rods();
    p.run.method = method;
    p.run.step = 0.004;
    p.run.time_limit = 0.4;
    const BodyState start{-10.0, 15.0, 0.0,
                          15.0};  // meets the left beam's interior, 15 m from its joint
    const GateTrace t = trace(p, 0, start);
    const double lever = 15.0, mu = 1.0 / (1.0 / p.body.mass + lever * lever / p.beams.inertia());
    const double u = 15.0, e = p.contact.restitution;
    double impulse = 0.0;
    int hits = 0;
    for (const TraceSample& s : t.samples) {
      impulse += s.impulse[kLeft];
      hits += s.contact[kLeft] == ContactMode::hit;
      EXPECT_EQ(s.impulse[kRight], 0.0);
    }
    EXPECT_EQ(hits, 1) << method;
    EXPECT_NEAR(impulse, (1 + e) * mu * u, 1e-9) << method;
    EXPECT_NEAR(t.samples.back().energy.hit_loss, 0.5 * (1 - e * e) * mu * u * u, 1e-9) << method;
    EXPECT_NEAR(t.samples.back().energy.lost, t.samples.back().energy.hit_loss, 1e-9) << method;
  }
}

TEST(EnergyGain, IsTheChangeOfKineticEnergyOfBothHits) {
  const GateParams p;
  GateState s;
  s.body = {2.0, 21.0, 1.0, 6.0};
  s.beams[kLeft] = {0.05, -0.3, false};
  s.beams[kRight] = {0.02, 0.2, false};
  const std::array<Touch, 2> t{nearest(p, kLeft, s.body, 0.05), nearest(p, kRight, s.body, 0.02)};
  const std::array<double, 2> u{gap_rate(t[0], s.body, s.beams[0]),
                                gap_rate(t[1], s.body, s.beams[1])},
      impulse{1.7, 0.9};
  GateState after = s;
  apply_impulses(p, t, impulse, after);
  EXPECT_NEAR(energy_gain(coupling(p, t), u, impulse), energy(p, after) - energy(p, s),
              64 * kEps * energy(p, s));
}

}  // namespace
}  // namespace gatewalk::dynamics
