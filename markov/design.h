// SPDX-License-Identifier: MIT
#pragma once
/// Field design: which cells of a field to change so that walks gain the most, or the least. A
/// search over maps of cell types by exchange of cells, guided by the adjoint gradient for all
/// cells at once.

#include <cstdint>
#include <functional>
#include <vector>

#include "markov/chain.h"
#include "markov/decide.h"

namespace gatewalk::markov {

struct DesignOptions {
  int max_cells = 0;          // see DecideOptions
  bool least = false;         // minimise the gain instead of maximising it
  int most_changes = 1;       // largest number of cells whose type may change
  std::vector<int> become{};  // types that a cell may become; empty: all
  /// The kind of each type; a cell may only become a type of its own kind. Empty: all types are of
  /// one kind.
  std::vector<int> kind_of_type{};
  /// Maps of types (rows * columns), within most_changes, from which to search besides the field's
  /// own map.
  std::vector<std::vector<int>> from{};
  /// The number of solved maps after which searches end with the best map so far; 0: no limit.
  std::int64_t most_solves = 0;
  /// Called with the number of the search before maps are solved; may throw to stop.
  std::function<void(std::size_t search)> told{};
};

/// A locally optimal map: among the changes tried, no change of one cell and no exchange of two
/// improves the map by more than rounding. If all cells may change, exchanges are not tried.
struct FieldDesign {
  std::vector<int> type_of_cell{};  // (rows * columns), cell row * columns + column
  double gain = 0.0;                // expected gain of a walk from the start
  int searches = 0;                 // number of searches that ended at this map
};

struct Designs {
  std::vector<FieldDesign> optima{};  // best map first
  double before = 0.0;                // gain of the field as it is
  /// (cells x types) The gain by each single change, except for walks that return to the cell: the
  /// derivative of the gain by the share of draws from that type.
  std::vector<double> gradient{};
  std::int64_t solves = 0;  // number of maps solved
  bool finished = true;     // no search ended because of most_solves
};

/// Searches for the best maps. Each step tries changes of one cell that walks reach and exchanges
/// of two cells, in the order of the gradient, eight at a time, and makes the best of the first
/// eight that gain. A search ends when the remaining changes promise so little that even the
/// gradient's largest error so far would not make them a gain. If all cells may change, there are
/// no exchanges, but many changes at once. A map in which walks can circle almost for ever is not
/// accepted. Gains are computed by predict; the result is the same for any number of threads.
///
/// Throws std::invalid_argument if field, start, gains and options do not fit together, and if
/// draws have gains; std::runtime_error if the values of all draws take more than 2 GB, or if walks
/// can circle almost for ever in the field as it is.
[[nodiscard]] Designs design(const FieldChain& chain, const Field& field, const Start& start,
                             const Gains& gains, const DesignOptions& options);

}  // namespace gatewalk::markov
