// SPDX-License-Identifier: MIT
#pragma once
/// Where bodies end in a field, and how: counted of trials or of walks, or as shares of all.

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "markov/chain.h"

namespace gatewalk::markov {

/// A number for each cell (rows x columns).
template <class Number>
using CellNumbers = Eigen::Array<Number, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using CellCounts = CellNumbers<std::int64_t>;
using CellProbabilities = CellNumbers<double>;

/// What ended in one cell.
template <class Number>
struct CellEndings {
  std::int64_t cell = 0;                     // row * columns + column
  std::array<Number, kEndings> by_ending{};  // by Ending

  [[nodiscard]] Number& operator[](Ending e) { return by_ending[static_cast<std::size_t>(e)]; }
  [[nodiscard]] Number operator[](Ending e) const { return by_ending[static_cast<std::size_t>(e)]; }
  friend bool operator==(const CellEndings&, const CellEndings&) = default;
};

/// `Number`: std::int64_t for counts of bodies, double for shares of all bodies.
template <class Number>
struct Ends {
  /// Bodies by their last cell inside the field, however they ended there (rows x columns).
  CellNumbers<Number> final_cells{};
  std::array<Number, kEndings> endings{};  // by Ending
  /// Cells in which bodies ended otherwise than trapped, in ascending order: most cells of a large
  /// field only trap. In all others, all of final_cells was trapped.
  std::vector<CellEndings<Number>> mixed_cells{};

  [[nodiscard]] Number operator[](Ending e) const { return endings[static_cast<std::size_t>(e)]; }
  [[nodiscard]] Number trapped() const { return (*this)[Ending::trapped]; }
  /// By a move over any of the four edges.
  [[nodiscard]] Number left_field() const;
  /// The limit of cells was visited, and the body would have gone on.
  [[nodiscard]] Number cut_off() const { return (*this)[Ending::cut_off]; }
  /// A state was entered whose row was never sampled.
  [[nodiscard]] Number unsampled() const { return (*this)[Ending::unsampled]; }

  /// Throws std::invalid_argument if both have cells, of different fields.
  Ends& operator+=(const Ends& other);
};
extern template struct Ends<std::int64_t>;
extern template struct Ends<double>;

/// Those that were trapped in each cell; that left the field from it (rows x columns).
template <class Number>
[[nodiscard]] CellNumbers<Number> trapped_cells(const Ends<Number>& ends) {
  CellNumbers<Number> cells = ends.final_cells;
  for (const auto& c : ends.mixed_cells) cells.data()[c.cell] = c[Ending::trapped];
  return cells;
}
template <class Number>
[[nodiscard]] CellNumbers<Number> departed_cells(const Ends<Number>& ends) {
  CellNumbers<Number> cells =
      CellNumbers<Number>::Zero(ends.final_cells.rows(), ends.final_cells.cols());
  for (const auto& c : ends.mixed_cells)
    for (const Ending edge : kEdges) cells.data()[c.cell] += c[edge];
  return cells;
}

/// Each number as share_of(number).
template <class Number, class ShareOf>
[[nodiscard]] Ends<double> shares_of(const Ends<Number>& ends, ShareOf share_of) {
  Ends<double> shares;
  shares.final_cells = ends.final_cells.unaryExpr(share_of);
  std::transform(ends.endings.begin(), ends.endings.end(), shares.endings.begin(), share_of);
  for (const auto& from : ends.mixed_cells) {
    CellEndings<double>& cell = shares.mixed_cells.emplace_back();
    cell.cell = from.cell;
    std::transform(from.by_ending.begin(), from.by_ending.end(), cell.by_ending.begin(), share_of);
  }
  return shares;
}

}  // namespace gatewalk::markov
