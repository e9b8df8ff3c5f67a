// SPDX-License-Identifier: MIT
#pragma once
/// Helpers that the readers of tracks share. Not part of the installed headers.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lattice/recorded/tracks.h"
#include "lattice/text/table.h"

namespace gatewalk::lattice {

/// True if `number` can be a frame number: a whole number, up to 1e12 in size.
[[nodiscard]] bool is_frame(double number);

/// `"text"`, shortened for a message.
[[nodiscard]] std::string in_quotes(const std::string& text);

/// Collects what neither the file nor the user says, and refuses it with all missing options named.
class Lacking {
 public:
  explicit Lacking(std::string path) : path_(std::move(path)) {}
  void add(const std::string& what, const std::string& option) {
    text_ += (text_.empty() ? "" : "; ") + what + ": " + option;
  }
  /// Throws std::invalid_argument if anything is missing.
  void refuse() const;

 private:
  std::string path_, text_;
};

/// Throws std::invalid_argument for an option that this kind of file does not use.
void refuse_unused(bool given, const std::string& path, const std::string& option,
                   const std::string& why);

/// Index of the key point asked for, or of the only one, which a remark then names. Throws
/// std::invalid_argument naming all `names`.
[[nodiscard]] std::size_t key_point_in(const std::vector<std::string>& names, TrackFile& file,
                                       const TrackOptions& options);

/// Adds places to tracks, and sorts out invalid ones.
class TrackMaker {
 public:
  /// `file`: its metres_per_unit must be known.
  TrackMaker(TrackFile& file, const TrackOptions& options) : file_(file), options_(options) {}
  /// Adds a place: `x` and `y` in the file's unit, NaN if there is none; `confidence` if it is
  /// known.
  void add(Track& track, double time, double x, double y, std::optional<double> confidence);

 private:
  TrackFile& file_;
  const TrackOptions& options_;
};

/// Time from each frame in which a body was seen to its next one, for all tracks, s.
[[nodiscard]] std::vector<double> steps_of(const TrackFile& file);
/// The frame interval of files whose frames have times: the median step of all tracks, s, which a
/// remark names.
[[nodiscard]] double median_step(TrackFile& file);
/// Throws std::invalid_argument if most steps of the times (s) are not whole numbers of frames at
/// `fps`; `fps_words` and `time_words` name both.
void require_steps(std::vector<double> steps, const std::string& source, double fps,
                   const std::string& fps_words, const std::string& time_words);

/// Reads a table of the columns that the options name, or one of DeepLabCut.
[[nodiscard]] TrackFile read_track_table(const std::string& path, const TrackOptions& options);
/// True if the line is the first of a table that DeepLabCut, or a compatible program, wrote.
[[nodiscard]] bool is_of_deeplabcut(const Table::Names& line);
/// Leaves out places that a tracker wrote while it had lost its body, and counts them, with a
/// warning. These are: the same place for more frames than noise explains, followed by another
/// place (the first frame is kept); and (0, 0) of the file, for as many frames or far from the
/// places before and after.
void leave_out_lost(TrackFile& file, const TrackOptions& options);

[[nodiscard]] TrackFile read_deeplabcut(Table& table, const TrackOptions& options);
[[nodiscard]] TrackFile read_movement(const std::string& path, const TrackOptions& options);

}  // namespace gatewalk::lattice
