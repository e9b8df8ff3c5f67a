// SPDX-License-Identifier: MIT
#include "markov/predict/row_sweeps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "chains.h"

namespace gatewalk::markov {
namespace {

using Moves = std::vector<RowSweeps::Move>;

constexpr int kInputs = 23;

/// States 0 and 1 are never entered; no walk goes on from 2 and 3. The others keep `stays` of the
/// walks in the row, most of them by moves to the side from which they were entered.
Moves some_moves(int widest, double stays, std::uint64_t seed) {
  test::Words words(seed);
  Moves moves;
  for (int from = 0; from < kInputs; ++from) {
    if (from == 2 || from == 3) continue;
    const int count = 1 + words.below(5);
    for (int k = 0; k < count; ++k) {
      const int to = 2 + words.below(kInputs - 2), by = 1 + words.below(widest);
      moves.push_back({from, to, to % 2 == 0 ? by : -by, stays / count});
    }
  }
  return moves;
}

/// Computes b + Q b + Q Q b + ..., number by number.
std::vector<double> plain_sum(const Moves& moves, RowSweeps::Sums sums, int columns,
                              std::vector<double> term) {
  std::vector<double> all = term;
  for (bool grows = true; grows;) {
    std::vector<double> next(term.size(), 0.0);
    for (int column = 0; column < columns; ++column)
      for (const auto& [from, to, di_x, p] : moves) {
        if (column + di_x < 0 || column + di_x >= columns) continue;
        const auto here = static_cast<std::size_t>(column * kInputs + from),
                   there = static_cast<std::size_t>((column + di_x) * kInputs + to);
        if (sums == RowSweeps::Sums::brought)
          next[there] += p * term[here];
        else
          next[here] += p * term[there];
      }
    grows = false;
    for (std::size_t i = 0; i < all.size(); ++i) {
      grows = grows || next[i] > 1e-18 * all[i];
      all[i] += next[i];
    }
    term.swap(next);
  }
  return all;
}

std::vector<double> summed(const Moves& moves, RowSweeps::Sums sums, int columns,
                           std::vector<double> values, RowSweeps::Of of, double tolerance) {
  RowSweeps row(moves, sums, columns, kInputs);
  EXPECT_TRUE(row.suits());
  row.solve(values.data(), of, tolerance);
  return values;
}

/// Random numbers in any cell, or in the cell of one column only.
std::vector<double> some_numbers(int columns, int only) {
  test::Words words(11);
  std::vector<double> b(static_cast<std::size_t>(columns) * kInputs, 0.0);
  for (int i = 0; i < columns * kInputs; ++i)
    if (only < 0 ? words.below(3) > 0 : i / kInputs == only)
      b[static_cast<std::size_t>(i)] = 1e-3 * (1 + words.below(1000));
  return b;
}

TEST(RowSweeps, IsThatOfMoreAndMoreMoves) {
  for (const auto sums : {RowSweeps::Sums::brought, RowSweeps::Sums::led_to})
    for (const int widest : {1, 2})
      for (const int columns : {3, 8, 9, 16, 31, 101})
        for (const int only : {-1, 1}) {
          const Moves moves = some_moves(widest, 0.8, 5);
          const auto b = some_numbers(columns, only), exact = plain_sum(moves, sums, columns, b);
          const auto x = summed(moves, sums, columns, b, RowSweeps::Of::each, 1e-12);
          for (std::size_t i = 0; i < x.size(); ++i)
            ASSERT_NEAR(x[i], exact[i], 1e-12 * exact[i]) << i << " of " << columns;
        }
}

TEST(RowSweeps, IsAsExactAsAskedFor) {
  const Moves moves = some_moves(1, 0.9, 7);
  const int columns = 101;
  const auto b = some_numbers(columns, 50),
             exact = plain_sum(moves, RowSweeps::Sums::brought, columns, b);
  const double largest = *std::max_element(exact.begin(), exact.end());
  for (const double tolerance : {1e-3, 1e-6, 1e-12}) {
    const auto of_each = summed(moves, RowSweeps::Sums::brought, columns, b, RowSweeps::Of::each,
                                tolerance),
               of_largest = summed(moves, RowSweeps::Sums::brought, columns, b,
                                   RowSweeps::Of::largest, tolerance);
    double off_largest = 0.0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
      ASSERT_NEAR(of_each[i], exact[i], tolerance * exact[i]);
      ASSERT_GE(of_each[i], of_largest[i]);  // numbers only grow, and settle later
      off_largest = std::max(off_largest, std::abs(of_largest[i] - exact[i]));
    }
    EXPECT_LE(off_largest, tolerance * largest);
    EXPECT_GT(off_largest, tolerance * 1e-5 * largest);  // it stopped earlier
  }
}

// Residuals have both signs.
TEST(RowSweeps, TakeNumbersOfEitherSign) {
  const Moves moves = some_moves(1, 0.8, 5);
  const int columns = 31;
  const auto b = some_numbers(columns, -1),
             exact = plain_sum(moves, RowSweeps::Sums::brought, columns, b);
  const double largest = *std::max_element(exact.begin(), exact.end());
  std::vector<double> negative = b;
  for (double& number : negative) number = -number;
  const auto x =
      summed(moves, RowSweeps::Sums::brought, columns, negative, RowSweeps::Of::largest, 1e-12);
  for (std::size_t i = 0; i < x.size(); ++i) ASSERT_NEAR(x[i], -exact[i], 1e-12 * largest);
}

TEST(RowSweeps, SuitsWalksThatLeaveSoon) {
  EXPECT_FALSE(RowSweeps(some_moves(1, 0.99, 5), RowSweeps::Sums::brought, 9, kInputs).suits());
  EXPECT_FALSE(RowSweeps(some_moves(2, 0.5, 5), RowSweeps::Sums::brought, 2, kInputs).suits());
}

}  // namespace
}  // namespace gatewalk::markov
