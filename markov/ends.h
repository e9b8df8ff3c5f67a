#pragma once
/// Where walks end, as all exact methods count it.

#include <algorithm>
#include <limits>
#include <vector>

#include "markov/exact.h"
#include "markov/sum.h"

namespace gatewalk::markov {

/// The cell (column + di_x, row + di_y), or -1 outside the field.
[[nodiscard]] inline std::int64_t neighbour_cell(const Field& field, std::int64_t column,
                                                 std::int64_t row, int di_x, int di_y) {
  column += di_x;
  row += di_y;
  const bool inside = column >= 0 && column < field.columns && row >= 0 && row < field.rows;
  return inside ? row * field.columns + column : -1;
}

/// What rounding makes at most, in all cells together and to first order. Each move is a sum of
/// products, all positive, that goes through `per_move` roundings: a share of the mass moved, and
/// misplaced mass ends but once. The mass that ends, 1, goes through `ending` more.
[[nodiscard]] inline double rounding_bound(double mean_steps, double per_move, double ending) {
  return 0.5 * std::numeric_limits<double>::epsilon() * (mean_steps * per_move + ending);
}

/// Collects where walks end.
class Ends {
 public:
  explicit Ends(const Field& field)
      : field_(field), cells_(static_cast<std::size_t>(field.columns) * field.rows) {}

  CompensatedSum trapped, left_field, cut_off, unsampled;

  void add(CompensatedSum& why, std::int64_t cell, double mass) {
    why += mass;
    cells_[static_cast<std::size_t>(cell)] += mass;
  }

  [[nodiscard]] FinalDistribution result() const {
    FinalDistribution d;
    d.final_cells.resize(field_.rows, field_.columns);
    std::transform(cells_.begin(), cells_.end(), d.final_cells.data(),
                   [](const CompensatedSum& sum) { return sum.value(); });
    d.trapped = trapped.value();
    d.left_field = left_field.value();
    d.cut_off = cut_off.value();
    d.unsampled = unsampled.value();
    return d;
  }

 private:
  Field field_;
  std::vector<CompensatedSum> cells_;
};

}  // namespace gatewalk::markov
