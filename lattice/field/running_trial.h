// SPDX-License-Identifier: MIT
#pragma once
/// Trials on their way through the field, and as they are kept.

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

/// The body of a trial from this entry into `cell`: its noise is the stream {seed,
/// stream_of(start), trial}.
void begin_trial(const dynamics::Cell& cell, const dynamics::Entry& start, std::uint64_t seed,
                 std::int64_t trial, dynamics::Body& body);

/// Throws std::invalid_argument where there are no cells to run.
void require_cells(const dynamics::CellField& cells);

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
