// SPDX-License-Identifier: MIT
#pragma once
/// The Chapman-Kolmogorov test: compares where walks are k gates ahead with the k-th power of the
/// kernel counted from the same runs. The null permutes each state's outcomes among its visits,
/// which gives memoryless walks of a chain with the same counts.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lattice/statistics/multiple_tests.h"

namespace gatewalk::lattice {

/// Walks from state to state, concatenated; each walk has at least one run.
struct StateWalks {
  static constexpr std::int32_t kTrapped = -1;

  int ways = 0;                     // coarse ways of entering a state
  std::vector<std::int32_t> way;    // (states) way of each state, in [0, ways)
  std::vector<std::int32_t> state;  // (runs) state in which each run begins
  /// (runs) The state entered next, or kTrapped. A walk whose last run is not trapped was stopped:
  /// the last run enters a state from which no run follows.
  std::vector<std::int32_t> next;
  std::vector<std::int64_t> passed;  // (walks) runs of this walk and of the walks before it

  [[nodiscard]] std::int64_t walks() const { return std::ssize(passed); }
  [[nodiscard]] std::int64_t begin(std::int64_t walk) const {
    return walk == 0 ? 0 : passed[static_cast<std::size_t>(walk - 1)];
  }
  /// Appends a walk through these states; `end`: the state that its last run enters, or kTrapped.
  /// Appends nothing if `states` is empty.
  void add(std::span<const std::int32_t> states, std::int32_t end);
  /// Throws std::invalid_argument if the vectors do not fit together.
  void validate() const;
};

inline constexpr int kMostGatesAhead = 8;

/// The result of the test: where walks are some gates after each of their runs began (trapped, or
/// the way of entering that gate), by the way in which the run's own gate was entered. Walks that
/// were stopped continue by the kernel. (Without the split by way the test would say little,
/// because the kernel was made of all these runs together.)
struct GatesAhead {
  struct Step {
    int gates = 0;  // gates ahead
    /// (ways x ways + 1) Shares of all runs, by the way now and the way then; last column: trapped.
    std::vector<double> seen, predicted;
    std::vector<std::array<double, 2>> excess_95{};  // of seen - predicted, under the null
    MultipleTests::Test total_variation;             // of seen and predicted
    double chance = 0.0, chance_95 = 0.0;  // mean and 95 % quantile of the null's total variation
    /// Implied time scales -k / ln |eigenvalue|, in gates, of the table from ways now to ways k =
    /// `gates` later, the longest first; scales_95: middle 95 % of the null's, about the
    /// prediction.
    std::vector<double> seen_scales{}, predicted_scales{};
    std::vector<std::array<double, 2>> scales_95{};
  };
  std::int64_t runs = 0;
  std::vector<Step> steps;  // for 2, 3, ... gates; one gate ahead nothing can differ
  double p = 1.0;           // of all steps together
  std::int64_t null_draws = 0;

  /// The step whose total variation exceeds the null's 95 % quantile most, or comes closest to it.
  [[nodiscard]] const Step& largest() const;
};

/// Runs the test for 2 to `most` gates ahead; `most` is at most kMostGatesAhead. The result is the
/// same for any number of threads. Throws std::invalid_argument for walks that do not fit together,
/// no walks, or no draws.
[[nodiscard]] GatesAhead gates_ahead(const StateWalks& walks, int most, std::int64_t null_draws,
                                     std::uint64_t seed);

}  // namespace gatewalk::lattice
