// SPDX-License-Identifier: MIT
#pragma once
/// Tracks cut at the borders of cells into passages.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/cells/section.h"
#include "lattice/recorded/local_fit.h"
#include "lattice/recorded/recorded.h"
#include "lattice/recorded/tracks.h"
#include "lattice/scene/cell_file.h"

namespace gatewalk::lattice {

struct CutOptions {
  double fastest = 0.0;  // m/s; a step that is faster is a jump to another place, or another body
  std::string window{};  // of the local fits: "15" (frames), "0.125s"; empty: as noise_of finds it
  int bridge = 0;        // so many frames may be missing without a gap
  int columns = 0, rows = 0;  // of the lattice, from its origin; 0: the field of the cell file
  bool endless = false;       // the lattice has no end, to any side
};

/// What became of a body in a cell; lost: from sight.
enum class CutEnd : std::uint8_t { left, trapped, lost };
/// By what it was lost.
enum class LostBy : std::uint8_t { gap, jump, end };
inline constexpr std::array<std::string_view, 3> kLostNames{"gap", "jump", "end of the track"};

/// A body's way through one cell, from where it was seen to enter.
struct CutPassage {
  std::size_t track = 0;
  int trial = 0;  // of its body, from 1
  int type = 0;   // of cell
  CutEnd end = CutEnd::lost;
  LostBy lost_by = LostBy::end;
  dynamics::Entry in{}, out{};         // `out` where it left: into the next cell
  double time = 0.0;                   // s
  std::array<double, 2> from{}, to{};  // m, where it entered and was last in the cell
};

struct CutTracks {
  std::vector<CutPassage> passages;  // by track and time
  TrackNoise noise;
  double crossing_velocity_noise = 0.0;  // m/s, root mean square over the crossings
  double hysteresis = 0.0;               // m: who is not further over a border has not crossed it
  int columns = 0, rows = 0;             // of the lattice; 0: without end
  std::vector<TrackPiece> pieces;        // of the file that was cut, which must stay where it is
  std::int64_t gaps = 0, jumps = 0;
  std::int64_t short_pieces = 0, short_frames = 0;  // too short for a fit, left out
  std::int64_t trials = 0, crossings = 0;
  std::int64_t uncounted = 0;    // crossings to and fro within the hysteresis
  std::int64_t first_stays = 0;  // in cells that nobody saw entered
  std::int64_t places_outside = 0, bodies_outside = 0;  // of the lattice; bodies never seen in it
  std::int64_t came_back = 0;   // trials that begin where a body comes into the lattice again
  std::int64_t moved_ends = 0;  // places beyond their face's end, by no more than the hysteresis
  double fastest_step = 0.0;    // m/s, of those that are no jumps
  std::vector<std::string> doubts;  // what is likely to be wrong with the options, in words

  [[nodiscard]] std::int64_t count(CutEnd end) const;
  [[nodiscard]] std::int64_t lost(LostBy by) const;
};

/// What can be measured of an entry: s (m, along the face from its middle, as x or y grows), vx,
/// vy, speed (m/s), heading (rad, 0 upwards, from +y towards +x). Throws std::invalid_argument
/// naming faces, coordinates, units or mirror images of `cell` that tracks cannot have.
void require_measurable(const CellFile& cell);

/// Cells are rectangles of `cell`, side by side from the tracks' origin: column and row 0 begin
/// there, and what lies outside the lattice is no cell. A trial begins where a body is first seen
/// to cross a border into a cell, and ends where it leaves the lattice, is trapped
/// (CellFile::trapped_after), or is lost: in a gap, by a jump, or at the track's end. A body that
/// comes back into the lattice begins another trial there. Throws std::invalid_argument for options
/// that make no sense with these tracks, a lattice that nobody gave, a crossing by a move that no
/// face has, and where nobody crosses any border.
[[nodiscard]] CutTracks cut_tracks(const TrackFile& file, const CellFile& cell,
                                   const CutOptions& options);

/// The passages as recorded runs. What else a passage takes is not known of tracks.
[[nodiscard]] RecordedRuns recorded_runs(const CutTracks& cut, const TrackFile& file,
                                         const CellFile& cell);

}  // namespace gatewalk::lattice
