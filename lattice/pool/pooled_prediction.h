// SPDX-License-Identifier: MIT
#pragma once
/// Predictions from the gate runs of full trials, as accurate as is asked for: trials are added
/// until the error bar says so. A start's answer is the chain's, or its trials' own shares where
/// these are the more certain.

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "dynamics/base/work.h"
#include "lattice/field/exits.h"
#include "lattice/pool/hausman_check.h"
#include "lattice/pool/pool_runner.h"
#include "lattice/statistics/group_spread.h"

namespace gatewalk::lattice {

struct AccuracyOptions {
  double accuracy = 0.02;  // total variation of the final gates that 95 % of answers keep
  /// New gate runs, but for the first few of each start. (These take some GB.)
  std::int64_t most_runs = 20'000'000;
  /// None are added but these: so many first runs of a start that the pool does not know.
  std::optional<std::int64_t> first_runs{};
  /// Exactly so many full trials of all starts together, or from anywhere in a range, whatever the
  /// accuracy.
  std::optional<std::int64_t> trials{};
  int per_leaf = dynamics::kEntriesPerLeaf;
  std::uint64_t seed = 1;

  /// Gate runs, about, that no more are added from.
  [[nodiscard]] std::int64_t limit() const {
    return trials ? std::numeric_limits<std::int64_t>::max() : most_runs;
  }
};

/// What is said of one start.
struct StartAnswer {
  dynamics::Entry start{};
  bool as_seen = false;             // not one start: all first entries of the pool's trials
  markov::FinalDistribution final;  // the answer
  bool from_trials = false;         // it is the shares of the start's own full trials
  Error95 error;
  double kernel_error_95 = 0.0;  // total variation, of the chain with endlessly many first runs;
                                 // of all where walks make the answer
  double unseen =
      0.0;  // share of first runs that enter the second gate where no run of the pool
            // did (missing_mass): the chain's error bars have it on top, corrcoef then has none
  double trials_error_95 = 1.0;  // total variation, of the trials' own shares
  EndingShares endings{std::array<double, markov::kEndings>{}};
  FieldExits exits{};
  std::array<CellProbabilities, 2> gates_95;  // low, high
  std::int64_t trials = 0, first_runs = 0;    // full ones; those through the first gate
  double direct_seconds = 0.0;  // of direct simulation for the same error bar; NaN where nothing
                                // was run that would tell
};

struct PooledPrediction {
  std::vector<StartAnswer> starts;
  bool reached = true;  // all answers are as accurate as was asked for
  /// The full trials of all starts whose answer is the chain's, and exact, against the chain.
  std::optional<HausmanCheck> hausman_check{};
  std::int64_t gate_runs = 0;  // made now
  int states = 0;
  std::int64_t nonzeros = 0;
  double seconds = 0.0;      // of all: runs, chains, error bars
  double run_seconds = 0.0;  // of the runs
  dynamics::Health health;
};

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
