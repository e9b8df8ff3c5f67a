// SPDX-License-Identifier: MIT
#pragma once
/// The ways through a field that walks take most often.

#include <cstdint>
#include <vector>

#include "markov/committor.h"

namespace gatewalk::markov {

/// Cells (row * columns + column) from the start on, and the share of all walks that pass exactly
/// these and then end in the way asked for.
struct CellPath {
  std::vector<std::int64_t> cells;
  double share = 0.0;
};

struct FrequentPaths {
  std::vector<CellPath> paths;  // the most frequent first
  bool gave_up = false;         // the search took too long: there are more
};

/// The most frequent paths with the ending of `chance`, which is that of the same chain, field and
/// limit. Best first search: what is known of a path is its beginning with
/// the share of the walks that pass it, and no way on from there has more than the share that ends
/// so at all. It gives up when `most_draws` nonzeros of the matrix have been looked at, about a
/// second.
[[nodiscard]] FrequentPaths most_frequent_paths(const FieldChain& chain, const Field& field,
                                                const Start& start, int max_cells,
                                                const EndingChance& chance, std::size_t count,
                                                std::int64_t most_draws = 10'000'000);

}  // namespace gatewalk::markov
