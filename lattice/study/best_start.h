// SPDX-License-Identifier: MIT
#pragma once
/// The place and velocity of entry with which a body crosses a field most often.

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

/// The range of one coordinate of the entry, by Section::coordinates.
struct CoordinateRange {
  std::size_t coordinate = 0;
  double low = 0.0, high = 0.0;
};

/// Which starts to search, and with how many runs.
struct BestStartOptions {
  std::vector<CoordinateRange>
      ranges{};                // at least one; other coordinates stay as in the problem's start
  std::vector<int> columns{};  // columns of the start's row; empty: that of the field's start
  double accuracy = 0.02;      // half of the widest interval of a probability to cross
  std::int64_t most_runs = 20'000'000;  // gate runs to choose with, about
  int per_leaf = dynamics::kEntriesPerLeaf;
  std::uint64_t seed = 1;
};

/// A chain's probabilities to cross the field, by entry.
struct StartChances {
  dynamics::StateSpace space;
  markov::Decisions chances;
  int row = 0;  // the start's

  /// The probability to cross from this start.
  [[nodiscard]] double chance(const TrialStart& start) const;
};

/// The best start, with the probabilities of the last chain that it was chosen with.
struct BestStart : ChoiceSummary, StartChances {
  /// The problem's own, unless another is better by more than a standard error in the search, and
  /// also in the held-out trials.
  TrialStart best;
  bool own = false;
  /// Held-out trials, not used in the search: from the best start, and from the problem's own.
  Crossings crossings{}, crossings_of_own{};
  Gain gain{};
};

/// Finds the best start. Trials from anywhere in the ranges form a chain of trees, which gives the
/// probability to cross after every first passage, in any column. The best leaves of chains with
/// three leaf sizes run as full trials, beside the best start so far. Further trials start from the
/// best of four random starts. Rounds go on until one gains little or the runs are used up. The
/// result is the same on any number of threads. Throws std::invalid_argument for missing or invalid
/// ranges, columns outside the field, and an accuracy outside [0.001, 0.5); std::runtime_error if a
/// run broke or values do not fit into memory.
[[nodiscard]] BestStart best_start(const Problem& problem, const BestStartOptions& options,
                                   const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
