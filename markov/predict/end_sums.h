// SPDX-License-Identifier: MIT
#pragma once
/// Sums of where and how walks end, shared by all exact methods.

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "markov/predict.h"
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

/// An upper bound of the rounding error in all cells together, to first order: u (mean_steps
/// per_move + ending), u = eps/2. Each move is a sum of positive products with `per_move`
/// roundings, so at most u per_move of the moved mass is misplaced or lost, and a walk makes
/// mean_steps moves on average. Misplaced mass ends once, so it is wrong in one cell and ending.
/// The mass that ends, 1 in all, has `ending` more roundings.
[[nodiscard]] inline double rounding_bound(double mean_steps, double per_move, double ending) {
  return 0.5 * std::numeric_limits<double>::epsilon() * (mean_steps * per_move + ending);
}

/// Accumulates the final cells and endings of walks.
class EndSums {
 public:
  explicit EndSums(const Field& field)
      : field_(field),
        trapped_(static_cast<std::size_t>(field.columns) * field.rows),
        block_(trapped_.size() / kBlock + 1, kNone) {}

  void add(Ending why, std::int64_t cell, double mass) {
    const auto at = static_cast<std::size_t>(cell);
    if (why == Ending::trapped) {
      trapped_[at] += mass;
      return;
    }
    std::int32_t& block = block_[at / kBlock];
    if (block == kNone) {
      block = static_cast<std::int32_t>(others_.size() / kBlock);
      others_.resize(others_.size() + kBlock);
    }
    others_[static_cast<std::size_t>(block) * kBlock + at % kBlock]
           [static_cast<std::size_t>(why) - 1] += mass;
  }
  /// Adds mass that leaves the field by a move from `cell` to (column, row).
  void depart(std::int64_t cell, std::int64_t column, std::int64_t row, double mass) {
    add(edge_before(field_, column, row), cell, mass);
  }

  [[nodiscard]] FinalDistribution result() const {
    FinalDistribution d;
    d.final_cells.resize(field_.rows, field_.columns);
    d.mixed_cells.reserve(std::min(others_.size(), trapped_.size()));
    std::array<CompensatedSum, kEndings> sums;
    for (std::size_t at = 0; at < trapped_.size(); ++at) {
      CellEndings<double> cell{static_cast<std::int64_t>(at), {trapped_[at].value()}};
      CompensatedSum all = trapped_[at];
      sums.front() += cell.by_ending.front();
      if (const std::int32_t block = block_[at / kBlock]; block != kNone) {
        const auto& others = others_[static_cast<std::size_t>(block) * kBlock + at % kBlock];
        bool is_mixed = false;
        for (std::size_t e = 1; e < kEndings; ++e) {
          const double mass = cell.by_ending[e] = others[e - 1].value();
          if (mass == 0.0) continue;
          is_mixed = true;
          sums[e] += mass;
          all += mass;
        }
        if (is_mixed) d.mixed_cells.push_back(cell);
      }
      d.final_cells.data()[at] = all.value();
    }
    for (std::size_t e = 0; e < kEndings; ++e) d.endings[e] = sums[e].value();
    return d;
  }

 private:
  // Most cells of a large field only trap. Other endings are stored in small blocks of cells, each
  // opened by its first such ending.
  static constexpr std::size_t kBlock = 8;
  static constexpr std::int32_t kNone = -1;

  Field field_;
  std::vector<CompensatedSum> trapped_;  // (cells)
  std::vector<std::int32_t> block_;      // index of each block in others_, or kNone
  std::vector<std::array<CompensatedSum, kEndings - 1>>
      others_;  // (opened blocks x kBlock) by Ending - 1
};

}  // namespace gatewalk::markov
