// SPDX-License-Identifier: MIT
#include "lattice/field/exits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dynamics/base/share.h"
#include "lattice/pool/kernel.h"
#include "lattice/pool/pool_answers.h"
#include "lattice/study/prediction.h"
#include "tests/support/disc_fields.h"

namespace gatewalk::lattice {
namespace {

using markov::Ending;

template <class Numbers>
auto sum_of(const Numbers& numbers) {
  return std::accumulate(numbers.begin(), numbers.end(), typename Numbers::value_type{});
}

/// A small field that many bodies leave over every side.
Scene leaving_scene() {
  Scene scene;
  scene.gate.forces.propulsion = 9.0;
  scene.gate.forces.random = 50.0;
  scene.gate.run.method = "moreau";
  scene.gate.run.step = 0.02;
  scene.field = {3, 2, 6};
  return scene;
}

RunPool pool_of_runs(const Scene& scene, std::int64_t n) {
  RunPool pool;
  OwnRuns& s = pool.starts.emplace_back();
  s.start = dynamics::entry_of(scene.start);
  (void)run_field(scene.gate, scene.field, scene.start, 9, {0, n}, &s.full);
  return pool;
}

// Gates are 50 m wide and 60 m long; the start's column is the middle one.
TEST(Exits, PlacesAreTheGatesInMetres) {
  dynamics::GateParams p;
  p.beams.joint_x = 25.0;
  p.run.traverse_y = 60.0;
  const FieldParams field{4, 3, 0};
  EXPECT_EQ(exit_bounds(p.gate_width(), p.gate_length(), field, kFarSide),
            (std::vector<double>{-125, -75, -25, 25, 75}));
  EXPECT_EQ(exit_bounds(p.gate_width(), p.gate_length(), field, 1),
            (std::vector<double>{0, 60, 120, 180}));
  EXPECT_EQ(exit_bounds(p.gate_width(), p.gate_length(), field, 2),
            exit_bounds(p.gate_width(), p.gate_length(), field, 1));
}

// Two places on one side: alone, the first is less certain than the side, the second more.
TEST(Exits, APartOfASideIsNoMoreThanTheSide) {
  std::array<double, markov::kEndings> shares{};
  shares[static_cast<std::size_t>(Ending::left_edge)] = 0.3;
  EndingShares endings(shares);
  endings.interval[static_cast<std::size_t>(Ending::left_edge)] = {0.2, 0.4};
  FieldExits exits;
  exits[1] = {{0.25, 0.05, 0.0}, {{{0.22, 0.45}, {0.01, 0.1}, {0.0, 0.5}}}};
  exits[2] = {{0.0}, {{{0.0, 0.7}}}};  // a side without an interval gives no bound
  const FieldExits within = within_sides(exits, endings);
  EXPECT_EQ(within[1].interval,
            (std::vector<std::array<double, 2>>{{0.2, 0.4}, {0.01, 0.1}, {0.0, 0.2}}));
  EXPECT_EQ(within[1].share, exits[1].share);
  EXPECT_EQ(within[2].interval, exits[2].interval);
}

TEST(Exits, OfTrialsAreThoseOfTheirLastGates) {
  const Scene scene = leaving_scene();
  FieldTrials each;
  const FieldTally tally = run_field(scene.gate, scene.field, scene.start, 3, {0, 2000}, &each);
  const FieldExits exits = exits_of(tally);
  std::array<std::vector<std::int64_t>, kSides.size()> counts;
  for (std::size_t i = 0; i < each.endings.size(); ++i)
    for (std::size_t side = 0; side < kSides.size(); ++side) {
      counts[side].resize(exits[side].share.size());
      const int column = each.final_gates[i] % 3, row = each.final_gates[i] / 3;
      if (each.endings[i] == kSides[side])
        ++counts[side][static_cast<std::size_t>(side == kFarSide ? column : row)];
    }
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    EXPECT_GT(sum_of(counts[side]), 20) << side;
    EXPECT_EQ(sum_of(counts[side]), tally[kSides[side]]);
  }
  const markov::CellCounts departed = departed_cells(tally);
  // No body crosses from the first row, and none leaves over a side from a column in the middle.
  EXPECT_EQ(counts[1][0], departed(0, 0));
  EXPECT_EQ(counts[2][0], departed(0, 2));
  EXPECT_EQ(counts[kFarSide][1], departed(1, 1));
  EXPECT_EQ(counts[kFarSide][0] + counts[1][1], departed(1, 0));
  for (std::size_t side = 0; side < kSides.size(); ++side)
    for (std::size_t i = 0; i < exits[side].share.size(); ++i) {
      EXPECT_EQ(exits[side].share[i], static_cast<double>(counts[side][i]) / 2000.0);
      EXPECT_LE(exits[side].interval[i][0], exits[side].share[i]);
      EXPECT_GT(exits[side].interval[i][1], exits[side].share[i]);
    }
}

// Walks and the exact chain agree on who leaves, by gate and by side, also in the corners, where
// bodies cross or leave over a side.
TEST(Exits, OfPredictionsAddUpToTheEndingsByEitherWay) {
  Scene scene = leaving_scene();
  const RunPool pool = pool_of_runs(scene, 2000);
  const Kernel kernel = kernel_of(FieldGates(scene.gate).map(), pool, 8);
  const markov::Counts row =
      first_rows(kernel, FieldGates(scene.gate).map(), pool, {&pool.starts[0]}, 0);
  scene.field.max_gates = 400'000;  // so that exact answers would take long
  const KernelAnswers by_walks =
      answers_of(kernel, FieldGates(scene.gate).map(), row, scene.field, 1);
  ASSERT_GT(by_walks.walks, 1'000'000);
  const auto exact =
      markov::predict(chain_of(kernel, FieldGates(scene.gate).map(), scene.field, row), {3, 2},
                      {{1, 0, kernel.space.size()}}, {.max_cells = 1000})
          .front();
  const ExitShares walked = exit_shares(by_walks.final.front()), of_exact = exit_shares(exact);
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    const auto ending = static_cast<std::size_t>(kSides[side]);
    EXPECT_NEAR(sum_of(of_exact[side]), exact.endings[ending], 1e-12) << side;
    EXPECT_NEAR(sum_of(walked[side]), by_walks.final.front().endings[ending], 1e-12) << side;
    for (std::size_t i = 0; i < of_exact[side].size(); ++i) {
      EXPECT_GT(of_exact[side][i], 0.001);
      const double sd = std::sqrt(of_exact[side][i] / static_cast<double>(by_walks.walks));
      EXPECT_NEAR(walked[side][i], of_exact[side][i], 5.0 * sd) << side << " " << i;
    }
  }
}

