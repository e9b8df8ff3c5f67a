#pragma once
/// Where walks end and how, as all exact methods count it.

#include <algorithm>
#include <array>
#include <cstdint>
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

/// Collects where walks end, and how.
class Ends {
 public:
  explicit Ends(const Field& field)
      : field_(field), cells_(static_cast<std::size_t>(field.columns) * field.rows),
        block_(cells_.size() / kBlock + 1, kNone) {}

  void add(Ending why, std::int64_t cell, double mass) {
    const auto at = static_cast<std::size_t>(cell);
    if (std::int32_t& block = block_[at / kBlock]; block != kNone || why != Ending::trapped) {
      if (block == kNone) block = open(at / kBlock);
      parts_[static_cast<std::size_t>(block) * kBlock + at % kBlock][static_cast<std::size_t>(why)] += mass;
    }
    sums_[static_cast<std::size_t>(why)] += mass;
    cells_[at] += mass;
  }
  /// By a move from `cell` to (column, row), outside the field.
  void depart(std::int64_t cell, std::int64_t column, std::int64_t row, double mass) {
    left_field_ += mass;
    add(edge_before(field_, column, row), cell, mass);
  }

  [[nodiscard]] FinalDistribution result() const {
    FinalDistribution d;
    d.final_cells.resize(field_.rows, field_.columns);
    std::transform(cells_.begin(), cells_.end(), d.final_cells.data(),
                   [](const CompensatedSum& sum) { return sum.value(); });
    for (std::size_t e = 0; e < kEndings; ++e) d.endings[e] = sums_[e].value();
    d.trapped = d.endings[static_cast<std::size_t>(Ending::trapped)];
    d.left_field = left_field_.value();
    d.cut_off = d.endings[static_cast<std::size_t>(Ending::cut_off)];
    d.unsampled = d.endings[static_cast<std::size_t>(Ending::unsampled)];
    d.mixed_cells.reserve(std::min(parts_.size(), cells_.size()));
    for (std::size_t b = 0; b < block_.size(); ++b)
      for (std::size_t i = 0; block_[b] != kNone && i < kBlock; ++i) {
        const auto& parts = parts_[static_cast<std::size_t>(block_[b]) * kBlock + i];
        CellEndings cell{static_cast<std::int64_t>(b * kBlock + i), {}};
        std::transform(parts.begin(), parts.end(), cell.by_ending.begin(),
                       [](const CompensatedSum& sum) { return sum.value(); });
        if (std::any_of(cell.by_ending.begin() + 1, cell.by_ending.end(), [](double mass) { return mass != 0.0; }))
          d.mixed_cells.push_back(cell);
      }
    return d;
  }

 private:
  // Most cells of a large field only trap. What ends otherwise is kept apart for small blocks of cells,
  // from the first such ending on; what was trapped there before is known by then.
  static constexpr std::size_t kBlock = 8;
  static constexpr std::int32_t kNone = -1;

  std::int32_t open(std::size_t block) {
    const auto number = static_cast<std::int32_t>(parts_.size() / kBlock);
    parts_.resize(parts_.size() + kBlock);
    for (std::size_t i = 0; i < kBlock && block * kBlock + i < cells_.size(); ++i)
      parts_[static_cast<std::size_t>(number) * kBlock + i].front() = cells_[block * kBlock + i];
    return number;
  }

  Field field_;
  std::vector<CompensatedSum> cells_;
  std::array<CompensatedSum, kEndings> sums_;  // by Ending
  CompensatedSum left_field_;
  std::vector<std::int32_t> block_;  // of each block, its place in parts_, or kNone
  std::vector<std::array<CompensatedSum, kEndings>> parts_;  // (opened blocks x kBlock) by Ending
};

}  // namespace gatewalk::markov
