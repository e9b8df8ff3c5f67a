// SPDX-License-Identifier: MIT
#pragma once
/// Chains with fewer states: states taken together in groups, and what that costs.

#include <vector>

#include "markov/predict.h"

namespace gatewalk::markov {

/// A chain of groups of states. It is exact (Kemeny and Snell, Finite Markov Chains, 1960, section
/// 6.3) where all states of a group go on to the groups with the same chances; how far they do not
/// is said in total variation of where one draw leads.
struct Lumping {
  struct Group {
    double weight = 0.0;   // of its states
    double largest = 0.0;  // between two of its states
    double mean = 0.0;     // between a state and the group's row, weighted mean
  };
  Chain chain;                // its inputs: groups; its outputs: those that lead to the same group
  std::vector<Group> groups;  // (groups)
  // Weighted means over the groups.
  double largest = 0.0, mean = 0.0;
};

/// `group_of` (inputs) counts from 0, without gaps; `weights` (inputs), not negative: how much each
/// state's row counts in its group's, as expected_visits() do, or the counts of each row: then rows
/// of counts are added. Groups without weight take their rows alike. Rows never sampled are left
/// out; a group of such rows was never sampled. Throws std::invalid_argument for other groups and
/// weights. For a field of several types lump each chain with the same groups.
[[nodiscard]] Lumping lump(const Chain& chain, const std::vector<int>& group_of,
                           const std::vector<double>& weights);

/// Expected visits of each input state (inputs), over all cells (walk_totals); max_cells 0: no
/// limit. Throws std::runtime_error where more than 1e-13 of the walks never end.
[[nodiscard]] std::vector<double> expected_visits(const FieldChain& chain, const Field& field,
                                                  const Start& start, int max_cells = 0);

/// How far apart two predictions are, in total variation.
struct LumpingError {
  double endings = 0.0, final_cells = 0.0;
  FinalDistribution fine, lumped;
};

/// Both chains over the same field, from a state and from its group.
[[nodiscard]] LumpingError lumping_error(const FieldChain& fine, const FieldChain& lumped,
                                         const std::vector<int>& group_of, const Field& field,
                                         const Start& start, const PredictOptions& options = {});

}  // namespace gatewalk::markov
