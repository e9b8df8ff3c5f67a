// SPDX-License-Identifier: MIT
#pragma once
/// Predictions from the gate runs of full trials: trials are added until the error bar reaches the
/// accuracy that was asked for.

#include <cstdint>
#include <optional>
#include <vector>

#include "dynamics/base/work.h"
#include "lattice/field/problem.h"
#include "lattice/pool/pool_runner.h"
#include "lattice/pool/pooled_prediction.h"
#include "lattice/pool/run_pool.h"

namespace gatewalk::lattice {

/// Predicts from `starts` (all different): exact for the chain, or from 4 million Monte Carlo walks
/// where exact answers take long (large fields, very many runs); the error bar then includes the
/// walks' sampling error. The pool keeps all runs, and runs it already has are used. Only the
/// seconds depend on the number of threads. Throws std::invalid_argument for an accuracy outside
/// (0, 1), as run_field, and std::runtime_error if a run broke.
[[nodiscard]] PooledPrediction predict_pooled(const Problem& problem, RunPool& pool,
                                              const std::vector<dynamics::Entry>& starts,
                                              const AccuracyOptions& options,
                                              const dynamics::Work& work = {});

/// Predicts from recorded runs, to which none can be added: for each start, or (nullopt) for all
/// first entries of the scattered trials. A start without runs of its own uses the runs of its
/// leaf. With fewer than kLeastBodies bodies there are no intervals (NaN), and any accuracy counts
/// as reached.
[[nodiscard]] PooledPrediction predict_recorded(
    const Problem& problem, const RunPool& pool,
    const std::vector<std::optional<dynamics::Entry>>& starts, const AccuracyOptions& options);

/// Predictions of the chain of all runs, without error bars.
[[nodiscard]] std::vector<markov::FinalDistribution> predict_whole(
    const Problem& problem, const RunPool& pool,
    const std::vector<std::optional<dynamics::Entry>>& starts, int per_leaf, std::uint64_t seed);

/// The trials' own shares as a prediction; mean_steps is their mean number of gates.
[[nodiscard]] markov::FinalDistribution shares_of(const FieldTrials& trials,
                                                  const FieldParams& field);

/// The start's face with its usual ranges, widened to hold the start.
[[nodiscard]] StartRange usual_range(const Problem& problem);

/// The result of pool_range(): how well a pool serves starts from a range.
struct PooledRange {
  StartRange range;
  int tried_on = 0;  // number of starts tried
  /// Total variation: the kernel's part of the error bar (infinitely many first runs) at the median
  /// start and at the worst. Measured at the last size tried, and scaled by 1 / sqrt(runs) to the
  /// final size. Bodies from some starts all enter the second gate in the same way; such starts
  /// need trials of their own, and get them when predicted.
  double kernel_error_95 = 0.0, worst_kernel_error_95 = 0.0;
  bool reached = true;
  std::int64_t gate_runs = 0;  // new runs
  double seconds = 0.0;
  dynamics::Health health;
};
/// Adds trials that start uniformly in the range, until the kernel's part of the error bar is below
/// options.accuracy at half of the starts tried. Throws as predict_pooled, and
/// std::invalid_argument for an empty range.
[[nodiscard]] PooledRange pool_range(const Problem& problem, RunPool& pool, const StartRange& range,
                                     const AccuracyOptions& options,
                                     const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
