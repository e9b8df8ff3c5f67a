// SPDX-License-Identifier: MIT
#include "markov/committor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "markov/predict.h"
#include "markov/solvers.h"
#include "tests/markov/chains.h"

namespace gatewalk::markov {
namespace {

using namespace test;

// From every state of some cells, the committor equals the share over the far edge in a prediction
// without a limit.
TEST(Committor, IsTheChanceOfTheFarEdge) {
  const Chain chain = Chain::from_counts(lattice_counts(3), never_down());
  const Field field{5, 6};
  const Committor c = committor(chain, field);
  for (const int row : {0, 3, 5})
    for (const int column : {0, 2, 4})
      for (int input = 0; input < 87; input += 7) {
        const auto p = predict(chain, field, {{column, row, input}});
        EXPECT_NEAR(c(column, row, input), p[0].endings[static_cast<std::size_t>(Ending::far_edge)],
                    1e-11)
            << column << " " << row << " " << input;
      }
}

// A single way up with probability q per row: q^n, however small.
TEST(Committor, KeepsItsDigitsWhereItIsSmall) {
  const double q = 0.01;
  const Chain chain =
      Chain::from_probabilities(matrix(1, 2, {{0, 0, q}, {0, 1, 1 - q}}), {{0, 0, 1}, {}});
  const Committor c = committor(chain, {3, 100});
  for (const int row : {0, 50, 99})
    EXPECT_NEAR(std::log10(c(1, row, 0)) / std::log10(std::pow(q, 100 - row)), 1.0, 1e-12) << row;
}

TEST(Committor, TakesCellsOfSeveralTypes) {
  const auto chain = [](double q) {
    return Chain::from_probabilities(matrix(1, 2, {{0, 0, q}, {0, 1, 1 - q}}), {{0, 0, 1}, {}});
  };
  const FieldChain rows = FieldChain::by_row({chain(0.5), chain(0.25)}, {0, 1, 1});
  EXPECT_DOUBLE_EQ(committor(rows, {2, 3})(0, 0, 0), 0.5 * 0.25 * 0.25);
}

// Rows of one type are solved in registers, by strips; rows of several types cell by cell. For
// equal cells both give the same, also if walks stay long in a row and leave by a side.
TEST(Committor, IsTheSameByEitherRoute) {
  for (const int far : {1, 3})
    for (const double stays : {0.3, 0.95}) {
      std::vector<Exit> exits = never_down();
      for (Exit& exit : exits) exit.di_x *= far;
      Probabilities p = Chain::from_counts(lattice_counts(3), exits).matrix();
      for (int row = 0; row < p.rows(); ++row) {  // p within the row, the rest ahead or ending
        double within = 0.0;
        for (Probabilities::InnerIterator it(p, row); it; ++it)
          within += exits[static_cast<std::size_t>(it.col())].di_x != 0 ? it.value() : 0.0;
        for (Probabilities::InnerIterator it(p, row); it && within > 0.0 && within < 1.0; ++it)
          it.valueRef() *= exits[static_cast<std::size_t>(it.col())].di_x != 0
                               ? stays / within
                               : (1.0 - stays) / (1.0 - within);
      }
      const Chain chain = Chain::from_probabilities(p, exits);
      const Field field{11, 4};
      std::vector<int> types(44);
      for (std::size_t i = 0; i < types.size(); ++i) types[i] = i % 2 == 0;
      for (const Ending ending : {Ending::far_edge, Ending::right_edge, Ending::trapped}) {
        const Committor by_sums = committor(chain, field, ending),
                        by_sweeps = committor(FieldChain::by_cell({chain, chain}, 11, types), field,
                                              ending);
        for (std::size_t i = 0; i < by_sums.values.size(); ++i)
          EXPECT_NEAR(by_sums.values[i], by_sweeps.values[i], 2e-11 * by_sweeps.values[i]);
      }
    }
}

// One state that moves to either side with 0.05, or ahead with 0.4: the probability to leave over
// the left side of a single row.
TEST(Committor, KnowsSmallChancesAsWellAsLargeOnes) {
  const Chain chain = Chain::from_probabilities(
      matrix(1, 4, {{0, 0, 0.05}, {0, 1, 0.05}, {0, 2, 0.4}, {0, 3, 0.5}}),
      {{0, -1, 0}, {0, 1, 0}, {0, 0, 1}, {}});
  for (const int columns : {9, 41, 101}) {
    // h(i) = 0.05 (h(i - 1) + h(i + 1)), h(-1) = 1, h(columns) = 0.
    const double r = (1.0 - std::sqrt(1.0 - 4.0 * 0.05 * 0.05)) / (2.0 * 0.05);
    const auto exact = [&](int i) {
      const double n = columns + 1.0, k = i + 1.0;
      return (std::pow(r, k) - std::pow(r, 2.0 * n - k)) / (1.0 - std::pow(r, 2.0 * n));
    };
    std::vector<int> types(static_cast<std::size_t>(columns));
    for (std::size_t i = 0; i < types.size(); ++i) types[i] = i % 2 == 0;
    const Committor by_sums = committor(chain, {columns, 1}, Ending::left_edge),
                    by_sweeps = committor(FieldChain::by_cell({chain, chain}, columns, types),
                                          {columns, 1}, Ending::left_edge);
    for (int i = 0; i < columns; ++i) {
      EXPECT_NEAR(by_sums(i, 0, 0) / exact(i), 1.0, 1e-10) << i << " of " << columns;
      EXPECT_NEAR(by_sweeps(i, 0, 0) / exact(i), 1.0, 1e-10) << i << " of " << columns;
    }
  }
}

// A gambler who wins a game with probability p. By hand: (r^n - 1) / (r^N - 1) with r = (1 - p) /
// p, for few states (elimination) and many (sweeps); for a fair game, r = 1: n / N.
TEST(Committor, OfMovesBackIsTheGamblersRuin) {
  for (const int rows : {9, 1500})
    for (const double p : {0.4, 0.5, 0.6}) {
      if (p == 0.5 && rows > 9) continue;  // walks circle too long
      const Chain chain = Chain::from_probabilities(matrix(1, 2, {{0, 0, p}, {0, 1, 1 - p}}),
                                                    {{0, 0, 1}, {0, 0, -1}});
      const Committor won = committor(chain, {1, rows}),
                      lost = committor(chain, {1, rows}, Ending::near_edge);
      const double r = (1 - p) / p;
      for (int row = 0; row < rows; row += rows / 9) {
        const double n = row + 1.0, all = rows + 1.0;
        const double exact =
            p == 0.5  ? n / all
            : p < 0.5 ? std::pow(r, n - all) * (1.0 - std::pow(r, -n)) / (1.0 - std::pow(r, -all))
                      : (1.0 - std::pow(r, n)) / (1.0 - std::pow(r, all));
        EXPECT_NEAR(won(0, row, 0) / exact, 1.0, 1e-9) << p << " " << row << " of " << rows;
        EXPECT_NEAR(won(0, row, 0) + lost(0, row, 0), 1.0, 1e-11) << p << " " << row;
      }
    }
}

// Walks that circle between two rows for ever have no ending.
TEST(Committor, LeavesOutWalksThatNeverEnd) {
  // State 0: on with 1/2, into the circle with 1/4, else trapped; 1 and 2: up and down.
  const Chain chain = Chain::from_probabilities(
      matrix(3, 4, {{0, 0, 0.5}, {0, 1, 0.25}, {0, 3, 0.25}, {1, 2, 1.0}, {2, 1, 1.0}}),
      {{0, 0, 1}, {1, 0, 1}, {2, 0, -1}, {}});
  const Committor far = committor(chain, {1, 2}),
                  trapped = committor(chain, {1, 2}, Ending::trapped);
  // In the second row both ways ahead lead over the edge: 1/2 * 3/4, and 1/4 + 1/2 * 1/4.
  EXPECT_DOUBLE_EQ(far(0, 0, 0), 0.375);
  EXPECT_DOUBLE_EQ(trapped(0, 0, 0), 0.375);
  EXPECT_EQ(far(0, 1, 1), 0.0);
}

// Rows of two types: from the first up into the second, and back again.
TEST(Committor, LeavesOutWalksThatCircleThroughCellsOfSeveralTypes) {
  const auto all_go = [](int rows) {
    return Chain::from_probabilities(matrix(1, 1, {{0, 0, 1.0}}), {{0, 0, rows}});
  };
  const Committor far = committor(FieldChain::by_row({all_go(1), all_go(-1)}, {0, 1, 0}), {1, 3});
  EXPECT_EQ(far.values, (std::vector<double>{0.0, 0.0, 1.0}));
}

// All walks go back, row by row, to the near edge. The states that can end are found in one pass;
// one row at a time through all rows would take hours.
TEST(Committor, OfManyRowsTakesNoLongerThanTheyAreMany) {
  constexpr int kRows = 1'000'000;
  const Chain back =
      Chain::from_probabilities(matrix(2, 1, {{0, 0, 1.0}, {1, 0, 1.0}}), {{1, 0, -1}});
  const Committor near = committor(back, {1, kRows}, Ending::near_edge);
  for (const int row : {0, kRows / 2, kRows - 1})
    for (const int input : {0, 1}) EXPECT_EQ(near(0, row, input), 1.0);
}

// With moves to all sides the committor equals a prediction without a limit, by a direct solve.
TEST(Committor, OfMovesToAllSidesIsWhatAPredictionSays) {
  const Chain chain = Chain::from_counts(lattice_counts(3), lattice_exits());
  for (const Field& field : {Field{3, 3}, Field{5, 6}})  // eliminated, swept
    for (const Ending ending : {Ending::far_edge, Ending::near_edge, Ending::trapped}) {
      const Committor c = committor(chain, field, ending);
      for (const int row : {0, field.rows - 1})
        for (int input = 0; input < 87; input += 29) {
          const auto p = solve_absorption(chain, field, {1, row, input});
          EXPECT_NEAR(c(1, row, input), p.endings[static_cast<std::size_t>(ending)], 1e-11)
              << field.rows << " " << row << " " << input;
        }
    }
  EXPECT_THROW((void)row_chances(chain, {5, 6}, {}), std::invalid_argument);
}

// From left to right and back, and out once in a million: sweeps do not converge.
TEST(Committor, KnowsWhereWalksCircleForLong) {
  const double out = 1e-6;
  // left (state 0): to the right, up, trapped; right (state 1): to the left.
  const Chain chain = Chain::from_probabilities(
      matrix(2, 4, {{0, 1, 1.0 - 4 * out}, {0, 2, out}, {0, 3, 3 * out}, {1, 0, 1.0}}),
      {{0, -1, 0}, {1, 1, 0}, {0, 0, 1}, {}});
  EXPECT_NEAR(committor(chain, {2, 1})(0, 0, 0), 0.25, 1e-12);
  EXPECT_NEAR(committor(chain, {2, 1}, Ending::trapped)(1, 0, 1), 0.75, 1e-12);
}

// To enter row r is to leave a field of r rows: two routes, from the far edge and from the start.
TEST(RowChances, AreTheCommittorsOfAllRows) {
  const Chain one = Chain::from_counts(lattice_counts(3), never_down()),
              other = Chain::from_counts(lattice_counts(5), never_down());
  const int columns = 5, rows = 7;
  std::vector<int> types;
  for (int cell = 0; cell < columns * rows; ++cell) types.push_back(cell * cell % 3 == 1);
  const auto chain_of_rows = [&](int r) {
    return FieldChain::by_cell({one, other}, columns, {types.begin(), types.begin() + columns * r});
  };
  for (const int input : {0, 40, 86}) {
    const auto chances = row_chances(chain_of_rows(rows), {columns, rows}, {1, 0, input});
    ASSERT_EQ(chances.size(), 7u);
    for (int r = 1; r <= rows; ++r) {
      const double c = committor(chain_of_rows(r), {columns, r})(1, 0, input);
      EXPECT_NEAR(chances[static_cast<std::size_t>(r) - 1] / c, 1.0, 1e-9) << r << " " << input;
    }
  }
}

TEST(RowChances, KeepTheirDigitsWhereTheyAreSmall) {
  const double q = 0.01;
  const Chain chain =
      Chain::from_probabilities(matrix(1, 2, {{0, 0, q}, {0, 1, 1 - q}}), {{0, 0, 1}, {}});
  const auto chances = row_chances(chain, {3, 100}, {1, 40, 0});
  ASSERT_EQ(chances.size(), 60u);
  EXPECT_NEAR(chances.back() / std::pow(q, 60), 1.0, 1e-12);
  const Chain closed = Chain::from_probabilities(matrix(1, 2, {{0, 1, 1.0}}), {{0, 0, 1}, {}});
  EXPECT_EQ(row_chances(closed, {3, 2}, {1, 0, 0}), (std::vector<double>{0.0, 0.0}));
}

}  // namespace
}  // namespace gatewalk::markov
