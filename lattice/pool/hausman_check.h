// SPDX-License-Identifier: MIT
#pragma once
/// Compares a chain with the full trials that it was made from. Trials keep what a chain may lose:
/// memory from gate to gate, differences within a state, which gate has which type. The test
/// therefore detects a wrong chain as far as this number of trials allows.

#include <cstdint>
#include <optional>
#include <vector>

#include "lattice/field/field_trials.h"
#include "lattice/pool/pooled_prediction.h"
#include "markov/predict.h"

namespace gatewalk::lattice {

/// Trials of one start or of a range, and the chain's exact answer for their bodies.
struct TrialsAndChain {
  const FieldTrials& trials;
  const markov::FinalDistribution& chain;
};

/// Tests all trials together; nullopt if there are no trials.
[[nodiscard]] std::optional<HausmanCheck> hausman_check(const std::vector<TrialsAndChain>& all,
                                                        const FieldParams& field,
                                                        std::uint64_t seed);

}  // namespace gatewalk::lattice
