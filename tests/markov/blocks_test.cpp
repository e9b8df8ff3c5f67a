// SPDX-License-Identifier: MIT
#include "tests/support/blocks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "markov/predict.h"
#include "tests/markov/chains.h"

namespace gatewalk::markov {
namespace {

using test::expect_same_in_blocks;

constexpr double kBound = 1e-12;
constexpr double kTolerance = 1e-14;  // share of walks that may be left

FinalDistribution fine(const FieldChain& chain, const Field& cells, const Start& start) {
  return predict(chain, cells, {start}, {.tolerance = kTolerance}).front();
}
FinalDistribution coarse(const BlockField& blocks, const Field& cells, const Start& start) {
  return fine(blocks.chain, blocks.field(cells), blocks.start(start));
}

Chain five_states(std::uint64_t seed = 1) {
  return Chain::from_counts(test::boundary_counts(seed), test::boundary_exits());
}
/// Few walks are trapped, so walks pass many cells.
Chain long_walks() {
  Counts counts = test::boundary_counts(5);
  for (int row = 0; row < 5; ++row) {
    for (int column = 0; column < 5; ++column) counts.coeffRef(row, column) *= 100;
    counts.coeffRef(row, 5) = 1;
  }
  return Chain::from_counts(counts, test::boundary_exits());
}

// One state that goes up or to the right: walks pass two neighbouring cells as binomials say.
TEST(BlockField, TwoCellsByHand) {
  const Chain chain = Chain::from_probabilities(
      test::matrix(1, 3, {{0, 0, 0.5}, {0, 1, 0.25}, {0, 2, 0.25}}), {{0, 0, 1}, {0, 1, 0}, {}});
  const BlockField blocks = block_field(chain, {2, 1});
  const Chain& block = blocks.chain.chains().front();
  ASSERT_EQ(blocks.entries.size(), 2u);  // the left cell, the right one
  const Eigen::MatrixXd p = block.matrix();
  const auto chance = [&](int input, const Exit& exit) {
    double sum = 0.0;
    for (int j = 0; j < block.outputs(); ++j)
      if (block.exits()[static_cast<std::size_t>(j)] == exit) sum += p(input, j);
    return sum;
  };
  EXPECT_EQ(chance(0, {0, 0, 1}), 0.5);
  EXPECT_EQ(chance(0, {1, 0, 1}), 0.25 * 0.5);
  EXPECT_EQ(chance(0, {0, 1, 0}), 0.25 * 0.25);
  EXPECT_EQ(chance(0, {}), 0.25 + 0.25 * 0.25);
  EXPECT_EQ(chance(1, {1, 0, 1}), 0.5);
  EXPECT_EQ(chance(1, {0, 1, 0}), 0.25);
  EXPECT_EQ(chance(1, {}), 0.25);
}

TEST(BlockField, AnswersAsItsCells) {
  for (const Chain& chain : {five_states(), long_walks()})
    for (const Start& start : {Start{4, 0, 0}, Start{0, 3, 2}, Start{8, 6, 0}, Start{3, 2, 2}}) {
      const Field cells{9, 9};
      const BlockField blocks = block_field(chain, {3, 3}, {start});
      expect_same_in_blocks(fine(chain, cells, start), coarse(blocks, cells, start), blocks.block,
                            kBound);
    }
}

TEST(BlockField, BlocksNeedNotBeSquare) {
  const Chain chain = long_walks();
  const Start start{5, 0, 0};
  for (const Field& block : {Field{1, 1}, Field{3, 1}, Field{1, 5}, Field{9, 1}, Field{9, 5}}) {
    const BlockField blocks = block_field(chain, block, {start});
    expect_same_in_blocks(fine(chain, {9, 5}, start), coarse(blocks, {9, 5}, start), block, kBound);
  }
}

// 3 x 3 cells, blocks of 3 x 3 such blocks, and blocks of these.
TEST(BlockField, BlocksOfBlocks) {
  const Chain chain = long_walks();
  for (const int cells : {9, 27, 81}) {
    Start start{cells / 2, 0, 0};
    const FinalDistribution d = fine(chain, {cells, cells}, start);
    FieldChain of_blocks = chain;
    for (int side = 3; side < cells; side *= 3) {
      SCOPED_TRACE(std::to_string(cells) + " cells in blocks of " + std::to_string(side));
      const BlockField blocks = block_field(of_blocks, {3, 3}, {start});
      start = blocks.start(start);
      of_blocks = blocks.chain;
      const Field field{cells / side, cells / side};
      expect_same_in_blocks(d, fine(of_blocks, field, start), {side, side}, kBound);
    }
  }
}

TEST(BlockField, ThePapersShape) {
  const Chain chain = Chain::from_counts(test::lattice_counts(1), test::never_down());
  const BlockField blocks = block_field(chain, {3, 3}, {test::kBottomCentre});
  EXPECT_EQ(blocks.chain.inputs(), 3 * 87);
  for (const int side : {9, 27, 81}) {
    const Field cells{side, side};
    const Start start{side / 2, 0, test::kBottomCentre.input};
    expect_same_in_blocks(fine(chain, cells, start), coarse(blocks, cells, start), {3, 3}, kBound);
  }
}

TEST(BlockField, TakesMovesDownAndLeaps) {
  std::vector<Exit> leaps = test::boundary_exits();
  leaps[0] = {0, 2, 1}, leaps[1] = {1, -3, 0}, leaps[2] = {2, 4, -1}, leaps[3] = {3, 0, 0};
  leaps[4] = {4, -1, 2};
  for (const auto& exits : {test::boundary_exits_down(), leaps}) {
    const Chain chain = Chain::from_counts(test::boundary_counts(2), exits);
    const Field cells{12, 9};
    const Start start{5, 4, 0};
    const BlockField blocks = block_field(chain, {3, 3}, {start});
    expect_same_in_blocks(fine(chain, cells, start), coarse(blocks, cells, start), {3, 3}, kBound);
  }
}

// Cells of three types in a pattern of 3 x 3: all blocks have one type. A block one cell high makes
// uniform rows, which solver `rows` accepts.
TEST(BlockField, ARepeatedPatternIsOneType) {
  const FieldChain chain = test::repeated({five_states(1), five_states(2), long_walks()}, {3, 3},
                                          {0, 1, 2, 2, 2, 0, 1, 0, 2}, {9, 9});
  const Field cells{9, 9};
  const Start start{4, 0, 0};
  for (const Field& block : {Field{3, 3}, Field{3, 1}}) {
    const BlockField blocks = block_field(chain, block, {start});
    EXPECT_EQ(std::ssize(blocks.chain.chains()), 3 / block.rows);
    EXPECT_TRUE(Predictor(blocks.chain).can_go_by_rows());
    expect_same_in_blocks(fine(chain, cells, start), coarse(blocks, cells, start), block, kBound);
  }
}

TEST(BlockField, OfCellsOfAnyTypes) {
  const Field cells{6, 6};
  test::Words words(1);
  std::vector<int> types;
  for (int cell = 0; cell < 36; ++cell) types.push_back(words.below(3));
  const std::vector<Chain> chains{five_states(1), five_states(2), long_walks()};
  const Start start{2, 1, 3};
  for (const FieldChain& chain :
       {FieldChain::by_cell(chains, 6, types), FieldChain::by_row(chains, {0, 1, 1, 2, 0, 2})}) {
    const BlockField blocks = block_field(chain, {3, 2}, {start});
    expect_same_in_blocks(fine(chain, cells, start), coarse(blocks, cells, start), {3, 2}, kBound);
  }
}

std::string complaint(const FieldChain& chain, const Field& block, const Start& start) {
  try {
    (void)block_field(chain, block, {start});
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "none";
}

// An unsampled way into a block stays unsampled; within a block unsampled rows are refused.
TEST(BlockField, StatesNeverSampled) {
  Counts counts = test::boundary_counts(1);
  test::empty_row(counts, 4);
  const Chain chain = Chain::from_counts(counts, test::boundary_exits());
  const Start start{1, 0, 0};
  const BlockField columns = block_field(chain, {1, 3}, {start});
  const auto d = coarse(columns, {3, 3}, start);
  EXPECT_GT(d.unsampled(), 0.01);
  expect_same_in_blocks(fine(chain, {3, 3}, start), d, {1, 3}, kBound);
  EXPECT_EQ(complaint(chain, {3, 1}, start),
            "blocks: walks get into a state never sampled within a block of 3 x 1 cells");
}

TEST(BlockField, RefusesWhatDoesNotFit) {
  const Chain chain = five_states();
  EXPECT_EQ(complaint(chain, {0, 3}, {}), "blocks: a block of 0 x 3 cells");
  EXPECT_EQ(complaint(FieldChain::by_row({chain}, {0, 0, 0, 0}), {3, 3}, {}),
            "blocks: types of 0 columns and 4 rows (0: any) do not fill blocks of 3 x 3 cells");
  EXPECT_EQ(complaint(chain, {40, 40}, {}),
            "field: more than 4000 states of 40 x 40 cells can be reached; take fewer cells, or a "
            "chain of fewer states");
  EXPECT_EQ(complaint(chain, {3, 3}, {0, 0, 5}),
            "blocks: a start lies outside the field, or has none of the 5 states");
  const Chain circle = Chain::from_probabilities(test::matrix(2, 2, {{0, 1, 1.0}, {1, 0, 1.0}}),
                                                 {{0, 1, 0}, {1, -1, 0}});
  EXPECT_EQ(complaint(circle, {3, 3}, {0, 0, 1}),
            "absorbing chain: state 1 (counted from 0) never ends");
  const BlockField blocks = block_field(chain, {3, 3});
  EXPECT_THROW((void)blocks.field({10, 9}), std::invalid_argument);
  EXPECT_THROW((void)blocks.start({1, 1, 0}), std::invalid_argument);
  EXPECT_EQ(blocks.start({4, 3, 0}).column, 1);
  EXPECT_EQ(blocks.start({4, 3, 0}).row, 1);
}

}  // namespace
}  // namespace gatewalk::markov
