// SPDX-License-Identifier: MIT
#pragma once
/// Simulates gate runs from every state and counts the transitions: the input-output matrix of Eq.
/// (16).

#include <cstdint>
#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/cells/transitions.h"
#include "dynamics/disc/params.h"

namespace gatewalk::dynamics {

/// The result of one run.
struct Arrival {
  std::int32_t column = -1;  // column of the matrix; -1: the run broke
  std::int32_t clamped = 0;  // 1: the body entered outside every bin
  Costs costs{};
};
/// The results of some trials of every row.
struct RowTrials {
  std::int64_t trials = 0;        // number of trials of each row
  std::vector<Arrival> arrivals;  // (rows x runs), by row; runs per trial: runs_per_trial
  Health health;
};
/// Writes or reads the results as bytes (base/bytes.h).
template <class Archive>
void each_part(Archive& archive, RowTrials& t) {
  archive(t.trials, t.arrivals, t.health);
}

/// Runs the trials `range` of every row, on all threads of the current TBB arena. Starts are
/// uniform in the row's bin, or drawn from `entries` if the row has any. The random force comes
/// from the stream {seed, row, run}. Results are the same for any number of threads.
[[nodiscard]] RowTrials row_trials(const StateSpace& space, const GateParams& p, std::uint64_t seed,
                                   TrialRange range, const Entries& entries = {});
/// Adds the results to the counts. A broken run counts in `health` but in no column; the caller
/// must check. Throws std::runtime_error for results (of a kept piece) of another state space.
void add(Transitions& t, const RowTrials& trials);
/// Runs trials by row_trials and adds their results.
void add_trials(Transitions& t, const GateParams& p, std::uint64_t seed, TrialRange range,
                const Entries& entries = {});

}  // namespace gatewalk::dynamics
