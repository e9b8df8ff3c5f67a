// SPDX-License-Identifier: MIT
#pragma once
/// What tracks show of single cells, as tables: each visit of a body, and how often and after how
/// long bodies went from one cell to another.

#include <string>

#include "lattice/recorded/cut_tracks.h"

namespace gatewalk::lattice {

/// A line for each passage, by body and time: body, trial, column, row, type (if cells have types),
/// in (face), entered_s (time in the track), out (face of the next cell, trapped or lost), time_s
/// (the dwell time; of the lost until then).
[[nodiscard]] std::string visits_csv(const CutTracks& cut, const TrackFile& file,
                                     const CellFile& cell);

/// A line for each cell and way out of it, by row, column and way: column, row, out, to_column,
/// to_row (of the next cell, in the lattice or not; empty for the trapped and lost), count, mean_s
/// (mean dwell time), share (of the cell's passages that were not lost; empty for the lost).
[[nodiscard]] std::string transitions_csv(const CutTracks& cut, const CellFile& cell);

}  // namespace gatewalk::lattice
