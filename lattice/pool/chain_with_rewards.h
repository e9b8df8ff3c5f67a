// SPDX-License-Identifier: MIT
#pragma once
/// A field's chain from one start, with what its draws take and where its states were entered: what
/// analyses are made of.

#include <cstdint>
#include <functional>
#include <vector>

#include "dynamics/base/random.h"
#include "lattice/field/problem.h"
#include "lattice/pool/kernel.h"
#include "markov/totals.h"

namespace gatewalk::lattice {

/// A field's chain from one start, with what its draws take: the quantities are those of
/// Section::costs.
struct ChainWithRewards {
  markov::FieldChain chain;
  markov::Rewards rewards;
  markov::Start start;
};
/// From the runs of one group of the trials, and that group's first runs from `start`, whose row is
/// the last one.
[[nodiscard]] ChainWithRewards chain_with_rewards(const Kernel& kernel,
                                                  const dynamics::CellMap& map,
                                                  const FieldParams& field, const RunPool& pool,
                                                  const FirstRow& start, TrialGroup group = {});

/// What is analysed.
struct AnalysedChain {
  ChainWithRewards chain;
  dynamics::StateSpace space;  // of its states; of trees without the start, whose row follows
  /// An entry into a gate that belongs to the state, drawn: of those seen, in gates of any type; of
  /// bins anywhere in the bin.
  std::function<dynamics::Entry(int state, dynamics::Random& random)> entry;
  std::vector<AnalysedChain> groups{};  // kTrialGroups, of groups of the trials; or none
  std::vector<std::int64_t> runs{};     // by state, in gates of the start's type
  std::int64_t bodies = 0;              // behind it, of trees with groups; each group has its part
};
/// Of trees, from the pool's runs; with error bars, but for recorded runs of fewer than
/// kLeastBodies bodies. Throws std::invalid_argument when there are no
/// runs of `start`.
[[nodiscard]] AnalysedChain analysed_chain(const Problem& problem, const RunPool& pool,
                                           const FirstRow& start,
                                           int per_leaf = dynamics::kEntriesPerLeaf);
/// Of matrices, one for each type. What runs took is not a number where they
/// do not know it.
[[nodiscard]] AnalysedChain analysed_chain(const Problem& problem,
                                           const std::vector<dynamics::Transitions>& matrices,
                                           const markov::Start& start);

}  // namespace gatewalk::lattice
