// SPDX-License-Identifier: MIT
#pragma once
/// Tracks from a lab: places of bodies, frame by frame, from a table with any columns, DeepLabCut's
/// CSV, or the NetCDF of movement. What a file does not say must be given as an option; nothing is
/// guessed.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace gatewalk::lattice {

/// What the user states about a file of tracks.
struct TrackOptions {
  /// The columns of a table with one place per line, by the names in the file:
  /// "body=TRACK_ID,frame=FRAME,x=POSITION_X,y=POSITION_Y"; with time= (s, unless the file states
  /// another unit) instead of frame=, and confidence=. Without body= there is a single body, or one
  /// body per set of columns whose names have a * for the body's: "frame=f,x=x*,y=y*".
  std::string columns{};
  std::optional<double> fps{};  // frames per second
  /// Unit of the file's x and y in m; if missing, the file must state it.
  std::optional<double> metres_per_unit{};
  std::optional<double> confidence{};     // places with less confidence are ignored
  std::string key_point{};                // for bodies with several key points
  double origin_x = 0.0, origin_y = 0.0;  // of the lattice, in the file's unit
  bool y_down = false;                    // y points down in the file, as in a picture
};

/// A body's places in the frames in which it was seen.
struct Track {
  std::string body;
  std::vector<double> time;  // s, ascending
  std::vector<double> x, y;  // m, from the lattice's origin
};

/// A number of 56 bits for the name of a body, different for nearly all names (FNV-1a): random
/// numbers and samples that it keys do not depend on the order of bodies in a file.
[[nodiscard]] std::uint64_t number_of_name(const std::string& name);

/// A file of tracks in SI units, with counts of what was left out.
struct TrackFile {
  std::string source, kind;          // the file's name; "a table", "DeepLabCut" or "movement"
  std::vector<Track> tracks;         // in the order of the file
  double interval = 0.0;             // s, from frame to frame
  double metres_per_unit = 0.0;      // unit of the file's places, m
  std::int64_t places = 0;           // lines (or frames) of all bodies, with or without a place
  std::int64_t no_place = 0;         // places that are not numbers
  std::int64_t unsure = 0;           // places with less confidence than asked for
  std::int64_t no_body = 0;          // lines without a body, left out
  std::int64_t repeated = 0;         // places repeated for more frames than noise explains
  std::int64_t at_zero = 0;          // places at (0, 0) of the file, where no body was
  std::int64_t unit_rows = 0;        // rows of descriptions and units, left out
  std::vector<std::string> remarks;  // how the file was read, one sentence each
  std::vector<std::string> warnings;
  bool y_down = false;  // as in TrackOptions
};

/// Reads a file, whose kind its first bytes show. Places that a tracker wrote while it had lost its
/// body are left out. Throws std::invalid_argument naming file, line and column, or the option that
/// states what the file does not.
[[nodiscard]] TrackFile read_tracks(const std::string& path, const TrackOptions& options);
/// Reads several recordings. Bodies are named by file: "a/1" is body 1 of a.csv.
[[nodiscard]] TrackFile read_tracks(const std::vector<std::string>& paths,
                                    const TrackOptions& options);

}  // namespace gatewalk::lattice
