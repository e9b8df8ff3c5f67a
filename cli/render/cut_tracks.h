// SPDX-License-Identifier: MIT
#pragma once
/// Tracks cut into passages: as a table, as JSON, and a picture.

#include <string>

#include "cli/render/figure.h"
#include "cli/render/json_fwd.h"
#include "lattice/cells/cut_tracks.h"

namespace gatewalk::cli {

[[nodiscard]] std::string table_of(const lattice::CutTracks& cut, const lattice::TrackFile& file,
                                   const lattice::CellFile& cell);

/// Lengths in m, times in s, shares of 1.
[[nodiscard]] Json to_json(const lattice::CutTracks& cut, const lattice::TrackFile& file,
                           const lattice::CellFile& cell);

/// All tracks over the cells, with the places where they were cut.
[[nodiscard]] Figure figure_of(const lattice::CutTracks& cut, const lattice::CellFile& cell);

}  // namespace gatewalk::cli
