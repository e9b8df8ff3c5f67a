// SPDX-License-Identifier: MIT
#pragma once
/// Visits in a row of equal cells, of walks that move to the neighbour at the right or the left
/// until they end or leave the row: a quasi-birth-death chain with one level per column. Solved by
/// block-tridiagonal (Thomas) elimination from the left, whatever the number of moves; in the terms
/// of matrix-analytic methods, linear level reduction (Latouche and Ramaswami, Introduction to
/// Matrix Analytic Methods in Stochastic Modeling, SIAM 1999).
///
/// r: states entered by a move to the right, l: by a move to the left. One visit of a state in l
/// makes Rl visits of r in the next column and Ll of l in the column before, one of r makes Rr and
/// Lr.

#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <vector>

#include "markov/chain.h"

namespace gatewalk::markov {

/// Dense, column by column, each padded with zeros to `height` numbers.
struct Block {
  int rows = 0, columns = 0, height = 0;
  std::vector<double> p;
  Block() = default;
  Block(int n_rows, int n_columns);
  [[nodiscard]] double* column(int j) { return p.data() + std::ptrdiff_t{j} * height; }
  [[nodiscard]] const double* column(int j) const { return p.data() + std::ptrdiff_t{j} * height; }
};

class RowElimination {
 public:
  /// Whether all moves of the chain within a row go one cell on, and are into so few states that
  /// dense matrices of them pay (2000).
  [[nodiscard]] static bool suits(const Chain& chain);
  explicit RowElimination(const Chain& chain);

  /// One column, those at its left eliminated. G' is G of the column before, 0 for the first.
  struct Column {
    Block visits;         // N = (I - G' Lr)^-1 (r x r): visits of r per r entered from outside
    Block turned;         // M = N G' Ll (r x l): visits of r per visit of l
    Block first_passage;  // G = Rl + Rr M (r x l): states in which walks first enter the column at
                          // the right, per visit of l
  };

  /// Operations (products of registers) that solve() takes per column, that a further column()
  /// takes.
  [[nodiscard]] double solve_cost() const;
  [[nodiscard]] double column_cost() const;

  /// The first `count` columns; the last one stands for all further ones once they hardly differ.
  /// Empty if walks can circle (almost) for ever, or the columns do not fit the memory allowed.
  /// They are kept: only columns that no call asked for before take time. Thread-safe.
  [[nodiscard]] std::vector<const Column*> columns(int count) const;

  /// Numbers that solve() needs to work with.
  [[nodiscard]] std::size_t workspace(int count) const;
  /// visits += (I - Q)^-1 entering, both in planes (stencil.h) that begin at the first column.
  void solve(const std::vector<const Column*>& columns, const double* entering, double* visits,
             std::ptrdiff_t stride, double* workspace) const;

 private:
  [[nodiscard]] bool append() const;

  std::vector<int> right_, left_;    // inputs entered by a move to the right, left
  std::vector<char> is_also_right_;  // of left_
  Block rr_, rl_, lr_, ll_;          // rl: to the right after entering by a move to the left
  mutable std::mutex growing_;
  mutable std::deque<Column> columns_;
  mutable bool is_settled_ = false, is_singular_ = false;
};

/// A RowElimination that is made when it is first asked for. Thread-safe.
class LazyRowElimination {
 public:
  /// `chain` must live as long.
  explicit LazyRowElimination(const Chain& chain) : chain_(chain) {}
  [[nodiscard]] const RowElimination& get() const {
    std::call_once(made_, [this] { elimination_ = std::make_unique<RowElimination>(chain_); });
    return *elimination_;
  }

 private:
  const Chain& chain_;
  mutable std::once_flag made_;
  mutable std::unique_ptr<const RowElimination> elimination_;
};

}  // namespace gatewalk::markov
