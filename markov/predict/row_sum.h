#pragma once
/// Linear equations of one row of equal cells, all columns side by side in vector registers.

#include <cstddef>
#include <vector>

#include "markov/predict/layout.h"

namespace gatewalk::markov {

/// x = b + Q x in a row of cells of one type, Q the moves within it (or their transpose), as the
/// sum of b, Q b, Q Q b, ...: to 1e-12. Numbers that are not negative stay so, and
/// nothing is subtracted. Many times as fast as sweeps over the cells, unless walks stay in the row
/// for long.
class RowSum {
 public:
  /// Q adds p times the number of state `source`, `di_x` columns on, to that of `target`.
  struct Term {
    int target, source, di_x;
    double p;
  };
  RowSum(const std::vector<Term>& terms, int columns, int inputs);

  /// Whether it is worth while: walks leave the row soon enough.
  [[nodiscard]] bool suits() const;
  /// `values` (columns x inputs): b, and then x, to 1e-12 of the largest or of each number, however
  /// small.
  enum class Of { largest, each };
  void solve(double* values, Of of);

 private:
  void add(const std::vector<Term>& terms, double* values) const;
  /// For every number of the circle its places in the planes and in the cells.
  template <class Use>
  void each(Use use) const;

  int columns_, inputs_, widest_ = 0;
  // States that depend on no other come first, those that no other depends on last; only what lies
  // between goes round in a circle.
  std::vector<Term> first_, last_;
  std::vector<int> circle_;        // states
  std::vector<GatherTerm> terms_;  // of the circle, by target
  std::vector<int> ends_;
  std::vector<Shift> shifts_;
  double stays_ = 1.0;
  std::ptrdiff_t origin_ = 0, stride_ = 0;
  std::vector<Range> range_;
  PlaneBuffer buffer_;
  Planes mask_, sum_, now_, next_;
};

}  // namespace gatewalk::markov
