// SPDX-License-Identifier: MIT
#pragma once
/// A chain set against the full trials that it was made from. Trials keep what a chain may lose:
/// what bodies remember from gate to gate, what differs within a state, which gate is of which
/// type. So a wrong chain is found out, as far as so many trials can tell.

#include <cstdint>
#include <optional>
#include <vector>

#include "lattice/field/field_trials.h"
#include "lattice/pool/pooled_prediction.h"
#include "markov/predict.h"

namespace gatewalk::lattice {

/// Trials of one start, or of a range, and the chain's exact answer for their bodies.
struct TrialsAndChain {
  const FieldTrials& trials;
  const markov::FinalDistribution& chain;
};

/// All together, in one test. None: there are no trials.
[[nodiscard]] std::optional<HausmanCheck> hausman_check(const std::vector<TrialsAndChain>& all,
                                                        const FieldParams& field,
                                                        std::uint64_t seed);

}  // namespace gatewalk::lattice
