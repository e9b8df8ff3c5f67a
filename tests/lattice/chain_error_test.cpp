// SPDX-License-Identifier: MIT
// The chain's error against its cost: truths, answers and summaries by hand, and a chart.
#include "lattice/scene/study/chain_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "dynamics/disc/row_trials.h"
#include "lattice/field/gate_chain.h"
#include "tests/support/disc_fields.h"

namespace gatewalk::lattice {
namespace {

using dynamics::StateSpace;
using dynamics::Transitions;

constexpr double kNever = ChainSummary::kNever;

/// A truth with these numbers of trials per gate of a field of 3 x 3.
FieldTruth truth_of(const std::array<std::int64_t, 9>& trials, double seconds_per_trial = 1.0) {
  FieldTally tally({.columns = 3, .rows = 3});
  for (std::size_t i = 0; i < trials.size(); ++i) tally.final_cells.data()[i] = trials[i];
  tally.trials = tally.final_cells.sum();
  tally.endings[static_cast<std::size_t>(markov::Ending::trapped)] = tally.trials;
  return field_truth({0, {0.0, 0.0, 15.0}}, std::move(tally), seconds_per_trial);
}

TEST(FieldTruth, IsToldFromAsTwoSamplesAreFromEachOther) {
  const FieldTruth t = truth_of({500, 500});
  EXPECT_EQ(t.p(0, 0), 0.5);
  // 1/n + 1/1000 = 1/m
  EXPECT_EQ(t.as_against_exact(1000), 500);
  EXPECT_EQ(t.as_against_exact(250), 200);
  EXPECT_EQ(t.as_against_exact(1'000'000'000), 1000);
  EXPECT_EQ(t.as_against_exact(0), 1);
  // As precise as 199 trials against an exact truth: n = 199 * 1000 / (1000 - 199).
  EXPECT_DOUBLE_EQ(t.seconds_for(expected_total_variation(t.p, 199)), 199'000.0 / 801);
  EXPECT_EQ(t.seconds_for(0.5 * t.floor.total_variation), kNever);
  EXPECT_EQ(t.floor.total_variation, expected_total_variation(t.p, 1000));
}

TEST(FieldTruth, IsNoneOfBrokenTrials) {
  FieldTally tally({.columns = 3, .rows = 3});
  tally.count({4}, {std::nullopt});
  EXPECT_THROW((void)field_truth({}, tally, 1.0), std::runtime_error);
}

/// One state per face: EN, RD, LD, RT, LT.
StateSpace five_states() { return dynamics::refined(dynamics::table3_space({}), 0.01); }

/// Of 1000 runs that enter from below, `up` go on upwards, and `left` to the left, where no run was
/// made; the others are trapped.
Transitions matrix(std::int64_t up, std::int64_t left) {
  Transitions t(five_states());
  t.trials[0] = 1000;
  for (const auto& [output, n] :
       std::map<int, std::int64_t>{{0, up},
                                   {t.space.first(dynamics::Boundary::right_deflect), left},
                                   {t.space.trapped(), 1000 - up - left}})
    if (n > 0) t.rows[0][output] = n;
  return t;
}

constexpr FieldParams kField{.columns = 3, .rows = 3, .max_gates = 0};

TEST(AskMatrices, GivesTheErrorsOfOne) {
  Transitions t = matrix(500, 250);
  t.clamped[0] = 75;  // of 750 that left
  // The middle column: in each row reached, 1/4 is trapped; 1/8 leaves at the top; as many end to
  // the left of it.
  const FieldTruth right = truth_of({16, 16, 0, 8, 8, 0, 4, 12, 0}), wrong = truth_of({0, 64});
  const ChainAnswers p = ask_matrices({t}, kField, {right, wrong}, 1);
  EXPECT_EQ(p.matrices, 1);
  EXPECT_EQ(p.runs, 1000);
  EXPECT_EQ(p.clamped_share, 0.1);
  EXPECT_EQ(p.rows_never_sampled, 4.0);
  const ChainAnswer &good = p.answers[0], &bad = p.answers[1];
  EXPECT_EQ(good.never_sampled, 0.25 + 0.125 + 0.0625);
  EXPECT_NEAR(good.exact.total_variation, 0.0, 1e-15);
  EXPECT_NEAR(good.exact.corrcoef, 1.0, 1e-15);
  EXPECT_TRUE(std::isnan(good.exact_sd));
  EXPECT_EQ(good.bins, 0.0);
  EXPECT_NEAR(bad.exact.total_variation, 0.75, 1e-15);
  // The walks' mean distance from the prediction is below 1/2 sqrt(2/pi 9/1e6) for a million walks.
  EXPECT_LT(good.walks[1].total_variation, 0.003);
  EXPECT_LT(good.walks[1].total_variation, good.walks[0].total_variation);
  // Shares of 1000 runs vary by about 1.5 %.
  EXPECT_GT(bad.sampling, 0.002);
  EXPECT_LT(bad.sampling, 0.05);
  EXPECT_EQ(wrong.floor.total_variation, 0.0);
  EXPECT_NEAR(bad.bins, std::sqrt(0.75 * 0.75 - bad.sampling * bad.sampling), 1e-15);
}

TEST(AskMatrices, GivesMeansOverSeveral) {
  // One matrix traps all bodies in the first gate, as the truth does; in the other half go on.
  const std::vector<Transitions> both{matrix(0, 0), matrix(500, 0)};
  const std::vector<FieldTruth> truths{truth_of({0, 8})};
  const ChainAnswers p = ask_matrices(both, kField, truths, 1);
  EXPECT_EQ(p.matrices, 2);
  EXPECT_EQ(p.runs, 1000);
  const ChainAnswer& a = p.answers[0];
  EXPECT_NEAR(a.exact.total_variation, (0.0 + 0.5) / 2, 1e-15);
  EXPECT_NEAR(a.exact_sd, std::sqrt(2 * 0.25 * 0.25), 1e-15);
  EXPECT_NEAR(a.bins, std::sqrt(0.25 * 0.25 - a.sampling * a.sampling / 2), 1e-15);
  // A resampled copy of the first matrix is the matrix itself: all of the spread comes from the
  // second.
  EXPECT_NEAR(ask_matrices({both[0]}, kField, truths, 1).answers[0].sampling, 0.0, 1e-15);
  EXPECT_GT(a.sampling, 0.0);
}

TEST(AskMatrices, CanBeStopped) {
  struct Stop {};
  EXPECT_THROW((void)ask_matrices({matrix(0, 0)}, kField, {truth_of({0, 8})}, 1,
                                  {[](auto...) { throw Stop{}; }}),
               Stop);
}

/// A chart of one start, whose full trials end in two gates and take a second each. Each point is
/// given by its cost and its error.
ChainErrorChart chart_of(const std::vector<std::array<double, 2>>& uniform,
                         const std::vector<std::array<double, 2>>& visited,
                         double seconds_per_trial = 1.0) {
  ChainErrorChart chart;
  chart.curves = {{1.0, five_states()}, {1.0, five_states(), true}};
  chart.truths = {truth_of({500'000'000, 500'000'000}, seconds_per_trial)};
  for (const std::size_t curve : {0, 1})
    for (const auto& [build, error] : curve == 0 ? uniform : visited) {
      ChainPoint p{{}, curve, 0, build};
      p.answers.push_back({.exact = {.total_variation = error}, .exact_seconds = 0.1});
      chart.points.push_back(std::move(p));
    }
  return chart;
}

TEST(ChainSummary, WeighsErrorsAgainstDirectSimulation) {
  // Direct simulation has an error of 0.1 after about 16 s, of 0.05 after 64 s, of 0.04 after 100
  // s.
  const ChainErrorChart chart =
      chart_of({{1, 0.10}, {200, 0.05}, {1000, 0.04}}, {{5, 0.03}, {6, 0.01}});
  const ChainSummary s = summary_of(chart, 0);
  EXPECT_EQ(s.best, 2u);
  EXPECT_EQ(s.cheapest, 1u);  // 0.05 is within 1.5 times 0.04, 0.1 is not
  EXPECT_EQ(s.best_visited, 4u);
  EXPECT_EQ(s.pays_from, 1.1);  // only the first point costs less than 16 s
  EXPECT_EQ(s.pays_until, chart.truths[0].seconds_for(0.10));
  EXPECT_NEAR(s.pays_until, 16.0, 1.0);
  EXPECT_EQ(s.starts_to_pay, 4.0);  // 200 s of runs, about 64 s saved per start
}

TEST(ChainSummary, SaysThatAChainNeverPays) {
  const ChainSummary s = summary_of(chart_of({{1, 0.1}, {2, 0.1}}, {}, 1e-4), 0);
  EXPECT_EQ(s.best, 0u);
  EXPECT_EQ(s.cheapest, 0u);
  EXPECT_FALSE(s.best_visited);
  EXPECT_EQ(s.pays_from, kNever);
  EXPECT_EQ(s.pays_until, 0.0);
  EXPECT_EQ(s.starts_to_pay, kNever);
}

const std::vector<dynamics::Entry> kStarts{{0, {0.0, 0.0, 15.0}}};

TEST(ChainErrorPlan, HasTheTrialsWithinTheLimitOfRuns) {
  const Scene scene = parse_scene("", "scene");
  ChainErrorOptions options{kStarts, {0.5, 1.0}, 100, 1000};
  ChainErrorPlan plan = plan_chain_error(scene, options);
  EXPECT_EQ(plan.pilot_trials, 0);
  ASSERT_EQ(plan.curves.size(), 2u);
  EXPECT_EQ(plan.curves[0].trials, (std::vector<std::int64_t>{10, 20}));  // of 23 rows
  EXPECT_EQ(plan.curves[1].trials, (std::vector<std::int64_t>{10}));      // of 87 rows
  options.visited = 50;
  plan = plan_chain_error(scene, options);
  EXPECT_EQ(plan.pilot_trials, 50);
  ASSERT_EQ(plan.curves.size(), 4u);
  for (std::size_t c = 0; c < 4; ++c) {
    EXPECT_EQ(plan.curves[c].visited, c >= 2);
    EXPECT_EQ(plan.curves[c].trials, plan.curves[c % 2].trials);
  }
  options.runs_limit = 229;
  plan = plan_chain_error(scene, options);
  EXPECT_TRUE(plan.empty());
  EXPECT_THROW((void)chart_chain_error(scene, plan), std::invalid_argument);
}

TEST(ChainErrorPlan, MakesBinsOfWhatAPilotSees) {
  const Scene scene = parse_scene("beams.length_m = 20", "scene");
  EXPECT_THROW((void)plan_chain_error(scene, {kStarts, {0.5, 100.0}},
                                      {[](auto...) { FAIL() << "runs before it refuses"; }}),
               std::invalid_argument);
  const ChainErrorPlan plan = plan_chain_error(scene, {kStarts, {0.5}, 100, 100'000, 40});
  EXPECT_EQ(plan.bins.kind, BinsChoice::Kind::automatic);
  EXPECT_EQ(plan.pilot_trials, 40);
  ASSERT_EQ(plan.curves.size(), 1u);
  EXPECT_FALSE(plan.curves[0].visited);
  EXPECT_FALSE(plan.curves[0].entries.empty());
  EXPECT_GT(plan.health.runs, 0);
}

TEST(ChainErrorChart, ChartsMatricesOfTheSameTrials) {
  const Scene scene = parse_scene("field = { rows = 3, columns = 3 }", "scene");
  const ChainErrorChart chart =
      chart_chain_error(scene, plan_chain_error(scene, {kStarts, {0.5}, 100, 460, {}, 5}));
  const StateSpace& space = chart.curves[0].space;
  ASSERT_EQ(chart.points.size(), 2u);
  EXPECT_EQ(chart.points[0].trials, 10);
  EXPECT_EQ(chart.points[0].matrices, 2);
  EXPECT_EQ(chart.points[1].trials, 20);
  EXPECT_EQ(chart.points[1].matrices, 1);
  EXPECT_EQ(chart.points[1].runs, 460);
  const StateSpace fixed = fixed_space(scene);
  const FieldTally truth =
      run_field(scene.gate, scene.field, dynamics::entry_state(scene.gate, kStarts[0]), 5, {0, 100},
                nullptr, &fixed);
  EXPECT_TRUE((chart.truths[0].tally.final_cells == truth.final_cells).all());
  // 20 trials at once give the same matrix as the pieces that matrices of 10 trials need.
  Transitions whole(space);
  dynamics::add_trials(whole, scene.gate, 5, {0, 20});
  const ChainAnswer again = ask_matrices({whole}, scene.field, chart.truths, 5).answers[0];
  EXPECT_EQ(chart.points[1].answers[0].exact.total_variation, again.exact.total_variation);
  EXPECT_EQ(chart.points[1].answers[0].walks[0].corrcoef, again.walks[0].corrcoef);
  EXPECT_EQ(chart.points[1].answers[0].sampling, again.sampling);
  EXPECT_GT(chart.health.runs, truth.health.runs + 460);  // includes the runs of trees
  EXPECT_EQ(chart.trees.size(), 1u);
  // Direct simulation covers the costs of the matrices.
  EXPECT_LT(chart.direct[0].front().seconds, chart.points[0].seconds(0));
  EXPECT_GE(chart.direct[0].back().seconds, chart.points[1].seconds(0));
}

}  // namespace
}  // namespace gatewalk::lattice
