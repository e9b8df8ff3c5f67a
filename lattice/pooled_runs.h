#pragma once
/// A chain from full trials: every gate run of every trial, pooled over all gates, since one gate
/// is like the other. A start's own first runs are its row; all later runs fill the rows of a tree
/// of the entries that were seen (dynamics/tree_space.h), mirrored too where the gate is symmetric.

#include <cstdint>
#include <vector>

#include "dynamics/state_space.h"
#include "dynamics/transitions.h"
#include "lattice/gate_chain.h"
#include "lattice/reference.h"

namespace gatewalk::lattice {

/// Full trials from one start (y = 0) with their passages; field.fidelity "active".
struct StartTrials {
  dynamics::Crossing start;
  bool own_state = true;  // its first runs are a row of their own, else runs like all others
  FieldTrials each{.final_gates = {}, .keep_passages = true};

  [[nodiscard]] std::int64_t trials() const { return std::ssize(each.final_gates); }
};

/// Every `of`-th trial, from number `group` on.
struct TrialGroup {
  std::int64_t group = 0, of = 1;
};

/// Counts and the states that they belong to.
struct CountedStates {
  dynamics::StateSpace space;
  markov::Counts counts;  // (n x n+1), the last column: trapped
  std::int64_t runs = 0;  // gate runs behind them; with mirror images there are more counts

  [[nodiscard]] markov::Chain chain() const {
    return markov::Chain::from_counts(counts, exits_of(space));
  }
};

/// Of the runs of one group of the trials. Runs that broke are left out.
[[nodiscard]] CountedStates pooled(const dynamics::GateParams& p,
                                   const std::vector<StartTrials>& starts, int per_leaf,
                                   TrialGroup group = {});

}  // namespace gatewalk::lattice
