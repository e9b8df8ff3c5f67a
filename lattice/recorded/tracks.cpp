// SPDX-License-Identifier: MIT
#include "lattice/recorded/tracks.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "lattice/recorded/track_source.h"
#include "lattice/text/digits.h"
#include "lattice/text/toml_text.h"

namespace gatewalk::lattice {

std::string in_quotes(const std::string& text) { return '"' + printable(text) + '"'; }

bool is_frame(double number) {
  constexpr double kMost = 1e12;  // all these have different times in s
  return number == std::floor(number) && std::abs(number) <= kMost;
}

void Lacking::refuse() const {
  if (!text_.empty()) throw std::invalid_argument(path_ + " does not say " + text_);
}

void refuse_unused(bool given, const std::string& path, const std::string& option,
                   const std::string& why) {
  if (given) throw std::invalid_argument(path + ": " + option + " has no effect: " + why);
}

std::size_t key_point_in(const std::vector<std::string>& names, TrackFile& file,
                         const TrackOptions& options) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + printable(name);
  if (options.key_point.empty() && names.size() == 1) {
    file.remarks.push_back("the only key point, " + all);
    return 0;
  }
  if (options.key_point.empty())
    throw std::invalid_argument(file.source +
                                " does not say which of its key points is the body's place: "
                                "--key-point NAME, of " +
                                all);
  const auto found = std::find(names.begin(), names.end(), options.key_point);
  if (found == names.end())
    throw std::invalid_argument(file.source + ": --key-point " + printable(options.key_point) +
                                ": there are " + all);
  file.remarks.push_back("key point " + printable(options.key_point));
  return static_cast<std::size_t>(found - names.begin());
}

void TrackMaker::add(Track& track, double time, double x, double y,
                     std::optional<double> confidence) {
  ++file_.places;
  if (std::isnan(x) || std::isnan(y)) {
    ++file_.no_place;
  } else if (confidence && !(*confidence >= *options_.confidence)) {
    ++file_.unsure;
  } else {
    const double scale = file_.metres_per_unit;
    track.time.push_back(time);
    track.x.push_back(scale * (x - options_.origin_x));
    track.y.push_back(scale * (options_.y_down ? options_.origin_y - y : y - options_.origin_y));
  }
}

std::vector<double> steps_of(const TrackFile& file) {
  std::vector<double> steps;
  for (const Track& track : file.tracks)
    for (std::size_t i = 1; i < track.time.size(); ++i)
      steps.push_back(track.time[i] - track.time[i - 1]);
  return steps;
}

