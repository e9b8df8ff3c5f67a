// SPDX-License-Identifier: MIT
#pragma once
/// How walks spread over an endless lattice of cells of one type, where nobody is trapped: of a
/// chain, and of bodies in cells of any kind by a chain of trees with error bars. Lengths are in
/// the unit of the lattice, times in that of the draws (without times: draws). How it compares with
/// direct simulation, with hops without memory (Machta and Zwanzig 1983) and with few steps of it
/// (Gilbert and Sanders 2009): README.md.

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "dynamics/cells/cell.h"
#include "lattice/pool/run_pool.h"
#include "lattice/statistics/group_spread.h"
#include "markov/chain.h"
#include "markov/totals.h"

namespace lorentz {

using namespace gatewalk;

/// After a long time t a walk has gone drift t in the mean, with covariance 2 tensor t.
struct Diffusion {
  std::vector<double>
      states;              // (inputs) the share of all draws made in each, in the long run; sum 1
  double mean_time = 1.0;  // of a draw, in the long run
  Eigen::Vector2d drift{0.0, 0.0};                  // length / time
  Eigen::Matrix2d tensor{Eigen::Matrix2d::Zero()};  // length^2 / time
  /// <r^2> = 4 D t, without drift.
  [[nodiscard]] double coefficient() const { return 0.5 * tensor.trace(); }
};

/// `lattice`: where the moves (1, 0) and (0, 1) lead, as columns. `time`: what draws take, mean and
/// mean square for each nonzero of the chain's matrix, in their order; without it each takes 1.
///
/// It is the Green-Kubo sum over moves (Klages and Korabel, J. Phys. A 35:4823, 2002; by steps of
/// memory Gilbert and Sanders, Phys. Rev. E 80:041121, 2009) of a walk whose draws take different
/// times. Its first term alone is a walk without memory (Machta and Zwanzig, Phys. Rev. Lett.
/// 50:1959, 1983). With a draw's move l and time T in the long run, f = l - drift T,
/// drift = <l> / <T>:
///   tensor = (<f_0 f_0'> + sum over k > 0 of <f_0 f_k'> + <f_k f_0'>) / (2 <T>)
/// The sum is one linear solve for two right-hand sides: with (I - P) h = E[f | state], Poisson's
/// equation, m = f + h(next) - h(state) knows nothing of later draws, and the sum is <m m'>. So the
/// tensor is never negative.
///
/// Throws std::invalid_argument where a walk can be trapped or get into a row never sampled, where
/// it depends on the start among which states it stays, when `time` does not belong to the chain
/// or <T> is not > 0; std::runtime_error when the solve has fewer than 9 digits.
[[nodiscard]] Diffusion diffusion(const markov::Chain& chain,
                                  const Eigen::Matrix2d& lattice = Eigen::Matrix2d::Identity(),
                                  const markov::Reward& time = {});

/// Trials 0 .. trials - 1, each from an entry drawn by `start` (called by several threads at once),
/// through `passages` cells or until it does not get out of one. The same for any number of
/// threads. What went wrong is added to `health`. For `lattice::RunPool::scattered`. Throws
/// std::invalid_argument unless both numbers are > 0.
[[nodiscard]] lattice::RangeRuns endless_trials(
    const dynamics::Cell& cell, const std::function<dynamics::Entry(dynamics::Random&)>& start,
    std::int64_t trials, int passages, std::uint64_t seed, dynamics::Health& health);

/// Of the chain whose states are the leaves of `space`: it remembers of a body by which leaf it
/// entered a cell, and nothing else.
struct TreeDiffusion {
  dynamics::StateSpace space;
  Diffusion walk;
};
/// From the pool's runs of one group of the trials, all of them by default. `lattice`: where the
/// moves (1, 0) and (0, 1) lead, as columns, in the length that D is to have. Times are the
/// section's first cost; without costs a passage takes 1. `per_leaf`: entries in a leaf, at least.
/// Throws std::invalid_argument for cells of several types, and as diffusion().
[[nodiscard]] TreeDiffusion tree_diffusion(const dynamics::CellMap& map,
                                           const lattice::RunPool& pool,
                                           const Eigen::Matrix2d& lattice,
                                           int per_leaf = dynamics::kEntriesPerLeaf,
                                           lattice::TrialGroup group = {});

struct PooledDiffusion {
  TreeDiffusion whole;
  std::vector<TreeDiffusion> groups;  // kTrialGroups, each with leaves of its own
  lattice::Mean95 coefficient;        // D, length^2 / time: of the whole, interval by the groups
};
/// With what leaves of finite size cost in the interval (lattice/statistics/group_spread.h). As
/// tree_diffusion.
[[nodiscard]] PooledDiffusion pooled_diffusion(const dynamics::CellMap& map,
                                               const lattice::RunPool& pool,
                                               const Eigen::Matrix2d& lattice,
                                               int per_leaf = dynamics::kEntriesPerLeaf);

}  // namespace lorentz
