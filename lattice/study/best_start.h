// SPDX-License-Identifier: MIT
#pragma once
/// Where, and how fast, a body should enter a field, so that it crosses it as often as it can.

#include <cstdint>
#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/cells/state_space.h"
#include "dynamics/cells/tree_space.h"
#include "lattice/field/field_trials.h"
#include "lattice/field/problem.h"
#include "lattice/study/crossings.h"
#include "markov/decide.h"

namespace gatewalk::lattice {

/// Of one number of the entry, by Section::coordinates.
struct CoordinateRange {
  std::size_t coordinate = 0;
  double low = 0.0, high = 0.0;
};

struct BestStartOptions {
  std::vector<CoordinateRange>
      ranges{};                // at least one; other numbers are those of the problem's start
  std::vector<int> columns{};  // of the first row; empty: that of the field's start
  double accuracy = 0.02;      // half of the widest interval that a chance to cross may have
  std::int64_t most_runs = 20'000'000;  // gate runs to choose by, about
  int per_leaf = dynamics::kEntriesPerLeaf;
  std::uint64_t seed = 1;
};

/// Chances to cross by a chain, of what bodies enter.
struct StartChances {
  dynamics::StateSpace space;
  markov::Decisions chances;

  /// From there.
  [[nodiscard]] double chance(const TrialStart& start) const;
};

/// With the chances by the chain that it was chosen by last.
struct BestStart : ChoiceSummary, StartChances {
  TrialStart best;  // the problem's own unless another is better by more than a standard error
  bool own = false;
  /// New trials in full, by which nothing was chosen: from the best start, and from the problem's.
  Crossings crossings{}, crossings_of_own{};
  Gain gain{};
};

/// Trials from starts anywhere in the ranges make a chain of trees; a first passage says what it
/// would lead to in any column. The best leaves of trees with leaves of three sizes are carried out
/// in full beside the best so far; more trials start where the best of four drawn starts is, and so
/// on until a round gains little or there are no more runs. The same on any number of threads.
/// Throws std::invalid_argument for no ranges, ranges that are none, other columns than the field
/// has, an accuracy outside [0.001, 0.5); std::runtime_error when a run broke and where values do
/// not fit into memory.
[[nodiscard]] BestStart best_start(const Problem& problem, const BestStartOptions& options,
                                   const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
