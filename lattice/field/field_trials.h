// SPDX-License-Identifier: MIT
#pragma once
/// The reference: trials of bodies through the field, cell by cell, written plainly.

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

/// Moves from cell to cell, by the face that is entered.
using FaceCounts = std::array<std::int64_t, dynamics::kMostFaces>;

/// Counts of trials through the field. None ends `unsampled`: only walks of a chain do. Tallies add
/// in any order.
struct FieldTally : markov::Ends<std::int64_t> {
  std::int64_t trials = 0;
  dynamics::TrialSet held;  // which
  FaceCounts entries{};     // of the moves inside the field
  FaceCounts clamped{};     // of these, outside every bin, if that was asked for
  dynamics::Health health;  // over all passages

  explicit FieldTally(const FieldParams& f) {
    final_cells = markov::CellCounts::Zero(f.rows, f.columns);
  }
  /// Trials with a run that stopped being finite: they have a final cell, and no ending.
  [[nodiscard]] std::int64_t broken() const;
  /// Counts trials by the gate in which each ended (row * columns + column), and how.
  void count(const std::vector<std::int32_t>& gates,
             const std::vector<std::optional<markov::Ending>>& how);
  /// Throws std::invalid_argument, and changes nothing, when a trial would be counted twice.
  FieldTally& operator+=(const FieldTally& other);
};

/// What each trial did, in the order of their numbers.
struct FieldTrials {
  // All three are empty where trials were not run in the field at hand: it is not known where and
  // how they would end there.
  std::vector<std::int32_t> final_gates{};               // row * columns + column
  std::vector<std::optional<markov::Ending>> endings{};  // none: a run stopped being finite
  std::vector<dynamics::Costs> costs{};                  // of all its runs together
  /// Number of the body that made each trial, where one made several: they go together when trials
  /// are taken in groups. Empty: each has its own.
  std::vector<std::int32_t> bodies{};
  bool keep_passages = false;
  PassageTable passages{};             // of all trials, if kept, ...
  std::vector<std::int64_t> passed{};  // ... and how many of them each trial and those before
                                       // it have
  /// Passages of trial number `at` in this order, from the first cell on.
  [[nodiscard]] PassageTable::Rows of_trial(std::size_t at) const {
    return passages.rows(static_cast<std::size_t>(at == 0 ? 0 : passed[at - 1]),
                         static_cast<std::size_t>(passed[at]));
  }
  /// Those into cells that trials then ran through, in their order.
  [[nodiscard]] std::vector<dynamics::Entry> entries() const;
  /// All those of others, with their passages if these keep any. Where the endings of one of both
  /// are not known, none are.
  void append(const FieldTrials& more);
  /// One of them.
  void append(const FieldTrials& from, std::size_t at);

 private:
  /// Whether endings stay known with trials of `more`; else those of these are forgotten.
  [[nodiscard]] bool keep_endings_with(const FieldTrials& more);
};

/// What becomes of what a body carries when it enters the next cell (dynamics::Carried): it is
/// kept, as in the model, or dropped: bodies without memory from cell to cell.
enum class Memory : std::uint8_t { kept, dropped };

/// Where a body is in a field, how many cells it has been carried through, and the trial's number.
struct Place {
  std::int32_t column = 0, row = 0, passed = 0;
  std::int64_t trial = 0;
};
/// A type of cells, for a body that enters there so.
using CellChoice = std::function<int(const Place& place, const dynamics::Entry& entry)>;
/// Where a trial begins, in the first row.
struct TrialStart {
  std::int32_t column = 0;
  dynamics::Entry entry{};
};
using StartOfTrial = std::function<TrialStart(std::int64_t trial)>;
/// Which of a field's types of cells a body meets that enters there, where its map does not say,
/// and where trials begin.
struct TypeChoice {
  dynamics::Entry start{};
  CellChoice type{};    // empty: the map's
  StartOfTrial from{};  // empty: all by `start`, in the field's start column
};

/// Puts the body of trial number i of a range, from 0, there, as it enters its first cell.
using BeginTrial = std::function<void(std::int64_t i, dynamics::Body& body)>;

/// Runs trials `range` through the field, in which each cell is fresh whenever a body enters, and
/// may be entered again. Trials in cells of one type are run together. `space` only counts what its
/// bins would have clamped. What each trial did is appended to `each`, if given. On all threads of
/// the current TBB arena, same result for any number of them. Throws std::invalid_argument where
/// the cells' map is not of this field, or has no cells to run, and for a `choice` of none of them,
/// or of columns that there are not.
[[nodiscard]] FieldTally run_field(const dynamics::CellField& cells, const FieldParams& field,
                                   const BeginTrial& begin, dynamics::TrialRange range,
                                   FieldTrials* each = nullptr,
                                   const dynamics::StateSpace* space = nullptr,
                                   Memory memory = Memory::kept, const TypeChoice& choice = {});
/// The same from one start.
[[nodiscard]] FieldTally run_field(const dynamics::CellField& cells, const FieldParams& field,
                                   const dynamics::Entry& start, std::uint64_t seed,
                                   dynamics::TrialRange range, FieldTrials* each = nullptr,
                                   const dynamics::StateSpace* space = nullptr,
                                   Memory memory = Memory::kept);

}  // namespace gatewalk::lattice
