#pragma once
/// Many trials through the field, and many walks, watched and checked.

#include <cstdint>
#include <functional>

#include "dynamics/base/work.h"
#include "lattice/exits.h"
#include "lattice/field_costs.h"
#include "lattice/gate_chain.h"
#include "lattice/problem.h"
#include "lattice/reference.h"

namespace gatewalk::lattice {

/// Carries out a range of trials through the field, and says what each did.
using RunTrialRange = std::function<FieldTally(dynamics::TrialRange range, FieldTrials& each)>;
/// Trials 0, 1, ... What they took is added to `costs`, and where they left the field to `exits`,
/// if given. Throws as `run`.
[[nodiscard]] FieldTally field_trials(const FieldParams& field, std::int64_t trials,
                                      const RunTrialRange& run, const dynamics::Work& work = {},
                                      FieldCosts* costs = nullptr, ExitCounts* exits = nullptr);
/// Takes trials with their passages, a piece at a time.
using TakeTrials = std::function<void(const FieldTrials& each)>;
/// Of a problem's cells, from its start; a sample is run again by a better method, if there is one.
[[nodiscard]] FieldTally field_trials(const Problem& problem, std::int64_t trials,
                                      std::uint64_t seed, const dynamics::Work& work = {},
                                      FieldCosts* costs = nullptr, ExitCounts* exits = nullptr,
                                      const TakeTrials& take = {});

/// Walks 0, 1, ... of the chain. Throws as markov::Walker::walk.
[[nodiscard]] markov::WalkTally walks(const markov::FieldChain& chain, const FieldParams& field,
                                      const markov::Start& start, std::int64_t count,
                                      std::uint64_t seed, const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
