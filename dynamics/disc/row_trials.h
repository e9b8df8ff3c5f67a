#pragma once
/// Runs of a gate -> counts: the input-output matrix of Eq. (16).

#include <cstdint>

#include "dynamics/base/trial_set.h"
#include "dynamics/cells/transitions.h"
#include "dynamics/disc/params.h"

namespace gatewalk::dynamics {

/// Adds trials `range` of every row: starts uniform in the row's bin, or drawn from `entries` in a
/// row that has any; random force from the stream {seed, row, run}. On all threads of the current
/// TBB arena; same counts for any number of them. A broken run is counted in `health` and in no
/// column; the caller decides.
void add_trials(Transitions& t, const GateParams& p, std::uint64_t seed, TrialRange range,
                const Entries& entries = {});

}  // namespace gatewalk::dynamics
