// SPDX-License-Identifier: MIT
#include "dynamics/disc/ensemble.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/numbers.h"
#include "tests/support/scenes.h"
#include "tests/support/threads.h"

namespace gatewalk::dynamics {
namespace {

using test::same_bits;

void expect_same(const Health& a, const Health& b) {
  EXPECT_EQ(a.runs, b.runs);
  EXPECT_EQ(a.penetrating, b.penetrating);
  EXPECT_EQ(a.creating_energy, b.creating_energy);
  EXPECT_EQ(a.fast, b.fast);
  EXPECT_EQ(a.broken, b.broken);
  EXPECT_EQ(a.undefined_contacts, b.undefined_contacts);
  EXPECT_EQ(a.forced_holds, b.forced_holds);
  EXPECT_EQ(a.impacts, b.impacts);
  EXPECT_EQ(a.steps, b.steps);
  EXPECT_TRUE(same_bits(a.worst_penetration, b.worst_penetration));
  EXPECT_TRUE(same_bits(a.worst_energy_created, b.worst_energy_created));
  EXPECT_TRUE(same_bits(a.worst_speed, b.worst_speed));
}

void expect_same(const GateTally& a, const GateTally& b) {
  EXPECT_EQ(a.trials, b.trials);
  EXPECT_EQ(a.counts, b.counts);
  expect_same(a.health, b.health);
}

// ---- Health ----

GateRun healthy_run() {
  GateRun run;
  run.outcome = Outcome::trapped;
  run.watch.max_speed = 20.0;
  return run;
}

// Limits: 1 % of R = 0.1 m; 1e-4 (8 N * 60 m + 1/2 * 1 kg * (20 m/s)^2) = 0.068 J.
TEST(Health, JudgesEachRun) {
  const GateParams p;
  Health h;
  add_run(h, p, healthy_run());
  GateRun run = healthy_run();
  run.watch.max_penetration = 0.0999;
  run.watch.energy_created = 0.0679;
  add_run(h, p, run);
  EXPECT_TRUE(h.clean());
  EXPECT_EQ(h.runs, 2);
  EXPECT_EQ(h.worst_penetration, 0.0999);
  EXPECT_EQ(h.worst_energy_created, 0.0679);
  EXPECT_EQ(h.worst_speed, 20.0);

  const auto judged = [&](auto change) {
    GateRun bad = healthy_run();
    change(bad);
    Health one;
    add_run(one, p, bad);
    EXPECT_FALSE(one.clean());
    Health sum = h;
    sum += one;
    EXPECT_FALSE(sum.clean());
    EXPECT_EQ(sum.runs, 3);
    return one;
  };
  EXPECT_EQ(judged([](GateRun& r) { r.watch.max_penetration = 0.1001; }).penetrating, 1);
  EXPECT_EQ(judged([](GateRun& r) { r.watch.energy_created = 0.0681; }).creating_energy, 1);
  EXPECT_EQ(judged([](GateRun& r) { r.watch.fast_steps = 4; }).fast, 1);
  EXPECT_EQ(judged([](GateRun& r) { r.outcome = Outcome::broken; }).broken, 1);
  EXPECT_EQ(judged([](GateRun& r) { r.watch.undefined_contacts = 7; }).undefined_contacts, 7);
}

TEST(Health, FewForcedHoldsAreNoFault) {
  GateRun run = healthy_run();
  run.watch.forced_holds = 3;
  run.watch.impacts = 5;
  run.watch.steps = 3000;
  Health h;
  add_run(h, GateParams{}, run);
  EXPECT_TRUE(h.clean());
  Health twice = h;
  twice += h;
  EXPECT_EQ(twice.forced_holds, 6);
  EXPECT_EQ(twice.impacts, 10);
  EXPECT_EQ(twice.steps, 6000);
  ++twice.forced_holds;
  EXPECT_FALSE(twice.clean());
}

// ---- Tallies ----

TEST(GateTrials, EveryTrialEndsOnce) {
  const GateTally t = run_gate_trials(test::study(10.0), {}, 1, {0, 500});
  EXPECT_EQ(t.trials, 500);
  EXPECT_EQ(t.traversed() + t.exited() + t[Outcome::trapped] + t[Outcome::broken], 500);
  EXPECT_EQ(t.traversed(),
            t[Outcome::traversed_left] + t[Outcome::traversed_right] + t[Outcome::traversed_even]);
  EXPECT_EQ(t.health.runs, 500);
  EXPECT_EQ(t[Outcome::broken], t.health.broken);
  EXPECT_GT(t[Outcome::traversed_left], 0);
  EXPECT_GT(t[Outcome::exited_left], 0);
  EXPECT_GT(t[Outcome::exited_right], 0);
  EXPECT_GT(t[Outcome::trapped], 0);
}

// Trial i in any range is the run of stream {seed, 0, i}.
TEST(GateTrials, TrialsCanBeReplayedAlone) {
  for (const char* method : {"stable", "paper"}) {
    GateParams p = test::study(10.0);
    p.forces.random = 40.0;
    p.run.method = method;
    const auto m = make_method(p);
    GateTally sum;
    for (std::int64_t trial = 7; trial < 27; ++trial) {
      RandomForce force(p.forces,
                        Random(Purpose::gate, {42, 0, static_cast<std::uint64_t>(trial)}));
      const GateRun run = run_gate(p, *m, {}, force);
      const GateTally alone = run_gate_trials(p, {}, 42, {trial, 1});
      EXPECT_EQ(alone.traversed(), is_traversed(run.outcome));
      EXPECT_EQ(alone[Outcome::exited_left], run.outcome == Outcome::exited_left);
      EXPECT_EQ(alone[Outcome::exited_right], run.outcome == Outcome::exited_right);
      EXPECT_EQ(alone[Outcome::trapped], run.outcome == Outcome::trapped);
      EXPECT_TRUE(same_bits(alone.health.worst_speed, run.watch.max_speed));
      EXPECT_TRUE(same_bits(alone.health.worst_energy_created, run.watch.energy_created));
      EXPECT_EQ(alone.health.impacts, run.watch.impacts);
      sum += alone;
    }
    expect_same(sum, run_gate_trials(p, {}, 42, {7, 20}));
  }
}

TEST(GateTrials, SameBitsOnAnyNumberOfThreadsAndForAnySplit) {
  const GateParams p = test::study(10.0);
  const auto on = [&](int threads) {
    return test::on_threads(threads, [&] { return run_gate_trials(p, {}, 5, {0, 300}); });
  };
  const GateTally whole = on(1);
  expect_same(on(2), whole);
  expect_same(on(8), whole);
  GateTally split;
  for (const TrialRange part : {TrialRange{0, 1}, {1, 98}, {99, 0}, {99, 201}})
    split += run_gate_trials(p, {}, 5, part);
  expect_same(split, whole);
}

TEST(GateTrials, OtherSeedOtherTrials) {
  const GateParams p = test::study(10.0);
  const GateTally a = run_gate_trials(p, {}, 1, {0, 50}), b = run_gate_trials(p, {}, 2, {0, 50});
  EXPECT_NE(a.health.worst_speed, b.health.worst_speed);
}

TEST(GateTrials, LeftMeansTheLeftBeamWasDeflectedMore) {
  GateParams p = test::study(10.0);
  p.forces.random = 0.0;
  p.forces.propulsion = 40.0;  // enough to get through
  p.beams.stiffness_right = 300.0;
  GateTally t = run_gate_trials(p, {0, 0, 0, 0}, 1, {0, 3});
  EXPECT_EQ(t[Outcome::traversed_even], 3);  // mirror symmetric: equal to the last bit
  t = run_gate_trials(p, {-8, 0, 0, 0}, 1, {0, 3});
  EXPECT_EQ(t[Outcome::traversed_left], 3);
  t = run_gate_trials(p, {8, 0, 0, 0}, 1, {0, 3});
  EXPECT_EQ(t[Outcome::traversed_right], 3);
}

TEST(GateTrials, ScenesThatCannotBeRunAreRefused) {
  GateParams p;
  p.run.step = 0.003;
  EXPECT_THROW((void)run_gate_trials(p, {}, 1, {0, 1}), InvalidParameter);
}

// ---- Converged figures of an independent program: F = 7, Rm = 10, kL = 300, kR = 500 ----

double percent(std::int64_t n, const GateTally& t) {
  return 100.0 * static_cast<double>(n) / static_cast<double>(t.trials);
}

// 20 000 trials of an independent program each. At 46 % their standard error is 0.35 % and that of
// our 10 000 trials 0.5 %, together 0.6 %; the tolerance is 2.5 times that.
TEST(GateTrials, ConvergedFiguresAtDamping10) {
  const GateTally t = run_gate_trials(test::study(10.0), {}, 1, {0, 10'000});
  EXPECT_NEAR(percent(t[Outcome::traversed_left], t), 46.0, 1.5);
  EXPECT_NEAR(percent(t.exited(), t), 35.8, 1.5);
  EXPECT_NEAR(percent(t[Outcome::trapped], t), 18.0, 1.5);
  EXPECT_TRUE(t.health.clean());
}

TEST(GateTrials, ConvergedFiguresAtDamping50) {
  const GateTally t = run_gate_trials(test::study(50.0), {}, 1, {0, 10'000});
  EXPECT_NEAR(percent(t[Outcome::traversed_left], t), 5.5, 0.8);
  EXPECT_NEAR(percent(t.exited(), t), 53.4, 1.5);
  EXPECT_NEAR(percent(t[Outcome::trapped], t), 41.0, 1.5);
  EXPECT_TRUE(t.health.clean());
}

double total_variation(const GateTally& a, const GateTally& b) {
  double distance = 0.0;
  for (std::size_t k = 0; k < kOutcomes; ++k)
    distance += 0.5 * std::abs(static_cast<double>(a.counts[k] - b.counts[k])) /
                static_cast<double>(a.trials);
  return distance;
}

// The default step is converged. A twentieth of the step, with the same noise, changes at most 1 %
// of the outcomes net.
TEST(GateTrials, OutcomesAreConvergedInTheStep) {
  GateParams p = test::study(10.0);
  const GateTally coarse = run_gate_trials(p, {}, 1, {0, 2000});
  p.run.step = 0.001;
  const GateTally fine = run_gate_trials(p, {}, 1, {0, 2000});
  EXPECT_LE(total_variation(coarse, fine), 0.01);
}

// Without restitution every hit becomes a lasting contact: outcomes are those of the reference, and
// hits do not accumulate.
TEST(GateTrials, PlasticHitsHaveTheReferencesOutcomes) {
  GateParams p;
  p.contact.restitution = 0.0;
  const GateTally stable = run_gate_trials(p, {.vy = 15.0}, 1, {0, 2000});
  p.run.method = "event";
  p.run.event_tolerance = 1e-4;
  const GateTally event = run_gate_trials(p, {.vy = 15.0}, 1, {0, 2000});
  EXPECT_GT(event.traversed(), 400);
  EXPECT_LE(total_variation(stable, event), 0.006);
  EXPECT_TRUE(stable.health.clean());
  EXPECT_LE(stable.health.forced_holds, 10);
}

// Nothing moves by more than half a radius between two checks for contact, up to speeds that need a
// thousand pieces of a step: no hit is missed, and the outcomes are those of the reference. Beyond,
// the status reports it.
TEST(GateTrials, TheDefaultFollowsAnySpeedOrSaysSo) {
  GateParams p;
  p.run.time_limit = 2.0;
  const auto towards = [](double speed, double angle) {
    return BodyState{3.0, 0.0, speed * std::cos(angle), speed * std::sin(angle)};
  };
  for (const double speed : {30.0, 300.0, 3000.0, 3e4})
    for (const double angle : {0.1, 0.8, 1.5}) {
      SCOPED_TRACE(testing::Message() << speed << " m/s at " << angle);
      const GateTally stable = run_gate_trials(p, towards(speed, angle), 1, {0, 100});
      EXPECT_TRUE(stable.health.clean());
      EXPECT_GE(stable.health.impacts, angle > 0.5 ? 100 : 0);
      GateParams q = p;
      q.run.method = "event";
      const GateTally event = run_gate_trials(q, towards(speed, angle), 1, {0, 100});
      EXPECT_LE(total_variation(stable, event), 0.02);
    }
  EXPECT_EQ(run_gate_trials(p, towards(1e6, 1.5), 1, {0, 100}).health.fast, 100);
}

}  // namespace
}  // namespace gatewalk::dynamics
