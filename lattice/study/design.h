// SPDX-License-Identifier: MIT
#pragma once
/// Which cells of a field to change, and into which of its types, so that bodies cross it as often,
/// or as rarely, as they can.

#include <cstdint>
#include <string>
#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/cells/tree_space.h"
#include "lattice/field/problem.h"
#include "lattice/study/crossings.h"
#include "markov/design.h"

namespace gatewalk::lattice {

struct FieldDesignOptions {
  int most_changes = 1;       // cells that may be changed
  std::vector<int> become{};  // types that they may be changed to; empty: all
  bool least = false;         // bodies shall cross as rarely as they can
  double accuracy = 0.02;     // half of the widest interval that a chance to cross may have
  std::int64_t most_runs = 20'000'000;  // gate runs to choose by, about
  int per_leaf = dynamics::kEntriesPerLeaf;
  int searches = 8;  // from maps that are drawn, beside those from the field's own
  std::uint64_t seed = 1;
};

struct DesignedField : ChoiceSummary {
  std::vector<int> type_of_cell{};  // (rows x columns), the near row first
  /// The maps that searches ended at, by the chain that this one was chosen by (of the field as it
  /// was: by the one with the largest leaves), the best first. That chain's chances to cross have
  /// its own error, and those of its optima are too good where they take chance for skill. Solves:
  /// of all searches.
  markov::Designs by_chain{};
  /// New trials in full, none of which it was chosen by, under the same noise as far as bodies take
  /// the same ways: of the changed field, and of the field as it was.
  Crossings crossings{}, before{};
  Gain gain{};
};

/// Trials through cells of all types that may stand there fill a matrix for each type over common
/// states. The best maps for these (markov/design.h), with leaves of three sizes, are carried out
/// in full beside the field's own and the best so far, all with the same trials; these are added,
/// and so on until a round gains little (`settled`) or there are no more runs. The same on any
/// number of threads. Throws std::invalid_argument for a field of one type, where no cell can
/// change, as markov::design, and for an accuracy outside [0.001, 0.5); std::runtime_error when a
/// run broke, and as markov::design.
[[nodiscard]] DesignedField design_field(const Problem& problem, const FieldDesignOptions& options,
                                         const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
