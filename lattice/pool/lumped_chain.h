// SPDX-License-Identifier: MIT
#pragma once
/// The error of a coarser chain: lumps states, and compares the lumped chain with the original.

#include <optional>
#include <vector>

#include "lattice/field/field_params.h"
#include "lattice/field/gate_chain.h"
#include "lattice/pool/chain_with_rewards.h"
#include "lattice/pool/reactive_visits.h"

namespace gatewalk::lattice {

/// The number of parts into which the first coordinate cuts the states of each face, then the
/// number for the next coordinate within each part, and so on. The parts of a cut have about equal
/// visits; coordinates without a number are not cut.
using LumpingParts = std::vector<int>;

/// Errors of a lumped chain.
struct LumpedChain {
  int states = 0;  // including the start's own state
  /// The largest total variation between the rows of two states of a part, averaged over the parts
  /// by visits; of the gate type with the largest average.
  double largest = 0.0;
  double endings = 0.0, final_gates = 0.0;  // total variation from the original chain's answer
};

/// Lumps a chain and predicts with it. `passages` are those of the chain; within a part, rows count
/// by the visits of their states in gates of all types. Returns nullopt if walks of either chain do
/// not end.
[[nodiscard]] std::optional<LumpedChain> lumped_chain(const AnalysedChain& chain,
                                                      const dynamics::CellMap& map,
                                                      const FieldParams& field,
                                                      const ReactiveVisits& passages,
                                                      const LumpingParts& parts);

}  // namespace gatewalk::lattice
