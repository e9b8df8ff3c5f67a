// SPDX-License-Identifier: MIT
#include "lattice/cells/tracks.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <unordered_map>

#include "lattice/cells/track_source.h"
#include "lattice/cells/track_units.h"
#include "lattice/text/csv.h"
#include "lattice/text/digits.h"
#include "lattice/text/toml_text.h"

namespace gatewalk::lattice {

std::string in_quotes(const std::string& text) { return '"' + printable(text) + '"'; }

std::optional<double> coordinate_in(std::string_view text) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (says_nothing(text)) return kNone;
  if (text.front() == '+') text.remove_prefix(1);
  double value = 0.0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size()) return {};
  return std::isfinite(value) ? value : kNone;
}

bool is_frame(double number) {
  constexpr double kMost = 1e12;  // all of them have different times
  return number == std::floor(number) && std::abs(number) <= kMost;
}

bool next_line_of(std::istream& in, const std::string& path, std::string& text) try {
  in.exceptions(std::ios_base::badbit);  // else what cannot be read looks like the end
  return static_cast<bool>(std::getline(in, text));
} catch (const std::ios_base::failure&) {
  throw std::invalid_argument(path + ": cannot be read on: " + std::strerror(EIO));
}

void Lacking::refuse() const {
  if (!text_.empty())
    throw std::invalid_argument(path_ + " does not say, and is not taken to mean, " + text_);
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

namespace {

/// Of all tracks, from a frame in which a body was seen to its next one.
std::vector<double> steps_of(const TrackFile& file) {
  std::vector<double> steps;
  for (const Track& track : file.tracks)
    for (std::size_t i = 1; i < track.time.size(); ++i)
      steps.push_back(track.time[i] - track.time[i - 1]);
  return steps;
}

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
  constexpr double kOff = 0.1;  // of a frame: times are rounded, and cameras not quite even
  if (steps.empty()) return;
  const double step = middle_of(std::move(steps)), frames = step * fps;
  if (std::round(frames) >= 1.0 && std::abs(frames - std::round(frames)) <= kOff) return;
  throw std::invalid_argument(source + ": " + fps_words + " is a frame every " +
                              rounded(1.0 / fps) + " s, but " + time_words + " has steps of " +
                              rounded(step) + " s: one of both is wrong");
}

namespace {

constexpr const char* kColumnsHelp =
    "--columns body=...,frame=...,x=...,y=... with the names of its columns (time=..., in s unless "
    "the file says otherwise, in place of frame=...; confidence=... if there is one)";

/// What a column means.
enum Meaning : std::size_t { kBody, kFrame, kTime, kX, kY, kConfidence, kMeanings };
constexpr std::array<const char*, kMeanings> kMeaningNames{"body", "frame", "time",
                                                           "x",    "y",     "confidence"};

constexpr std::size_t kNoColumn = static_cast<std::size_t>(-1);

/// The names that --columns gives.
std::array<std::string, kMeanings> named_columns(const std::string& given) {
  const auto refuse = [&](const std::string& what) {
    throw std::invalid_argument("--columns " + printable(given) + ": " + what);
  };
  std::array<std::string, kMeanings> names;
  const auto pairs = csv_fields(given);
  if (!pairs) refuse("a quotation mark is not closed, or not at a field's end");
  for (const std::string& pair : *pairs) {
    const std::size_t equals = pair.find('=');
    if (equals == pair.npos || equals + 1 == pair.size())
      refuse(in_quotes(pair) + " is no MEANING=COLUMN");
    const std::string meaning = pair.substr(0, equals);
    const auto found = std::find(kMeaningNames.begin(), kMeaningNames.end(), meaning);
    if (found == kMeaningNames.end())
      refuse(in_quotes(meaning) + " is none of body, frame, time, x, y, confidence");
    std::string& name = names[static_cast<std::size_t>(found - kMeaningNames.begin())];
    if (!name.empty()) refuse(meaning + "= is given twice");
    name = pair.substr(equals + 1);
  }
  for (const Meaning needed : {kBody, kX, kY})
    if (names[needed].empty()) refuse(std::string(kMeaningNames[needed]) + "= is missing");
  if (names[kFrame].empty() == names[kTime].empty())
    refuse("one of frame= and time= is needed, and only one");
  return names;
}

/// A table with a line a place.
class LongTable {
 public:
  LongTable(const std::string& path, const TrackOptions& options) : options_(options) {
    file_.source = path;
    file_.kind = "a table";
  }

  TrackFile read() {
    require_options();
    std::ifstream in(file_.source, std::ios::binary);
    if (!in)
      throw std::invalid_argument(file_.source + ": cannot be read: " + std::strerror(errno));
    std::string text;
    while (next_line(in, text)) {
      auto fields = csv_fields(text);
      if (!fields) refuse("a quotation mark is not closed, or not at a field's end");
      if (header_.empty()) {
        header_ = std::move(*fields);
        find_columns();
      } else if (fields->size() != header_.size()) {
        refuse("has " + std::to_string(fields->size()) + " fields, the first line " +
               std::to_string(header_.size()));
      } else if (!is_unit_row(*fields)) {
        take(*fields);
      }
    }
    if (in.bad())
      throw std::invalid_argument(file_.source + ": cannot be read: " + std::strerror(errno));
    if (!held_.empty()) refuse_held();
    if (rows_.empty()) throw std::invalid_argument(file_.source + ": has no line of any body");
    make_tracks();
    return std::move(file_);
  }

 private:
  struct Row {
    std::int32_t body;
    std::uint32_t line;
    double when, x, y, confidence;
  };

  [[noreturn]] void refuse(const std::string& what) const { refuse_at(line_, what); }
  [[noreturn]] void refuse_at(std::size_t line, const std::string& what) const {
    throw std::invalid_argument(file_.source + ":" + std::to_string(line) + ": " + what);
  }

  void require_options() const {
    refuse_unused(!options_.key_point.empty(), file_.source, "--key-point",
                  "a table with a line a place has none");
    Lacking lacking(file_.source);
    if (options_.columns.empty()) lacking.add("which column is what", kColumnsHelp);
    const auto names = options_.columns.empty() ? std::array<std::string, kMeanings>{}
                                                : named_columns(options_.columns);
    if (!options_.fps && names[kTime].empty()) lacking.add("frames per second", "--fps N");
    if (!options_.metres_per_unit && options_.columns.empty())
      lacking.add("what x and y are in", "--metres-per-unit X (1: metres)");
    if (!names[kConfidence].empty() && !options_.confidence)
      lacking.add("from which confidence on a place counts", "--confidence X");
    lacking.refuse();
    refuse_unused(names[kConfidence].empty() && options_.confidence, file_.source, "--confidence",
                  "--columns names no confidence=");
  }

  /// Comments and empty lines are left out.
  bool next_line(std::istream& in, std::string& text) {
    while (next_line_of(in, file_.source, text)) {
      if (++line_ == 1 && text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
      if (text.ends_with('\r')) text.pop_back();
      if (!has_no_fields(text)) return true;
    }
    return false;
  }

  void find_columns() {
    const auto names = named_columns(options_.columns);
    std::string all;
    for (const std::string& name : header_) all += (all.empty() ? "" : ", ") + printable(name);
    for (std::size_t meaning = 0; meaning < kMeanings; ++meaning) {
      column_[meaning] = kNoColumn;
      if (names[meaning].empty()) continue;
      const auto found = std::find(header_.begin(), header_.end(), names[meaning]);
      if (found == header_.end())
        refuse("there is no column " + in_quotes(names[meaning]) + " (" + kMeaningNames[meaning] +
               "= of --columns): there are " + all);
      if (std::find(found + 1, header_.end(), names[meaning]) != header_.end())
        refuse("there are two columns " + in_quotes(names[meaning]));
      column_[meaning] = static_cast<std::size_t>(found - header_.begin());
    }
  }

  /// TrackMate has three rows of descriptions and units behind the header: all three, or none.
  bool is_unit_row(const std::vector<std::string>& fields) {
    if (!may_be_units_) return false;
    const bool is_text = !coordinate_in(fields[column_[kX]]) && !coordinate_in(fields[column_[kY]]);
    if (!is_text) {
      if (!held_.empty()) refuse_held();
      may_be_units_ = false;
      return false;
    }
    held_.push_back(line_);
    held_x_ = fields[column_[kX]];
    if (held_.size() == 3) {
      file_.unit_rows = 3;
      units_ = fields;
      file_.remarks.push_back("3 rows of descriptions and units behind the header left out, x in " +
                              printable(held_x_));
      held_.clear();
      may_be_units_ = false;
    }
    return true;
  }
  [[noreturn]] void refuse_held() const {
    refuse_at(held_.back(), "column " + printable(header_[column_[kX]]) + ": " +
                                in_quotes(held_x_) +
                                " is no number, nor are there three rows of descriptions and "
                                "units behind the header, as TrackMate writes");
  }

  double number_of(const std::vector<std::string>& fields, Meaning meaning) const {
    const std::string& text = fields[column_[meaning]];
    const auto value = coordinate_in(text);
    if (!value)
      refuse("column " + printable(header_[column_[meaning]]) + ": " + in_quotes(text) +
             " is no number");
    return *value;
  }

  void take(const std::vector<std::string>& fields) {
    const std::string& name = fields[column_[kBody]];
    if (says_nothing(name)) {
      ++file_.no_body;
      return;
    }
    const Meaning when = column_[kFrame] != kNoColumn ? kFrame : kTime;
    Row row{0,
            static_cast<std::uint32_t>(line_),
            number_of(fields, when),
            number_of(fields, kX),
            number_of(fields, kY),
            column_[kConfidence] != kNoColumn ? number_of(fields, kConfidence) : 0.0};
    if (std::isnan(row.when) || (when == kFrame && !is_frame(row.when)))
      refuse("column " + printable(header_[column_[when]]) + ": " +
             in_quotes(fields[column_[when]]) +
             (when == kFrame ? " is no whole number of at most 10^12" : " is no time"));
    const auto known =
        bodies_.try_emplace(name, static_cast<std::int32_t>(file_.tracks.size())).first;
    row.body = known->second;
    if (static_cast<std::size_t>(row.body) == file_.tracks.size())
      file_.tracks.push_back({name, {}, {}, {}});
    rows_.push_back(row);
  }

  /// What the file says that a column is in: by the row of units, and by its name.
  [[nodiscard]] std::vector<StatedUnit> stated_of(Meaning meaning) const {
    const std::size_t column = column_[meaning];
    std::vector<StatedUnit> all{unit_in_name(header_[column])};
    const std::string text = units_.empty() ? std::string() : units_[column];
    if (text.find_first_not_of(" ()[]") != text.npos)
      all.insert(all.begin(), {text, "in the row of units", unit_called(text), true, true});
    return all;
  }
  [[nodiscard]] std::string column_words(Meaning meaning) const {
    return "column " + printable(header_[column_[meaning]]);
  }

  /// Frames in s, or times in what the file says.
  double seconds_of(double when) const {
    return column_[kFrame] != kNoColumn ? when / *options_.fps
           : time_unit_                 ? time_unit_->in_si(when)
                                        : when;
  }
  void find_units() {
    if (column_[kFrame] != kNoColumn) {
      const std::string& name = header_[column_[kFrame]];
      for (const StatedUnit& stated : stated_of(kFrame))
        if (stated.unit && stated.unit->kind == UnitKind::time)
          throw std::invalid_argument(file_.source + ": " + column_words(kFrame) + " is " +
                                      stated.words() + ", no numbers of frames: time=" +
                                      printable(name) + " in place of frame= of --columns");
    } else {
      const std::string& name = header_[column_[kTime]];
      time_unit_ =
          time_unit_of(stated_of(kTime), file_.source + ": " + column_words(kTime),
                       "give frame=" + printable(name) +
                           " of --columns in place of time=, and frames per second, --fps N");
      if (time_unit_ && time_unit_->in_si(1.0) != 1.0)
        file_.remarks.push_back(column_words(kTime) + " is " + words_of_units(kTime) +
                                ": converted to s");
    }
    file_.metres_per_unit = metres_per_unit_of(stated_of(kX), stated_of(kY), column_words(kX),
                                               column_words(kY), file_, options_);
  }
  [[nodiscard]] std::string words_of_units(Meaning meaning) const {
    for (const StatedUnit& stated : stated_of(meaning))
      if (stated.unit) return stated.words();
    return {};
  }

  /// Among numbers from 0 on, -1 is what clustering and tracking give to those of no body.
  void drop_minus_one() {
    const auto whole = [](const std::string& name) {
      const auto number = coordinate_in(name);
      return number && *number == std::floor(*number) ? number : std::nullopt;
    };
    std::optional<std::size_t> none;
    for (std::size_t i = 0; i < file_.tracks.size(); ++i) {
      const auto number = whole(file_.tracks[i].body);
      if (!number || *number < -1.0 || (*number == -1.0 && none)) return;
      if (*number == -1.0) none = i;
    }
    if (!none || file_.tracks.size() == 1) return;
    const std::string name = file_.tracks[*none].body;
    const auto gone = static_cast<std::int32_t>(*none);
    file_.no_body += std::erase_if(rows_, [&](const Row& row) { return row.body == gone; });
    for (Row& row : rows_) row.body -= row.body > gone ? 1 : 0;
    file_.tracks.erase(file_.tracks.begin() + gone);
    file_.remarks.push_back("body " + printable(name) +
                            " beside numbers from 0 is none: its lines are of no body");
  }

  void make_tracks() {
    find_units();
    drop_minus_one();
    std::stable_sort(rows_.begin(), rows_.end(), [](const Row& a, const Row& b) {
      return a.body != b.body ? a.body < b.body : a.when < b.when;
    });
    const bool by_frame = column_[kFrame] != kNoColumn;
    TrackMaker maker(file_, options_);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const Row& row = rows_[i];
      Track& track = file_.tracks[static_cast<std::size_t>(row.body)];
      if (i > 0 && rows_[i - 1].body == row.body && rows_[i - 1].when == row.when)
        refuse_at(row.line, "body " + in_quotes(track.body) + " has a place in " +
                                (by_frame ? "frame " : "the time ") + shortest(row.when) +
                                " already (line " + std::to_string(rows_[i - 1].line) +
                                "): a body is at one place at a time");
      maker.add(track, seconds_of(row.when), row.x, row.y,
                column_[kConfidence] != kNoColumn ? std::optional(row.confidence) : std::nullopt);
    }
    rows_ = {};
    if (options_.fps && !by_frame)
      require_steps(steps_of(file_), file_.source, *options_.fps,
                    "--fps " + shortest(*options_.fps),
                    column_words(kTime) + (time_unit_ ? "" : " (in s)"));
    file_.interval = options_.fps ? 1.0 / *options_.fps : median_step(file_);
  }

  const TrackOptions& options_;
  TrackFile file_;
  std::size_t line_ = 0;
  std::vector<std::string> header_;
  std::array<std::size_t, kMeanings> column_{};  // of each meaning
  bool may_be_units_ = true;
  std::vector<std::size_t> held_;  // lines that may be units
  std::string held_x_;
  std::vector<std::string> units_;      // the row of units
  std::optional<TrackUnit> time_unit_;  // that it states
  std::unordered_map<std::string, std::int32_t> bodies_;
  std::vector<Row> rows_;
};

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
  std::string_view first(bytes.data(), static_cast<std::size_t>(in.gcount()));
  if (first.empty()) throw std::invalid_argument(path + ": is empty");
  if (first.starts_with("\x89HDF") || first.starts_with("CDF")) return read_movement(path, options);
  if (first.starts_with("\xEF\xBB\xBF")) first.remove_prefix(3);
  if (first.starts_with("scorer,")) return read_deeplabcut(path, options);
  return LongTable(path, options).read();
}

}  // namespace

TrackFile read_tracks(const std::string& path, const TrackOptions& options) {
  require_sensible(options);
  TrackFile file = read_by_kind(path, options);
  file.remarks.push_back("the lattice begins at (" + shortest(options.origin_x) + ", " +
                         shortest(options.origin_y) + ") of the file, " +
                         (options.y_down ? "its rows count down along y" : "y grows upwards") +
                         ", a unit is " + shortest(file.metres_per_unit) + " m");
  return file;
}

}  // namespace gatewalk::lattice
