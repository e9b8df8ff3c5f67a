// SPDX-License-Identifier: MIT
#pragma once
/// Predictions of a pool's chains: the chain of all trials, and the chains of eight groups of the
/// trials, from which error bars come.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "lattice/field/field_params.h"
#include "lattice/pool/kernel.h"
#include "lattice/statistics/group_spread.h"
#include "markov/solvers.h"

namespace gatewalk::lattice {

/// Predictions of a kernel from several starts, whose first draws are `first_rows` (starts x n+1):
/// exact, or by Monte Carlo walks where exact ones would take long (large fields, very many runs).
struct KernelAnswers {
  std::vector<markov::FinalDistribution> final;  // (starts)
  std::int64_t walks = 0;                        // Monte Carlo walks per start; 0: exact
};
[[nodiscard]] KernelAnswers answers_of(const Kernel& kernel, const dynamics::CellMap& map,
                                       const markov::Counts& first_rows, const FieldParams& field,
                                       std::uint64_t seed);

/// Least number of entries in a leaf of the chains that give the shares of endings, beside chains
/// with leaves of `per_leaf` entries that give the map of final gates. The size of leaves biases an
/// ending, and smaller leaves halve that bias; in the map, many small leaves would make each gate's
/// share noisier. Pools of very many runs, whose bias is small, get larger leaves, so that these
/// chains do not take long. Chains whose states were limited (per_leaf > kEntriesPerLeaf) keep
/// their leaves.
[[nodiscard]] int ending_leaf(const RunPool& pool, int per_leaf = dynamics::kEntriesPerLeaf);

/// Shares of all bodies by markov::Ending.
using EndingsOf = std::array<double, markov::kEndings>;

/// What a chain of small leaves says of one start.
struct SmallLeaves {
  EndingsOf endings{};
  markov::CellProbabilities final_cells{};  // empty by the adjoint, which gives endings alone
};
/// Answers for each start by the exact chain with leaves of `leaf` entries, from the runs of one
/// group of the trials. nullopt for a start whose row is that of its leaf, because the few
/// runs of a small leaf would make all of its first draws; and for all starts if they are many and
/// the chain too large for the adjoint.
[[nodiscard]] std::vector<std::optional<SmallLeaves>> by_small_leaves(
    const dynamics::CellMap& map, const FieldParams& field, const RunPool& pool,
    const std::vector<FirstRow>& starts, int leaf, TrialGroup group = {});

/// Final gates by the exact chain with leaves of `leaf` entries: means over the starts, by all
/// trials and by each group of the trials. `per_row`: see kernel_of(). nullopt if an exact
/// prediction takes too long.
[[nodiscard]] std::optional<GroupedMaps> mean_maps(const dynamics::CellMap& map,
                                                   const FieldParams& field, const RunPool& pool,
                                                   const std::vector<FirstRow>& starts, int leaf,
                                                   std::optional<int> per_row = {});

/// The prediction with the shares of endings taken from `endings`; the map of each ending keeps its
/// shape. A prediction that knows no way to one of these endings is returned as it is.
[[nodiscard]] markov::FinalDistribution with_endings(markov::FinalDistribution prediction,
                                                     const EndingsOf& endings);

/// These answers by all trials, and by each group of the trials.
struct PoolSmallLeaves {
  SmallLeaves whole;
  std::array<SmallLeaves, kTrialGroups> groups;
};

/// The predictions for one start by all trials, and by each group of the trials.
struct PoolAnswer {
  markov::FinalDistribution whole{};
  std::vector<markov::FinalDistribution> groups{};  // (kTrialGroups)
  /// (kTrialGroups) Predictions of each group's kernel with the first runs of all trials: their
  /// spread shows the kernel's part of the error. Empty if answers come from Monte Carlo walks.
  std::vector<markov::FinalDistribution> kernels{};
  std::int64_t walks = 0;        // see KernelAnswers
  double unseen = 0.0;           // missing_mass()
  std::int64_t pool_trials = 0;  // number of trials that the pool had
  int coordinates = 0;           // number of coordinates by which the states differ
  /// Endings from small leaves, once they are asked for (PoolChains::add_endings). Without them the
  /// endings are those of `whole` and `groups`.
  std::optional<PoolSmallLeaves> small_leaves{};

  /// Final gates; and by the chain of small leaves, nullopt if it gives none.
  [[nodiscard]] GroupedMaps maps() const;
  [[nodiscard]] std::optional<GroupedMaps> maps_of_small_leaves() const;
};

struct PoolAnswers {
  std::vector<PoolAnswer> starts{};
  int states = 0;
  std::int64_t nonzeros = 0;

  /// Whether answers come from Monte Carlo walks.
  [[nodiscard]] bool by_walks() const { return !starts.empty() && starts.front().walks > 0; }
};

/// The chains of a pool that grows. Kernels are kept while only first runs are added.
class PoolChains {
 public:
  /// `starts`: number of starts at first. For many starts answers come by the adjoint, and leaves
  /// are twice as large, which costs less.
  PoolChains(const dynamics::CellMap& map, const FieldParams& field, int per_leaf,
             std::size_t starts, std::uint64_t seed);

  /// True if answers for this number of starts come by the adjoint: further starts then cost
  /// nothing.
  [[nodiscard]] bool by_adjoint(const RunPool& pool, std::size_t starts) const;

  /// True for many starts: the adjoint pays for them if it fits into memory.
  [[nodiscard]] bool are_for_many() const { return per_leaf_ > ending_per_leaf_; }
  /// Least number of entries in a leaf of the chains.
  [[nodiscard]] int per_leaf() const { return per_leaf_; }

  [[nodiscard]] PoolAnswers ask(const RunPool& pool, const std::vector<FirstRow>& starts);
  /// Adds the endings from small leaves to exact answers for these starts, and returns true; false
  /// if the answers come from Monte Carlo walks, or ending_leaf() is no smaller. The chains are
  /// made anew with each call.
  [[nodiscard]] bool add_endings(const RunPool& pool, const std::vector<FirstRow>& starts,
                                 PoolAnswers& said) const;

 private:
  struct GroupChain {
    Kernel kernel;
    std::optional<markov::AdjointPredictor> adjoint{};
  };
  void renew(const RunPool& pool);
  [[nodiscard]] KernelAnswers answers(const GroupChain& chain, int group,
                                      const markov::Counts& rows) const;

  dynamics::CellMap map_;
  const FieldParams& field_;
  int ending_per_leaf_;  // as asked for; per_leaf_ is larger for many starts
  int per_leaf_;
  std::uint64_t seed_;
  std::int64_t runs_ = -1;  // number of runs behind the kernels
  bool by_walks_ = false;
  std::vector<GroupChain> chains_{};  // of all trials, then one of each group
};

}  // namespace gatewalk::lattice
