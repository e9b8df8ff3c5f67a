// SPDX-License-Identifier: MIT
#pragma once
/// Does a label help to predict a run's outcome once its state is known? A conditional test. The
/// null permutes each state's outcomes among its runs. If runs belong to clusters that are not
/// independent, such as the runs of one body, the null instead multiplies each cluster's
/// differences by +1 or -1 at random (wild cluster bootstrap with Rademacher weights). The rows of
/// a fine chain have few runs each, so the test pools the differences over all rows.

#include <cstdint>
#include <span>
#include <vector>

#include "lattice/statistics/multiple_tests.h"

namespace gatewalk::lattice {

/// One run in the test; all numbers count from 0.
struct LabelledRun {
  std::int32_t state = 0, label = 0, outcome = 0, cluster = 0;
};

struct IndependenceOptions {
  double level = 0.05;            // at which `seen_at_90` is detected
  std::int64_t null_draws = 999;  // behind the p-values
  std::uint64_t seed = 1;
  std::uint64_t number = 0;      // of the test: different numbers give different draws
  int clusters = 0;              // number of clusters of runs; 0: all runs are independent
  int labels = 0, outcomes = 0;  // possible ones; 0: those that occur
};

/// What a label tells beyond the state. Counts are (labels x outcomes). "Expected" counts are those
/// if each state's outcomes were distributed at random over its runs.
struct Independence {
  /// Informative runs: those in states with at least two labels and two outcomes.
  std::int64_t runs = 0, states = 0;

  /// With clusters: sum of squared differences over their variances. Otherwise the generalised
  /// Cochran-Mantel-Haenszel statistic (general association; Landis, Heyman and Koch, Int. Stat.
  /// Rev. 46, 1978): observed minus expected counts, summed over the states, against their
  /// covariance. Detects differences that have the same direction in all states.
  MultipleTests::Test pooled{.seen = 0.0, .p = 1.0, .p_adjusted = 1.0};
  int degrees = 0;             // degrees of freedom of the chi-squared distribution of `pooled`
  double p_chi_squared = 1.0;  // p-value of `pooled` by that distribution
  /// The largest difference relative to its standard deviation, with its label and outcome. -1: no
  /// difference has enough counts (with clusters, one count is enough).
  MultipleTests::Test strongest{.seen = 0.0, .p = 1.0, .p_adjusted = 1.0};
  int label = -1, outcome = -1;
  double more = 0.0;  // share of the label's runs by which the outcome exceeds the expected count
  /// Squared differences, summed over the states. Detects differences whose direction varies
  /// between states, if states have many runs.
  MultipleTests::Test state_by_state{.seen = 0.0, .p = 1.0, .p_adjusted = 1.0};
  double p = 1.0;  // of the three tests together; with clusters, of the first two
  std::int64_t null_draws = 0;

  /// The size of the memory that `pooled` shows, with 95 % bounds and corrected for chance. It is
  /// the total variation between the outcomes after one half of the labels and after the other
  /// half, if all states had the same memory, and if it moved a share from the most common outcome
  /// to the next. NaN without informative runs, and with clusters, for which no chi-squared
  /// distribution is known.
  double memory = 0.0, memory_low = 0.0, memory_high = 0.0;
  /// A memory of this size is detected at the options' level with probability at least 0.9.
  /// Infinite if no size is, or if the draws are too few for that level.
  double seen_at_90 = 0.0;
};

/// Runs the test; equal runs in equal order give equal results for any number of threads. Throws
/// std::invalid_argument for negative numbers, more than 64 labels times outcomes without clusters,
/// no draws, or a level outside (0, 1).
[[nodiscard]] Independence test_independence(std::span<const LabelledRun> runs,
                                             const IndependenceOptions& options);

}  // namespace gatewalk::lattice
