// SPDX-License-Identifier: MIT
#pragma once
/// The paths through a field that walks take most often.

#include <cstdint>
#include <vector>

#include "markov/committor.h"

namespace gatewalk::markov {

/// A path of cells (row * columns + column) from the start on, and the share of all walks that
/// follow exactly this path and then have the wanted ending.
struct CellPath {
  std::vector<std::int64_t> cells;
  double share = 0.0;
};

struct FrequentPaths {
  std::vector<CellPath> paths;  // the most frequent first
  bool gave_up = false;         // the search reached its limit: more paths exist
};

/// Finds the `count` most frequent paths with the ending of `chance`, which must be made for the
/// same chain, field and limit. Best-first search: a partial path is ranked by the share of walks
/// that follow it and then end so at all, an upper bound for every continuation. The search gives
/// up after looking at `most_draws` nonzeros of the matrix, about a second.
[[nodiscard]] FrequentPaths most_frequent_paths(const FieldChain& chain, const Field& field,
                                                const Start& start, int max_cells,
                                                const EndingChance& chance, std::size_t count,
                                                std::int64_t most_draws = 10'000'000);

}  // namespace gatewalk::markov
