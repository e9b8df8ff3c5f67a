// SPDX-License-Identifier: MIT
// Walks that circle long or for ever, for which a sum over moves would have to stop early.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <vector>

#include "markov/predict/plan.h"
#include "markov/solvers.h"
#include "tests/markov/chains.h"
#include "tests/support/field_states.h"

namespace gatewalk::markov {
namespace {

using test::matrix;
using Solver = PredictOptions::Solver;

constexpr Solver kAutomatic = Solver::automatic;

double of(const FinalDistribution& d, Ending e) { return d.endings[static_cast<std::size_t>(e)]; }

/// Ahead to the right (3/4) or back out of the field; then left and right between two cells, with
/// probability `leave` to go ahead at every second move; back in row 0: out. In a field of 3 x 3
/// cells all walks that go right cross.
Chain rarely_leaves(double leave) {
  return Chain::from_probabilities(matrix(4, 5,
                                          {{0, 1, 0.75},
                                           {0, 3, 0.25},
                                           {1, 2, 1.0},
                                           {2, 1, 1.0 - leave},
                                           {2, 0, leave},
                                           {3, 0, 1.0}}),
                                   {{0, 0, 1}, {1, 1, 0}, {2, -1, 0}, {3, 0, -1}, {}});
}

/// A cycle of three cells in a row of four, by steps of +1, +1 and -2 cells; from the third cell
/// `up` go ahead (and so out of the field of one row), `trapped` are trapped.
Chain round_of_three(double up, double trapped) {
  return Chain::from_probabilities(
      matrix(3, 5,
             {{0, 1, 1.0}, {1, 2, 1.0}, {2, 0, 1.0 - up - trapped}, {2, 3, up}, {2, 4, trapped}}),
      {{0, -2, 0}, {1, 1, 0}, {2, 1, 0}, {0, 0, 1}, {}});
}

// Closed form: no mass is lost, and a walk makes 2 / leave moves in each row in which it circles.
TEST(Circling, EndsAreRightHoweverSeldomWalksLeave) {
  for (const double leave : {1e-3, 1e-6, 1e-9, 1e-12, 1e-15}) {
    SCOPED_TRACE(leave);
    const FinalDistribution d =
        predict(FieldChain(rarely_leaves(leave)), {3, 3}, {{1, 0, 0}}).front();
    // Row 0: 1/4 go back. Walks that go right circle, then go ahead into row 1, where again 3/4 go
    // right and 1/4 back into row 0, where state `back` goes ahead. In rows 1 and 2 state `back` of
    // the row below leads ahead again, so all of them cross in the end.
    EXPECT_NEAR(of(d, Ending::near_edge), 0.25, 1e-13);
    EXPECT_NEAR(of(d, Ending::far_edge), 0.75, 1e-13);
    EXPECT_LE(d.remainder + d.rounding, 1e-12);
    EXPECT_EQ(d.endless, 0.0);
  }
}

// Row by row, with moves that RowElimination does not take.
TEST(Circling, RoundsOfThreeEndByTheirChances) {
  for (const double leave : {1e-3, 1e-6, 1e-9, 1e-12}) {
    SCOPED_TRACE(leave);
    const Chain chain = round_of_three(0.75 * leave, 0.25 * leave);
    ASSERT_TRUE(Predictor(chain).can_go_by_rows());
    for (const Start start : {Start{0, 0, 0}, Start{1, 0, 1}, Start{2, 0, 2}}) {
      const FinalDistribution d = predict(FieldChain(chain), {4, 1}, {start}).front();
      EXPECT_NEAR(of(d, Ending::far_edge), 0.75, 1e-3 * leave + 1e-12);
      EXPECT_NEAR(of(d, Ending::trapped), 0.25, 1e-3 * leave + 1e-12);
      EXPECT_LE(d.remainder + d.rounding, 1e-10);
    }
  }
}

// Half of the walks enter two states that lead only to each other.
TEST(Circling, WhatNeverEndsIsTold) {
  const Chain chain =
      Chain::from_probabilities(matrix(3, 4, {{0, 1, 0.5}, {0, 3, 0.5}, {1, 2, 1.0}, {2, 1, 1.0}}),
                                {{0, 0, 1}, {1, 1, 0}, {2, -1, 0}, {}});
  for (const Solver solver : {kAutomatic, Solver::direct}) {
    const FinalDistribution d =
        predict(FieldChain(chain), {3, 2}, {{1, 0, 0}}, {.solver = solver}).front();
    EXPECT_EQ(d.trapped(), 0.5);
    EXPECT_EQ(d.endless, 0.5);
    EXPECT_EQ(d.remainder, 0.5);
    EXPECT_EQ(d.left_field() + d.unsampled(), 0.0);
    EXPECT_EQ(d.mean_steps, 1.0);
  }
  const FinalDistribution all = predict(FieldChain(chain), {3, 2}, {{2, 0, 1}}).front();
  EXPECT_EQ(all.endless, 1.0);
}

// A second route: dense elimination, state by state, of random chains with ways back; and the same
// bits alone and together.
TEST(Circling, AgreesWithDenseElimination) {
  test::Words words(5);
  for (int k = 0; k < 30; ++k) {
    const FieldChain chain(test::random_chain(words));
    const Field field{1 + words.below(5), 1 + words.below(5)};
    std::vector<Start> starts;
    for (int s = 0; s < 3; ++s)
      starts.push_back({words.below(field.columns), words.below(field.rows), words.below(2)});
    const auto found = predict(chain, field, starts, {.solver = Solver::direct});
    for (std::size_t s = 0; s < starts.size(); ++s) {
      const FieldStates states = field_states(chain, field, {starts[s]});
      const auto exact = field_answer(states, eliminate(absorbing_chain<double>(states), 1, false));
      for (std::size_t e = 0; e < kEndings; ++e)
        EXPECT_NEAR(found[s].endings[e], exact.endings[e], 1e-14);
      for (int row = 0; row < field.rows; ++row)
        for (int column = 0; column < field.columns; ++column)
          EXPECT_NEAR(found[s].final_cells(row, column), exact.final_cells(row, column), 1e-14);
      test::expect_endings_add_up(found[s]);
      const FinalDistribution alone = solve_directly(chain, field, starts[s]).value();
      EXPECT_EQ(alone.endings, found[s].endings);
      EXPECT_EQ(alone.mean_steps, found[s].mean_steps);
      const FinalDistribution by_klu = solve_absorption(chain, field, starts[s]);
      EXPECT_NEAR(alone.mean_steps, by_klu.mean_steps, 1e-10 * by_klu.mean_steps);
      test::expect_same_endings(alone, by_klu, 1e-11);
    }
  }
}

// The paper's shape with moves down: 7000 states, for which sums also converge.
TEST(Circling, AgreesWithSumsInALargerField) {
  const FieldChain chain(Chain::from_counts(test::lattice_counts(3), test::lattice_exits()));
  const Field field{5, 4};
  const auto direct = solve_directly(chain, field, {2, 0, 12});
  ASSERT_TRUE(direct.has_value());
  EXPECT_GT(direct->operations, 0.0);
  test::expect_same_endings(*direct, predict(chain, field, {{2, 0, 12}}).front(), 1e-12);
  EXPECT_FALSE(solve_directly(chain, field, {2, 0, 12}, 1e4).has_value());
  EXPECT_THROW(
      (void)predict(chain, field, {{2, 0, 12}}, {.max_cells = 5, .solver = Solver::direct}),
      std::invalid_argument);
}

// Where elimination without subtraction would be too large, KLU's LU is used, and the result states
// its digits; if it keeps too few, there is no result.
TEST(Circling, TooLargeForEliminationByKlu) {
  const int kStates = 60;
  const auto circling = [kStates](double trapped, double most_operations) {
    test::Words words(3);
    std::vector<Eigen::Triplet<double>> entries;
    std::vector<Exit> exits;
    for (int i = 0; i < kStates; ++i) {
      for (int k = 0; k < 8; ++k)
        entries.emplace_back(i, words.below(kStates), (1.0 - trapped) / 8.0);
      entries.emplace_back(i, kStates, trapped);
      exits.push_back({i, 0, 0});
    }
    exits.push_back({});
    Probabilities p(kStates, kStates + 1);
    p.setFromTriplets(entries.begin(), entries.end());
    return solve_circles(FieldChain(Chain::from_probabilities(p, exits)), {1, 1}, {0, 0, 0},
                         most_operations);
  };
  const auto eliminated = circling(1e-4, 2e9), by_klu = circling(1e-4, 1e3);
  ASSERT_TRUE(eliminated && by_klu);
  EXPECT_GT(eliminated->operations, 1e3);
  EXPECT_NEAR(eliminated->trapped(), 1.0, 1e-12);
  EXPECT_EQ(by_klu->operations, 0.0);
  EXPECT_GT(by_klu->rounding, eliminated->rounding);
  EXPECT_NEAR(by_klu->trapped(), 1.0, by_klu->remainder + by_klu->rounding);
  EXPECT_FALSE(circling(1e-12, 1e3));
}

// If sums converge in time they are used: the same bits.
TEST(Circling, SumsThatSettleStay) {
  const FieldChain chain(Chain::from_counts(test::lattice_counts(4), test::lattice_exits()));
  const FinalDistribution
      automatic = predict(chain, {9, 9}, {test::kBottomCentre}).front(),
      steps = predict(chain, {9, 9}, {test::kBottomCentre}, {.solver = Solver::steps}).front();
  EXPECT_EQ(automatic.endings, steps.endings);
  EXPECT_EQ(automatic.operations, 0.0);
  EXPECT_GT(automatic.steps, 0);
  // 10^-3 per round takes some 10^5 sums.
  EXPECT_GT(predict(FieldChain(rarely_leaves(1e-3)), {3, 3}, {{1, 0, 0}}).front().operations, 0.0);
}

}  // namespace
}  // namespace gatewalk::markov
