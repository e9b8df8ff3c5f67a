// SPDX-License-Identifier: MIT
// The chain against the full dynamics: findings by hand, and the parts of a validation.
#include "lattice/study/validation.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "lattice/field/gate_chain.h"
#include "tests/support/disc_fields.h"

namespace gatewalk::lattice {
namespace {

TEST(Finding, SaysWhatChanceExplains) {
  EXPECT_EQ(finding_of(false, 0.03, 0.05), Finding::within_trials);
  EXPECT_EQ(finding_of(false, 0.05, 0.05), Finding::within_trials);
  EXPECT_EQ(finding_of(false, 0.06, 0.05), Finding::within_trials_and_matrix);
  EXPECT_EQ(finding_of(true, 0.03, 0.05), Finding::own_error);  // an ending differs
}

TEST(MeanAndSd, LeavesOutWhatIsNoNumber) {
  MeanAndSd m;
  for (const double x : {1.0, std::nan(""), 2.0, 6.0}) m.add(x);
  EXPECT_EQ(m.n, 3);
  EXPECT_DOUBLE_EQ(m.mean(), 3.0);
  EXPECT_DOUBLE_EQ(m.sd(), std::sqrt((4.0 + 1.0 + 9.0) / 2.0));
  MeanAndSd one;
  one.add(1.0);
  EXPECT_TRUE(std::isnan(one.sd()));
}

/// No noise and a strong push: a body goes straight up through all three rows, and over the far
/// edge of the middle column.
Scene straight_up() {
  return parse_scene(
      "forces = { random_N = 0.0, propulsion_N = 100.0 }\n"
      "field = { columns = 3, rows = 3, max_gates = 9 }",
      "straight");
}

/// Every entry goes up, and enters the next gate in the middle, at 15 m/s.
dynamics::Transitions all_up(const Scene& scene, std::int64_t runs) {
  dynamics::Transitions t(dynamics::table3_space(scene.gate));
  for (int row = 0; row < t.space.size(); ++row) {
    const auto state = t.space.index_of({dynamics::Boundary::enter, {0.0, 0.0, 15.0}}).state;
    t.rows[static_cast<std::size_t>(row)][state] = runs;
    t.trials[static_cast<std::size_t>(row)] = runs;
  }
  return t;
}

/// Every entry is trapped.
dynamics::Transitions all_trapped(const Scene& scene, std::int64_t runs) {
  dynamics::Transitions t(dynamics::table3_space(scene.gate));
  for (int row = 0; row < t.space.size(); ++row) {
    t.rows[static_cast<std::size_t>(row)][t.space.trapped()] = runs;
    t.trials[static_cast<std::size_t>(row)] = runs;
  }
  return t;
}

const dynamics::Entry kStart{0, {0.0, 0.0, 15.0}};

TEST(ValidateChain, ARightChainIsWithinChance) {
  const Scene scene = straight_up();
  const Validation v = validate_chain(problem_of(scene), {all_up(scene, 1000)}, {kStart},
                                      {.trials = 250, .null_draws = 99, .seed = 3});
  ASSERT_EQ(v.starts.size(), 1u);
  const StartValidation& s = v.starts.front();
  EXPECT_EQ(s.dynamics.final_cells(2, 1), 250);
  EXPECT_EQ(s.walks.final_cells(2, 1), 250);  // as many walks as trials
  EXPECT_DOUBLE_EQ(s.exact.final_cells(2, 1), 1.0);
  EXPECT_EQ(s.exact_against.total_variation, 0.0);
  EXPECT_EQ(s.finding(), Finding::within_trials);
  EXPECT_EQ(s.paper_sized.exact_rmse.n, 2);  // whole blocks of 100
  EXPECT_NEAR(s.paper_sized.exact_rmse.mean(), 0.0, 1e-12);
  EXPECT_EQ(v.entries, 2 * 250);
  EXPECT_EQ(v.entries_by[dynamics::Boundary::right_traverse] +
                v.entries_by[dynamics::Boundary::left_traverse],
            0);
  EXPECT_EQ(v.walks, 250);
  EXPECT_EQ(v.health.runs, 3 * 250);
}

TEST(ValidateChain, AWrongChainHasAnErrorOfItsOwn) {
  const Scene scene = straight_up();
  const Validation v = validate_chain(problem_of(scene), {all_trapped(scene, 1000)}, {kStart},
                                      {.trials = 100, .walks = 40, .null_draws = 99, .seed = 3});
  const StartValidation& s = v.starts.front();
  EXPECT_EQ(s.exact_against.total_variation, 1.0);  // start gate against last row
  EXPECT_EQ(s.finding(), Finding::own_error);
  EXPECT_TRUE(s.joint_test.differs(markov::Ending::far_edge));
  EXPECT_TRUE(s.joint_test.differs(markov::Ending::trapped));
  EXPECT_FALSE(s.joint_test.differs(markov::Ending::left_edge));
  EXPECT_EQ(s.walks.trapped(), 40);
  // One of 9 gates is off by 100 trials in 100, another by as much in the other direction.
  EXPECT_DOUBLE_EQ(s.exact_against.rmse_per_100, 100.0 * std::sqrt(2.0 / 9.0));
}

// The chain traps 6 %, the dynamics nobody: with 50 runs per row, sampling error explains the
// difference, with 100 000 it does not.
TEST(ValidateChain, CountsTheSamplingOfTheMatrix) {
  Scene scene = straight_up();
  const auto seldom_trapped = [&](std::int64_t runs) {
    dynamics::Transitions t = all_up(scene, runs);
    for (auto& row : t.rows) {
      row.begin()->second -= runs * 2 / 100;
      row[t.space.trapped()] += runs * 2 / 100;
    }
    return validate_chain(problem_of(scene), {t}, {kStart},
                          {.trials = 1000, .null_draws = 199, .seed = 1})
        .starts.front();
  };
  const StartValidation few = seldom_trapped(50), many = seldom_trapped(100'000);
  EXPECT_NEAR(few.exact.trapped(), many.exact.trapped(), 1e-12);  // 1 - .98^3
  EXPECT_EQ(few.finding(), Finding::within_trials_and_matrix);
  EXPECT_EQ(many.finding(), Finding::own_error);
  EXPECT_GT(few.matrix_noise_mean, 10 * many.matrix_noise_mean);
}

TEST(ValidateChain, IsTheSameForAnyPieces) {
  const Scene scene = parse_scene("field = { columns = 3, rows = 3 }", "scene");
  const dynamics::Transitions matrix = all_up(scene, 10);
  const ValidationOptions options{.trials = 120, .walks = 130, .null_draws = 19, .seed = 5};
  const StartValidation s =
      validate_chain(problem_of(scene), {matrix}, {kStart}, options).starts.front();
  FieldTrials each;
  const FieldTally dynamics =
      run_field(scene.gate, scene.field, dynamics::entry_state(scene.gate, kStart), 5, {0, 120},
                &each, &matrix.space);
  EXPECT_TRUE((s.dynamics.final_cells == dynamics.final_cells).all());
  EXPECT_EQ(s.dynamics.endings, dynamics.endings);
  markov::CellCounts first = markov::CellCounts::Zero(3, 3);
  for (std::size_t t = 0; t < 100; ++t) ++first.data()[each.final_gates[t]];
  EXPECT_DOUBLE_EQ(s.paper_sized.exact_rmse.mean(),
                   rmse_per_100(shares(first), s.exact.final_cells));
}

TEST(ValidateChain, RefusesFieldsTooLargeToKeep) {
  const Scene scene = parse_scene("field = { columns = 1001, rows = 100 }", "scene");
  EXPECT_THROW((void)validate_chain(problem_of(scene), {all_up(scene, 1)}, {kStart}, {}),
               std::invalid_argument);
}

}  // namespace
}  // namespace gatewalk::lattice
