// SPDX-License-Identifier: MIT
#include "dynamics/disc/study/work_precision.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "tests/support/scenes.h"

namespace gatewalk::dynamics {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// ---- Limits of what can be shown, by hand ----

// 1000 trials. The reference's own error is 0.002 in outcomes, of which chance explains 0.001, so
// the limit is ten times 0.002. In columns the reference has no error: the limit is ten trials.
WorkPrecision by_hand() {
  WorkPrecision chart;
  chart.trials = 1000;
  chart.params.run.tolerance = 0.05;
  chart.reference.own.outcomes = {.total_variation = 0.002, .chance = 0.001};
  chart.reference.own.columns = {.total_variation = 0.0, .chance = 0.0};
  return chart;
}

TEST(WorkPrecision, ErrorsMustStandOutFromTheReferenceAndFromChance) {
  const WorkPrecision chart = by_hand();
  EXPECT_DOUBLE_EQ(chart.outcome_limit(), 0.02);
  EXPECT_DOUBLE_EQ(chart.column_limit(), 0.01);
  Errors e;
  e.outcomes.chance = 0.009;  // twice that is less than the limit
  e.columns.chance = 0.009;   // and more than this one
  EXPECT_DOUBLE_EQ(chart.outcome_bound(e), 0.02);
  EXPECT_DOUBLE_EQ(chart.column_bound(e), 0.018);
}

TEST(WorkPrecision, NothingStandsOutFromAReferenceThatPartedFromItself) {
  WorkPrecision chart = by_hand();
  StrongError& own = chart.reference.own.strong;
  own.position = 3e-6;
  own.velocity = std::nan("");
  EXPECT_DOUBLE_EQ(chart.position_limit(), 3e-5);
  EXPECT_EQ(chart.strong_limit(&StrongError::velocity), 0.0);  // no exits: nothing to part
  own.parted = 1;
  EXPECT_EQ(chart.strong_limit(&StrongError::velocity), kInfinite);
  own.position = 0.0;  // the same bits: 1e-9 of R is rounding
  EXPECT_DOUBLE_EQ(chart.position_limit(), 1e-9 * chart.params.body.radius);
}

ChartPoint point(double microseconds, double total_variation, double chance, Verdict verdict) {
  ChartPoint p;
  p.microseconds = {microseconds + 10.0, microseconds, microseconds + 2.0, microseconds + 3.0};
  p.errors.outcomes = {.total_variation = total_variation, .chance = chance};
  p.verdict = verdict;
  return p;
}

TEST(WorkPrecision, TheCheapestIsTheQuickestThatIsShownToBeGoodEnough) {
  WorkPrecision chart = by_hand();
  EXPECT_EQ(chart.cheapest(), nullptr);
  chart.points = {point(1.0, 0.06, 0.0, Verdict::fine),         // off by more than 0.05
                  point(2.0, 0.01, 0.026, Verdict::fine),       // chance alone may show 0.052
                  point(3.0, 0.01, 0.0, Verdict::penetration),  // has a fault
                  point(6.0, 0.01, 0.0, Verdict::fine), point(5.0, 0.05, 0.02, Verdict::fine)};
  EXPECT_EQ(chart.cheapest(), &chart.points[4]);
  chart.params.run.tolerance = 0.019;  // below what the reference can show
  EXPECT_EQ(chart.cheapest(), nullptr);
}

TEST(ChartPoint, HasNumbersPerTrial) {
  ChartPoint p = point(7.0, 0.0, 0.0, Verdict::fine);
  EXPECT_EQ(p.least_microseconds(), 7.0);
  EXPECT_EQ(p.median_microseconds(), 9.5);  // 7 9 | 10 17
  EXPECT_TRUE(std::isnan(p.steps_per_trial()));
  p.health.runs = 4;
  p.health.steps = 10;
  p.health.evaluations = 30;
  EXPECT_EQ(p.steps_per_trial(), 2.5);
  EXPECT_EQ(p.evaluations_per_trial(), 7.5);
  EXPECT_TRUE(std::isnan(ChartPoint{}.least_microseconds()));
  EXPECT_TRUE(std::isnan(ChartPoint{}.median_microseconds()));
}

// ---- Run ----

constexpr BodyState kStart{.x = 1.0, .y = 0.0, .vx = 0.0, .vy = 15.0};

TrialEnds ends_of(const GateParams& p, const Setting& s, std::int64_t trials) {
  TrialEnds ends;
  add_trial_ends(ends, s.applied_to(p), kStart, 3, {0, trials});
  return ends;
}

TEST(WorkPrecision, RunsEverySettingAgainstTheReference) {
  const GateParams p = test::study(10.0);
  constexpr std::int64_t kTrials = 24;
  const WorkPrecision chart = work_precision(
      p, kStart,
      {.label = "gate", .methods = {"moreau", "paper"}, .trials = kTrials, .rounds = 2, .seed = 3});
  EXPECT_EQ(chart.label, "gate");
  std::vector<Setting> settings = chart_settings("moreau", p);
  for (const Setting& s : chart_settings("paper", p)) settings.push_back(s);
  ASSERT_EQ(chart.points.size(), settings.size());
  EXPECT_GE(chart.timed_trials, 1);
  EXPECT_LE(chart.timed_trials, kTrials);
  for (std::size_t i = 0; i < settings.size(); ++i) {
    const ChartPoint& point = chart.points[i];
    EXPECT_EQ(point.setting, settings[i]);
    EXPECT_EQ(point.health.runs, kTrials);
    EXPECT_EQ(point.microseconds.size(), 2u);  // without the warm-up round
    EXPECT_GT(point.least_microseconds(), 0.0);
  }
  // The errors against the reference, and those of the reference against another setting, run here.
  const TrialEnds reference = ends_of(p, reference_setting(p), kTrials);
  const TrialEnds some = ends_of(p, settings[2], kTrials);
  const TrialEnds stable = ends_of(p, chart_settings("stable", p).back(), kTrials);
  EXPECT_EQ(chart.points[2].errors.strong.position,
            strong_error(p, some.trials, reference.trials).position);
  EXPECT_EQ(chart.points[2].errors.columns.changed,
            column_error(some.trials, reference.trials, table3_space(p)).changed);
  EXPECT_EQ(chart.reference.other.strong.position,
            strong_error(p, stable.trials, reference.trials).position);
  EXPECT_LT(chart.reference.own.strong.position, chart.points[2].errors.strong.position);
  EXPECT_EQ(std::accumulate(chart.reference.outcomes.begin(), chart.reference.outcomes.end(),
                            std::int64_t{0}),
            kTrials);
  EXPECT_EQ(chart.reference[Outcome::trapped],
            std::count_if(reference.trials.begin(), reference.trials.end(),
                          [](const TrialEnd& e) { return e.outcome == Outcome::trapped; }));
}

// `stable` needs over 1024 pieces of half a radian for a step above 512 sqrt(I/k). Here a whole
// hold is longer than that, and half a hold is shorter. (`event` takes twice that rate.)
TEST(WorkPrecision, ARefusalIsAResult) {
  GateParams p = test::study(10.0);
  const double step = 0.7 / p.forces.random_rate;
  p.beams.stiffness_left = p.beams.stiffness_right =
      p.beams.inertia() * (512.0 / step) * (512.0 / step);
  p.run.time_limit = 0.1;
  const WorkPrecision chart = work_precision(
      p, kStart, {.label = "stiff", .methods = {"stable"}, .trials = 2, .rounds = 1, .seed = 3});
  ASSERT_EQ(chart.points.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(chart.points[i].ran(), i > 0) << i;
    EXPECT_EQ(chart.points[i].refusal.empty(), i > 0) << i;
    EXPECT_EQ(chart.points[i].microseconds.size(), i > 0 ? 1u : 0u) << i;
  }
  // The finest setting ran and serves as the other method; after 0.1 s all bodies are still inside.
  EXPECT_EQ(chart.reference.other_method, chart.points[7].setting);
  EXPECT_EQ(chart.reference.other.strong.trapped, 2);
}

TEST(WorkPrecision, CanBeStoppedWhileTimesAreTaken) {
  struct Enough {};
  const Work work{[](std::string_view what, std::int64_t done, std::int64_t) {
    if (what == "gate, times" && done == 3) throw Enough{};
  }};
  EXPECT_THROW((void)work_precision(test::study(10.0), kStart,
                                    {.label = "gate", .methods = {"moreau"}, .trials = 2}, work),
               Enough);
}

TEST(WorkPrecision, RefusesWhatItCannotCompare) {
  GateParams p;
  EXPECT_NO_THROW(require_reference(p));
  EXPECT_THROW((void)work_precision(p, kStart, {.label = "none", .methods = {}, .trials = 0}),
               std::invalid_argument);
  EXPECT_THROW(
      (void)work_precision(p, kStart, {.label = "other", .methods = {"euler"}, .trials = 1}),
      std::invalid_argument);
  p.run.traverse_y = p.beams.joint_y + p.body.radius;  // no room ahead of the beams
  EXPECT_THROW(require_reference(p), InvalidParameter);
}

}  // namespace
}  // namespace gatewalk::dynamics
