// SPDX-License-Identifier: MIT
#pragma once
/// State spaces whose states are the leaves of trees grown over entries that were seen: many small
/// leaves where bodies enter often, few large ones elsewhere.
/// Cuts are midpoints of data and coordinates are compared on their scales: a scene whose
/// lengths, times and masses are multiplied by powers of 4 gets the same trees times these powers,
/// bit for bit.

#include <vector>

#include "dynamics/cells/entry_table.h"
#include "dynamics/cells/state_space.h"

namespace gatewalk::dynamics {

/// Open; and `points`. Per face the entries are halved at the median of the coordinate along which
/// they spread most (largest standard deviation, in Coordinate::scale) until a half would have
/// fewer than `per_leaf`; equal values stay together. A face where nothing was seen is one state,
/// of what is usual there. Throws std::invalid_argument unless per_leaf >= 1 and the section is
/// valid, and for more than kMostStates leaves. `state_of`, if given: the state of each entry, as
/// index_of says it.
[[nodiscard]] StateSpace tree_space(const Section& section, const EntryTable& seen,
                                    int per_leaf = kEntriesPerLeaf, std::vector<Entry> points = {},
                                    std::vector<int>* state_of = nullptr);

}  // namespace gatewalk::dynamics
