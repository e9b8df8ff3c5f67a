// SPDX-License-Identifier: MIT
#pragma once
/// State spaces of trees grown over observed entries: many small leaves where bodies enter often,
/// few large leaves elsewhere. Cuts are midpoints of data, and spreads are compared in units of the
/// coordinates' scales, so a scene whose lengths, times and masses are multiplied by powers of 4
/// gets the same trees times these powers, bit for bit.

#include <vector>

#include "dynamics/cells/entry_table.h"
#include "dynamics/cells/state_space.h"

namespace gatewalk::dynamics {

/// Makes an open space of trees, with `points`. At each face the entries are halved at the median
/// of the coordinate with the largest standard deviation (in units of Coordinate::scale), until a
/// half would have fewer than `per_leaf` entries; equal values stay together. A face without
/// entries is one state with its usual range. `state_of`, if given, receives the state of each
/// entry, as index_of gives it. Throws std::invalid_argument unless per_leaf >= 1 and the section
/// is valid, and for more than kMostStates leaves.
[[nodiscard]] StateSpace tree_space(const Section& section, const EntryTable& seen,
                                    int per_leaf = kEntriesPerLeaf, std::vector<Entry> points = {},
                                    std::vector<int>* state_of = nullptr);

/// Number of coordinates that any tree cuts: those that vary, as far as the leaves tell.
[[nodiscard]] int coordinates_cut(const StateSpace& space);

}  // namespace gatewalk::dynamics