namespace {

double middle_of(std::vector<double> steps) {
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

}  // namespace

double median_step(TrackFile& file) {
  std::vector<double> steps = steps_of(file);
  if (steps.empty())
    throw std::invalid_argument(file.source + ": no body was seen twice, so there are no tracks");
  const double step = middle_of(std::move(steps));
  file.remarks.push_back("a frame every " + rounded(step) +
                         " s, the median step (--fps says otherwise)");
  return step;
}

void require_steps(std::vector<double> steps, const std::string& source, double fps,
                   const std::string& fps_words, const std::string& time_words) {
  constexpr double kOff = 0.1;  // of a frame: times are rounded, and cameras slightly uneven
  if (steps.empty()) return;
  const double step = middle_of(std::move(steps)), frames = step * fps;
  if (std::round(frames) >= 1.0 && std::abs(frames - std::round(frames)) <= kOff) return;
  throw std::invalid_argument(source + ": " + fps_words + " is a frame every " +
                              rounded(1.0 / fps) + " s, but " + time_words + " has steps of " +
                              rounded(step) + " s: one of both is wrong");
}

namespace {

void require_sensible(const TrackOptions& options) {
  const auto require = [](const std::optional<double>& value, const char* name, bool may_be_0) {
    if (value && !(std::isfinite(*value) && (may_be_0 ? *value >= 0.0 : *value > 0.0)))
      throw std::invalid_argument(std::string(name) + " " + shortest(*value) + ": must be " +
                                  (may_be_0 ? "0 or more" : "above 0"));
  };
  require(options.fps, "--fps", false);
  require(options.metres_per_unit, "--metres-per-unit", false);
  require(options.confidence, "--confidence", true);
}

TrackFile read_by_kind(const std::string& path, const TrackOptions& options) {
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in || std::filesystem::is_directory(path))
    throw std::invalid_argument(path + ": cannot be read: " + std::strerror(in ? EISDIR : errno));
  if (!std::filesystem::is_regular_file(path))
    throw std::invalid_argument(path + ": must be a file: it is looked at before it is read");
  std::array<char, 16> bytes{};
  in.read(bytes.data(), bytes.size());
  const std::string_view first(bytes.data(), static_cast<std::size_t>(in.gcount()));
  const bool is_classic = first.starts_with("CDF") && first.size() > 3 && first[3] < '\t';
  if (first.starts_with("\x89HDF") || is_classic) return read_movement(path, options);
  return read_track_table(path, options);
}

/// Names that distinguish the files: "a" for "a.csv", or the whole paths if names are equal.
std::vector<std::string> short_names(const std::vector<std::string>& paths) {
  std::vector<std::string> names;
  for (const std::string& path : paths)
    names.push_back(std::filesystem::path(path).stem().string());
  std::vector<std::string> sorted = names;
  std::sort(sorted.begin(), sorted.end());
  return std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end() ? names : paths;
}

/// Joins remarks: those common to all recordings once, others with the name of their file.
std::vector<std::string> joined_remarks(const std::vector<std::string>& paths,
                                        const std::vector<std::vector<std::string>>& of_files) {
  std::vector<std::string> joined;
  for (std::size_t i = 0; i < of_files.size(); ++i)
    for (const std::string& remark : of_files[i]) {
      const bool is_shared =
          std::all_of(of_files.begin(), of_files.end(), [&](const auto& remarks) {
            return std::find(remarks.begin(), remarks.end(), remark) != remarks.end();
          });
      if (!is_shared)
        joined.push_back(paths[i] + ": " + remark);
      else if (i == 0)
        joined.push_back(remark);
    }
  return joined;
}

/// Adds the bodies of another recording.
void add_recording(TrackFile& all, TrackFile&& file, const std::string& name) {
  constexpr double kSameInterval = 1e-3;  // relative; tolerance for clocks of cameras of one kind
  if (all.tracks.empty()) {
    all.kind = file.kind;
    all.interval = file.interval;
    all.metres_per_unit = file.metres_per_unit;
    all.y_down = file.y_down;
  }
  if (std::abs(file.interval - all.interval) > kSameInterval * all.interval)
    throw std::invalid_argument(file.source + " has a frame every " + rounded(file.interval) +
                                " s, " + all.source + " every " + rounded(all.interval) +
                                " s: recordings of one call must have the same, or be cut and "
                                "built apart");
  all.source += (all.source.empty() ? "" : ", ") + file.source;
  for (Track& track : file.tracks) {
    if (track.body != name) track.body = name + "/" + track.body;
    all.tracks.push_back(std::move(track));
  }
  all.places += file.places;
  all.no_place += file.no_place;
  all.unsure += file.unsure;
  all.no_body += file.no_body;
  all.repeated += file.repeated;
  all.at_zero += file.at_zero;
  all.unit_rows += file.unit_rows;
  for (std::string& warning : file.warnings) all.warnings.push_back(std::move(warning));
}

}  // namespace

TrackFile read_tracks(const std::string& path, const TrackOptions& options) {
  require_sensible(options);
  TrackFile file = read_by_kind(path, options);
  file.y_down = options.y_down;
  leave_out_lost(file, options);
  file.remarks.push_back("the lattice begins at (" + shortest(options.origin_x) + ", " +
                         shortest(options.origin_y) + ") of the file, " +
                         (options.y_down ? "its rows count down along y" : "y grows upwards") +
                         ", a unit is " + shortest(file.metres_per_unit) + " m");
  return file;
}

TrackFile read_tracks(const std::vector<std::string>& paths, const TrackOptions& options) {
  if (paths.size() == 1) return read_tracks(paths.front(), options);
  require_different(paths);
  const std::vector<std::string> names = short_names(paths);
  TrackFile all;
  std::vector<std::vector<std::string>> remarks;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    TrackFile file = read_tracks(paths[i], options);
    remarks.push_back(file.remarks);
    add_recording(all, std::move(file), names[i]);
  }
  all.remarks = joined_remarks(paths, remarks);
  return all;
}

std::uint64_t number_of_name(const std::string& name) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return hash >> 8;
}

}  // namespace gatewalk::lattice
