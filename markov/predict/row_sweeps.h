// SPDX-License-Identifier: MIT
#pragma once
/// Linear equations of one row of equal cells, several columns side by side in vector registers.

#include <cstddef>
#include <vector>

#include "markov/predict/layout.h"
#include "markov/predict/stencil.h"

namespace gatewalk::markov {

/// x = b + Q x in a row of cells of one type, Q the moves within it or their transpose, by sweeps
/// along the row, one to either side: states that are entered by moves to the right in the order in
/// which such moves are made, then those to the left, so that only turns are left to the next
/// sweeps. From x = b on, numbers only grow: what is not negative stays so, and nothing is
/// subtracted.
///
/// The row is cut into strips of equal length, one for each number in a register: a sweep takes the
/// first columns of all strips together, then the second ones, ... and a strip hears of its
/// neighbours once a sweep.
class RowSweeps {
 public:
  /// With chance p from a state to another, `di_x` columns on.
  struct Move {
    int from, to, di_x;
    double p;
  };
  /// Sums of what moves bring (visits), or of what they lead to (chances: Q x of a state is the sum
  /// of p times the number of the state that the move leads to).
  enum class Sums { brought, led_to };
  RowSweeps(const std::vector<Move>& moves, Sums sums, int columns, int inputs);

  /// Whether it is worth while: walks leave the row soon enough.
  [[nodiscard]] bool suits() const;
  /// `values` (columns x inputs): b, of either sign, and then x, to `tolerance` of the largest
  /// magnitude, or (b not negative) of each number, however small.
  /// Returns how many sweeps to both sides that took.
  enum class Of { largest, each };
  int solve(double* values, Of of, double tolerance = 1e-12);

 private:
  /// For every number of the row its places in the strips and in the cells.
  template <class Use>
  void each(Use use) const;
  /// What a strip has to know of its neighbours: of states [first, last).
  void tell_neighbours(int first, int last);

  int columns_, inputs_, widest_ = 0;
  int length_ = 0;  // of a strip
  double stays_ = 1.0;
  // Places of states: those that depend on no other, those entered by moves to the right and to the
  // left of which others depend, and those that no other depends on.
  std::vector<int> states_;
  int right_ = 0, left_ = 0, last_ = 0;  // where they begin
  bool right_first_up_ = true;           // those to the right from the first column on
  struct Terms {
    std::vector<StripTerm> terms;  // by place
    std::vector<int> ends;
  };
  Terms first_, further_;  // first: what states that depend on no other add once and for all
  std::vector<double> shares_;
  std::ptrdiff_t stride_ = 0;  // from a column to the next
  PlaneBuffer buffer_;
  Planes mask_, b_, x_;
};

}  // namespace gatewalk::markov