TEST(Exits, IntervalsOfGroupsAndOfResampledMatrices) {
  const ExitShares own{{{0.1, 0.0}, {0.2}, {0.3}}};
  std::vector<ExitShares> others(8, own);
  for (std::size_t g = 0; g < others.size(); ++g)
    others[g][0][0] += 0.01 * (static_cast<double>(g) - 3.5);
  const Evidence from{1000.0, 3000.0};
  const FieldExits groups = exits_of_groups(own, others, from);
  const auto expected =
      share_95(0.1, {0.065, 0.075, 0.085, 0.095, 0.105, 0.115, 0.125, 0.135}, from);
  for (std::size_t end : {0, 1}) EXPECT_NEAR(groups[0].interval[0][end], expected[end], 1e-12);
  EXPECT_LT(groups[0].interval[0][1] - groups[0].interval[0][0], 0.09);
  // No body was seen there, and nothing varies: the bound is what 1000 trials can rule out.
  EXPECT_EQ(groups[0].interval[1], dynamics::interval_of_share(0.0, 1000.0));
  EXPECT_GT(groups[1].interval[0][1] - groups[1].interval[0][0], 0.02);
  const FieldExits resampled = exits_of(own, others, {1000, 0});
  EXPECT_DOUBLE_EQ(resampled[0].interval[0][0], 0.065);
  EXPECT_DOUBLE_EQ(resampled[0].interval[0][1], 0.135);
  EXPECT_LT(resampled[1].interval[0][0], 0.2);
  EXPECT_TRUE(std::isnan(exits_of(own, {}, {1000, 0})[0].interval[0][0]));
}

TEST(Resampled95, LeavesOutTheOutermost) {
  std::vector<double> drawn(199);
  for (std::size_t i = 0; i < drawn.size(); ++i)
    drawn[i] = static_cast<double>(drawn.size() - i) / 1000.0;
  EXPECT_EQ(resampled_95(drawn, 0.1, {}), (std::array{0.005, 0.195}));
}

// A share outside the middle 95 % of the draws gets the Jeffreys interval of an effective number of
// trials: p (1 - p) over the mean square of the draws minus the share.
TEST(Resampled95, ContainsTheShareByConstruction) {
  const std::vector<double> drawn{0.08, 0.08, 0.08, 0.079};
  const auto skewed = resampled_95(drawn, 0.1, {});
  double squares = 0.0;
  for (const double d : drawn) squares += (d - 0.1) * (d - 0.1) / 4.0;
  const auto expected = dynamics::interval_of_share(0.1, 0.09 / squares);
  for (const std::size_t end : {0, 1}) EXPECT_NEAR(skewed[end], expected[end], 1e-9);
  for (const double share : {1e-6, 0.01, 0.5, 0.99, 1.0 - 1e-6})
    for (const double off : {-0.5, 0.0, 0.5, 3.0}) {
      std::vector<double> others;
      for (int k = 0; k < 99; ++k)
        others.push_back(std::clamp(share * (1.0 + off) + share * 0.001 * k, 0.0, 1.0));
      for (const Evidence from : {Evidence{100.0, 0.0}, Evidence{100.0, 1e5}}) {
        const auto [low, high] = resampled_95(others, share, from);
        EXPECT_LT(low, share) << share << " " << off;
        EXPECT_GT(high, share) << share << " " << off;
      }
    }
}

}  // namespace
}  // namespace gatewalk::lattice
