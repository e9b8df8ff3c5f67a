// SPDX-License-Identifier: MIT
#pragma once
/// Which cells of a field to change, so that walks gain the most, or the least: searches over maps
/// of types by exchange of cells, led by the adjoint gradient for all cells at once.

#include <cstdint>
#include <functional>
#include <vector>

#include "markov/chain.h"
#include "markov/decide.h"

namespace gatewalk::markov {

struct DesignOptions {
  int max_cells = 0;          // as DecideOptions
  bool least = false;         // what walks gain shall be as little as it can
  int most_changes = 1;       // cells whose type may be another than the field has there
  std::vector<int> become{};  // types that a cell may be changed to; empty: all
  /// By type: its kind; a cell may be changed to types of its own one only. Empty: all are alike.
  std::vector<int> kind_of_type{};
  /// Maps of types to search from, beside the field's own: (rows * columns), within most_changes.
  std::vector<std::vector<int>> from{};
  /// Once so many maps are solved searches end with the best so far; 0: no bound.
  std::int64_t most_solves = 0;
  /// Told before maps are solved, with the number of the search; may throw to stop.
  std::function<void(std::size_t search)> told{};
};

/// A map that no change of one cell and no exchange of two improves by more than rounding, of those
/// that were tried; none of exchanges where all cells may change.
struct FieldDesign {
  std::vector<int> type_of_cell{};  // (rows * columns), cell row * columns + column
  double gain = 0.0;                // of a walk from the start
  int searches = 0;                 // that ended there
};

struct Designs {
  std::vector<FieldDesign> optima{};  // the best first
  double before = 0.0;                // what the field gains as it is
  /// (cells x types) what each change alone would gain, but for walks that come back to the cell:
  /// the derivative of the gain by the share of draws that are made from that type.
  std::vector<double> gradient{};
  std::int64_t solves = 0;  // of the field
  bool finished = true;     // no search was ended by most_solves
};

/// At each step changes of one cell that walks come to and exchanges of two are tried in the order
/// of what the gradient says, eight at a time, and the best of the first eight that gain is made; a
/// search ends once what is left says so little that not even the largest error so far of what the
/// gradient said would make it a gain. Where all cells may change there are no exchanges, but many
/// changes at once. A map in which walks can circle almost for ever is not taken. The same on any
/// number of threads. Gains are found by predict.
/// Throws std::invalid_argument where field, start, gains and options cannot belong together and
/// where draws have gains; std::runtime_error where values of all draws take more than 2 GB, and
/// where walks can circle almost for ever in the field as it is.
[[nodiscard]] Designs design(const FieldChain& chain, const Field& field, const Start& start,
                             const Gains& gains, const DesignOptions& options);

}  // namespace gatewalk::markov
