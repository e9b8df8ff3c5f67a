// SPDX-License-Identifier: MIT
#include "lattice/study/rare.h"
#include "lattice/scene/terrain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/base/share.h"
#include "lattice/study/trials.h"
#include "tests/support/disc_fields.h"
#include "tests/support/long.h"
#include "tests/support/threads.h"

namespace gatewalk::lattice {
namespace {

using dynamics::Entry;

/// The paper's field: about 4 % of the bodies enter row 3.
Scene fast_scene() {
  Scene scene;
  scene.gate.forces.propulsion = 7.0;
  scene.gate.forces.random = 50.0;
  scene.gate.run.method = "moreau";
  scene.gate.run.step = 0.02;
  return scene;
}

/// Four types, one of which stands far from the start only: about 2 % of the bodies get beyond it.
Scene mixed_scene() {
  return parse_scene(R"(
forces = { propulsion_N = 7.0, random_N = 50.0 }
run = { method = "moreau", step_s = 0.02 }
field.rows = 6
[terrain]
map = [
  "s.t.s.t.s",
  "t.t.t.t.t",
  "..u...u..",
  "s...u...s",
  ".s.u.u.s.",
  "s..u.s..u"]
[terrain.types.s]
beams.stiffness_left_Nm_per_rad = 300.0
beams.stiffness_right_Nm_per_rad = 300.0
[terrain.types.t]
forces.propulsion_N = 5.5
[terrain.types.u]
beams.stiffness_left_Nm_per_rad = 300.0
forces.propulsion_N = 8.0
)",
                     "mixed.toml");
}

double equal_worth(int, int, const Entry&) { return 1.0; }

/// A value unrelated to where bodies get: it doubles to the right, and jumps with the speed.
double wrong_worth(int column, int row, const Entry& entry) {
  return std::exp2(column % 3 - row +
                   (std::fmod(std::abs(entry.at[dynamics::kEntryVx]), 2.0) > 1.0 ? 2.0 : 0.0));
}

/// The shares of full trials that enter rows 1, 2, ..., `rows`; bodies do not move back.
std::vector<RowChance> direct(const Scene& scene, int rows, std::int64_t trials) {
  const FieldTally tally = field_trials(problem_of(up_to_row(scene, rows)), {0, trials}, 77);
  const auto share = [&](std::int64_t entered) {
    const double p = static_cast<double>(entered) / static_cast<double>(trials);
    return RowChance{
        .probability = p,
        .relative_standard_error = std::sqrt((1.0 - p) / p / static_cast<double>(trials)),
        .trials = trials};
  };
  std::vector<RowChance> shares;
  for (int row = 1; row < rows; ++row)
    shares.push_back(share(tally.final_cells.bottomRows(rows - row).sum()));
  shares.push_back(share(tally.endings[static_cast<std::size_t>(markov::Ending::far_edge)]));
  return shares;
}

/// Shares that several tests use.
RowChance fast_truth(int row) {
  static const std::vector<RowChance> shares = direct(fast_scene(), 5, 100'000);
  return shares.at(static_cast<std::size_t>(row) - 1);
}
RowChance mixed_truth(int row) {
  static const std::vector<RowChance> shares = direct(mixed_scene(), 6, 20'000);
  return shares.at(static_cast<std::size_t>(row) - 1);
}

void expect_agree(const RowChance& a, const RowChance& b, double sigmas) {
  EXPECT_LT(std::abs(std::log(a.probability / b.probability)),
            sigmas * std::hypot(a.relative_standard_error, b.relative_standard_error))
      << a.probability << " and " << b.probability;
}

TEST(Splitting, WithoutValuesIsPlainTrials) {
  const Scene scene = fast_scene();
  const Splitting s = split(problem_of(scene), 1.0, equal_worth, {.row = 2, .accuracy = 0.02});
  for (const RowChance& c : s.rows) {
    const double n = static_cast<double>(s.trials);
    EXPECT_NEAR(c.probability * n, std::round(c.probability * n), 1e-6);  // no body was split
    EXPECT_NEAR(c.relative_standard_error, std::sqrt((1 / c.probability - 1) / (n - 1)), 1e-12);
  }
  expect_agree(s.rows[1], fast_truth(2), 4.0);
}

TEST(Splitting, IntervalOfASmallChanceIsThatOfTheLogarithm) {
  const auto [low, high] =
      RowChance{.probability = 1e-3, .relative_standard_error = 0.1}.interval_95();
  EXPECT_NEAR(low, 1e-3 * std::exp(-0.196), 1e-8);
  EXPECT_NEAR(high, 1e-3 * std::exp(0.196), 1e-8);
}

// Even if all trials succeeded, some bodies may fail.
TEST(Splitting, IntervalOfALargeChanceIsNoNarrowerThanThatOfTheTrials) {
  const auto interval = [](double p, double error) {
    return RowChance{.probability = p, .relative_standard_error = error, .trials = 1000}
        .interval_95();
  };
  const auto all = dynamics::share_interval(1000, 1000);
  EXPECT_EQ(interval(1.0, 0.0), all);
  EXPECT_EQ(interval(1.0 + 1e-9, 0.0), all);  // weights may sum to more than 1
  EXPECT_NEAR(interval(std::nextafter(1.0, 0.0), 0.0)[0], all[0], 1e-9);
  const auto plain = interval(0.998, std::sqrt(0.002 / 0.998 / 1000));
  EXPECT_EQ(plain[0], dynamics::share_interval(998, 1000)[0]);
  EXPECT_EQ(plain[1], 1.0);
  // Bodies of different weights give more sampling error than trials of weight 1.
  for (const double p : {0.9, 0.9999, 1.003})
    EXPECT_NEAR(interval(p, 0.05)[0], p * std::exp(-0.05 * dynamics::kNormal95), 1e-12) << p;
}

// Each round has as many trials as the last rounds suggest.
TEST(Splitting, FewRoundsReachTheAccuracy) {
  dynamics::Work work;
  int rounds = 0;
  std::int64_t total = 0;
  work.told = [&](std::string_view, std::int64_t, std::int64_t of) {
    rounds += of != total;
    total = of;
  };
  const Splitting s =
      split(problem_of(fast_scene()), 1.0, equal_worth, {.row = 2, .accuracy = 0.02}, work);
  EXPECT_TRUE(s.reached);
  EXPECT_GE(s.trials, 3000);
  EXPECT_LE(rounds, 4);
}

TEST(Splitting, IsUnbiasedWhateverTheValues) {
  const Scene scene = fast_scene();
  const Splitting s = split(problem_of(scene), 1.0, wrong_worth,
                            {.row = 3, .accuracy = 0.04, .most_runs = 3'000'000, .seed = 5});
  expect_agree(s.rows[2], fast_truth(3), 4.0);
}

TEST(Splitting, CountsTheRowsAheadOfTheStart) {
  Scene scene = mixed_scene();
  scene.field.start_row = 2;
  scene.field.own_start_column = 1;
  const Problem problem = problem_of(up_to_row(scene, 5));
  const RareEvent e = rare_event(problem, {.row = 5, .accuracy = 0.1, .most_runs = 100'000});
  EXPECT_TRUE(e.splitting.reached);
  EXPECT_EQ(e.splitting.first_row, 3);
  ASSERT_EQ(e.splitting.rows.size(), 3u);
  ASSERT_EQ(e.chain.size(), 3u);
  const DirectRows direct = direct_rows(problem, 20'000, 77);
  ASSERT_EQ(direct.entered.size(), 3u);
  for (std::size_t r = 0; r < 3; ++r) {
    const auto n = static_cast<double>(direct.trials);
    const double p = static_cast<double>(direct.entered[r]) / n;
    expect_agree(e.splitting.rows[r],
                 {.probability = p,
                  .relative_standard_error = std::sqrt((1.0 - p) / p / n),
                  .trials = direct.trials},
                 4.0);
  }
  for (const int row : {0, 1, 2})
    EXPECT_THROW((void)up_to_row(problem, row), std::invalid_argument) << row;
}

TEST(Splitting, IsUnbiasedInAMixedFieldWhateverTheValues) {
  const Scene scene = mixed_scene();
  const Splitting s = split(problem_of(scene), 1.0, wrong_worth,
                            {.row = 6, .accuracy = 0.15, .most_runs = 1'000'000, .seed = 5});
  expect_agree(s.rows[5], mixed_truth(6), 4.0);
}

void expect_same(const Splitting& a, const Splitting& b) {
  EXPECT_EQ(a.trials, b.trials);
  EXPECT_EQ(a.gate_runs, b.gate_runs);
  ASSERT_EQ(a.rows.size(), b.rows.size());
  for (std::size_t r = 0; r < a.rows.size(); ++r) {
    EXPECT_EQ(a.rows[r].probability, b.rows[r].probability);
    EXPECT_EQ(a.rows[r].relative_standard_error, b.rows[r].relative_standard_error);
  }
}

TEST(Splitting, IsTheSameOnAnyNumberOfThreads) {
  for (const Scene& scene : {fast_scene(), mixed_scene()}) {
    const SplittingOptions few{.row = 3, .accuracy = 0.1};
    expect_same(
        test::on_threads(1, [&] { return split(problem_of(scene), 1.0, wrong_worth, few); }),
        test::on_threads(4, [&] { return split(problem_of(scene), 1.0, wrong_worth, few); }));
  }
}

// A type without any cell changes nothing.
TEST(Splitting, IsThatOfThePlainFieldWhereAllGatesAreAlike) {
  const Scene scene = fast_scene();
  Scene typed = scene;
  typed.terrain = mixed_scene().terrain;
  typed.terrain->type_of_cell.assign(9 * 9, 0);
  ASSERT_GT(gates_of(typed).types().size(), 1u);
  const SplittingOptions few{.row = 3, .accuracy = 0.1};
  expect_same(split(problem_of(scene), 1.0, wrong_worth, few),
              split(problem_of(typed), 1.0, wrong_worth, few));
}

TEST(Splitting, RefusesWhatMakesNoSense) {
  const Scene scene = fast_scene();
  EXPECT_THROW((void)split(problem_of(scene), 1.0, equal_worth, {.row = 0}), std::invalid_argument);
  EXPECT_THROW((void)split(problem_of(scene), 0.0, equal_worth, {.row = 1}), std::invalid_argument);
  const auto zero = [](int, int, const Entry&) { return 0.0; };
  EXPECT_THROW((void)split(problem_of(scene), 1.0, zero, {.row = 2}), std::invalid_argument);
}

// A given map has its size; a scene may ask for more rows of a map drawn at random.
TEST(Splitting, EndsWithTheTerrain) {
  const Scene scene = mixed_scene();
  EXPECT_EQ(up_to_row(scene, 2).terrain->type_of_cell,
            std::vector<int>(scene.terrain->type_of_cell.begin(),
                             scene.terrain->type_of_cell.begin() + 18));
  const auto refusal = [](const Scene& s) -> std::string {
    try {
      (void)rare_event(problem_of(up_to_row(s, 7)), {.row = 7});
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "(accepted)";
  };
  EXPECT_EQ(refusal(scene),
            "mixed.toml: the terrain has 6 rows; the row to enter (--row) must be at most 6");
  Scene drawn = scene;
  drawn.terrain->shares = {{"s", 0.5}};
  EXPECT_EQ(refusal(drawn),
            "mixed.toml: the terrain has 6 rows; the row to enter (--row) must be at most 6, or "
            "field.rows larger: as many are drawn");
}

TEST(Splitting, RareEventAgreesWithDirectTrials) {
  const Scene scene = fast_scene();
  const RareEvent e = rare_event(problem_of(scene), {.row = 5, .accuracy = 0.05});
  const RowChance d = fast_truth(5);
  EXPECT_LT(d.probability, 0.05);
  EXPECT_TRUE(e.splitting.reached);
  expect_agree(e.splitting.rows[4], d, 4.0);
  EXPECT_NEAR(e.chain[4] / d.probability, 1.0, 0.4);
}

TEST(Splitting, RareEventAgreesWithDirectTrialsInAMixedField) {
  const Scene scene = mixed_scene();
  const RareEvent e = rare_event(problem_of(scene), {.row = 6, .accuracy = 0.1});
  const RowChance d = mixed_truth(6);
  EXPECT_NEAR(d.probability, 0.018, 0.003);
  EXPECT_GE(e.pool_runs, 60'000);  // all of its trials, with at least one gate each
  EXPECT_TRUE(e.splitting.reached);
  expect_agree(e.splitting.rows[5], d, 4.0);
  EXPECT_NEAR(e.chain[5] / d.probability, 1.0, 0.4);
}

// Rows that no body gets beyond: the chain knows no way, and the rows before are as precise as
// ever.
TEST(Splitting, RareEventEndsWhereNobodyGetsThrough) {
  Scene scene = mixed_scene();
  Terrain& terrain = *scene.terrain;
  ASSERT_EQ(terrain.types[1].name, "t");
  terrain.types[1].keys = {{"beams.stiffness_left_Nm_per_rad", 1e4, ""},
                           {"beams.stiffness_right_Nm_per_rad", 1e4, ""}};
  std::fill(terrain.type_of_cell.begin() + 9, terrain.type_of_cell.begin() + 18, 2);
  const RareEvent e = rare_event(problem_of(scene), {.row = 3, .most_runs = 200'000});
  EXPECT_EQ(e.chain[1], 0.0);
  EXPECT_EQ(e.splitting.rows[1].probability, 0.0);
  EXPECT_EQ(e.splitting.rows[2].probability, 0.0);
  EXPECT_FALSE(e.splitting.reached);
  expect_agree(e.splitting.rows[0], direct(scene, 1, 100'000).front(), 4.0);
}

// Bounds without any body: the interval of a share; beyond a row that bodies entered, at most what
// is known of that row.
TEST(Splitting, SaysHowLikelyItIsAtMostWhereNobodyCame) {
  Scene stuck = fast_scene();
  stuck.gate.forces.propulsion = stuck.gate.forces.random = 0.0;
  stuck.start.vy = 0.0;
  const Splitting s = split(problem_of(stuck), 1.0, equal_worth, {.row = 2, .most_in_vain = 3000});
  EXPECT_EQ(s.trials, 3000);
  EXPECT_FALSE(s.reached);
  for (const RowChance& c : s.rows) {
    EXPECT_EQ(c.probability, 0.0);
    EXPECT_TRUE(std::isnan(c.relative_standard_error));
    EXPECT_NEAR(c.at_most, 1.0 - std::pow(0.025, 1.0 / 3000.0), 1e-15);
    EXPECT_EQ(c.interval_95(), (std::array{0.0, c.at_most}));
  }
}

// Repeats with so few trials that most see no body in the last row: the bound is above the truth
// except in 2.5 % of them, and not larger than necessary.
TEST(Splitting, ABoundWhereNobodyCameHoldsAsOftenAsItSays) {
  Scene scene = fast_scene();
  scene.gate.forces.propulsion = 6.6;
  const RowChance truth = direct(scene, 8, 60'000).back();
  int without = 0, below = 0, large = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const auto by_row = [](int, int row, const Entry&) { return std::pow(1.1, row); };
    const RowChance last = split(problem_of(scene), 1.0, by_row,
                                 {.row = 8, .accuracy = 0.9, .most_runs = 1, .seed = seed})
                               .rows.back();
    if (last.probability > 0.0) continue;
    ++without;
    below += last.at_most < truth.probability;
    large += last.at_most > 100.0 * truth.probability;
  }
  EXPECT_GT(without, 10);
  EXPECT_LE(below, 3);
  EXPECT_EQ(large, 0);
}

// Few full trials suffice for the chain if many of them reach the row; otherwise all are needed.
TEST(Splitting, RareEventRunsFewTrialsForTheChainOfACommonEvent) {
  const Scene scene = fast_scene();
  const RareEvent common = rare_event(problem_of(scene), {.row = 2}),
                  rare = rare_event(problem_of(scene), {.row = 7, .accuracy = 0.9});
  EXPECT_LT(common.pool_runs, 7500 * 6);
  EXPECT_GT(rare.pool_runs, 60'000);
  expect_agree(common.splitting.rows[1], fast_truth(2), 4.0);
}

// 95 % intervals hold in 93 to 97 % of 1000 repeats, for a probability of about 0.001; in the usual
// 40 repeats, for a larger one, at least 34 times.
TEST(Splitting, IntervalsHoldAsOftenAsTheySay) {
  const Scene scene = fast_scene();
  const auto by_row = [](int, int row, const Entry&) { return std::pow(2.4, row); };
  const int row = test::usual_or_full(5, 8);
  const int repeats = test::usual_or_full(40, 1000);
  const RowChance truth =
      repeats == 40 ? fast_truth(row)
                    : rare_event(problem_of(scene), {.row = row, .accuracy = 0.01, .seed = 5000})
                          .splitting.rows.back();
  int holds = 0, below = 0;
  for (int i = 0; i < repeats; ++i) {
    const Splitting s =
        split(problem_of(scene), 1.0, by_row,
              {.row = row, .accuracy = 0.2, .seed = static_cast<std::uint64_t>(i) + 1});
    const auto [low, high] = s.rows.back().interval_95();
    holds += low <= truth.probability && truth.probability <= high;
    below += high < truth.probability;
  }
  RecordProperty("truth", std::to_string(truth.probability));
  RecordProperty("holds", holds);
  RecordProperty("below", below);  // intervals below the truth
  EXPECT_GE(holds, test::usual_or_full(34, 930));
  EXPECT_LE(holds, test::usual_or_full(40, 970));
}

// Most bodies enter row 2, after walls that give them weights by unrelated values.
TEST(Splitting, IntervalsOfLargeChancesHold) {
  Scene scene = fast_scene();
  scene.gate.forces.propulsion = 20.0;
  const RowChance truth = direct(scene, 2, 40'000).back();
  ASSERT_GT(truth.probability, 0.985);
  int holds = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const Splitting s =
        split(problem_of(scene), 2.0, wrong_worth, {.row = 3, .trials = 200, .seed = seed});
    const auto [low, high] = s.rows.at(1).interval_95();
    holds += low <= truth.probability && truth.probability <= high;
  }
  EXPECT_GE(holds, 34);
}

TEST(DirectRows, AreThoseThatTrialsEnter) {
  const Problem problem = problem_of(up_to_row(mixed_scene(), 4));
  const DirectRows direct = direct_rows(problem, 500, 77);
  const FieldTally tally = field_trials(problem, {0, 500}, 77);
  ASSERT_EQ(direct.entered.size(), 4U);
  for (int row = 1; row < 4; ++row)
    EXPECT_EQ(direct.entered[static_cast<std::size_t>(row) - 1],
              tally.final_cells.bottomRows(4 - row).sum());
  EXPECT_EQ(direct.entered[3], tally.endings[static_cast<std::size_t>(markov::Ending::far_edge)]);
  EXPECT_GT(direct.entered[0], direct.entered[1]);
}

}  // namespace
}  // namespace gatewalk::lattice
