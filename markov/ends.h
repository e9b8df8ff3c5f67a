// SPDX-License-Identifier: MIT
#pragma once
/// Where bodies end in a field, and how: counted of trials or of walks, or as shares of all.

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

#include "markov/chain.h"
#include "markov/sum.h"

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
  [[nodiscard]] Number left_field() const {
    std::conditional_t<std::is_floating_point_v<Number>, CompensatedSum, Number> sum{};
    for (const Ending edge : kEdges) sum += (*this)[edge];
    if constexpr (std::is_floating_point_v<Number>)
      return sum.value();
    else
      return sum;
  }
  /// The limit of cells was visited, and the body would have gone on.
  [[nodiscard]] Number cut_off() const { return (*this)[Ending::cut_off]; }
  /// A state was entered whose row was never sampled.
  [[nodiscard]] Number unsampled() const { return (*this)[Ending::unsampled]; }

  /// Throws std::invalid_argument if both have cells, of different fields.
  Ends& operator+=(const Ends& other) {
    const bool has_cells = final_cells.size() > 0, adds_cells = other.final_cells.size() > 0;
    if (has_cells && adds_cells &&
        (final_cells.rows() != other.final_cells.rows() ||
         final_cells.cols() != other.final_cells.cols()))
      throw std::invalid_argument("tallies of different fields cannot be added");
    for (std::size_t e = 0; e < kEndings; ++e) endings[e] += other.endings[e];
    if (!adds_cells) return *this;
    if (!has_cells) {
      final_cells = other.final_cells;
      mixed_cells = other.mixed_cells;
      return *this;
    }
    const auto trapped_in = [](const Ends& ends, std::int64_t cell) {
      CellEndings<Number> all{cell};
      all[Ending::trapped] = ends.final_cells.data()[cell];
      return all;
    };
    std::vector<CellEndings<Number>> both;
    auto here = mixed_cells.begin();
    auto there = other.mixed_cells.begin();
    while (here != mixed_cells.end() || there != other.mixed_cells.end()) {
      const bool is_here = here != mixed_cells.end() &&
                           (there == other.mixed_cells.end() || here->cell <= there->cell),
                 is_there = there != other.mixed_cells.end() &&
                            (here == mixed_cells.end() || there->cell <= here->cell);
      auto& sum = both.emplace_back(is_here ? *here : trapped_in(*this, there->cell));
      const auto more = is_there ? *there : trapped_in(other, here->cell);
      for (std::size_t e = 0; e < kEndings; ++e) sum.by_ending[e] += more.by_ending[e];
      here += is_here;
      there += is_there;
    }
    mixed_cells = std::move(both);
    final_cells += other.final_cells;
    return *this;
  }
};

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
