// SPDX-License-Identifier: MIT
#pragma once
/// Which cells of a field to change to which of its types, so that bodies cross the field as often,
/// or as rarely, as possible.

#include <cstdint>
#include <string>
#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/cells/tree_space.h"
#include "lattice/field/problem.h"
#include "lattice/study/crossings.h"
#include "markov/design.h"

namespace gatewalk::lattice {

/// What may be changed, and how to search.
struct FieldDesignOptions {
  int most_changes = 1;                 // most cells that may be changed
  std::vector<int> become{};            // types that cells may be changed to; empty: all
  bool least = false;                   // bodies shall cross as rarely as possible
  double accuracy = 0.02;               // half of the widest interval of a probability to cross
  std::int64_t most_runs = 20'000'000;  // gate runs to choose with, about
  int per_leaf = dynamics::kEntriesPerLeaf;
  int searches = 8;  // searches from random maps, besides those from the field's own
  std::uint64_t seed = 1;
};

/// The best field found.
struct DesignedField : ChoiceSummary {
  std::vector<int> type_of_cell{};  // (rows x columns), the near row first
  /// The maps at which searches ended, the best first, by the chain that this field was chosen with
  /// (for the unchanged field: the chain with the largest leaves). That chain's probabilities
  /// include its own error, and are too optimistic for its optima. Solves: of all searches.
  markov::Designs by_chain{};
  /// Held-out trials, not used in the search, under the same noise as long as bodies take the same
  /// ways: of the changed field, and of the unchanged one.
  Crossings crossings{}, before{};
  Gain gain{};
};

/// Searches the best map. Trials through cells of all permitted types give a matrix per type over
/// common states. The best maps for these matrices (markov/design.h), with three leaf sizes, run as
/// full trials beside the field's own map and the best so far, all with the same trial numbers;
/// these trials are added. Rounds go on until one gains little (`settled`) or the runs are used up.
/// The result is the same on any number of threads. Throws std::invalid_argument for a field of one
/// type, in which no cell can change, as markov::design, and for an accuracy outside [0.001, 0.5);
/// std::runtime_error if a run broke, and as markov::design.
[[nodiscard]] DesignedField design_field(const Problem& problem, const FieldDesignOptions& options,
                                         const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
