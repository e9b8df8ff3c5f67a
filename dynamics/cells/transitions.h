// SPDX-License-Identifier: MIT
#pragma once
/// Integer counts of passages from state to state: a matrix before it is divided by anything.

#include <Eigen/SparseCore>
#include <cstdint>
#include <map>
#include <vector>

#include "dynamics/cells/health.h"
#include "dynamics/cells/section.h"
#include "dynamics/cells/state_space.h"

namespace gatewalk::dynamics {

/// Counts of a state space's n rows and n + 1 columns, the last one "trapped".
struct Transitions {
  explicit Transitions(StateSpace state_space);

  StateSpace space;
  std::vector<std::map<int, std::int64_t>> rows;  // (n) column -> count
  /// (n) column -> what these runs took; no columns where nothing is known (older files, trees).
  std::vector<std::map<int, CostSums>> costs;
  std::vector<std::int64_t> trials;   // (n)
  std::vector<std::int64_t> clamped;  // (n) crossings of this row outside every bin
  Health health;

  [[nodiscard]] Eigen::SparseMatrix<std::int64_t, Eigen::RowMajor> counts() const;  // (n x n+1)

  struct Totals {
    std::int64_t runs = 0;
    std::int64_t crossings = 0;  // runs that left their gate
    std::int64_t clamped = 0;    // of these, outside every bin
    std::int64_t nonzeros = 0;
    std::int64_t empty_rows = 0;
    Totals& operator+=(const Totals& other);
    [[nodiscard]] double clamped_share() const {
      return crossings > 0 ? static_cast<double>(clamped) / static_cast<double>(crossings) : 0.0;
    }
  };
  [[nodiscard]] Totals totals() const;

  /// Adds other trials of the same space; throws std::invalid_argument for another space.
  Transitions& operator+=(const Transitions& other);
};

/// Where the trials of a row may start: entries that fell into it.
using Entries = std::vector<std::vector<Entry>>;  // (n)
[[nodiscard]] Entries entries_of(const StateSpace& space, const std::vector<Entry>& seen);

/// Runs in a row of the space for one trial of it. Every walk that starts in a point passes its
/// row, once, and the others a few times in all: so that its sampling weighs no more than theirs, a
/// point's row gets as many runs as a tenth of the bins, at least 1. A bin's row gets 1.
[[nodiscard]] std::int64_t runs_per_trial(const StateSpace& space, int row);
/// The same of all rows together.
[[nodiscard]] std::int64_t runs_per_trial(const StateSpace& space);

}  // namespace gatewalk::dynamics
