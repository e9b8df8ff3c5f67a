// SPDX-License-Identifier: MIT
#pragma once
/// Endings by start and by cell: how bodies end that start in each state of a chain, and how bodies
/// end that come to each cell.

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

/// The outcomes of a chain's walks, and of its groups.
struct ChainOutcomes {
  markov::Outcomes whole;
  std::vector<markov::Outcomes> groups;
};
/// Computes the outcomes. Throws as markov::outcomes.
[[nodiscard]] ChainOutcomes chain_outcomes(const AnalysedChain& chain, const FieldParams& field,
                                           const dynamics::Work& work = {});

/// Bodies that start in one state, or in one of several neighbouring states.
struct StartState {
  int first_leaf = 0;
  std::int64_t runs = 0;  // runs that entered so, in gates of the first gate's type
  EndingShares endings{std::array<double, markov::kEndings>{}};
  markov::CellProbabilities gates;
  std::array<markov::CellProbabilities, 2> gates_95;  // lower and upper bounds
};
/// The endings from each start state.
struct StartStates {
  std::vector<int> of_leaf;  // by leaf: index of its state; -1: not asked for, or no run
  std::vector<StartState> states;
  std::int64_t least_runs = 1;  // least number of runs for which states were joined
};

/// Endings by start state of a chain of trees: for each state by which bodies enter through these
/// faces, as if they started so in the field's first cell. The first passages are those of that
/// state alone. Error bars include the spread of these few runs (Student's t), the sampling error
/// of later gates, and the bias of coarser states (kTrialGroups groups); NaN without groups. If
/// cells times states exceed `most`, neighbouring states are joined.
[[nodiscard]] StartStates start_states(const Problem& problem, const RunPool& pool,
                                       const AnalysedChain& chain, const ChainOutcomes& outcomes,
                                       const std::vector<int>& faces, int per_leaf,
                                       std::int64_t most);

/// Bodies from the chain's start that come to a cell, weighted by visits.
struct CellAhead {
  /// Per body; all other numbers are per visit, and missing if there are hardly any visits.
  Mean95 visits;
  EndingShares endings{std::array<double, markov::kEndings>{}};
  markov::CellProbabilities gates;  // where these bodies end
  std::vector<Mean95> next;         // by Outcomes::moves, then trapped in this cell
};
/// Endings by cell. `bodies` and `gate_runs`: numbers behind the chain. A cell has intervals if
/// bodies of every group come there.
[[nodiscard]] std::vector<CellAhead> cells_ahead(const ChainOutcomes& outcomes,
                                                 const FieldParams& field, std::int64_t bodies,
                                                 std::int64_t gate_runs);

}  // namespace gatewalk::lattice
