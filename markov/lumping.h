// SPDX-License-Identifier: MIT
#pragma once
/// Lumped chains: states are merged into groups, and the error of lumping is computed.

#include <vector>

#include "markov/predict.h"

namespace gatewalk::markov {

/// A lumped chain, whose states are groups of states. Lumping is exact (Kemeny and Snell, Finite
/// Markov Chains, 1960, section 6.3) if all states of a group have the same transition
/// probabilities to the groups. The deviation from this is given as total variation of one draw.
struct Lumping {
  struct Group {
    double weight = 0.0;   // weight of the group's states
    double largest = 0.0;  // largest total variation between two of its states
    double mean = 0.0;     // weighted mean total variation between a state and the group's row
  };
  Chain chain;                // inputs: groups; outputs: one for all that lead to the same group
  std::vector<Group> groups;  // (groups)
  // Weighted means of `largest` and `mean` over the groups.
  double largest = 0.0, mean = 0.0;
};

/// Lumps a chain. `group_of` (inputs) numbers the groups from 0 without gaps. `weights` (inputs),
/// not negative, weight each state's row within its group: expected_visits(), or the counts of each
/// row, so that rows of counts are added. A group without weight averages its rows equally.
/// Unsampled rows are left out; a group of only such rows is unsampled. For a field of several
/// types, lump each chain with the same groups. Throws std::invalid_argument for groups or weights
/// that do not fit.
[[nodiscard]] Lumping lump(const Chain& chain, const std::vector<int>& group_of,
                           const std::vector<double>& weights);

/// Expected visits of each input state (inputs), summed over all cells (walk_totals). max_cells 0:
/// no limit. Throws std::runtime_error if more than 1e-13 of the walks never end.
[[nodiscard]] std::vector<double> expected_visits(const FieldChain& chain, const Field& field,
                                                  const Start& start, int max_cells = 0);

/// The total variation between the predictions of the full and of the lumped chain.
struct LumpingError {
  double endings = 0.0, final_cells = 0.0;
  FinalDistribution fine, lumped;
};

/// Predicts with both chains over the same field, from a state and from its group, and compares the
/// results.
[[nodiscard]] LumpingError lumping_error(const FieldChain& fine, const FieldChain& lumped,
                                         const std::vector<int>& group_of, const Field& field,
                                         const Start& start, const PredictOptions& options = {});

}  // namespace gatewalk::markov
