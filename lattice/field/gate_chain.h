// SPDX-License-Identifier: MIT
#pragma once
/// Counts + state space -> chain.

#include <vector>

#include "dynamics/cells/section.h"
#include "dynamics/cells/transitions.h"
#include "lattice/field/field_params.h"
#include "markov/chain.h"

namespace gatewalk::lattice {

struct CountedField;

/// Exits of a state space: output j enters the next gate in state j; the last one is "trapped".
[[nodiscard]] std::vector<markov::Exit> exits_of(const dynamics::StateSpace& space);

[[nodiscard]] markov::Chain make_chain(const dynamics::Transitions& t);

/// A chain for each of map.types, where that type stands.
[[nodiscard]] markov::FieldChain field_chain(const dynamics::CellMap& map,
                                             std::vector<markov::Chain> chains);
/// The same of matrices with the same states.
[[nodiscard]] markov::FieldChain make_chain(const dynamics::CellMap& map,
                                            const std::vector<dynamics::Transitions>& matrices);

/// Every cell draws from the matrix of its type; matrices as map.types.
[[nodiscard]] CountedField counted_field(const dynamics::CellMap& map,
                                         const std::vector<dynamics::Transitions>& matrices);
/// Every cell draws from the same matrix.
[[nodiscard]] CountedField counted_field(const dynamics::Transitions& matrix);

/// The chain's start for a body that enters the field's start cell so: its state, and whether it
/// lies outside the bins as StateSpace::Index says.
struct ChainStart {
  markov::Start start;
  bool clamped = false, beyond = false;
};
[[nodiscard]] ChainStart chain_start(const dynamics::StateSpace& space, const FieldParams& field,
                                     const dynamics::Entry& entry);

}  // namespace gatewalk::lattice
