// SPDX-License-Identifier: MIT
#pragma once
/// Tracks from a lab: where bodies were seen, frame by frame, from a table of any columns,
/// DeepLabCut's CSV or the NetCDF of movement. What a file does not say is asked for, never
/// guessed.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace gatewalk::lattice {

/// What the user says of a file of tracks.
struct TrackOptions {
  /// Of a table with a line a place: "body=TRACK_ID,frame=FRAME,x=POSITION_X,y=POSITION_Y", by the
  /// names of the file's columns; time= (s, unless the file says another unit) in place of
  /// frame=, and confidence=.
  /// Without body= there is one body; or several, with columns for each, whose names have a * for
  /// the body's: "frame=f,x=x*,y=y*".
  std::string columns{};
  std::optional<double> fps{};              // frames per second
  std::optional<double> metres_per_unit{};  // of the file's x and y; none: the file must say it
  std::optional<double> confidence{};       // a place with less is none
  std::string key_point{};                  // of a body that has several
  double origin_x = 0.0, origin_y = 0.0;    // of the lattice, in the file's unit
  bool y_down = false;                      // y grows downwards in the file, as in a picture
};

/// A body's places, in the frames in which it was seen.
struct Track {
  std::string body;
  std::vector<double> time;  // s, rising
  std::vector<double> x, y;  // m, from the lattice's origin
};

struct TrackFile {
  std::string source, kind;          // the file; "a table", "DeepLabCut", "movement"
  std::vector<Track> tracks;         // in the order of the file
  double interval = 0.0;             // s, from frame to frame
  double metres_per_unit = 0.0;      // of the file's places
  std::int64_t places = 0;           // lines (or frames) of all bodies, seen there or not
  std::int64_t no_place = 0;         // of them without a number
  std::int64_t unsure = 0;           // of them with less confidence than asked for
  std::int64_t no_body = 0;          // lines of no body, left out
  std::int64_t repeated = 0;         // places that stand still for more frames than noise allows
  std::int64_t at_zero = 0;          // places that are (0, 0) of the file, where nobody was
  std::int64_t unit_rows = 0;        // rows of descriptions and units, left out
  std::vector<std::string> remarks;  // what was taken for what, in words
  std::vector<std::string> warnings;
  bool y_down = false;  // as TrackOptions
};

/// Reads a file of either kind, which it tells by its first bytes. Places that a tracker wrote
/// where it had lost its body are left out. Throws std::invalid_argument naming file, line and
/// column, or the option that says what the file does not.
[[nodiscard]] TrackFile read_tracks(const std::string& path, const TrackOptions& options);
/// The same of several recordings, whose bodies are told apart by file: "a/1" is body 1 of a.csv.
[[nodiscard]] TrackFile read_tracks(const std::vector<std::string>& paths,
                                    const TrackOptions& options);

}  // namespace gatewalk::lattice
