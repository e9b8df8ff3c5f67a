// SPDX-License-Identifier: MIT
#pragma once
/// runs.csv: passages of bodies through cells, recorded or carried out elsewhere, a line each
/// (README.md beside it has the format); as a table, and back.

#include <array>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "lattice/field/passage_table.h"
#include "lattice/scene/cell_file.h"

namespace gatewalk::lattice {

/// One way of a body from cell to cell.
struct RecordedTrial {
  dynamics::Entry start{};            // into the first cell
  std::int32_t body = 0;              // of RecordedRuns::bodies
  std::int64_t first = 0, count = 0;  // which passages are its own
};

struct RecordedRuns {
  std::vector<std::string> bodies;     // names, in the order in which they first come
  std::vector<RecordedTrial> trials;   // in the order of the file
  PassageTable passages;               // of all trials, one after the other
  std::int64_t trapped = 0, lost = 0;  // passages that ended so; all others left their cell
  /// By Section::costs: passages that were not lost and of which it is not known (NaN).
  std::array<std::int64_t, dynamics::kMostCosts> unknown{};
  std::vector<std::string> remarks{};  // what was understood of a file that is not plain CSV

  [[nodiscard]] PassageTable::Rows of_trial(const RecordedTrial& trial) const {
    return passages.rows(static_cast<std::size_t>(trial.first),
                         static_cast<std::size_t>(trial.first + trial.count));
  }
};

/// All passages, each with the entry by which it began.
[[nodiscard]] std::vector<EnteredPassage> entered_passages(const RecordedRuns& runs);

/// Whether a table has all these columns; false for what is no regular file.
[[nodiscard]] bool has_columns(const std::string& path,
                               std::initializer_list<std::string_view> columns);

/// Costs but the time that a table must have a column of: all of the cells, or none; without one
/// they are not known.
enum class CostColumns : std::uint8_t { all, as_there_are };

/// Reads a table (lattice/text/table.h) at `path` (-: standard input). Coordinates of `cells`
/// without a scale get the standard deviation of all entries (1 where all are the same). Throws
/// std::invalid_argument naming file, line, column and what is allowed.
[[nodiscard]] RecordedRuns read_runs(const std::string& path, CellFile& cells,
                                     CostColumns costs = CostColumns::all);

/// Writes what reads back the same; trials of a body get numbers from 1. Throws
/// std::invalid_argument for passages that read_runs would refuse, std::runtime_error when `path`
/// cannot be written (markov::replace_file).
void write_runs(const std::string& path, const CellFile& cells, const RecordedRuns& runs);

}  // namespace gatewalk::lattice
