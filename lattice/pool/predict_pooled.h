// SPDX-License-Identifier: MIT
#pragma once
/// Predictions from the gate runs of full trials, as accurate as is asked for: trials are added
/// until the error bar says so.

#include <cstdint>
#include <optional>
#include <vector>

#include "dynamics/base/work.h"
#include "lattice/field/problem.h"
#include "lattice/pool/pool_runner.h"
#include "lattice/pool/pooled_prediction.h"
#include "lattice/pool/run_pool.h"

namespace gatewalk::lattice {

/// Answers for `starts` (different): exact for the chain, or from 4 million walks where that
/// would take long (large fields, very many runs), whose chance is in the error bar. The pool keeps
/// all runs; what it holds already is used. Trials are those of the seed that no other command
/// runs. The same but for the seconds on any number of threads. Throws std::invalid_argument for an
/// accuracy outside (0, 1), as run_field, and std::runtime_error when a run broke.
[[nodiscard]] PooledPrediction predict_pooled(const Problem& problem, RunPool& pool,
                                              const std::vector<dynamics::Entry>& starts,
                                              const AccuracyOptions& options,
                                              const dynamics::Work& work = {});

/// From the runs that a pool has, to which none can be added: for each start, or (none) for all
/// first entries of its scattered trials. A start of no runs of its own has those of its leaf. With
/// fewer than kLeastBodies bodies there are no intervals (NaN), and any accuracy counts as reached.
[[nodiscard]] PooledPrediction predict_recorded(
    const Problem& problem, const RunPool& pool,
    const std::vector<std::optional<dynamics::Entry>>& starts, const AccuracyOptions& options);

/// The same answers without error bars.
[[nodiscard]] std::vector<markov::FinalDistribution> predict_whole(
    const Problem& problem, const RunPool& pool,
    const std::vector<std::optional<dynamics::Entry>>& starts, int per_leaf, std::uint64_t seed);

/// The shares of trials themselves.
[[nodiscard]] markov::FinalDistribution shares_of(const FieldTrials& trials,
                                                  const FieldParams& field);

/// The usual entries by the start's face, and the start.
[[nodiscard]] StartRange usual_range(const Problem& problem);

/// What trials from all over a range of starts make of a pool.
struct PooledRange {
  StartRange range;
  int tried_on = 0;  // starts
  /// Total variation, with endlessly many first runs, at the last size tried, by 1 / sqrt(runs) to
  /// the size made: of the start in the middle, and of the
  /// worst. Bodies from some starts all enter the second gate in the same way: these need trials of
  /// their own, and get them when they are predicted.
  double kernel_error_95 = 0.0, worst_kernel_error_95 = 0.0;
  bool reached = true;
  std::int64_t gate_runs = 0;  // made now
  double seconds = 0.0;
  dynamics::Health health;
};
/// Adds trials that start uniformly in the range until the chain's own part of the error bar, with
/// endlessly many first runs, is below options.accuracy at half of the starts that it is tried on.
/// Throws as predict_pooled, and std::invalid_argument for an empty range.
[[nodiscard]] PooledRange pool_range(const Problem& problem, RunPool& pool, const StartRange& range,
                                     const AccuracyOptions& options,
                                     const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
