// SPDX-License-Identifier: MIT
#pragma once
/// Trials of the full dynamics through a field, cell by cell: the reference for the chain.

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/cells/cell.h"
#include "lattice/field/field_params.h"
#include "lattice/field/passage_table.h"
#include "markov/ends.h"

namespace gatewalk::dynamics {
class StateSpace;
}

namespace gatewalk::lattice {

/// Number of moves from cell to cell, by the face through which the body enters the next cell.
using FaceCounts = std::array<std::int64_t, dynamics::kMostFaces>;

/// Counts of trials through the field, by final gate and by ending. Tallies of different trials may
/// be added in any order. No trial ends `unsampled`: only walks of a chain do.
struct FieldTally : markov::Ends<std::int64_t> {
  std::int64_t trials = 0;
  dynamics::TrialSet held;  // numbers of the trials counted
  FaceCounts entries{};     // moves inside the field, by face
  FaceCounts clamped{};     // moves whose entry lies outside all bins; 0 without a state space
  dynamics::Health health;  // of all passages

  explicit FieldTally(const FieldParams& f) {
    final_cells = markov::CellCounts::Zero(f.rows, f.columns);
  }
  /// Trials with a broken passage (dynamics::Fate). Such a trial has a final cell but no ending.
  [[nodiscard]] std::int64_t broken() const;
  /// Adds one trial per element: `gates` has the final gate (row * columns + column), `how` the
  /// ending.
  void count(const std::vector<std::int32_t>& gates,
             const std::vector<std::optional<markov::Ending>>& how);
  /// Adds the trials of `other`. Throws std::invalid_argument, and changes nothing, if both tallies
  /// hold the same trial.
  FieldTally& operator+=(const FieldTally& other);
};

/// What each trial did, in the order of the trial numbers.
struct FieldTrials {
  // These three are empty for trials that were not run in this field: where and how such trials
  // would end here is unknown.
  std::vector<std::int32_t> final_gates{};               // row * columns + column
  std::vector<std::optional<markov::Ending>> endings{};  // none: a passage was broken
  std::vector<dynamics::Costs> costs{};                  // sums over all passages of the trial
  /// The number of the body that made each trial. Groups of trials keep all trials of a body
  /// together. Empty: each trial has a body of its own.
  std::vector<std::int32_t> bodies{};
  bool keep_passages = false;
  PassageTable passages{};             // of all trials, one trial after the other, if kept
  std::vector<std::int64_t> passed{};  // (trials) passages of this trial and of those before it
  /// Passages of the trial at index `at`, from its first cell on.
  [[nodiscard]] PassageTable::Rows of_trial(std::size_t at) const {
    return passages.rows(static_cast<std::size_t>(at == 0 ? 0 : passed[at - 1]),
                         static_cast<std::size_t>(passed[at]));
  }
  /// Entries into the second and all later cells of each trial, in order.
  [[nodiscard]] std::vector<dynamics::Entry> entries() const;
  /// Appends all trials of `more`, with their passages if keep_passages is set. If the endings of
  /// either side are unknown, final gates, endings and costs are cleared.
  void append(const FieldTrials& more);
  /// Appends the trial of `from` at index `at`, with its passages if keep_passages is set.
  void append(const FieldTrials& from, std::size_t at);

 private:
  /// Whether endings stay known once trials of `more` are appended; if not, clears final gates,
  /// endings and costs.
  [[nodiscard]] bool keep_endings_with(const FieldTrials& more);
};

/// Whether a body keeps its memory (dynamics::Carried) when it enters the next cell. `kept` is the
/// model; with `dropped` bodies have no memory from cell to cell.
enum class Memory : std::uint8_t { kept, dropped };

/// A body's cell in the field, the number of cells it has passed, and its trial's number.
struct Place {
  std::int32_t column = 0, row = 0, passed = 0;
  std::int64_t trial = 0;
};
/// Returns the index of the cell type that a body meets when it enters at `place` by `entry`.
using CellChoice = std::function<int(const Place& place, const dynamics::Entry& entry)>;
/// The column and the entry by which a trial begins in the field's start row.
struct TrialStart {
  std::int32_t column = 0;
  dynamics::Entry entry{};
};
using StartOfTrial = std::function<TrialStart(std::int64_t trial)>;
/// Which cell types bodies meet, instead of those of the field's map, and where trials begin.
struct TypeChoice {
  dynamics::Entry start{};
  CellChoice type{};    // empty: the map's types
  StartOfTrial from{};  // empty: all trials begin by `start`, in the field's start cell
};

/// Prepares `body` for trial number i of a range, counted from 0, as it enters its first cell.
using BeginTrial = std::function<void(std::int64_t i, dynamics::Body& body)>;

/// Runs trials `range` through the field on all threads of the current TBB arena; the result is the
/// same for any number of threads. A cell is fresh whenever a body enters, and may be entered
/// again. `each`, if given, gets what each trial did; `space` only counts entries outside its bins.
/// Throws std::invalid_argument if the cells' map does not fit the field or has no cells to run, or
/// if `choice` names a type or a column that does not exist.
[[nodiscard]] FieldTally run_field(const dynamics::CellField& cells, const FieldParams& field,
                                   const BeginTrial& begin, dynamics::TrialRange range,
                                   FieldTrials* each = nullptr,
                                   const dynamics::StateSpace* space = nullptr,
                                   Memory memory = Memory::kept, const TypeChoice& choice = {});
/// Runs trials `range` through the field from one start. `seed`, the start and the trial's number
/// determine a trial's noise.
[[nodiscard]] FieldTally run_field(const dynamics::CellField& cells, const FieldParams& field,
                                   const dynamics::Entry& start, std::uint64_t seed,
                                   dynamics::TrialRange range, FieldTrials* each = nullptr,
                                   const dynamics::StateSpace* space = nullptr,
                                   Memory memory = Memory::kept);

}  // namespace gatewalk::lattice
