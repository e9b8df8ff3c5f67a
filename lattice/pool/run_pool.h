// SPDX-License-Identifier: MIT
#pragma once
/// Gate runs of full trials, pooled over all gates of a type, since one is like the other; and the
/// chain that they make: a start's own first runs are its row, all later runs fill the rows of
/// trees grown over the entries that were seen (dynamics/cells/tree_space.h), their mirror images
/// too where the gate is symmetric. All types share the trees: what enters a gate comes from
/// another one.

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <variant>
#include <vector>

#include "dynamics/cells/entry_table.h"
#include "dynamics/cells/state_space.h"
#include "dynamics/cells/tree_space.h"
#include "lattice/field/gate_chain.h"
#include "lattice/field/reference.h"

namespace gatewalk::lattice {

/// Trials from one start (y = 0) with their passages; field.fidelity "active".
struct OwnRuns {
  dynamics::Entry start{};
  FieldTrials full{.final_gates = {}, .keep_passages = true};
  FieldTrials first{.final_gates = {}, .keep_passages = true};  // that ran through one gate only

  /// Runs through the first gate.
  [[nodiscard]] std::int64_t first_runs() const {
    return std::ssize(full.passed) + std::ssize(first.passed);
  }
  [[nodiscard]] std::int64_t gate_runs() const {
    return std::ssize(full.passages) + std::ssize(first.passages);
  }
};

/// Trials that start anywhere: all their runs are pooled.
struct RangeRuns {
  std::vector<dynamics::Entry> starts;  // (trials)
  FieldTrials each{.final_gates = {}, .keep_passages = true};
};

/// Where the chain's row of a start comes from: the start's own first runs, the runs of the leaf
/// that holds an entry, or (monostate) the first runs of all scattered trials.
using FirstRow = std::variant<std::monostate, const OwnRuns*, dynamics::Entry>;

struct RunPool {
  std::vector<OwnRuns> starts;
  RangeRuns scattered;

  /// Place of a start among `starts`; their number if it is none.
  [[nodiscard]] std::size_t place_of(const dynamics::Entry& start) const;
  /// From the start's own runs if it has any, else from its leaf; without an entry from all
  /// scattered trials.
  [[nodiscard]] FirstRow first_row(const std::optional<dynamics::Entry>& start) const;
  [[nodiscard]] std::int64_t gate_runs() const;
  /// Those that ran through the field.
  [[nodiscard]] std::int64_t trials() const;
  /// Bodies that made them.
  [[nodiscard]] std::int64_t bodies() const;
};

/// Trials number group, group + of, group + 2 of, ... of every start; where bodies made several
/// trials each, all those of bodies number group, group + of, ...
struct TrialGroup {
  std::int64_t group = 0, of = 1;
  [[nodiscard]] bool holds(const FieldTrials& trials, std::int64_t trial) const {
    return (trials.bodies.empty() ? trial : trials.bodies[static_cast<std::size_t>(trial)]) % of ==
           group;
  }
};

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

/// Counts of trees' states, none of which is a start's own. Where a leaf has fewer runs of a type
/// than asked for, its row is that of all its neighbours in the smallest part of the tree that has
/// them.
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
