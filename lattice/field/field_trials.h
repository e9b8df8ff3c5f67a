// SPDX-License-Identifier: MIT
#pragma once
/// The reference: trials of bodies through the field, cell by cell, written plainly.

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "dynamics/base/trial_set.h"
#include "dynamics/cells/cell.h"
#include "dynamics/cells/state_space.h"
#include "lattice/field/field_params.h"
#include "lattice/field/passage_table.h"
#include "markov/walk.h"

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

/// Trials, and what each did.
struct RunTrials {
  FieldTally tally;
  FieldTrials each;
};
/// Throws std::runtime_error for a piece that was read and that no trials make.
void require_whole(const RunTrials& piece, const std::vector<std::uint8_t>& endings,
                   std::uint8_t broken);
/// As a piece is kept (dynamics/base/bytes.h).
template <class Archive>
void each_part(Archive& archive, RunTrials& piece) {
  auto& [tally, each] = piece;
  constexpr std::uint8_t kBroken = 255;
  std::vector<std::uint8_t> endings;
  for (const auto& ending : each.endings)
    endings.push_back(ending ? static_cast<std::uint8_t>(*ending) : kBroken);
  archive(each.final_gates, endings, each.costs, each.passages, each.passed, tally.held,
          tally.entries, tally.clamped, tally.health);
  if constexpr (Archive::reads) {
    require_whole(piece, endings, kBroken);
    for (const std::uint8_t read : endings) {
      auto& ending = each.endings.emplace_back();
      if (read != kBroken) ending = static_cast<markov::Ending>(read);
    }
    tally.count(each.final_gates, each.endings);
  }
}

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

/// The body of a trial from this entry into `cell`: its noise is the stream {seed,
/// stream_of(start), trial}.
void begin_trial(const dynamics::Cell& cell, const dynamics::Entry& start, std::uint64_t seed,
                 std::int64_t trial, dynamics::Body& body);

/// Throws std::invalid_argument where there are no cells to run.
void require_cells(const dynamics::CellField& cells);

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

/// Where a passage through a cell of this section leads, as markov::follow takes it.
[[nodiscard]] markov::Exit exit_of(const dynamics::Section& section, dynamics::Fate fate,
                                   const dynamics::Entry& next);

/// One trial on its way through the field, whoever carries its body.
class RunningTrial {
 public:
  explicit RunningTrial(std::int32_t start_column) : column_(start_column) {}

  /// Takes a passage through the cell where the trial is, of this type. The entry into the next
  /// cell; none when the trial ends here. Passages are kept if asked for.
  [[nodiscard]] std::optional<dynamics::Entry> follow(const dynamics::CellMap& map,
                                                      const FieldParams& field,
                                                      const dynamics::Passage& passage,
                                                      bool keep_passages, int type);
  [[nodiscard]] std::optional<dynamics::Entry> follow(const dynamics::CellMap& map,
                                                      const FieldParams& field,
                                                      const dynamics::Passage& passage,
                                                      bool keep_passages) {
    return follow(map, field, passage, keep_passages, map.type_of(column_, row_));
  }
  void add_to(FieldTrials& each, const FieldParams& field) const;

  [[nodiscard]] std::int32_t column() const { return column_; }
  [[nodiscard]] std::int32_t row() const { return row_; }
  [[nodiscard]] std::int32_t passed() const { return cells_; }
  [[nodiscard]] const std::optional<markov::Ending>& ending() const { return ending_; }

  /// The body, while it waits for cells of another type.
  std::unique_ptr<dynamics::Body> waiting;

 private:
  std::optional<markov::Ending> ending_;  // none: a passage broke
  std::int32_t column_, row_ = 0;
  int cells_ = 0;  // visited
  dynamics::Costs costs_{};
  PassageTable passages_;
};

/// The tally of trials that have ended, and `each` of them.
[[nodiscard]] FieldTally tally_of(const std::vector<RunningTrial>& trials,
                                  const dynamics::CellMap& map, const FieldParams& field,
                                  dynamics::TrialRange range, FieldTrials* each);

}  // namespace gatewalk::lattice
