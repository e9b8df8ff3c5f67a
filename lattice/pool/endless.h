// SPDX-License-Identifier: MIT
#pragma once
/// Cells of one type without end: trials through them, and how bodies spread (diffusion), by a
/// chain of trees with error bars. How it compares with direct simulation, with hops without memory
/// (Machta and Zwanzig 1983) and with few steps of it (Gilbert and Sanders 2009): results/lorentz.

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "dynamics/cells/cell.h"
#include "lattice/pool/run_pool.h"
#include "lattice/statistics/group_spread.h"
#include "markov/diffusion.h"

namespace gatewalk::lattice {

/// Trials 0 .. trials - 1, each from an entry drawn by `start` (called by several threads at once),
/// through `passages` cells or until it does not get out of one. The same for any number of
/// threads. What went wrong is added to `health`. For `RunPool::scattered`. Throws
/// std::invalid_argument unless both numbers are > 0.
[[nodiscard]] RangeRuns endless_trials(
    const dynamics::Cell& cell, const std::function<dynamics::Entry(dynamics::Random&)>& start,
    std::int64_t trials, int passages, std::uint64_t seed, dynamics::Health& health);

/// Of the chain whose states are the leaves of `space`: it remembers of a body by which leaf it
/// entered a cell, and nothing else.
struct TreeDiffusion {
  dynamics::StateSpace space;
  markov::Diffusion walk;
};
/// From the pool's runs of one group of the trials, all of them by default. `lattice`: where the
/// moves (1, 0) and (0, 1) lead, as columns, in the length that D is to have. Times are the
/// section's first cost; without costs a passage takes 1. `per_leaf`: entries in a leaf, at least.
/// Throws std::invalid_argument for cells of several types, and as markov::diffusion.
[[nodiscard]] TreeDiffusion tree_diffusion(const dynamics::CellMap& map, const RunPool& pool,
                                           const Eigen::Matrix2d& lattice,
                                           int per_leaf = dynamics::kEntriesPerLeaf,
                                           TrialGroup group = {});

struct PooledDiffusion {
  TreeDiffusion whole;
  std::vector<TreeDiffusion> groups;  // kTrialGroups, each with leaves of its own
  Mean95 coefficient;                 // D, length^2 / time: of the whole, interval by the groups
};
/// With what leaves of finite size cost in the interval (lattice/statistics/group_spread.h). As
/// tree_diffusion.
[[nodiscard]] PooledDiffusion pooled_diffusion(const dynamics::CellMap& map, const RunPool& pool,
                                               const Eigen::Matrix2d& lattice,
                                               int per_leaf = dynamics::kEntriesPerLeaf);

}  // namespace gatewalk::lattice
