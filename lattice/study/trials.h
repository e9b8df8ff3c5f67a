// SPDX-License-Identifier: MIT
#pragma once
/// Runs many trials through the field, and many walks, with progress reports and checks.

#include <cstdint>
#include <functional>

#include "dynamics/base/work.h"
#include "lattice/field/field_costs.h"
#include "lattice/field/field_trials.h"
#include "lattice/field/gate_chain.h"
#include "lattice/field/problem.h"
#include "markov/walk.h"

namespace gatewalk::lattice {

/// Runs a range of trials through the field; `each` gets what each trial did.
using RunTrialRange = std::function<FieldTally(dynamics::TrialRange range, FieldTrials& each)>;
/// Takes trials in the order of their numbers, one piece at a time.
using TakeTrials = std::function<void(const FieldTrials& each)>;
/// A function that adds the costs of trials to `costs`, which must outlive it.
[[nodiscard]] TakeTrials added_to(FieldCosts& costs);

/// Runs trials through the field, and hands each to `take`, if given. Pieces of work can be kept.
/// Throws as `run`.
[[nodiscard]] FieldTally field_trials(const FieldParams& field, dynamics::TrialRange trials,
                                      const RunTrialRange& run, const dynamics::Work& work = {},
                                      const TakeTrials& take = {});
/// Runs trials through a problem's cells, from its start; a sample is run again by a better method,
/// if there is one.
[[nodiscard]] FieldTally field_trials(const Problem& problem, dynamics::TrialRange trials,
                                      std::uint64_t seed, const dynamics::Work& work = {},
                                      const TakeTrials& take = {}, bool keep_passages = false);

/// Runs walks 0, 1, ... of the chain. Throws as markov::Walker::walk.
[[nodiscard]] markov::WalkTally walks(const markov::FieldChain& chain, const FieldParams& field,
                                      const markov::Start& start, std::int64_t count,
                                      std::uint64_t seed, const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
