#pragma once
/// Many trials through the field, and many walks, watched and checked.

#include <cstdint>

#include "dynamics/base/work.h"
#include "lattice/exits.h"
#include "lattice/field_costs.h"
#include "lattice/gate_chain.h"
#include "lattice/reference.h"
#include "lattice/scene/scene.h"

namespace gatewalk::lattice {

/// Trials 0, 1, ... through the field from the scene's start; entries are counted by
/// fixed_space(scene). A sample is run again by a better method (check_outcomes). What they took is
/// added to `costs`, and where they left the field to `exits`, if given. Throws as run_field.
[[nodiscard]] FieldTally field_trials(const Scene& scene, std::int64_t trials, std::uint64_t seed,
                                      const dynamics::Work& work = {}, FieldCosts* costs = nullptr,
                                      ExitCounts* exits = nullptr);

/// Walks 0, 1, ... of the chain. Throws as markov::Walker::walk.
[[nodiscard]] markov::WalkTally walks(const markov::FieldChain& chain, const FieldParams& field,
                                      const ChainStart& start, std::int64_t count,
                                      std::uint64_t seed, const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
