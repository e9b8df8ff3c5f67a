// SPDX-License-Identifier: MIT
#include "dynamics/disc/study/accuracy.h"
#include "dynamics/base/kept_pieces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "tests/support/numbers.h"
#include "tests/support/scenes.h"
#include "tests/support/threads.h"

namespace gatewalk::dynamics {
namespace {

using test::kEps;

TrialEnd left(double x = 0.0, double seconds = 1.0) {
  return {Outcome::traversed_left, 0, {x, 65.0, 0.0, 10.0}, seconds};
}
TrialEnd trapped() { return {Outcome::trapped, 87, {}, 12.0}; }

// ---- Settings ----

TEST(ChartSettings, AreEightOrMoreFromCoarseToFine) {
  GateParams p;
  for (const auto method : chart_methods()) {
    const auto settings = chart_settings(method, p);
    ASSERT_GE(settings.size(), 8u) << method;
    int usual = 0;
    for (std::size_t i = 0; i < settings.size(); ++i) {
      if (i > 0) {
        EXPECT_LT(settings[i].value, settings[i - 1].value) << method;
      }
      const GateParams q = settings[i].applied_to(p);
      EXPECT_EQ(q.run.method, method);
      EXPECT_EQ(method == "event" ? q.run.event_tolerance : q.run.step, settings[i].value);
      EXPECT_NO_THROW(validate(q)) << method << ' ' << settings[i].value;
      usual += settings[i].usual;
    }
    EXPECT_EQ(usual, 1) << method;
  }
  EXPECT_THROW((void)chart_settings("euler", p), std::invalid_argument);
}

TEST(ChartSettings, StepsFitIntoAnyHold) {
  GateParams p;
  p.forces.random_rate = 30.0;
  for (const Setting& s : chart_settings("stable", p)) EXPECT_NO_THROW(validate(s.applied_to(p)));
}

// ---- Weak error, by hand ----

// Ten trials: compared with the reference, the run has two more `left`, one fewer `right` and one
// fewer `trapped`. TV = (2 + 1 + 1)/2/10 = 0.2. Two trials changed, each towards the surplus: d =
// 1, 1, 0 x 8, so the variance of the mean is (10 * 0.2 * 0.8)/9/10 = 0.16/9. The columns changed
// 2, 1, 1 times: chance = sqrt(2/pi)/2/10 (sqrt 2 + 1 + 1).
TEST(WeakError, OfHandMadeOutcomes) {
  std::vector<TrialEnd> reference(10, left()), run;
  reference[0].outcome = reference[1].outcome = Outcome::traversed_right;
  reference[2].outcome = reference[3].outcome = Outcome::trapped;
  run = reference;
  run[0].outcome = run[2].outcome = Outcome::traversed_left;
  const WeakError e = outcome_error(run, reference);
  EXPECT_NEAR(e.total_variation, 0.2, 4 * kEps);
  EXPECT_NEAR(e.standard_error, std::sqrt(0.16 / 9.0), 4 * kEps);
  EXPECT_NEAR(e.chance, std::sqrt(2.0 / std::numbers::pi) / 20.0 * (std::sqrt(2.0) + 2.0),
              4 * kEps);
  EXPECT_EQ(e.changed, 2);
}

// Trials that swap outcomes cancel: the error is 0, and `chance` gives the error that they could
// have made.
TEST(WeakError, ExchangedTrialsCancel) {
  std::vector<TrialEnd> reference(4, left()), run;
  reference[0] = trapped();
  run = reference;
  std::swap(run[0], run[1]);
  const WeakError e = outcome_error(run, reference);
  EXPECT_EQ(e.total_variation, 0.0);
  EXPECT_EQ(e.changed, 2);
  EXPECT_NEAR(e.chance, std::sqrt(2.0 / std::numbers::pi) / 8.0 * 2.0 * std::sqrt(2.0), 4 * kEps);
}

// If changes of the reference cancel by chance, the limit follows from chance; without changes,
// from one trial.
TEST(WeakError, LimitIsTheLargestOfErrorChanceAndOneTrial) {
  EXPECT_EQ(weak_limit({.total_variation = 0.02, .chance = 0.01}, 1000), kReferenceMargin * 0.02);
  EXPECT_EQ(weak_limit({.total_variation = 0.0, .chance = 0.01}, 1000), kReferenceMargin * 0.01);
  EXPECT_EQ(weak_limit({.total_variation = 0.0, .chance = 0.0}, 1000), kReferenceMargin * 0.001);
}

// The mean of |TV| over fair coin flips of the changed trials is `chance`. 2000 repeats of 100
// trials have a standard deviation of sqrt(1 - 2/pi) of the mean, which leaves 1.7 %; the normal
// law for a sum of 100 flips is off by 1/(4 * 100). Tolerance: 4 standard errors and this error, 4
// * 1.7 % + 0.25 %.
TEST(WeakError, ChanceIsWhatFairFlipsShow) {
  test::Draw draw(7);
  double sum = 0.0, chance = 0.0;
  constexpr int kRepeats = 2000;
  for (int r = 0; r < kRepeats; ++r) {
    std::vector<TrialEnd> a, b;
    for (int i = 0; i < 100; ++i) {
      const bool forth = draw.coin();
      a.push_back(forth ? left() : trapped());
      b.push_back(forth ? trapped() : left());
    }
    const WeakError e = outcome_error(a, b);
    sum += e.total_variation;
    chance = e.chance;
  }
  EXPECT_NEAR(sum / kRepeats, chance, 0.07 * chance);
}

// The paired standard error equals the spread over repeats of the experiment: 10 % of the trials
// change, two in three of them one way. A standard deviation from 2000 repeats has a relative error
// of 1/sqrt(4000) = 1.6 %, the mean of the estimates a smaller one. Tolerance: 4 of these.
TEST(WeakError, StandardErrorIsTheSpreadOfRepeats) {
  test::Draw draw(8);
  double sum = 0.0, squares = 0.0, claimed = 0.0;
  constexpr int kRepeats = 2000;
  for (int r = 0; r < kRepeats; ++r) {
    std::vector<TrialEnd> a, b;
    for (int i = 0; i < 1000; ++i) {
      const double u = draw.uniform(0, 1);
      a.push_back(u < 0.5 ? left() : trapped());
      b.push_back(u < 0.5 - 0.2 / 3 || (u >= 0.5 && u < 0.5 + 0.1 / 3) ? left() : trapped());
    }
    const WeakError e = outcome_error(a, b);
    sum += e.total_variation;
    squares += e.total_variation * e.total_variation;
    claimed += e.standard_error;
  }
  const double mean = sum / kRepeats;
  EXPECT_NEAR(mean, 0.1 / 3, 4 * std::sqrt(0.1 / 1000 / kRepeats));
  const double spread = std::sqrt(squares / kRepeats - mean * mean);
  EXPECT_NEAR(claimed / kRepeats / spread, 1.0, 0.065);
}

// Two starts: of the first start's 4 trials one changes from trapped to left; of the second start's
// 6 trials two change the other way. The mean is 4/10 * 1/4 + 6/10 * 2/6 = 0.3; all trials together
// have a surplus of one trapped, 0.1. Standard errors: variances of the means 1/4 * 3/4 / 3 and 2/6
// * 4/6 / 5, weighted with 0.4^2 and 0.6^2.
TEST(WeakError, OfTwoStartsDoesNotCancel) {
  std::vector<TrialEnd> reference(10, left()), run;
  reference[0] = trapped();
  run = reference;
  run[0] = left();
  run[4] = run[5] = trapped();
  const TrialRange parts[] = {{0, 4}, {4, 6}};
  const WeakError e = outcome_error(run, reference, parts);
  EXPECT_NEAR(e.total_variation, 0.3, 4 * kEps);
  EXPECT_NEAR(outcome_error(run, reference).total_variation, 0.1, 4 * kEps);
  EXPECT_NEAR(e.standard_error, std::sqrt(0.16 / 16.0 + 0.36 * 2.0 / 45.0), 4 * kEps);
  EXPECT_EQ(e.changed, 3);
}

TEST(WeakError, OfColumns) {
  const StateSpace space = table3_space(GateParams{});
  std::vector<TrialEnd> reference(5, left()), run = reference;
  run[0].column = space.size() + 1;  // broken, the last column
  run[1].column = 3;
  EXPECT_NEAR(column_error(run, reference, space).total_variation, 0.4, 4 * kEps);
  EXPECT_EQ(outcome_error(run, reference).total_variation, 0.0);
  EXPECT_THROW((void)outcome_error(run, std::span(reference).first(4)), std::invalid_argument);
  EXPECT_THROW((void)outcome_error({}, {}), std::invalid_argument);
}

// ---- Strong error, by hand ----

// Of ten trials five have not parted, four have, and one is trapped. The median of nine is the
// fifth.
TEST(StrongError, MediansWithPartedTrialsInfinitelyFar) {
  const GateParams p;
  std::vector<TrialEnd> reference(10, left()), run = reference;
  run[0].exit.x = 0.1;
  run[0].exit.vx = 3.0;  // 3 m/s off, 1/2 * 9 J
  run[1].exit.x = -0.2;
  run[1].seconds = 1.01;
  run[2].exit.x = 0.4;
  run[2].outcome = Outcome::traversed_right;  // the same way out
  run[3].exit.x = 1.5;                        // parted: too far
  run[4].seconds = 1.06;                      // parted: too late
  run[5].outcome = Outcome::exited_left;      // parted: another way
  run[6] = reference[6] = trapped();
  run[7].outcome = reference[7].outcome = Outcome::broken;  // parted, even if both broke
  run[8].exit.x = 0.05;
  run[8].seconds = 0.98;
  run[9].exit.x = 0.3;
  const StrongError e = strong_error(p, run, reference);
  EXPECT_EQ(e.compared, 5);
  EXPECT_EQ(e.parted, 4);
  EXPECT_EQ(e.trapped, 1);
  EXPECT_NEAR(e.parted_share(), 4.0 / 9.0, kEps);
  EXPECT_NEAR(e.position, 0.4, kEps);   // 0.05, 0.1, 0.2, 0.3, 0.4
  EXPECT_NEAR(e.velocity, 3.0, kEps);   // 0, 0, 0, 0, 3
  EXPECT_NEAR(e.time, 0.02, 4 * kEps);  // 0, 0, 0, 0.01, 0.02
  EXPECT_NEAR(e.energy, 4.5, 4 * kEps);
}

// A method that loses more trials must not seem better; from half on there is no median.
TEST(StrongError, GrowsAsTrialsPart) {
  std::vector<TrialEnd> reference(8, left()), run = reference;
  for (std::size_t i = 0; i < run.size(); ++i) run[i].exit.x = 0.01 * static_cast<double>(i + 1);
  for (std::size_t parted = 0; parted < 8; ++parted) {
    if (parted > 0) run[8 - parted].outcome = Outcome::broken;  // the farthest of those left
    const StrongError e = strong_error(GateParams{}, run, reference);
    EXPECT_EQ(e.parted, static_cast<std::int64_t>(parted));
    if (parted < 4) {
      EXPECT_NEAR(e.position, 0.05, kEps) << parted;  // the fifth of eight, independent of the last
    } else {
      EXPECT_TRUE(std::isnan(e.position) && std::isnan(e.energy)) << parted;
    }
  }
}

TEST(StrongError, TrappedOnlyInOneHasParted) {
  const std::vector<TrialEnd> a{left(), trapped()}, b{trapped(), trapped()};
  const StrongError e = strong_error(GateParams{}, a, b);
  EXPECT_EQ(e.parted, 1);
  EXPECT_EQ(e.trapped, 1);
  EXPECT_EQ(e.compared, 0);
  EXPECT_TRUE(std::isnan(e.position));
}

// ---- Trials ----

TEST(TrialEnds, AreThoseOfGateTrials) {
  const GateParams p = test::study(10.0);
  TrialEnds ends;
  add_trial_ends(ends, p, {}, 5, {0, 120});
  add_trial_ends(ends, p, {}, 5, {120, 80});
  const GateTally tally = run_gate_trials(p, {}, 5, {0, 200});
  std::array<std::int64_t, kOutcomes> n{};
  const StateSpace space = table3_space(p);
  for (const TrialEnd& e : ends.trials) {
    ++n[static_cast<std::size_t>(e.outcome)];
    EXPECT_EQ(e.column == space.trapped(), e.outcome == Outcome::trapped);
    EXPECT_LE(e.column, space.trapped());
  }
  EXPECT_EQ(n, tally.counts);  // none is even
  EXPECT_EQ(ends.health.steps, tally.health.steps);
  EXPECT_EQ(ends.verdict(), Verdict::fine);
}

TEST(TrialEnds, SameOnAnyNumberOfThreads) {
  const GateParams p = test::study(10.0);
  const auto on = [&](int threads) {
    return test::on_threads(threads, [&] {
      TrialEnds ends;
      add_trial_ends(ends, p, {}, 5, {0, 100});
      return ends;
    });
  };
  const TrialEnds one = on(1), four = on(4);
  for (std::size_t i = 0; i < one.trials.size(); ++i) {
    EXPECT_TRUE(test::same_bits(one.trials[i].exit.x, four.trials[i].exit.x)) << i;
    EXPECT_EQ(one.trials[i].outcome, four.trials[i].outcome) << i;
  }
}

TEST(TrialEnds, AgainstThemselvesAreExact) {
  const GateParams p = test::study(10.0);
  TrialEnds ends;
  add_trial_ends(ends, p, {}, 5, {0, 100});
  const WeakError weak = column_error(ends.trials, ends.trials, table3_space(p));
  EXPECT_EQ(weak.total_variation, 0.0);
  EXPECT_EQ(weak.chance, 0.0);
  EXPECT_EQ(weak.changed, 0);
  const StrongError strong = strong_error(p, ends.trials, ends.trials);
  EXPECT_EQ(strong.parted, 0);
  EXPECT_GT(strong.compared, 0);
  EXPECT_EQ(strong.position, 0.0);
  EXPECT_EQ(strong.velocity, 0.0);
}

// A run whose limit of work is too small is no trial: it ends broken.
TEST(TrialEnds, CutShortIsBroken) {
  const GateParams p = test::study(10.0);
  const auto method = make_method(p);
  const GateRun whole = run_gate_trial(p, *method, {}, 1, 0);
  const GateRun cut = run_gate_trial(p, *method, {}, 1, 0, 100);
  EXPECT_FALSE(whole.out_of_work);
  EXPECT_TRUE(cut.out_of_work);
  EXPECT_LT(cut.watch.steps, 100 + 2 * steps_per_hold(p));
  const StateSpace space = table3_space(p);
  EXPECT_EQ(end_of(p, space, cut).outcome, Outcome::broken);
  EXPECT_EQ(end_of(p, space, cut).column, space.size() + 1);
}

// ---- A check by a better method ----

// The trials are those of the gate; the sample is a fifth of them, at least 100.
TEST(CheckedTrials, AreThoseOfTheGateAndASampleIsChecked) {
  const GateParams p = test::study(10.0);
  const BodyState start{.x = 1.0, .y = 0.0, .vx = 0.0, .vy = 12.0};
  const GateTally checked = run_checked_trials(p, start, 3, {"runs", {0, 600}});
  const GateTally plain = run_gate_trials(p, start, 3, {0, 600});
  EXPECT_EQ(checked.trials, 600);
  EXPECT_EQ(checked.counts, plain.counts);
  EXPECT_EQ(checked.health.impacts, plain.health.impacts);
  EXPECT_EQ(plain.health.checked_trials, 0);
  EXPECT_EQ(checked.health.checked_trials, 120);
  Health by_hand = plain.health;
  check_outcomes(by_hand, p, {&start, 1}, 3, 120);
  EXPECT_EQ(checked.health.outcome_error, by_hand.outcome_error);
}

// ---- Order of a method ----

// 300 trials of `stable` against `stable` at hold/80: the median exit error of trials that have not
// parted falls with the square of the step (contacts are of second order, hits are found exactly).
// From hold/2 to hold/8 the factor is 16; between 8 and 32 the slope is 1.5 to 2.5.
TEST(StrongError, OfStableFallsWithTheStep) {
  const GateParams p = test::study(10.0);
  const auto with_step = [&](int n) {
    GateParams q = p;
    q.run.step = 0.02 / n;
    TrialEnds ends;
    add_trial_ends(ends, q, {}, 5, {0, 300});
    return ends;
  };
  const TrialEnds reference = with_step(80), coarse = with_step(2), fine = with_step(8);
  const StrongError at_coarse = strong_error(p, coarse.trials, reference.trials);
  const StrongError at_fine = strong_error(p, fine.trials, reference.trials);
  const double fall = at_coarse.position / at_fine.position;
  EXPECT_GT(fall, 8.0);
  EXPECT_LT(fall, 32.0);
  EXPECT_LT(at_fine.parted_share(), 0.05);
  // The error of the outcomes is at most what parted trials can change.
  EXPECT_LE(outcome_error(fine.trials, reference.trials).total_variation, 0.02);
}

// ---- Verdicts ----

TEST(Verdict, IsTheWorstFaultOfMoreThanThePermittedRuns) {
  Health h;
  h.runs = 1000;
  h.steps = 100'000;
  EXPECT_EQ(judge(h, 0, 0.01), Verdict::fine);
  h.undefined_contacts = 1001;
  EXPECT_EQ(judge(h, 0, 0.01), Verdict::no_formula);
  h.fast = 11;
  EXPECT_EQ(judge(h, 0, 0.01), Verdict::too_fast);
  h.creating_energy = 11;
  EXPECT_EQ(judge(h, 0, 0.01), Verdict::energy);
  h.penetrating = 10;
  EXPECT_EQ(judge(h, 0, 0.01), Verdict::energy);  // 1 % is permitted
  EXPECT_EQ(judge(h, 0, 0.0), Verdict::penetration);
  h.penetrating = 11;
  EXPECT_EQ(judge(h, 0, 0.01), Verdict::penetration);
  h.unstable = 11;
  EXPECT_EQ(judge(h, 0, 0.01), Verdict::beyond_bound);
  h.forced_holds = 100;
  EXPECT_EQ(judge(h, 0, 0.01), Verdict::beyond_bound);
  h.forced_holds = 101;
  EXPECT_EQ(judge(h, 0, 0.01), Verdict::stuck);
  h.forced_holds = 0;
  EXPECT_EQ(judge(h, 1, 0.01), Verdict::stuck);
  h.broken = 1;
  EXPECT_EQ(judge(h, 0, 0.01), Verdict::not_finite);
  EXPECT_EQ(name_of(Verdict::not_finite), "not finite");
  EXPECT_EQ(name_of(Verdict::refused), "refused");
}

}  // namespace
}  // namespace gatewalk::dynamics
