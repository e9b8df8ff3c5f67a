// SPDX-License-Identifier: MIT
/// Large fields without limit: 301 x 301 cells in a usual run. 1001 x 1001 and a million walks:
///     GATEWALK_LONG=1 build/tests/markov_tests --gtest_filter='LargeField.*'

#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <iostream>
#include <utility>

#include "chains.h"
#include "markov/predict.h"
#include "markov/walk.h"
#include "tests/support/blocks.h"
#include "tests/support/long.h"
#include "tests/support/propagation.h"

namespace gatewalk::markov {
namespace {

using test::propagate;

using RowMethod = PredictOptions::RowMethod;
using Solver = PredictOptions::Solver;

const int kSide = gatewalk::test::usual_or_full(301, 1001);
const std::int64_t kManyWalks = gatewalk::test::usual_or_full(20'000, 1'000'000);

/// Chains of the paper's shape: from below (0 to 24), to the right (25 to 54), to the left (55 to
/// 84). Walks keep their direction for some 20 cells and are trapped in `trapped` of the draws.
Chain keeping_on(double trapped) {
  test::Words words(11);
  auto exits = test::lattice_exits();
  for (Exit& exit : exits)
    if (exit.di_y < 0) exit.di_y = 1;
  std::vector<test::Entry> entries;
  for (int row = 0; row < 87; ++row) {
    const int kind = row < 25 ? 0 : row < 55 ? 1 : row < 85 ? 2 : 0;  // up, right, left
    const double up = kind == 0 ? 0.9 : 0.05;
    const auto share_out = [&](double p, int first, int count) {
      for (int k = 0; k < 4; ++k)
        entries.push_back({row, first + (words.below(count / 4) * 4 + k) % count, p / 4});
    };
    share_out((1 - trapped) * up, 0, 25);
    share_out((1 - trapped) * (1 - up) * (kind == 1 ? 0.9 : kind == 2 ? 0.1 : 0.5), 25, 30);
    share_out((1 - trapped) * (1 - up) * (kind == 1 ? 0.1 : kind == 2 ? 0.9 : 0.5), 55, 30);
    entries.push_back({row, 87, trapped});
  }
  Probabilities p(87, 88);
  for (const test::Entry& e : entries) p.coeffRef(e.row, e.column) += e.p;
  return Chain::from_probabilities(p, exits);
}

void expect_whole(const FinalDistribution& d) {
  EXPECT_NEAR(d.final_cells.sum() + d.remainder, 1.0, 1e-12);
  EXPECT_NEAR(d.trapped() + d.left_field() + d.cut_off() + d.unsampled() + d.remainder, 1.0, 1e-12);
  EXPECT_LE(d.remainder + d.rounding, 1e-10);
}

using Shares = Eigen::ArrayXd;

// The count of n walks differs from a probability p by sqrt(p (1 - p) / n) or less on average. One
// walk changes the total variation by 1/n, so the total variation exceeds its mean by more than
// sqrt(10 / n) once in e^20 = 5e8 (McDiarmid).
void expect_as_walked(const Shares& walked, const Shares& p, const char* what) {
  const auto n = static_cast<double>(kManyWalks);
  const double apart = 0.5 * (walked / n - p).abs().sum();
  const double by_chance = 0.5 * (p * (1 - p).max(0.0) / n).sqrt().sum();
  EXPECT_LE(apart, by_chance + std::sqrt(10 / n)) << what;
  EXPECT_GE(apart, 0.3 * by_chance) << what << ": walks do not vary";
}

TEST(LargeField, IsAsWalked) {
  const Field field{kSide, kSide};
  const Start start{kSide / 2, 0, 12};
  const Chain chain = keeping_on(1e-3);
  const auto d = Predictor(chain).predict(field, start);
  expect_whole(d);
  // All of the field is reached.
  EXPECT_GT(d.final_cells.row(kSide - 1).sum(), 0.05);
  EXPECT_GT(d.final_cells.col(kSide - 1).sum() / d.final_cells.sum(), 1e-9);

  const WalkTally tally = Walker(chain).walk(field, start, 0, 5, {0, kManyWalks});
  const Eigen::ArrayXXd walked = tally.final_cells.cast<double>();
  expect_as_walked(walked.rowwise().sum(), d.final_cells.rowwise().sum(), "final rows");
  expect_as_walked(walked.colwise().sum().transpose(), d.final_cells.colwise().sum().transpose(),
                   "final columns");
  const auto n = static_cast<double>(kManyWalks);
  const Shares fates{
      {static_cast<double>(tally.trapped()), static_cast<double>(tally.left_field())}};
  expect_as_walked(fates, Shares{{d.trapped(), d.left_field()}}, "fates");
  EXPECT_NEAR(static_cast<double>(tally.steps) / n / d.mean_steps, 1.0, 10 / std::sqrt(n));
}

// Two routes: elimination of columns and sums over moves.
TEST(LargeField, EliminationIsSummation) {
  const Field field{kSide, kSide / 3};
  const Start start{kSide / 3, 0, 3};
  const Predictor predictor(keeping_on(1e-3));
  const auto a = predictor.predict(
      field, start,
      {.solver = Solver::rows, .row_method = RowMethod::elimination, .tolerance = 1e-12});
  const auto b = predictor.predict(
      field, start, {.solver = Solver::rows, .row_method = RowMethod::sums, .tolerance = 1e-12});
  expect_whole(a);
  expect_whole(b);
  EXPECT_LE((a.final_cells - b.final_cells).abs().sum(),
            a.remainder + a.rounding + b.remainder + b.rounding);
  EXPECT_LE((a.final_cells - b.final_cells).abs().sum(), 1e-11);
  EXPECT_NEAR(a.mean_steps / b.mean_steps, 1.0, 1e-9);
}

// If walks end long before any border, rows (and columns) alone form a chain: the same chain
// without its moves in the other direction.
TEST(LargeField, RowsAndColumnsAreChainsOfTheirOwn) {
  const Chain chain = keeping_on(0.3);
  const auto d = Predictor(chain).predict({kSide, kSide}, {kSide / 2, 0, 12});
  expect_whole(d);
  EXPECT_LE(d.left_field(), 1e-13);
  const auto without = [&](bool x) {
    auto exits = chain.exits();
    for (Exit& exit : exits) (x ? exit.di_x : exit.di_y) = 0;
    return Chain::from_probabilities(chain.matrix(), exits);
  };
  const auto rows = propagate(without(true), {1, kSide}, {0, 0, 12});
  const auto columns = propagate(without(false), {kSide, 1}, {kSide / 2, 0, 12});
  EXPECT_LE((d.final_cells.rowwise().sum() - rows.final_cells.col(0)).abs().maxCoeff(), 1e-12);
  EXPECT_LE((d.final_cells.colwise().sum() - columns.final_cells.row(0)).abs().maxCoeff(), 1e-12);
}

/// Seconds of processor time, reported in a long run.
template <class Work>
auto timed(const char* what, Work work) {
  const std::clock_t begin = std::clock();
  auto result = work();
  if (gatewalk::test::usual_or_full(0, 1) != 0)
    std::cout << what << ": " << static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC << " s"
              << std::endl;
  return result;
}

/// Chains of the paper's shape in cells of three types, in a repeated pattern of 9 x 9 cells.
FieldChain patterned(const Field& cells) {
  test::Words words(5);
  std::vector<int> pattern;
  for (int cell = 0; cell < 81; ++cell) pattern.push_back(words.below(3));
  return test::repeated({keeping_on(1e-3), keeping_on(0.01), keeping_on(0.03)}, {9, 9}, pattern,
                        cells);
}

// Blocks of 9 x 1 cells make rows uniform; blocks of 9 x 9 (3 x 3 blocks of 3 x 3 cells) leave one
// type.
void expect_same_in_both_blocks(int side) {
  const Field cells{side, side};
  const Start start{side / 2, 0, 12};
  const FieldChain chain = patterned(cells);
  const PredictOptions options{.tolerance = 1e-13};
  const auto wide = timed("blocks of 9 x 1", [&] { return block_field(chain, {9, 1}, {start}); });
  const auto in_wide = timed("prediction in them", [&] {
    return predict(wide.chain, wide.field(cells), {wide.start(start)}, options).front();
  });
  expect_whole(in_wide);
  const auto small = timed("blocks of 3 x 3", [&] { return block_field(chain, {3, 3}, {start}); });
  const auto square = timed("blocks of 3 x 3 of these", [&] {
    return block_field(small.chain, {3, 3}, {small.start(start)});
  });
  ASSERT_EQ(square.chain.chains().size(), 1u);
  const Field squares{side / 9, side / 9};
  const auto in_squares = timed("prediction in them", [&] {
    return predict(square.chain, squares, {square.start(small.start(start))}, options).front();
  });
  test::expect_same_in_blocks(in_wide, in_squares, {1, 9}, 1e-12);
  const auto fine =
      timed("prediction in cells", [&] { return predict(chain, cells, {start}, options).front(); });
  test::expect_same_in_blocks(fine, in_wide, {9, 1}, 1e-12);
  test::expect_same_in_blocks(fine, in_squares, {9, 9}, 1e-12);
}

TEST(LargeField, ARepeatedPatternInBlocks) {
  expect_same_in_both_blocks(gatewalk::test::usual_or_full(45, 297));
}
TEST(LargeField, AMillionCellsInBlocks) {
  expect_same_in_both_blocks(gatewalk::test::usual_or_full(90, 999));
}

// With one type, the cells' own rows are the faster way.
TEST(LargeField, OneTypeInBlocks) {
  const int side = gatewalk::test::usual_or_full(45, 999);
  const Field cells{side, side};
  const Start start{side / 2, 0, 12};
  const Chain chain = keeping_on(1e-3);
  const PredictOptions options{.tolerance = 1e-13};
  const auto blocks = timed("blocks of 3 x 3", [&] { return block_field(chain, {3, 3}, {start}); });
  const auto coarse = timed("prediction in them", [&] {
    return predict(blocks.chain, blocks.field(cells), {blocks.start(start)}, options).front();
  });
  const auto fine =
      timed("prediction in cells", [&] { return predict(chain, cells, {start}, options).front(); });
  test::expect_same_in_blocks(fine, coarse, {3, 3}, 1e-12);
}

}  // namespace
}  // namespace gatewalk::markov
