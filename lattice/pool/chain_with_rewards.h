// SPDX-License-Identifier: MIT
#pragma once
/// A field's chain from one start with the costs of its draws and the entries into its states: the
/// input of all analyses.

#include <cstdint>
#include <functional>
#include <vector>

#include "dynamics/base/random.h"
#include "lattice/field/problem.h"
#include "lattice/pool/kernel.h"
#include "markov/totals.h"

namespace gatewalk::lattice {

/// A field's chain from one start, with the mean costs of its draws by Section::costs.
struct ChainWithRewards {
  markov::FieldChain chain;
  markov::Rewards rewards;
  markov::Start start;
};
/// Builds the chain from the runs of one group of the trials, and that group's first runs from
/// `start`. The start's row is the last one.
[[nodiscard]] ChainWithRewards chain_with_rewards(const Kernel& kernel,
                                                  const dynamics::CellMap& map,
                                                  const FieldParams& field, const RunPool& pool,
                                                  const FirstRow& start, TrialGroup group = {});

/// A chain ready for analysis, with its groups for error bars.
struct AnalysedChain {
  ChainWithRewards chain;
  /// Of the chain's states; with trees, without the start, whose row comes after the states.
  dynamics::StateSpace space;
  /// Draws an entry into a gate that belongs to the state: with trees, one that was seen in a gate
  /// of any type; with bins, any place in the bin.
  std::function<dynamics::Entry(int state, dynamics::Random& random)> entry;
  std::vector<AnalysedChain> groups{};  // kTrialGroups chains from groups of the trials; or none
  std::vector<std::int64_t> runs{};     // runs by state, in gates of the start's type
  /// Bodies behind the chain, for trees with groups; each group has its part of them.
  std::int64_t bodies = 0;
};
/// The chain of trees from the pool's runs, with groups for error bars unless fewer than
/// kLeastBodies bodies were recorded. Throws std::invalid_argument if there are no runs of `start`.
[[nodiscard]] AnalysedChain analysed_chain(const Problem& problem, const RunPool& pool,
                                           const FirstRow& start,
                                           int per_leaf = dynamics::kEntriesPerLeaf);
/// The chain of bins from one matrix per cell type. Costs are NaN where the matrices do not know
/// them.
[[nodiscard]] AnalysedChain analysed_chain(const Problem& problem,
                                           const std::vector<dynamics::Transitions>& matrices,
                                           const markov::Start& start);

}  // namespace gatewalk::lattice
