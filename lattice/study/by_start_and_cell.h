// SPDX-License-Identifier: MIT
#pragma once
/// What a chain says of every start and of every cell: how bodies end that start in each of its
/// states, and how those end that come to each cell.

#include <array>
#include <cstdint>
#include <vector>

#include "dynamics/base/work.h"
#include "lattice/field/problem.h"
#include "lattice/pool/chain_with_rewards.h"
#include "lattice/statistics/ending_shares.h"
#include "lattice/statistics/group_spread.h"
#include "markov/outcomes.h"

namespace gatewalk::lattice {

/// How walks of a chain end, and of the groups of its trials.
struct ChainOutcomes {
  markov::Outcomes whole;
  std::vector<markov::Outcomes> groups;
};
/// Throws as markov::outcomes.
[[nodiscard]] ChainOutcomes chain_outcomes(const AnalysedChain& chain, const FieldParams& field,
                                           const dynamics::Work& work = {});

/// Bodies that start in one state, or in one of several neighbouring ones.
struct StartState {
  int first_leaf = 0;
  std::int64_t runs = 0;  // of the first gate's type that entered so
  EndingShares endings{std::array<double, markov::kEndings>{}};
  markov::CellProbabilities gates;
  std::array<markov::CellProbabilities, 2> gates_95;  // low, high
};
struct StartStates {
  std::vector<int> of_leaf;  // by leaf, number of its state; -1: not asked for, or no run
  std::vector<StartState> states;
  std::int64_t least_runs = 1;  // that states were joined for
};

/// Of trees: every state by which bodies enter through these faces, as if they started so in the
/// field's first cell, by the runs of that state alone. Error bars count that these are few (by
/// their spread, Student's t), the later gates' runs, and what larger states would change (by
/// kTrialGroups groups); without groups there are none (NaN). Where the states would have more
/// than `most` numbers together (cells x states), neighbours are joined.
[[nodiscard]] StartStates start_states(const Problem& problem, const RunPool& pool,
                                       const AnalysedChain& chain, const ChainOutcomes& outcomes,
                                       const std::vector<int>& faces, int per_leaf,
                                       std::int64_t most);

/// Bodies from the chain's start that come to a cell, by visits.
struct CellAhead {
  Mean95 visits;  // of a body; the others per visit; nothing else where there are next to none
  EndingShares endings{std::array<double, markov::kEndings>{}};
  markov::CellProbabilities gates;  // where they end
  std::vector<Mean95> next;         // by Outcomes::moves, then trapped here
};
/// `bodies` behind the chain and their `gate_runs`. Intervals where every group's bodies come.
[[nodiscard]] std::vector<CellAhead> cells_ahead(const ChainOutcomes& outcomes,
                                                 const FieldParams& field, std::int64_t bodies,
                                                 std::int64_t gate_runs);

}  // namespace gatewalk::lattice
