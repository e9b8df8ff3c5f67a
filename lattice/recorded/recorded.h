// SPDX-License-Identifier: MIT
#pragma once
/// runs.csv: a table of passages of bodies through cells, recorded or simulated elsewhere, one per
/// line (format: cli/site/reference/files.md). Reads and writes such tables.

#include <array>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "lattice/field/passage_table.h"
#include "lattice/scene/cell_file.h"

namespace gatewalk::lattice {

/// A body's way from cell to cell.
struct RecordedTrial {
  dynamics::Entry start{};            // into the first cell
  std::int32_t body = 0;              // index into RecordedRuns::bodies
  std::int64_t first = 0, count = 0;  // the trial's passages
};

/// Recorded runs: bodies, trials and passages.
struct RecordedRuns {
  std::vector<std::string> bodies;    // names, in the order of first occurrence
  std::vector<RecordedTrial> trials;  // in the order of the file
  PassageTable passages;              // of all trials, one trial after the other
  /// Passages that ended so; in all others the body left its cell.
  std::int64_t trapped = 0, lost = 0;
  /// By Section::costs: passages that were not lost, but whose cost is unknown (NaN).
  std::array<std::int64_t, dynamics::kMostCosts> unknown{};
  std::vector<std::string> remarks{};  // how a file was read that is not plain CSV

  [[nodiscard]] PassageTable::Rows of_trial(const RecordedTrial& trial) const {
    return passages.rows(static_cast<std::size_t>(trial.first),
                         static_cast<std::size_t>(trial.first + trial.count));
  }
};

/// All passages, each with the entry into its cell.
[[nodiscard]] std::vector<EnteredPassage> entered_passages(const RecordedRuns& runs);

/// True if the table at `path` has all these columns; false for anything but a regular file.
[[nodiscard]] bool has_columns(const std::string& path,
                               std::initializer_list<std::string_view> columns);

/// Which cost columns a table must have, besides the time: all of the cells' costs, or only those
/// that it has; missing ones are unknown (NaN).
enum class CostColumns : std::uint8_t { all, as_there_are };

/// Reads a table (lattice/text/table.h) at `path` (-: standard input). Coordinates of `cells`
/// without a scale get the standard deviation of all entries (1 if they are all equal). Throws
/// std::invalid_argument naming file, line, column and what is allowed.
[[nodiscard]] RecordedRuns read_runs(const std::string& path, CellFile& cells,
                                     CostColumns costs = CostColumns::all);

/// The name of a body as a field of a table, in quotes where it needs them. Throws
/// std::invalid_argument for a name without letters or with line ends.
[[nodiscard]] std::string body_field(const std::string& text);

/// Writes a table that read_runs reads back the same; each body's trials are numbered from 1.
/// Throws std::invalid_argument for passages that read_runs would refuse, std::runtime_error if
/// `path` cannot be written (markov::replace_file).
void write_runs(const std::string& path, const CellFile& cells, const RecordedRuns& runs);

}  // namespace gatewalk::lattice
