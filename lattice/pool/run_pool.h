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
#include "lattice/field/field_trials.h"
#include "lattice/field/gate_chain.h"

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

}  // namespace gatewalk::lattice
