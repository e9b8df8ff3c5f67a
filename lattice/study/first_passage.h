// SPDX-License-Identifier: MIT
#pragma once
/// First passage: the probability to reach a cell, a state or an ending, and the time to get there;
/// from the start with intervals, and from every state of every cell.

#include <vector>

#include "lattice/field/problem.h"
#include "lattice/pool/chain_with_rewards.h"
#include "lattice/statistics/group_spread.h"
#include "markov/first_passage.h"

namespace gatewalk::lattice {

/// First passage from a start. Means are over the bodies that reach the target. Intervals come from
/// groups of the trials; NaN without groups, for a target that is a state, because groups have
/// other states, and if the start is in the target.
struct FirstPassage {
  Mean95 chance;              // from the start
  Mean95OfRuns gates;         // gates visited before
  Mean95OfRuns time;          // first cost of the section, s; NaN if it was not measured
  markov::FirstPassages all;  // of the chain; the total is the time
};
/// Computes the first passage. Throws as markov::first_passages.
[[nodiscard]] FirstPassage first_passage(const FieldParams& field, const AnalysedChain& chain,
                                         const markov::PassageTarget& target);

}  // namespace gatewalk::lattice
