// SPDX-License-Identifier: MIT
#include "markov/predict/row_elimination.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "chains.h"

namespace gatewalk::markov {
namespace {

/// Two inputs entered from the left, two from the right, one (2) from both; the rest goes up or
/// ends.
Chain small() {
  const std::vector<Exit> exits{{0, 1, 0},  {1, 1, 0},  {2, 1, 0}, {2, -1, 0},
                                {3, -1, 0}, {4, -1, 0}, {0, 0, 1}, {}};
  std::vector<test::Entry> entries;
  test::Words words(3);
  for (int row = 0; row < 5; ++row) {
    std::vector<double> p;
    double sum = 0.0;
    for (int k = 0; k < 8; ++k) sum += p.emplace_back(k < 6 ? 1 + words.below(9) : 0.2 + 0.1 * row);
    for (int k = 0; k < 8; ++k) entries.push_back({row, k, p[static_cast<std::size_t>(k)] / sum});
  }
  return Chain::from_probabilities(test::matrix(5, 8, entries), exits);
}

/// The moves within a row of cells as one matrix: from (cell, input) to (cell, input).
Eigen::MatrixXd within_row(const Chain& chain, int cells) {
  const int n = chain.inputs();
  Eigen::MatrixXd q = Eigen::MatrixXd::Zero(n * cells, n * cells);
  for (int cell = 0; cell < cells; ++cell)
    for (int input = 0; input < n; ++input)
      for (Probabilities::InnerIterator it(chain.matrix(), input); it; ++it) {
        const Exit& exit = chain.exits()[static_cast<std::size_t>(it.col())];
        const int next = cell + exit.di_x;
        if (exit.next_input == Exit::kTrapped || exit.di_y != 0 || next < 0 || next >= cells)
          continue;
        q(next * n + exit.next_input, cell * n + input) += it.value();
      }
  return q;
}

void expect_solves(const Chain& chain, int cells, double bound) {
  ASSERT_TRUE(RowElimination::suits(chain));
  const RowElimination elimination(chain);
  const int n = chain.inputs();
  using PlanesOfARow = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  PlanesOfARow entering = PlanesOfARow::Zero(n, cells + 3),
               visits = PlanesOfARow::Ones(n, cells + 3);
  std::vector<char> sideways(static_cast<std::size_t>(n));
  for (const Exit& exit : chain.exits())
    if (exit.next_input != Exit::kTrapped && exit.di_y == 0)
      sideways[static_cast<std::size_t>(exit.next_input)] = 1;
  Eigen::VectorXd b = Eigen::VectorXd::Zero(n * cells);
  test::Words words(7);
  for (int input = 0; input < n; ++input)
    for (int cell = 0; cell < cells; ++cell)
      if (sideways[static_cast<std::size_t>(input)])
        b(cell * n + input) = entering(input, cell) = 1e-3 * words.below(1000);
  const auto columns = elimination.columns(cells);
  ASSERT_EQ(columns.size(), static_cast<std::size_t>(cells));
  std::vector<double> workspace(elimination.workspace(cells));
  elimination.solve(columns, entering.data(), visits.data(), cells + 3, workspace.data());

  const Eigen::MatrixXd q = within_row(chain, cells);
  const Eigen::VectorXd x =
      (Eigen::MatrixXd::Identity(n * cells, n * cells) - q).partialPivLu().solve(b);
  for (int input = 0; input < n; ++input)
    for (int cell = 0; cell < cells; ++cell)
      EXPECT_NEAR(visits(input, cell) - 1.0, x(cell * n + input), bound * x.maxCoeff());
}

TEST(RowElimination, IsTheDenseSolution) {
  for (const int cells : {1, 2, 3, 9, 40, 130}) expect_solves(small(), cells, 1e-12);
}

TEST(RowElimination, IsTheDenseSolutionForThePapersShape) {
  auto exits = test::lattice_exits();
  for (Exit& exit : exits)
    if (exit.di_y < 0) exit.di_y = 1;
  for (const int cells : {1, 5, 12})
    expect_solves(Chain::from_counts(test::lattice_counts(1), exits), cells, 1e-12);
}

TEST(RowElimination, FurtherColumnsAreTheLastOne) {
  const RowElimination elimination(small());
  const auto few = elimination.columns(5), many = elimination.columns(3000);
  EXPECT_TRUE(std::equal(few.begin(), few.end(), many.begin()));
  EXPECT_NE(few[3], few[4]);
  EXPECT_EQ(many[2000], many[2999]);
}

TEST(RowElimination, TakesNeighboursOnlyAndNoCircles) {
  const auto one = [](int di_x, int di_y) {
    return Chain::from_probabilities(test::matrix(1, 1, {{0, 0, 1.0}}), {{0, di_x, di_y}});
  };
  EXPECT_FALSE(RowElimination::suits(one(2, 0)));
  EXPECT_FALSE(RowElimination::suits(one(0, 0)));
  EXPECT_TRUE(RowElimination::suits(one(-1, 0)));
  EXPECT_TRUE(RowElimination::suits(one(5, 1)));
  EXPECT_EQ(RowElimination(one(1, 0)).columns(7).size(), 7u);
  const Chain circle = Chain::from_probabilities(test::matrix(2, 2, {{0, 1, 1.0}, {1, 0, 1.0}}),
                                                 {{0, 1, 0}, {1, -1, 0}});
  EXPECT_EQ(RowElimination(circle).columns(1).size(), 1u);
  EXPECT_TRUE(RowElimination(circle).columns(2).empty());
}

}  // namespace
}  // namespace gatewalk::markov
