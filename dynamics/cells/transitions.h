// SPDX-License-Identifier: MIT
#pragma once
/// Integer counts of passages from state to state: a transition matrix before normalisation.

#include <Eigen/SparseCore>
#include <cstdint>
#include <map>
#include <vector>

#include "dynamics/cells/health.h"
#include "dynamics/cells/section.h"
#include "dynamics/cells/state_space.h"

namespace gatewalk::dynamics {

/// The counts for a state space of n states: n rows, and n + 1 columns of which the last is
/// "trapped".
struct Transitions {
  explicit Transitions(StateSpace state_space);

  StateSpace space;
  std::vector<std::map<int, std::int64_t>> rows;  // (n) column -> count
  /// (n) column -> cost sums of these runs; empty where costs are unknown (older files, trees).
  std::vector<std::map<int, CostSums>> costs;
  std::vector<std::int64_t> trials;   // (n)
  std::vector<std::int64_t> clamped;  // (n) crossings of this row that ended outside every bin
  Health health;

  [[nodiscard]] Eigen::SparseMatrix<std::int64_t, Eigen::RowMajor> counts() const;  // (n x n+1)

  /// Sums over all rows.
  struct Totals {
    std::int64_t runs = 0;
    std::int64_t crossings = 0;  // runs that left their cell
    std::int64_t clamped = 0;    // crossings outside every bin
    std::int64_t nonzeros = 0;
    std::int64_t empty_rows = 0;
    Totals& operator+=(const Totals& other);
    [[nodiscard]] double clamped_share() const {
      return crossings > 0 ? static_cast<double>(clamped) / static_cast<double>(crossings) : 0.0;
    }
  };
  [[nodiscard]] Totals totals() const;

  /// Adds the counts of other trials. Throws std::invalid_argument for another state space.
  Transitions& operator+=(const Transitions& other);
};

/// Entries sorted by the state that contains them: possible starts for the trials of each row.
using Entries = std::vector<std::vector<Entry>>;  // (n)
[[nodiscard]] Entries entries_of(const StateSpace& space, const std::vector<Entry>& seen);

/// The number of runs that a row gets for one trial of the space. A bin's row gets 1. A point's row
/// gets a tenth of the number of bins, at least 1: every walk from a point passes the point's row
/// once, so its sampling error would otherwise dominate.
[[nodiscard]] std::int64_t runs_per_trial(const StateSpace& space, int row);
/// The number of runs that all rows together get for one trial of the space.
[[nodiscard]] std::int64_t runs_per_trial(const StateSpace& space);

}  // namespace gatewalk::dynamics
