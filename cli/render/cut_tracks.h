// SPDX-License-Identifier: MIT
#pragma once
/// Tracks cut into passages, as a result, a table and a figure.

#include <string>

#include "cli/fields/fields.h"
#include "cli/render/figure.h"
#include "cli/render/provenance.h"
#include "lattice/recorded/cut_tracks.h"

namespace gatewalk::cli {

/// The result of `passages`.
struct CutResult {
  lattice::TrackFile file;
  lattice::CellFile cell;
  lattice::CutTracks cut{};  // of the file, which must outlive this object
  Provenance made_by{};
};
void describe(Fields& out, const CutResult& result);
/// The first screen; and what --details adds to it.
[[nodiscard]] std::string answer_text(const CutResult& result);
[[nodiscard]] std::string details_text(const CutResult& result);

/// All tracks over the cells, with the places where tracks were cut.
[[nodiscard]] Figure figure_of(const lattice::CutTracks& cut, const lattice::CellFile& cell);

}  // namespace gatewalk::cli
