// SPDX-License-Identifier: MIT
#pragma once
/// The chain that pooled gate runs make: counts between the leaves of trees grown over their
/// entries, and the first rows of starts.

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "dynamics/cells/state_space.h"
#include "dynamics/cells/tree_space.h"
#include "lattice/field/gate_chain.h"
#include "lattice/pool/run_pool.h"

namespace gatewalk::lattice {

/// Calls use(entry, type of the gate) for all runs of the group's trials but the starts' own first
/// ones and those that broke.
void each_entry(const RunPool& pool, TrialGroup group,
                const std::function<void(const dynamics::Entry& entry, int type)>& use);

/// Where entries were seen: the least boxes around those of some neighbouring leaves of a boundary.
/// A box may hold places between its leaves where none was.
struct SeenEntries {
  struct Box {
    std::array<double, dynamics::kMostCoordinates> low{}, high{};  // 0 behind the last
    std::int64_t entries = 0;
  };
  std::vector<Box> boxes{};
  std::size_t coordinates = 0;

  SeenEntries() = default;
  /// `state[i]` is that of entries[i].
  SeenEntries(const dynamics::StateSpace& space, const dynamics::EntryTable& entries,
              const std::vector<int>& state);
  [[nodiscard]] bool holds(std::size_t box, const dynamics::Entry& entry) const;
  /// Place among `boxes`.
  [[nodiscard]] static std::size_t place_of(const dynamics::StateSpace& space, int state);
};

/// Transition counts between the leaves of trees; chain_of() adds the rows of starts. Where a leaf
/// has fewer runs of a type than asked for, its row is that of all its neighbours in the smallest
/// part of the tree that has them.
struct Kernel {
  dynamics::StateSpace space;
  std::vector<markov::Counts> counts;  // by type of gate: (n x n+1), the last column: trapped
  std::vector<SeenEntries> seen{};     // by type, of the kernel of all trials
  /// By type, where there are several: the first leaf of those that share a leaf's row (n).
  std::vector<std::vector<int>> shared_by{};

  [[nodiscard]] std::int64_t nonzeros() const;  // of all types
};

/// From the runs of one group of the trials but the starts' own first ones. With mirror images a
/// run makes two counts. Runs that broke are left out. Leaves are larger where there would be more
/// than kMostStates of them.
[[nodiscard]] Kernel kernel_of(const dynamics::CellMap& map, const RunPool& pool,
                               int per_leaf = dynamics::kEntriesPerLeaf, TrialGroup group = {});

/// What the runs behind each of the kernel's counts took: by type, in the order of the nonzeros.
[[nodiscard]] std::vector<std::vector<dynamics::CostSums>> cost_sums(const Kernel& kernel,
                                                                     const dynamics::CellMap& map,
                                                                     const RunPool& pool,
                                                                     TrialGroup group = {});

/// Runs of all trials through cells of this type, as those of a kernel: from the states of one
/// space (rows) to the outputs of another, with mirror images where the cells are symmetric.
[[nodiscard]] markov::Counts counts_between(const dynamics::StateSpace& rows,
                                            const dynamics::StateSpace& outputs,
                                            const dynamics::CellMap& map, const RunPool& pool,
                                            int type);

/// Leaves taken together, for each the first of its part: the smallest parts of the trees with
/// `least` runs in each, where runs[i] are those of leaf i.
[[nodiscard]] std::vector<int> joined_leaves(const dynamics::StateSpace& space,
                                             const std::vector<std::int64_t>& runs,
                                             std::int64_t least);

/// How often the first runs from each start, in a cell of this type, ended in each of the kernel's
/// outputs (starts x n+1): the runs of one group of the trials, or of several, for each of which
/// all starts have a row. A start in the middle of a symmetric cell has mirror images too.
[[nodiscard]] markov::Counts first_rows(const Kernel& kernel, const dynamics::CellMap& map,
                                        const RunPool& pool, const std::vector<FirstRow>& starts,
                                        int type,
                                        const std::vector<TrialGroup>& groups = {TrialGroup{}});

/// What those of one start took, in the order of its row's nonzeros; `sums`: cost_sums of the
/// kernel.
[[nodiscard]] std::vector<dynamics::CostSums> first_cost_sums(
    const Kernel& kernel, const std::vector<std::vector<dynamics::CostSums>>& sums,
    const dynamics::CellMap& map, const RunPool& pool, const FirstRow& start, int type,
    TrialGroup group = {});

/// The share of the start's first runs that enter the next gate of the field where no run of the
/// kernel did, less what chance alone would make: what the kernel says of these is a guess.
[[nodiscard]] double missing_mass(const Kernel& kernel, const dynamics::CellMap& map,
                                  const FieldParams& field, const OwnRuns& start);

/// The kernel's rows, and behind them `first_rows`, which nothing leads to: they are those of the
/// gate in which trials start.
[[nodiscard]] markov::FieldChain chain_of(const Kernel& kernel, const dynamics::CellMap& map,
                                          const FieldParams& field,
                                          const markov::Counts& first_rows);

/// The same as matrices, in which the starts are states of their own.
[[nodiscard]] std::vector<dynamics::Transitions> transitions_of(
    const Kernel& kernel, const dynamics::CellMap& map, const FieldParams& field,
    const std::vector<dynamics::Entry>& starts, const markov::Counts& first_rows);

}  // namespace gatewalk::lattice
