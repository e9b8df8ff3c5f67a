// SPDX-License-Identifier: MIT
#pragma once
/// What it costs to have fewer states: a chain with several of them as one, beside it.

#include <optional>
#include <vector>

#include "lattice/field/field_params.h"
#include "lattice/field/gate_chain.h"
#include "lattice/pool/chain_with_rewards.h"
#include "lattice/pool/reactive_visits.h"

namespace gatewalk::lattice {

/// Into how many parts the states of each boundary are cut by the first coordinate, then each part
/// by the next one; the parts of a cut are visited about as often. Coordinates without a number are
/// not cut.
using LumpingParts = std::vector<int>;

struct LumpedChain {
  int states = 0;  // the start's own is one of them
  /// Total variation between the rows of two states of one part: the largest, a mean over parts by
  /// visits, in the type of gate where it is most.
  double largest = 0.0;
  double endings = 0.0, final_gates = 0.0;  // total variation to the chain's
};

/// `passages`: of the chain; rows of a part count by the visits of their states, in gates of all
/// types. None where walks of either chain do not end.
[[nodiscard]] std::optional<LumpedChain> lumped_chain(const AnalysedChain& chain,
                                                      const dynamics::CellMap& map,
                                                      const FieldParams& field,
                                                      const ReactiveVisits& passages,
                                                      const LumpingParts& parts);

}  // namespace gatewalk::lattice
