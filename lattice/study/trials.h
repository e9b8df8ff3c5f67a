// SPDX-License-Identifier: MIT
#pragma once
/// Many trials through the field, and many walks, watched and checked.

#include <cstdint>
#include <functional>

#include "dynamics/base/work.h"
#include "lattice/field/field_costs.h"
#include "lattice/field/field_trials.h"
#include "lattice/field/gate_chain.h"
#include "lattice/field/problem.h"
#include "markov/walk.h"

namespace gatewalk::lattice {

/// Carries out a range of trials through the field, and says what each did.
using RunTrialRange = std::function<FieldTally(dynamics::TrialRange range, FieldTrials& each)>;
/// Takes trials in the order of their numbers, a piece at a time.
using TakeTrials = std::function<void(const FieldTrials& each)>;
/// Adds what they took to `costs`, which outlive it.
[[nodiscard]] TakeTrials added_to(FieldCosts& costs);

/// Trials through the field, each of which `take` is handed, if given. Pieces can be kept. Throws
/// as `run`.
[[nodiscard]] FieldTally field_trials(const FieldParams& field, dynamics::TrialRange trials,
                                      const RunTrialRange& run, const dynamics::Work& work = {},
                                      const TakeTrials& take = {});
/// Of a problem's cells, from its start; a sample is run again by a better method, if there is one.
[[nodiscard]] FieldTally field_trials(const Problem& problem, dynamics::TrialRange trials,
                                      std::uint64_t seed, const dynamics::Work& work = {},
                                      const TakeTrials& take = {}, bool keep_passages = false);

/// Walks 0, 1, ... of the chain. Throws as markov::Walker::walk.
[[nodiscard]] markov::WalkTally walks(const markov::FieldChain& chain, const FieldParams& field,
                                      const markov::Start& start, std::int64_t count,
                                      std::uint64_t seed, const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
