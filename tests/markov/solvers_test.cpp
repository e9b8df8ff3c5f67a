// SPDX-License-Identifier: MIT
/// One set of tests for all solvers of exact predictions: closed forms worked out by hand, and each
/// solver against the others within their stated errors.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <ostream>
#include <stdexcept>
#include <string>

#include "chains.h"
#include "markov/predict.h"
#include "tests/support/propagation.h"

namespace gatewalk::markov {
namespace {

using RowMethod = PredictOptions::RowMethod;
using Solver = PredictOptions::Solver;
using test::matrix;
using test::propagate;

constexpr double kEps = std::numeric_limits<double>::epsilon();

struct Route {
  const char* name;
  Solver solver;
  RowMethod row_method = RowMethod::cheapest;
  friend void PrintTo(const Route& route, std::ostream* out) { *out << route.name; }
};

class Solvers : public testing::TestWithParam<Route> {
 protected:
  [[nodiscard]] static PredictOptions options(int max_cells = 0) {
    return {
        .max_cells = max_cells, .solver = GetParam().solver, .row_method = GetParam().row_method};
  }
  [[nodiscard]] static bool takes_a_limit() {
    return GetParam().solver != Solver::rows && GetParam().solver != Solver::klu;
  }
  [[nodiscard]] static FinalDistribution from(const FieldChain& chain, const Field& field,
                                              const Start& start, int max_cells = 0) {
    return predict(chain, field, {start}, options(max_cells)).front();
  }
};

INSTANTIATE_TEST_SUITE_P(
    All, Solvers,
    testing::Values(Route{"automatic", Solver::automatic}, Route{"steps", Solver::steps},
                    Route{"rows_by_elimination", Solver::rows, RowMethod::elimination},
                    Route{"rows_by_sweeps", Solver::rows, RowMethod::sweeps},
                    Route{"rows_by_sums", Solver::rows, RowMethod::sums},
                    Route{"klu", Solver::klu}),
    [](const auto& param) { return std::string(param.param.name); });

/// The error bound that the result states, plus a few roundings of the expected numbers.
double bound(const FinalDistribution& d) { return d.remainder + d.rounding + 4 * kEps; }

void expect_cells(const FinalDistribution& d, const CellProbabilities& expected) {
  ASSERT_EQ(d.final_cells.rows(), expected.rows());
  ASSERT_EQ(d.final_cells.cols(), expected.cols());
  EXPECT_LE((d.final_cells - expected).abs().sum(), bound(d)) << d.final_cells;
  EXPECT_LE(bound(d), 1e-11);
  EXPECT_NEAR(d.final_cells.sum() + d.remainder, 1.0, 1e-12);
  test::expect_endings_add_up(d);
}

/// One state: to the right with `right`, to the left with `left`, up with `up`, else trapped.
Chain drift(double right, double left, double up) {
  return Chain::from_probabilities(
      matrix(1, 4, {{0, 0, right}, {0, 1, left}, {0, 2, up}, {0, 3, 1 - right - left - up}}),
      {{0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {}});
}

/// State 0 walks to the right and turns into 1 with 1/4, is trapped with 1/4; state 1 walks to the
/// left as 0 with 1/2, else trapped.
Chain two_states() {
  return Chain::from_probabilities(
      matrix(2, 4, {{0, 0, 0.5}, {0, 1, 0.25}, {0, 3, 0.25}, {1, 2, 0.5}, {1, 3, 0.5}}),
      {{0, 1, 0}, {1, 1, 0}, {0, -1, 0}, {}});
}

// Two cells in a row, from state 0 in the left one. v: visits of state 0 on the left, r0, r1: on
// the right of states 0, 1. v = 1 + r1/2, r0 = v/2, r1 = v/4: v = 8/7, r0 = 4/7, r1 = 2/7.
TEST_P(Solvers, TwoStatesInTwoCells) {
  const FinalDistribution d = from(two_states(), {2, 1}, {0, 0, 0});
  // Left: trapped v/4. Right: of r0 3/4 leave over the right edge and 1/4 is trapped; of r1 half.
  expect_cells(d, CellProbabilities{{2.0 / 7.0, 4.0 / 7.0 + 1.0 / 7.0}});
  EXPECT_NEAR(d.endings[static_cast<std::size_t>(Ending::right_edge)], 3.0 / 7.0, bound(d));
  EXPECT_NEAR(d.trapped(), 2.0 / 7.0 + 1.0 / 7.0 + 1.0 / 7.0, bound(d));
  EXPECT_NEAR(d.mean_steps, 8.0 / 7.0 + 4.0 / 7.0 + 2.0 / 7.0, 10 * bound(d));
}

// Up with 1/2, to the right with 1/4, else trapped: column c and row r are reached with
// binomial(c + r, r) / (2^r 4^c).
TEST_P(Solvers, ThreeByThreeCells) {
  const FinalDistribution d = from(drift(0.25, 0.0, 0.5), {3, 3}, {0, 0, 0});
  CellProbabilities expected(3, 3);
  const double paths[3][3] = {{1, 1, 1}, {1, 2, 3}, {1, 3, 6}};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) {
      const double visits = paths[row][column] * std::pow(0.5, row) * std::pow(0.25, column);
      expected(row, column) = visits * (0.25 + (row == 2 ? 0.5 : 0.0) + (column == 2 ? 0.25 : 0.0));
    }
  expect_cells(d, expected);
}

// At most two cells: trapped at the start with 1/4, cut off in the cell above with 1/2 * 3/4 and to
// the right with 1/4 * 3/4.
TEST_P(Solvers, ThreeByThreeCellsWithALimitOfTwo) {
  if (!takes_a_limit()) {
    EXPECT_THROW((void)from(drift(0.25, 0.0, 0.5), {3, 3}, {0, 0, 0}, 2), std::invalid_argument);
    return;
  }
  const FinalDistribution d = from(drift(0.25, 0.0, 0.5), {3, 3}, {0, 0, 0}, 2);
  expect_cells(d, CellProbabilities{{0.25, 0.25, 0.0}, {0.5, 0.0, 0.0}, {0.0, 0.0, 0.0}});
  EXPECT_NEAR(d.cut_off(), 9.0 / 16.0, bound(d));
}

// Row 0: up with 1/2, else trapped. Row 1: to either side with 1/4 each, else trapped. A walk in
// the middle of row 1 visits it 8/7 times and each neighbour 2/7 times.
TEST_P(Solvers, TwoChainsByRow) {
  const FieldChain chain =
      FieldChain::by_row({drift(0.0, 0.0, 0.5), drift(0.25, 0.25, 0.0)}, {0, 1});
  const FinalDistribution d = from(chain, {3, 2}, {1, 0, 0});
  // In the side cells 3/4 of the visits end, trapped or over the side.
  expect_cells(d, CellProbabilities{{0.0, 0.5, 0.0}, {3.0 / 28.0, 2.0 / 7.0, 3.0 / 28.0}});
}

/// Black cells (column + row even) let walks go up or to the right with 1/2 each, white cells trap
/// half of them and let the others up.
FieldChain chessboard(int columns, int rows) {
  std::vector<int> types;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) types.push_back((column + row) % 2);
  return FieldChain::by_cell({drift(0.5, 0.0, 0.5), drift(0.0, 0.0, 0.5)}, columns, types);
}

TEST_P(Solvers, ATypePerCellOfAChessboard) {
  const Field field{3, 3};
  // (column, row). (0, 0) passes 1/2 each to (1, 0) and (0, 1), both white: each traps 1/4 and
  // passes 1/4 up. (1, 1) passes 1/8 each to (2, 1) and (1, 2). (0, 2) passes 1/8 over the far edge
  // and 1/8 to (1, 2), where 1/4 ends, half of it trapped. (2, 1) traps 1/16 and passes 1/16 to (2,
  // 2), which all of it leaves.
  const FinalDistribution d = from(chessboard(3, 3), field, {0, 0, 0});
  expect_cells(
      d, CellProbabilities{{0.0, 0.25, 0.0}, {0.25, 0.0, 1.0 / 16.0}, {0.125, 0.25, 1.0 / 16.0}});
}

/// A chain for each row of the field with the paper's states, moves to the sides and up; some rows
/// unsampled.
std::vector<Chain> three_chains() {
  auto exits = test::lattice_exits();
  for (Exit& exit : exits)
    if (exit.di_y < 0) exit.di_y = 1;
  std::vector<Chain> chains;
  for (const std::uint64_t seed : {1, 2, 3}) {
    Counts counts = test::lattice_counts(seed);
    test::empty_row(counts, 5 + static_cast<int>(seed));
    chains.push_back(Chain::from_counts(counts, exits));
  }
  return chains;
}

void expect_agree(const FinalDistribution& a, const FinalDistribution& b) {
  const double together = bound(a) + bound(b);
  EXPECT_LE(together, 1e-11);
  EXPECT_LE((a.final_cells - b.final_cells).abs().sum(), together);
  double apart = 0.0;
  for (std::size_t e = 0; e < kEndings; ++e) apart += std::abs(a.endings[e] - b.endings[e]);
  EXPECT_LE(apart, together);
  EXPECT_LE((trapped_cells(a) - trapped_cells(b)).abs().sum(), together);
  EXPECT_LE((departed_cells(a) - departed_cells(b)).abs().sum(), together);
}

TEST_P(Solvers, AgreeWithThePlainReferenceWithinTheirBounds) {
  const std::vector<Chain> chains = three_chains();
  const Field field{7, 5};
  test::Words words(5);
  std::vector<int> types;
  for (int cell = 0; cell < 35; ++cell) types.push_back(words.below(3));
  for (const FieldChain& chain :
       {FieldChain(chains[0]), FieldChain::by_row(chains, {0, 2, 2, 1, 0}),
        FieldChain::by_cell(chains, 7, types)}) {
    const std::vector<Start> starts{{3, 0, 12}, {0, 1, 30}, {6, 4, 70}, {2, 2, 6}};
    for (const int max_cells : {0, 1, 2, 13}) {
      if (max_cells != 0 && !takes_a_limit()) continue;
      const auto all = predict(chain, field, starts, options(max_cells));
      for (std::size_t k = 0; k < starts.size(); ++k) {
        SCOPED_TRACE("start " + std::to_string(k) + ", limit " + std::to_string(max_cells));
        expect_agree(all[k], propagate(chain, field, starts[k], {.max_cells = max_cells}));
      }
    }
  }
}

// A prepared predictor gives the bits of the function.
TEST_P(Solvers, PreparedOrNotIsTheSame) {
  const FieldChain chain = FieldChain::by_row(three_chains(), {0, 2, 2, 1, 0});
  const Field field{7, 5};
  const auto once = from(chain, field, {3, 0, 12});
  const auto again = Predictor(chain).predict(field, {3, 0, 12}, options());
  EXPECT_TRUE((once.final_cells == again.final_cells).all());
  EXPECT_EQ(once.endings, again.endings);
  EXPECT_EQ(once.steps, again.steps);
}

TEST_P(Solvers, RefuseFieldsOfAnotherSize) {
  const FieldChain rows = FieldChain::by_row({drift(0.25, 0.25, 0.25)}, {0, 0});
  EXPECT_THROW((void)from(rows, {2, 3}, {}), std::invalid_argument);
  EXPECT_NO_THROW((void)from(rows, {5, 2}, {}));
  EXPECT_THROW((void)from(chessboard(3, 2), {3, 3}, {}), std::invalid_argument);
  EXPECT_THROW((void)from(chessboard(3, 2), {2, 3}, {}), std::invalid_argument);
  EXPECT_THROW((void)from(rows, {5, 2}, {5, 0, 0}), std::invalid_argument);
}

TEST(FieldChain, RefusesTypesThatAreNone) {
  const Chain one = drift(0.25, 0.25, 0.25);
  EXPECT_THROW((void)FieldChain::by_cell({one}, 2, {0, 0, 0}), std::invalid_argument);
  EXPECT_THROW((void)FieldChain::by_cell({one}, 0, {}), std::invalid_argument);
  EXPECT_THROW((void)FieldChain::by_cell({one}, 1, {}), std::invalid_argument);
  EXPECT_THROW((void)FieldChain::by_cell({one}, 2, {0, 1}), std::invalid_argument);
  EXPECT_THROW((void)FieldChain::by_cell({one, two_states()}, 2, {0, 1}), std::invalid_argument);
}

TEST(FieldChain, KnowsTheTypeOfEachCell) {
  const Chain one = drift(0.25, 0.25, 0.25), other = drift(0.5, 0.0, 0.25);
  const FieldChain uniform = one;
  EXPECT_EQ(uniform.type_of(40, 50), 0);
  EXPECT_EQ(uniform.rows(), 0);
  EXPECT_TRUE(uniform.has_uniform_rows());
  const FieldChain rows = FieldChain::by_row({one, other}, {0, 1});
  EXPECT_EQ(rows.type_of(40, 1), 1);
  EXPECT_EQ(rows.rows(), 2);
  EXPECT_EQ(rows.columns(), 0);
  EXPECT_TRUE(rows.has_uniform_rows());
  const FieldChain cells = FieldChain::by_cell({one, other}, 3, {0, 0, 0, 1, 1, 0});
  EXPECT_EQ(cells.type_of(1, 1), 1);
  EXPECT_EQ(cells.type_of(2, 1), 0);
  EXPECT_EQ(cells.rows(), 2);
  EXPECT_EQ(cells.columns(), 3);
  EXPECT_FALSE(cells.has_uniform_rows());
  EXPECT_TRUE(FieldChain::by_cell({one, other}, 2, {0, 0, 1, 1}).has_uniform_rows());
}

}  // namespace
}  // namespace gatewalk::markov
