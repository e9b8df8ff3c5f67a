// SPDX-License-Identifier: MIT
#pragma once
/// Trials that are still under way in the field, and the form in which finished trials are kept.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/cells/cell.h"
#include "lattice/field/field_params.h"
#include "lattice/field/field_trials.h"
#include "lattice/field/passage_table.h"
#include "markov/chain.h"

namespace gatewalk::lattice {

/// A tally of trials, and what each trial did.
struct RunTrials {
  FieldTally tally;
  FieldTrials each;
};
/// Throws std::runtime_error if a piece that was read does not form whole trials.
void require_whole(const RunTrials& piece, const std::vector<std::uint8_t>& endings,
                   std::uint8_t broken);
/// Writes or reads trials as part of a kept piece of work (dynamics/base/bytes.h).
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

/// Prepares the body of a trial that enters `cell` by `start`. The stream {seed, stream_of(start),
/// trial} is the trial's noise.
void begin_trial(const dynamics::Cell& cell, const dynamics::Entry& start, std::uint64_t seed,
                 std::int64_t trial, dynamics::Body& body);

/// Throws std::invalid_argument if there are no cells to run.
void require_cells(const dynamics::CellField& cells);

/// The exit to which a passage through a cell of this section leads, in the form markov::follow
/// takes.
[[nodiscard]] markov::Exit exit_of(const dynamics::Section& section, dynamics::Fate fate,
                                   const dynamics::Entry& next);

/// One trial on its way through the field, independent of what carries its body.
class RunningTrial {
 public:
  RunningTrial(std::int32_t column, std::int32_t row) : column_(column), row_(row) {}
  explicit RunningTrial(const FieldParams& field)
      : RunningTrial(field.start_column(), field.start_row) {}

  /// Adds a passage through the trial's current cell, which is of type `type`. Returns the entry
  /// into the next cell, or nullopt if the trial ends here. `keep_passages` keeps the passage.
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

  /// The body, while the trial waits for cells of another type.
  std::unique_ptr<dynamics::Body> waiting;

 private:
  std::optional<markov::Ending> ending_;  // none: a passage broke, or the trial goes on
  std::int32_t column_, row_;
  int cells_ = 0;  // cells visited
  dynamics::Costs costs_{};
  PassageTable passages_;
};

/// The tally of finished trials; `each`, if given, gets what each trial did.
[[nodiscard]] FieldTally tally_of(const std::vector<RunningTrial>& trials,
                                  const dynamics::CellMap& map, const FieldParams& field,
                                  dynamics::TrialRange range, FieldTrials* each);

}  // namespace gatewalk::lattice
