// SPDX-License-Identifier: MIT
#pragma once
/// Cuts tracks at the borders of cells into passages.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/cells/section.h"
#include "lattice/recorded/recorded.h"
#include "lattice/recorded/smooth_path.h"
#include "lattice/recorded/tracks.h"
#include "lattice/scene/cell_file.h"

namespace gatewalk::lattice {

/// How tracks are cut.
struct CutOptions {
  double fastest = 0.0;  // m/s; a faster step is a jump to another place, or another body
  int bridge = 0;        // most missing frames in a row that are bridged
  /// Of the lattice, counted from its origin; 0: the field of the cell file.
  int columns = 0, rows = 0;
  bool endless = false;  // the lattice extends without end to all sides
};

/// What became of a body in a cell; lost: nobody saw.
enum class CutEnd : std::uint8_t { left, trapped, lost };
/// Why a body was lost.
enum class LostBy : std::uint8_t { gap, jump, wall, end };
inline constexpr std::array<std::string_view, 4> kLostNames{"gap", "jump", "wall",
                                                            "end of the track"};

/// A body's passage through one cell, from where the body was seen to enter.
struct CutPassage {
  std::size_t track = 0;
  int trial = 0;  // number among the body's trials, from 1
  int type = 0;   // of cell
  CutEnd end = CutEnd::lost;
  LostBy lost_by = LostBy::end;
  dynamics::Entry in{}, out{};  // `out`: entry into the next cell, if the body left
  int column = 0, row = 0;
  double entered = 0.0, time = 0.0;    // s, of the track when the body entered; how long it stayed
  std::array<double, 2> from{}, to{};  // m, where the body entered, and its last place in the cell
};

/// The passages cut from tracks, and what was left out.
struct CutTracks {
  std::vector<CutPassage> passages;  // by track, then by time
  TrackNoise noise;
  /// m and m/s, along each axis: standard deviation, given all measured places, of places (root
  /// mean square over frames) and of velocities (over crossings)
  double path_noise = 0.0, velocity_noise = 0.0;
  int columns = 0, rows = 0;       // of the lattice; 0: without end
  std::vector<TrackPiece> pieces;  // of the TrackFile that was cut, which must stay in memory
  std::int64_t gaps = 0, jumps = 0;
  std::int64_t short_pieces = 0, short_frames = 0;  // too short for a fit; left out
  std::int64_t trials = 0, crossings = 0;
  /// Crossings after which the path turns back before it is five of its standard deviations beyond
  /// the border: whether there was one is drawn by its probability.
  std::int64_t unsure_crossings = 0;
  std::int64_t places_put_back = 0;  // places beyond walls
  std::int64_t first_stays = 0;      // stays in cells that nobody saw entered
  /// Outside the lattice; bodies never seen inside.
  std::int64_t places_outside = 0, bodies_outside = 0;
  std::int64_t came_back = 0;       // trials that begin where a body comes back into the lattice
  std::int64_t moved_ends = 0;      // entries beyond the end of their face, moved to that end
  double fastest_step = 0.0;        // m/s, among steps that are no jumps
  std::vector<std::string> doubts;  // what is probably wrong with the options, one sentence each

  [[nodiscard]] std::int64_t count(CutEnd end) const;
  [[nodiscard]] std::int64_t lost(LostBy by) const;
  /// Nearly all passages were lost, or nearly all places lie outside the lattice: the options do
  /// not fit the file.
  [[nodiscard]] bool is_off() const;
  [[nodiscard]] bool is_mostly_outside() const;
  /// The number of passages whose track ends at most `distance` (m) from the outer border of a
  /// lattice with an end.
  [[nodiscard]] std::int64_t ended_at_outer_border(const CellFile& cell, double distance) const;
};

/// Throws std::invalid_argument naming faces, coordinates, units or mirror images of `cell` that
/// tracks cannot have. Tracks give the coordinates s (m, along the face from its middle, as x or y
/// grows), vx, vy, speed (m/s) and heading (rad, 0 upwards, from +y towards +x).
void require_measurable(const CellFile& cell);

/// Cuts tracks into passages. Cells are rectangles of `cell`, side by side from the tracks' origin,
/// where column and row 0 begin; there are no cells outside the lattice. Since places are noisy,
/// each track is replaced by a path drawn given all its places (drawn_path), the same in each call;
/// intervals from resampled bodies so contain the noise of tracks. A path does not cross the walls
/// of the cells' types (CellFile::walls): it is cut along the nearest way that crosses none. A
/// trial begins where a body is first seen to cross a border into a cell. It ends where the body
/// leaves the lattice, is trapped (CellFile::trapped_after), or is lost: in a gap, by a jump,
/// because it stays beyond walls, or at the track's end. A body that comes back into the lattice
/// begins another trial. Throws std::invalid_argument for options that do not fit these tracks, a
/// lattice that is not given, a crossing by a move that no face has, and tracks without any
/// crossing.
[[nodiscard]] CutTracks cut_tracks(const TrackFile& file, const CellFile& cell,
                                   const CutOptions& options);

/// The passages as recorded runs. Costs other than the time are unknown (NaN).
[[nodiscard]] RecordedRuns recorded_runs(const CutTracks& cut, const TrackFile& file,
                                         const CellFile& cell);

}  // namespace gatewalk::lattice
