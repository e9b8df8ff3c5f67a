// SPDX-License-Identifier: MIT
#pragma once
/// How likely walks are to end in one way, from every state of every cell: the committor of their
/// leaving over the far edge, the same of any other ending, and with a limit of cells; and to enter
/// every row, from one start.

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "markov/chain.h"

namespace gatewalk::markov {

/// Chance that a walk without limit of cells ends so.
struct Committor {
  int columns = 0, rows = 0, inputs = 0;
  std::vector<double> values;  // (rows x columns x inputs)

  [[nodiscard]] double operator()(std::int64_t column, std::int64_t row, std::int64_t input) const {
    return values[static_cast<std::size_t>((row * columns + column) * inputs + input)];
  }
};

/// What rows of a field are solved to.
inline constexpr double kRowTolerance = 1e-12;

/// Row by row from the far edge; within a row by sweeps to both sides until no value changes by
/// more than `tolerance` of it (in a row of cells of one type that walks soon leave in registers,
/// to that tolerance of each value). Where moves lead to a row below: by sweeps over all rows
/// until, besides, no more than `tolerance` of the walks from any state are still on their way. Of
/// few states then, and wherever 10^5 sweeps do not do, by the elimination of first_passages
/// (first_passage.h). Relative accuracy is that of sums of positive numbers, however small the
/// values: nothing is subtracted. A row never sampled ends as `unsampled`. Walks that can never end
/// have no ending: the chance is 0. Throws std::invalid_argument for fields of another size than
/// the chain's, and as first_passages.
[[nodiscard]] Committor committor(const FieldChain& chain, const Field& field,
                                  Ending ending = Ending::far_edge,
                                  double tolerance = kRowTolerance);

/// The same of walks that may visit so many cells.
class EndingChance {
 public:
  /// max_cells 0: no limit, as committor(), to `tolerance`. Memory: max_cells x rows x columns x
  /// inputs numbers; throws std::invalid_argument above 4 GiB. `from`: with a limit only of cells
  /// and draws that walks from its cell can come to, in less time and memory; elsewhere the chance
  /// is not a number. On all threads of the current TBB arena.
  EndingChance(const FieldChain& chain, const Field& field, Ending ending, int max_cells,
               double tolerance = kRowTolerance, const std::optional<Start>& from = {});

  /// From a cell (row * columns + column) in which the walk is to make its `draw`-th draw, counted
  /// from 1; behind the last one it is cut off. Without limit the number says nothing.
  [[nodiscard]] double operator()(int draw, std::int64_t cell, std::int64_t input) const {
    const std::int64_t layer = max_cells_ == 0 ? 0 : draw - 1;
    if (layer >= layers_) return ending_ == Ending::cut_off ? 1.0 : 0.0;
    const std::int64_t begin = begin_[static_cast<std::size_t>(layer * cells_ + cell)];
    return begin < 0 ? std::numeric_limits<double>::quiet_NaN()
                     : values_[static_cast<std::size_t>(begin + input)];
  }
  [[nodiscard]] Ending ending() const { return ending_; }

 private:
  Ending ending_;
  int max_cells_;
  std::int64_t cells_, inputs_, layers_;
  std::vector<std::int64_t> begin_;  // (layers x cells) of `values_`; -1: nobody comes there
  std::vector<double> values_;       // by input
};

/// Chance that a walk without limit of cells from there enters rows start.row + 1, ..., field.rows;
/// the last is to leave over the far edge. Row by row from the start, by the same sweeps, with the
/// same relative accuracy. Throws as committor, and std::invalid_argument for moves over a row.
[[nodiscard]] std::vector<double> row_chances(const FieldChain& chain, const Field& field,
                                              const Start& start);

}  // namespace gatewalk::markov
