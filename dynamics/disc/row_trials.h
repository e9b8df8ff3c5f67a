// SPDX-License-Identifier: MIT
#pragma once
/// Runs of a gate -> counts: the input-output matrix of Eq. (16).

#include <cstdint>
#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/cells/transitions.h"
#include "dynamics/disc/params.h"

namespace gatewalk::dynamics {

/// What became of a run.
struct Arrival {
  std::int32_t column = -1;  // none: it broke
  std::int32_t clamped = 0;  // 1: outside every bin
  Costs costs{};
};
/// Some trials of every row.
struct RowTrials {
  std::int64_t trials = 0;        // of each row
  std::vector<Arrival> arrivals;  // (rows x runs), by row; as many runs as runs_per_trial says
  Health health;
};
/// As a piece is kept (base/bytes.h).
template <class Archive>
void each_part(Archive& archive, RowTrials& t) {
  archive(t.trials, t.arrivals, t.health);
}

/// Trials `range` of every row: starts uniform in the row's bin, or drawn from `entries` in a
/// row that has any; random force from the stream {seed, row, run}. On all threads of the current
/// TBB arena; the same for any number of them.
[[nodiscard]] RowTrials row_trials(const StateSpace& space, const GateParams& p, std::uint64_t seed,
                                   TrialRange range, const Entries& entries = {});
/// A broken run is counted in `health` and in no column; the caller decides. Throws
/// std::runtime_error for trials, of a piece that was kept, that are not of this state space.
void add(Transitions& t, const RowTrials& trials);
/// Both.
void add_trials(Transitions& t, const GateParams& p, std::uint64_t seed, TrialRange range,
                const Entries& entries = {});

}  // namespace gatewalk::dynamics
