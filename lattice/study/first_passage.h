// SPDX-License-Identifier: MIT
#pragma once
/// How likely bodies are to reach a cell, a state or an ending, and how long those that do are on
/// their way: from the start with intervals, and from every state of every cell.

#include <vector>

#include "lattice/field/problem.h"
#include "lattice/pool/chain_with_rewards.h"
#include "lattice/statistics/group_spread.h"
#include "markov/first_passage.h"

namespace gatewalk::lattice {

/// Means are over the bodies that get there. Intervals are those of groups of the trials: none
/// (NaN) without groups, of a state, as groups have states of their own, and where the start is
/// there.
struct FirstPassage {
  Mean95 chance;              // at the start
  Mean95OfRuns gates;         // visited before
  Mean95OfRuns time;          // of the section's first cost, s; NaN where nobody measured it
  markov::FirstPassages all;  // of the chain; the total is the time
};
/// Throws as markov::first_passages.
[[nodiscard]] FirstPassage first_passage(const FieldParams& field, const AnalysedChain& chain,
                                         const markov::PassageTarget& target);

}  // namespace gatewalk::lattice
