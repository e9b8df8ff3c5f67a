// SPDX-License-Identifier: MIT
#pragma once
/// Linear equations of one row of equal cells, solved for several columns side by side in vector
/// registers.

#include <cstddef>
#include <vector>

#include "markov/predict/layout.h"
#include "markov/predict/stencil.h"

namespace gatewalk::markov {

/// Solves x = b + Q x in a row of cells of one type, where Q holds the moves within the row or
/// their transpose, by alternating sweeps to both sides. A sweep treats states entered by moves to
/// the right in the order of these moves, the next sweep those entered to the left, so only turns
/// are left to later sweeps. Starting from x = b, numbers only grow, and nothing is subtracted.
///
/// The row is cut into strips of equal length, one for each number in a register. A sweep takes the
/// first columns of all strips together, then the second ones, and so on; strips exchange values
/// with their neighbours once per sweep.
class RowSweeps {
 public:
  /// A move from a state to another, `di_x` columns on, with probability p.
  struct Move {
    int from, to, di_x;
    double p;
  };
  /// The kind of sum: `brought` adds what moves bring (visits); `led_to` averages over where moves
  /// lead (probabilities): Q x of a state is the sum of p times the number of the move's target.
  enum class Sums { brought, led_to };
  RowSweeps(const std::vector<Move>& moves, Sums sums, int columns, int inputs);

  /// Whether sweeps are worth while: walks must leave the row soon enough.
  [[nodiscard]] bool suits() const;
  /// Solves in place: `values` (columns x inputs) holds b, of either sign, and then x, to
  /// `tolerance` of the largest magnitude or (for b >= 0) of each number. Returns the number of
  /// sweeps to both sides.
  enum class Of { largest, each };
  int solve(double* values, Of of, double tolerance = 1e-12);

 private:
  /// Calls use for every number of the row with its places in the strips and in the cells.
  template <class Use>
  void each(Use use) const;
  /// Passes the values of states [first, last) on to the neighbouring strips.
  void tell_neighbours(int first, int last);

  int columns_, inputs_, widest_ = 0;
  int length_ = 0;  // of a strip
  double stays_ = 1.0;
  // The order of states: first those that depend on no other; then those entered by moves to the
  // right and to the left on which others depend; last those on which no other depends.
  std::vector<int> states_;
  int right_ = 0, left_ = 0, last_ = 0;  // first index of each group
  bool right_first_up_ = true;           // states entered to the right go from the first column on
  struct Terms {
    std::vector<StripTerm> terms;  // by place
    std::vector<int> ends;
  };
  Terms first_, further_;  // first_: fixed contributions of states that depend on no other
  std::vector<double> shares_;
  std::ptrdiff_t stride_ = 0;  // distance from a column to the next
  PlaneBuffer buffer_;
  Planes mask_, b_, x_;
};

}  // namespace gatewalk::markov
