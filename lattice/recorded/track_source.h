// SPDX-License-Identifier: MIT
#pragma once
/// What the readers of tracks share. Not part of the installed headers.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lattice/recorded/tracks.h"
#include "lattice/text/table.h"

namespace gatewalk::lattice {

/// Whether it can be the number of a frame: a whole one, up to 1e12.
[[nodiscard]] bool is_frame(double number);

/// `"text"`, fit for a message.
[[nodiscard]] std::string in_quotes(const std::string& text);

/// Refuses what the file does not say and the user did not: names all options that are missing.
class Lacking {
 public:
  explicit Lacking(std::string path) : path_(std::move(path)) {}
  void add(const std::string& what, const std::string& option) {
    text_ += (text_.empty() ? "" : "; ") + what + ": " + option;
  }
  /// Throws std::invalid_argument unless nothing is lacking.
  void refuse() const;

 private:
  std::string path_, text_;
};

/// Throws std::invalid_argument for an option that this kind of file makes no use of.
void refuse_unused(bool given, const std::string& path, const std::string& option,
                   const std::string& why);

/// Which of `names` was meant: the one asked for, or the only one, which is said. Throws
/// std::invalid_argument naming them.
[[nodiscard]] std::size_t key_point_in(const std::vector<std::string>& names, TrackFile& file,
                                       const TrackOptions& options);

/// Sorts out places as they come, one frame of one body after the other.
class TrackMaker {
 public:
  /// Of a file whose metres_per_unit is known.
  TrackMaker(TrackFile& file, const TrackOptions& options) : file_(file), options_(options) {}
  /// `x` and `y` in the file's unit, NaN where there is none; `confidence` too, if it is known.
  void add(Track& track, double time, double x, double y, std::optional<double> confidence);

 private:
  TrackFile& file_;
  const TrackOptions& options_;
};

/// Of all tracks, from a frame in which a body was seen to its next one, s.
[[nodiscard]] std::vector<double> steps_of(const TrackFile& file);
/// Where frames have times of their own: the interval that most steps of all tracks have (their
/// median), which is said.
[[nodiscard]] double median_step(TrackFile& file);
/// Throws std::invalid_argument where most steps of the times (s) are no whole number of the frames
/// that `fps` means; `fps_words` and `time_words` name both.
void require_steps(std::vector<double> steps, const std::string& source, double fps,
                   const std::string& fps_words, const std::string& time_words);

/// A table of the columns that the options name, or one of DeepLabCut.
[[nodiscard]] TrackFile read_track_table(const std::string& path, const TrackOptions& options);
/// Whether a line is the first of a table of DeepLabCut, or of what writes like it.
[[nodiscard]] bool is_of_deeplabcut(const Table::Names& line);
/// Leaves out places that a tracker wrote in frames in which it had lost its body: the same one
/// again, for more frames than the noise of places allows, until the body is elsewhere, but for the
/// first of them; and (0, 0) of the file, for as many frames or far from those before and behind.
/// Counts them, with a warning.
void leave_out_lost(TrackFile& file, const TrackOptions& options);

[[nodiscard]] TrackFile read_deeplabcut(Table& table, const TrackOptions& options);
[[nodiscard]] TrackFile read_movement(const std::string& path, const TrackOptions& options);

}  // namespace gatewalk::lattice
