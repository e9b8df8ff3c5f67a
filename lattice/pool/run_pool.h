// SPDX-License-Identifier: MIT
#pragma once
/// Gate runs of full trials, pooled over all gates of a type, because all gates of a type are
/// alike; and the chain made from these runs. A start's own first runs form its row. All later runs
/// fill the rows of trees grown over the entries seen (dynamics/cells/tree_space.h), with their
/// mirror images if the gate is symmetric. All types share the trees, because a body enters a gate
/// from a gate of any type.

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

/// Trials from one start (y = 0), with their passages; field.fidelity is "active".
struct OwnRuns {
  dynamics::Entry start{};
  FieldTrials full{.final_gates = {}, .keep_passages = true};
  /// Trials that ran through one gate only.
  FieldTrials first{.final_gates = {}, .keep_passages = true};

  /// Number of runs through the first gate.
  [[nodiscard]] std::int64_t first_runs() const {
    return std::ssize(full.passed) + std::ssize(first.passed);
  }
  [[nodiscard]] std::int64_t gate_runs() const {
    return std::ssize(full.passages) + std::ssize(first.passages);
  }
};

/// Trials from anywhere in a range; all their runs are pooled.
struct RangeRuns {
  std::vector<dynamics::Entry> starts;  // (trials)
  FieldTrials each{.final_gates = {}, .keep_passages = true};
};

/// Where the chain's row for a start comes from: the start's own first runs, the runs of the leaf
/// that holds an entry, or (monostate) the first runs of all scattered trials.
using FirstRow = std::variant<std::monostate, const OwnRuns*, dynamics::Entry>;

/// All trials that a chain of trees is made from.
struct RunPool {
  std::vector<OwnRuns> starts;
  RangeRuns scattered;

  /// Index of a start in `starts`; starts.size() if it is not there.
  [[nodiscard]] std::size_t place_of(const dynamics::Entry& start) const;
  /// The source of a start's row: its own runs if it has any, else its leaf; for nullopt, all
  /// scattered trials.
  [[nodiscard]] FirstRow first_row(const std::optional<dynamics::Entry>& start) const;
  [[nodiscard]] std::int64_t gate_runs() const;
  /// Number of trials that ran through the field.
  [[nodiscard]] std::int64_t trials() const;
  /// Number of bodies that made these trials.
  [[nodiscard]] std::int64_t bodies() const;
};

/// A group of trials: numbers group, group + of, group + 2 of, ... of every start. If bodies made
/// several trials each: all trials of bodies number group, group + of, ...
struct TrialGroup {
  std::int64_t group = 0, of = 1;
  [[nodiscard]] bool holds(const FieldTrials& trials, std::int64_t trial) const {
    return (trials.bodies.empty() ? trial : trials.bodies[static_cast<std::size_t>(trial)]) % of ==
           group;
  }
};

}  // namespace gatewalk::lattice
