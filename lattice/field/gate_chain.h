// SPDX-License-Identifier: MIT
#pragma once
/// Builds a gate chain from counted transitions and their state space.

#include <vector>

#include "dynamics/cells/section.h"
#include "dynamics/cells/transitions.h"
#include "lattice/field/field_params.h"
#include "markov/chain.h"

namespace gatewalk::lattice {

struct CountedField;

/// The chain's exits, one per output: output j enters the next gate in state j; the last output is
/// "trapped".
[[nodiscard]] std::vector<markov::Exit> exits_of(const dynamics::StateSpace& space);

/// The chain of one cell type, with the transition probabilities that the counts give.
[[nodiscard]] markov::Chain make_chain(const dynamics::Transitions& t);

/// The chain of a field: `chains` has one chain for each of map.types.
[[nodiscard]] markov::FieldChain field_chain(const dynamics::CellMap& map,
                                             std::vector<markov::Chain> chains);
/// The chain of a field from one matrix of counts for each of map.types; all matrices have the same
/// states.
[[nodiscard]] markov::FieldChain make_chain(const dynamics::CellMap& map,
                                            const std::vector<dynamics::Transitions>& matrices);

/// Counts and chain of a field in which every cell draws from the matrix of its type; `matrices`
/// has one matrix for each of map.types.
[[nodiscard]] CountedField counted_field(const dynamics::CellMap& map,
                                         const std::vector<dynamics::Transitions>& matrices);
/// Counts and chain of a field in which every cell draws from the same matrix.
[[nodiscard]] CountedField counted_field(const dynamics::Transitions& matrix);

/// The chain's start for a body that enters the field's start cell by a given entry: the state, and
/// whether the entry lies outside the bins (StateSpace::Index).
struct ChainStart {
  markov::Start start;
  bool clamped = false, beyond = false;
};
[[nodiscard]] ChainStart chain_start(const dynamics::StateSpace& space, const FieldParams& field,
                                     const dynamics::Entry& entry);

}  // namespace gatewalk::lattice
