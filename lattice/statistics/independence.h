// SPDX-License-Identifier: MIT
#pragma once
/// Does a label tell more of a run's outcome than its state does? A conditional test on plain data.
/// The null deals each state's outcomes out anew among its runs. Where runs belong to clusters,
/// such as those of one body, and depend on each other, it changes the sign of each cluster's
/// differences or not, at random (Rademacher weights, as in wild bootstraps of clusters). A row of
/// a fine chain has only a few runs, so what it shows is pooled over all of them.

#include <cstdint>
#include <span>
#include <vector>

#include "lattice/statistics/multiple_tests.h"

namespace gatewalk::lattice {

/// One run as the test sees it, all numbered from 0.
struct LabelledRun {
  std::int32_t state = 0, label = 0, outcome = 0, cluster = 0;
};

struct IndependenceOptions {
  double level = 0.05;            // at which `seen_at_90` is found
  std::int64_t null_draws = 999;  // behind the p-values
  std::uint64_t seed = 1;
  std::uint64_t number = 0;      // of the test: others have other draws
  int clusters = 0;              // that runs belong to; 0: each run is its own
  int labels = 0, outcomes = 0;  // that there may be; 0: those that were seen
};

/// What a label tells beyond the state. Counts are (labels x outcomes); "more than expected": than
/// if the outcomes in each state had been dealt out to its runs at random.
struct Independence {
  /// Runs that can tell, in states where two labels and two outcomes were seen.
  std::int64_t runs = 0, states = 0;

  /// Of clusters: squared differences over their variances, summed. Else the generalised
  /// Cochran-Mantel-Haenszel statistic (general association; Landis, Heyman and Koch,
  /// Int. Stat. Rev. 46, 1978): counts less expected, summed over the states, against their
  /// covariance. Sees what goes the same way in all states.
  MultipleTests::Test pooled{.seen = 0.0, .p = 1.0, .p_adjusted = 1.0};
  int degrees = 0;             // of its chi-squared distribution
  double p_chi_squared = 1.0;  // by that distribution
  /// The largest of the same differences, each over its standard deviation, and whose it is. -1:
  /// none has counts enough; of clusters one is enough.
  MultipleTests::Test strongest{.seen = 0.0, .p = 1.0, .p_adjusted = 1.0};
  int label = -1, outcome = -1;
  double more = 0.0;  // share of the label's runs by which its outcome is more often than expected
  /// Squared differences, summed over the states. Sees what goes another way in each state, where
  /// states have many runs.
  MultipleTests::Test state_by_state{.seen = 0.0, .p = 1.0, .p_adjusted = 1.0};
  double p = 1.0;  // of the three together, of clusters of the first two
  std::int64_t null_draws = 0;

  /// How large a memory `pooled` shows, with 95 %, as the total variation between what follows
  /// after one half of the labels and after the other, if it were the same in all states: so much
  /// of the most common outcome went to the next one. Chance is taken off. NaN where nothing tells,
  /// and of clusters, of which no chi-squared distribution is known.
  double memory = 0.0, memory_low = 0.0, memory_high = 0.0;
  /// A memory this large is found at the options' level with a probability of 0.9 at least.
  /// Infinite where none is, or there are too few draws for that level.
  double seen_at_90 = 0.0;
};

/// Runs in any order; for the same runs in the same order the result is the same for any number of
/// threads. Throws std::invalid_argument for negative numbers, without clusters for more than 64
/// labels times outcomes, for no draws and a level not in (0, 1).
[[nodiscard]] Independence test_independence(std::span<const LabelledRun> runs,
                                             const IndependenceOptions& options);

}  // namespace gatewalk::lattice
