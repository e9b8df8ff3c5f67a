// SPDX-License-Identifier: MIT
#pragma once
/// Expected visits in a row of equal cells for walks that move one cell to the right or left until
/// they end or leave the row: a quasi-birth-death chain with one level per column. It is solved by
/// block-tridiagonal (Thomas) elimination from the left, for any number of moves; in
/// matrix-analytic terms, linear level reduction (Latouche and Ramaswami, Introduction to Matrix
/// Analytic Methods in Stochastic Modeling, SIAM 1999).
///
/// r are the states entered by a move to the right, l those entered by a move to the left. One
/// visit of a state in l makes Rl visits of r in the next column and Ll visits of l in the previous
/// column; one visit of a state in r makes Rr and Lr.

#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <vector>

#include "markov/chain.h"

namespace gatewalk::markov {

/// A dense matrix, column by column, each padded with zeros to `height` numbers.
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
  /// Whether the elimination suits the chain: all moves within a row go one cell, into at most 2000
  /// states, so that dense matrices pay.
  [[nodiscard]] static bool suits(const Chain& chain);
  explicit RowElimination(const Chain& chain);

  /// The matrices of one column after elimination of the columns to its left. G' is G of the
  /// previous column, 0 for the first.
  struct Column {
    Block visits;         // N = (I - G' Lr)^-1 (r x r): visits of r per r entered from outside
    Block turned;         // M = N G' Ll (r x l): visits of r per visit of l
    Block first_passage;  // G = Rl + Rr M (r x l): states in which walks first enter the column at
                          // the right, per visit of l
  };

  /// Cost in products of registers: solve() per column, and one further column().
  [[nodiscard]] double solve_cost() const;
  [[nodiscard]] double column_cost() const;

  /// The first `count` columns; once columns hardly differ, the last one stands for all further
  /// ones. Empty if walks can circle (almost) for ever, or the columns exceed the memory allowed.
  /// Columns are kept, so only new ones take time. Thread-safe.
  [[nodiscard]] std::vector<const Column*> columns(int count) const;

  /// The number of doubles that solve() needs as workspace.
  [[nodiscard]] std::size_t workspace(int count) const;
  /// Computes visits += (I - Q)^-1 entering, both in planes (stencil.h) that begin at the first
  /// column.
  void solve(const std::vector<const Column*>& columns, const double* entering, double* visits,
             std::ptrdiff_t stride, double* workspace) const;

 private:
  [[nodiscard]] bool append() const;

  std::vector<int> right_, left_;    // inputs entered by a move to the right, left
  std::vector<char> is_also_right_;  // for each of left_
  Block rr_, rl_, lr_, ll_;          // rl: to the right after entering by a move to the left
  mutable std::mutex growing_;
  mutable std::deque<Column> columns_;
  mutable bool is_settled_ = false, is_singular_ = false;
};

/// A RowElimination that is made on first use. Thread-safe.
class LazyRowElimination {
 public:
  /// `chain` must outlive this object.
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
