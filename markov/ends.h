// SPDX-License-Identifier: MIT
#pragma once
/// Where and how bodies end in a field: as counts of trials or walks, or as shares of all bodies.

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "markov/chain.h"

namespace gatewalk::markov {

/// An array with one number for each cell (rows x columns).
template <class Number>
using CellNumbers = Eigen::Array<Number, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using CellCounts = CellNumbers<std::int64_t>;
using CellProbabilities = CellNumbers<double>;

/// The bodies that ended in one cell, by ending.
template <class Number>
struct CellEndings {
  std::int64_t cell = 0;                     // row * columns + column
  std::array<Number, kEndings> by_ending{};  // by Ending

  [[nodiscard]] Number& operator[](Ending e) { return by_ending[static_cast<std::size_t>(e)]; }
  [[nodiscard]] Number operator[](Ending e) const { return by_ending[static_cast<std::size_t>(e)]; }
  friend bool operator==(const CellEndings&, const CellEndings&) = default;
};

/// Final cells and endings of many bodies. `Number` is std::int64_t for counts of bodies, double
/// for shares of all bodies.
template <class Number>
struct Ends {
  /// Bodies by the last cell inside the field (rows x columns), whatever their ending.
  CellNumbers<Number> final_cells{};
  std::array<Number, kEndings> endings{};  // by Ending
  /// Cells with an ending other than trapped, in ascending order. In all other cells, every body of
  /// final_cells was trapped; in large fields these are most cells.
  std::vector<CellEndings<Number>> mixed_cells{};

  [[nodiscard]] Number operator[](Ending e) const { return endings[static_cast<std::size_t>(e)]; }
  [[nodiscard]] Number trapped() const { return (*this)[Ending::trapped]; }
  /// Bodies that left the field over any of its four edges.
  [[nodiscard]] Number left_field() const;
  /// Bodies that had visited the largest permitted number of cells and would have gone on.
  [[nodiscard]] Number cut_off() const { return (*this)[Ending::cut_off]; }
  /// Bodies that entered an unsampled state.
  [[nodiscard]] Number unsampled() const { return (*this)[Ending::unsampled]; }

  /// Adds the numbers of other bodies. Throws std::invalid_argument if both have cells and their
  /// fields differ.
  Ends& operator+=(const Ends& other);
};
extern template struct Ends<std::int64_t>;
extern template struct Ends<double>;

/// Bodies trapped in each cell (rows x columns).
template <class Number>
[[nodiscard]] CellNumbers<Number> trapped_cells(const Ends<Number>& ends) {
  CellNumbers<Number> cells = ends.final_cells;
  for (const auto& c : ends.mixed_cells) cells.data()[c.cell] = c[Ending::trapped];
  return cells;
}
/// Bodies that left the field from each cell (rows x columns).
template <class Number>
[[nodiscard]] CellNumbers<Number> departed_cells(const Ends<Number>& ends) {
  CellNumbers<Number> cells =
      CellNumbers<Number>::Zero(ends.final_cells.rows(), ends.final_cells.cols());
  for (const auto& c : ends.mixed_cells)
    for (const Ending edge : kEdges) cells.data()[c.cell] += c[edge];
  return cells;
}

/// The same ends with share_of() applied to each number.
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
