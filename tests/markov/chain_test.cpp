// SPDX-License-Identifier: MIT
#include "markov/chain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "chains.h"

namespace gatewalk::markov {
namespace {

using test::matrix;

const std::vector<Exit> kTwoExits = {{0, 0, 1}, {}};

std::string refusal(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

#define EXPECT_REFUSED(action, part)                       \
  do {                                                     \
    const std::string what = refusal([&] { action; });     \
    EXPECT_NE(what.find(part), std::string::npos) << what; \
  } while (false)

TEST(Chain, RowsAreCountsOverTheirSum) {
  Counts counts(2, 2);  // left uncompressed on purpose
  counts.coeffRef(0, 0) = 1;
  counts.coeffRef(0, 1) = 2;
  counts.coeffRef(1, 1) = std::int64_t{1} << 60;
  const Chain chain = Chain::from_counts(counts, kTwoExits);
  EXPECT_EQ(chain.inputs(), 2);
  EXPECT_EQ(chain.outputs(), 2);
  EXPECT_EQ(chain.exits(), kTwoExits);
  EXPECT_EQ(chain.matrix().coeff(0, 0), 1.0 / 3.0);
  EXPECT_EQ(chain.matrix().coeff(0, 1), 2.0 / 3.0);
  EXPECT_EQ(chain.matrix().coeff(1, 1), 1.0);
  EXPECT_EQ(chain.matrix().nonZeros(), 3);
  EXPECT_EQ(chain.unsampled_rows(), 0);
}

TEST(Chain, RowsOfStartsStandBehindTheOthers) {
  Counts counts(2, 2), starts(2, 2);
  counts.coeffRef(0, 1) = 5;
  counts.coeffRef(1, 0) = 2;
  starts.coeffRef(1, 0) = 3;
  starts.coeffRef(1, 1) = 1;
  const Chain chain = Chain::from_counts(counts, kTwoExits, starts);
  EXPECT_EQ(chain.inputs(), 4);
  EXPECT_EQ(chain.matrix().coeff(0, 1), 1.0);
  EXPECT_EQ(chain.matrix().coeff(1, 0), 1.0);
  EXPECT_FALSE(chain.is_sampled(2));
  EXPECT_EQ(chain.matrix().coeff(3, 0), 0.75);
  EXPECT_EQ(chain.matrix().coeff(3, 1), 0.25);
  starts.coeffRef(0, 0) = -1;
  EXPECT_REFUSED(Chain::from_counts(counts, kTwoExits, starts), "row 2 (counted from 0): count -1");
  EXPECT_REFUSED(Chain::from_counts(counts, kTwoExits, Counts(1, 3)),
                 "rows of 3 outputs cannot stand behind rows of 2");
}

TEST(Chain, AnAllZeroRowIsUnsampled) {
  Counts counts(3, 2);
  counts.coeffRef(0, 1) = 4;
  counts.coeffRef(1, 0) = 0;  // stored zero
  counts.coeffRef(1, 1) = 0;
  const Chain chain = Chain::from_counts(counts, kTwoExits);
  EXPECT_TRUE(chain.is_sampled(0));
  EXPECT_FALSE(chain.is_sampled(1));
  EXPECT_FALSE(chain.is_sampled(2));
  EXPECT_EQ(chain.unsampled_rows(), 2);
  EXPECT_EQ(chain.matrix().nonZeros(), 1);

  const Chain same =
      Chain::from_probabilities(matrix(3, 2, {{0, 1, 1.0}, {1, 0, 0.0}, {1, 1, -0.0}}), kTwoExits);
  EXPECT_EQ(same.unsampled_rows(), 2);
  EXPECT_EQ(same.matrix().nonZeros(), 1);
}

TEST(Chain, RefusesCountsThatAreNone) {
  Counts counts(2, 2);
  counts.coeffRef(0, 0) = 1;
  counts.coeffRef(1, 1) = -1;
  EXPECT_REFUSED(Chain::from_counts(counts, kTwoExits), "row 1 (counted from 0): count -1");
  counts.coeffRef(1, 0) = std::numeric_limits<std::int64_t>::max();
  counts.coeffRef(1, 1) = 1;
  EXPECT_REFUSED(Chain::from_counts(counts, kTwoExits), "row 1 (counted from 0): the sum");
}

TEST(Chain, RefusesARowThatDoesNotAddUp) {
  const auto with_sum = [](double sum) {
    return Chain::from_probabilities(matrix(2, 2, {{0, 1, 1.0}, {1, 0, 0.25}, {1, 1, sum - 0.25}}),
                                     kTwoExits);
  };
  EXPECT_REFUSED(with_sum(0.9), "row 1 (counted from 0): probabilities sum to 0.90000000000000002");
  EXPECT_REFUSED(with_sum(1.0 + 1.1e-12), "row 1");
  EXPECT_REFUSED(with_sum(1.0 - 1.1e-12), "row 1");
  // Nothing is normalised: rows within the tolerance stay as given.
  EXPECT_EQ(with_sum(1.0 - 9e-13).matrix().coeff(1, 1), (1.0 - 9e-13) - 0.25);
}

TEST(Chain, RefusesWhatIsNoProbability) {
  for (const double p : {-1e-300, std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    EXPECT_REFUSED(
        Chain::from_probabilities(matrix(2, 2, {{0, 1, 1.0}, {1, 0, p}, {1, 1, 1.0}}), kTwoExits),
        "of output 0 is not a probability");
  }
}

TEST(Chain, KeepsAnEscapeOf1e300) {
  const Chain chain =
      Chain::from_probabilities(matrix(1, 2, {{0, 0, 1.0}, {0, 1, 1e-300}}), kTwoExits);
  EXPECT_EQ(chain.matrix().coeff(0, 1), 1e-300);
}

TEST(Chain, RefusesExitsThatDoNotFit) {
  Counts counts(1, 2);
  counts.coeffRef(0, 0) = 1;
  const auto build = [&](std::vector<Exit> exits) { return Chain::from_counts(counts, exits); };
  EXPECT_EQ(build({{0, -3, 7}, {}}).inputs(), 1);
  EXPECT_REFUSED(build({{}}), "1 exits for 2 outputs");
  EXPECT_REFUSED(build({{}, {}, {}}), "3 exits for 2 outputs");
  EXPECT_REFUSED(build({{}, {1, 0, 1}}), "exit of output 1 (counted from 0): next_input 1");
  EXPECT_REFUSED(build({{-2, 0, 0}, {}}), "exit of output 0");
  EXPECT_REFUSED(build({{Exit::kTrapped, 1, 0}, {}}), "trapped, and yet it moves");
  EXPECT_REFUSED(build({{Exit::kTrapped, 0, -1}, {}}), "trapped, and yet it moves");
  EXPECT_REFUSED(Chain::from_counts(Counts(0, 2), {{}, {}}), "at least one input");
  EXPECT_REFUSED(Chain::from_probabilities(Probabilities(1, 0), {}), "at least one");
}

TEST(Chain, RefusesAStartThatDoesNotBelong) {
  const Chain chain = Chain::from_probabilities(matrix(2, 2, {{0, 1, 1.0}}), kTwoExits);
  const Field field{3, 2};
  EXPECT_NO_THROW(validate(chain, field, {2, 1, 1}, 0));
  EXPECT_REFUSED(validate(chain, field, {3, 1, 1}, 0), "start: cell (3, 1)");
  EXPECT_REFUSED(validate(chain, field, {-1, 1, 1}, 0), "start: cell");
  EXPECT_REFUSED(validate(chain, field, {2, 2, 1}, 0), "start: cell");
  EXPECT_REFUSED(validate(chain, field, {2, -1, 1}, 0), "start: cell");
  EXPECT_REFUSED(validate(chain, field, {2, 1, 2}, 0), "start: input 2 is not in [0, 2)");
  EXPECT_REFUSED(validate(chain, field, {2, 1, -1}, 0), "start: input");
  EXPECT_REFUSED(validate(chain, field, {2, 1, 1}, -1), "max_cells");
  EXPECT_REFUSED(validate(chain, {0, 2}, {0, 0, 0}, 1), "field");
  EXPECT_REFUSED(validate(chain, {3, -1}, {0, 0, 0}, 1), "field");
  EXPECT_REFUSED(validate(chain, {1 << 16, 1 << 15}, {0, 0, 0}, 1), "field");
}

TEST(FieldChain, TakesOtherChainsForTheSameCells) {
  const auto chain = [](std::int64_t up) {
    Counts counts(1, 2);
    counts.coeffRef(0, 0) = up;
    counts.coeffRef(0, 1) = 1;
    return Chain::from_counts(counts, kTwoExits);
  };
  const FieldChain field = FieldChain::by_cell({chain(1), chain(3)}, 2, {0, 1, 1, 0});
  const FieldChain other = field.with({chain(7), chain(9)});
  for (const auto& [column, row] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}})
    EXPECT_EQ(other.type_of(column, row), field.type_of(column, row));
  EXPECT_EQ(other.at(1, 0).matrix().coeff(0, 0), 0.9);
  EXPECT_EQ(other.columns(), 2);
  EXPECT_REFUSED((void)field.with({chain(1)}), "1 chains cannot take the place of 2");
}

}  // namespace
}  // namespace gatewalk::markov
