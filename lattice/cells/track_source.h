// SPDX-License-Identifier: MIT
#pragma once
/// What the readers of tracks share. Not part of the installed headers.

#include <istream>
#include <string>
#include <string_view>
#include <vector>

#include "lattice/cells/tracks.h"

namespace gatewalk::lattice {

/// A number; NaN for a field that says nothing, or infinity; none for anything else.
[[nodiscard]] std::optional<double> coordinate_in(std::string_view text);

/// Whether it can be the number of a frame: a whole one, up to 1e12.
[[nodiscard]] bool is_frame(double number);

/// `"text"`, fit for a message.
[[nodiscard]] std::string in_quotes(const std::string& text);

/// The next line; false at the end. Throws std::invalid_argument where the file cannot be read on.
[[nodiscard]] bool next_line_of(std::istream& in, const std::string& path, std::string& text);

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

/// Where frames have times of their own: the interval that most steps of all tracks have (their
/// median), which is said.
[[nodiscard]] double median_step(TrackFile& file);
/// Throws std::invalid_argument where most steps of the times (s) are no whole number of the frames
/// that `fps` means; `fps_words` and `time_words` name both.
void require_steps(std::vector<double> steps, const std::string& source, double fps,
                   const std::string& fps_words, const std::string& time_words);

[[nodiscard]] TrackFile read_deeplabcut(const std::string& path, const TrackOptions& options);
[[nodiscard]] TrackFile read_movement(const std::string& path, const TrackOptions& options);

}  // namespace gatewalk::lattice
