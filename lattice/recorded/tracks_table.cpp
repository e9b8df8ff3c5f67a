// SPDX-License-Identifier: MIT
// Reads tables whose columns the user names: one place per line, or one frame per line with columns
// for each body.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <unordered_map>
#include <unordered_set>

#include "lattice/recorded/track_source.h"
#include "lattice/recorded/track_units.h"
#include "lattice/text/csv.h"
#include "lattice/text/digits.h"
#include "lattice/text/toml_text.h"

namespace gatewalk::lattice {
namespace {

constexpr const char* kColumnsHelp =
    "--columns body=...,frame=...,x=...,y=... with the names of its columns (time=..., in s unless "
    "the file says otherwise, in place of frame=...; confidence=... if there is one; no body= for "
    "one body, or where columns are of a body each: x=x*,y=y*)";

/// The meanings of columns.
enum Meaning : std::size_t { kBody, kFrame, kTime, kX, kY, kConfidence, kMeanings };
constexpr std::array<const char*, kMeanings> kMeaningNames{"body", "frame", "time",
                                                           "x",    "y",     "confidence"};
using NamedColumns = std::array<std::string, kMeanings>;

bool is_pattern(const std::string& name) { return name.find('*') != name.npos; }

/// The column names in --columns.
NamedColumns named_columns(const std::string& given) {
  const auto refuse = [&](const std::string& what) {
    throw std::invalid_argument("--columns " + printable(given) + ": " + what);
  };
  NamedColumns names;
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
  for (const Meaning needed : {kX, kY})
    if (names[needed].empty()) refuse(std::string(kMeaningNames[needed]) + "= is missing");
  if (names[kFrame].empty() == names[kTime].empty())
    refuse("one of frame= and time= is needed, and only one");
  const bool of_bodies = is_pattern(names[kX]);
  for (const Meaning of_place : {kX, kY, kConfidence}) {
    const std::string& name = names[of_place];
    if (!name.empty() && is_pattern(name) != of_bodies)
      refuse("x=, y= and confidence= must have a * all, which is the body's name, or none of them");
    if (std::count(name.begin(), name.end(), '*') > 1)
      refuse(in_quotes(name) + " has more than one *");
  }
  if (of_bodies && !names[kBody].empty())
    refuse("body= has no meaning beside x=" + names[kX] + ", whose * is the body's name");
  return names;
}

/// "1" for column "x1" and pattern "x*", whatever the case; nullopt for another column.
std::optional<std::string> body_in(const std::string& column, std::string_view pattern) {
  const std::size_t star = pattern.find('*');
  const std::string before = in_small_letters(pattern.substr(0, star)),
                    behind = in_small_letters(pattern.substr(star + 1)),
                    name = in_small_letters(column);
  if (name.size() <= before.size() + behind.size() || !name.starts_with(before) ||
      !name.ends_with(behind))
    return {};
  return column.substr(before.size(), column.size() - before.size() - behind.size());
}

std::string column_of(const std::string& body, std::string pattern) {
  return pattern.replace(pattern.find('*'), 1, body);
}

/// The pattern of x if columns look like places of several bodies: "X_Arena0_Ind*" for
/// X_Arena0_Ind1 with Y_Arena0_Ind1. Else empty.
std::string pattern_in(const Table::Names& names) {
  const std::unordered_set<std::string> all(names.begin(), names.end());
  for (const std::string& name : names) {
    const std::size_t digits = name.find_last_not_of("0123456789") + 1;
    if (digits == name.size() || (name[0] != 'x' && name[0] != 'X')) continue;
    std::string other = name;
    other[0] = name[0] == 'x' ? 'y' : 'Y';
    if (all.contains(other)) return name.substr(0, digits) + "*";
  }
  return {};
}

/// True if a line names all columns of --columns.
bool has_columns(const Table::Names& line, const NamedColumns& names) {
  return std::all_of(names.begin(), names.end(), [&](const std::string& name) {
    if (name.empty()) return true;
    if (!is_pattern(name)) return Table::column_in(line, name).has_value();
    return std::any_of(line.begin(), line.end(), [&](const std::string& column) {
      return body_in(column, name).has_value();
    });
  });
}

class TrackTable {
 public:
  TrackTable(Table& table, NamedColumns names, const TrackOptions& options)
      : options_(options), table_(table), names_(std::move(names)) {
    file_.source = table.lines().name();
    file_.kind = "a table";
  }

  TrackFile read() {
    require_options();
    find_columns();
    while (table_.next())
      if (!is_unit_row()) take();
    if (!held_.empty()) refuse_held();
    if (rows_.empty()) refuse_nobody();
    for (std::string& remark : table_.remarks()) file_.remarks.push_back(std::move(remark));
    make_tracks();
    return std::move(file_);
  }

 private:
  struct Row {
    std::int32_t body;
    std::uint32_t line;
    double when, x, y, confidence;
  };
  /// Columns of a body's places; kNone: no such column.
  struct Places {
    std::size_t x, y, confidence;
  };
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  [[nodiscard]] bool has(Meaning meaning) const { return !names_[meaning].empty(); }

  void require_options() const {
    refuse_unused(!options_.key_point.empty(), file_.source, "--key-point",
                  "of a table the columns say it");
    Lacking lacking(file_.source);
    if (options_.columns.empty())
      lacking.add("which column is what (there are " + table_.column_words() + ")", kColumnsHelp);
    if (!options_.fps && !has(kTime)) lacking.add("frames per second", "--fps N");
    if (!options_.metres_per_unit && options_.columns.empty())
      lacking.add("what x and y are in", "--metres-per-unit X (1: metres)");
    if (has(kConfidence) && !options_.confidence)
      lacking.add("from which confidence on a place counts", "--confidence X");
    lacking.refuse();
    refuse_unused(!has(kConfidence) && options_.confidence, file_.source, "--confidence",
                  "--columns names no confidence=");
  }

  std::size_t column(const std::string& name, const char* meaning) {
    const auto found = table_.column(name);
    if (found) return *found;
    const std::string pattern = pattern_in(table_.columns());
    std::string other = pattern;
    if (!pattern.empty()) other[0] = pattern[0] == 'x' ? 'y' : 'Y';
    table_.refuse(table_.header_line(),
                  "there is no column " + in_quotes(name) + " (" + meaning +
                      "= of --columns): there are " + table_.column_words() +
                      (pattern.empty() ? ""
                                       : " (if these are places of a body each, give x=" + pattern +
                                             ",y=" + other + " and no body=)"));
  }

  void find_columns() {
    when_ = has(kFrame) ? column(names_[kFrame], "frame") : column(names_[kTime], "time");
    if (!is_pattern(names_[kX])) {
      if (has(kBody)) body_ = column(names_[kBody], "body");
      places_.push_back({column(names_[kX], "x"), column(names_[kY], "y"),
                         has(kConfidence) ? column(names_[kConfidence], "confidence") : kNone});
    } else {
      for (const std::string& name : table_.columns()) {
        const auto body = body_in(name, names_[kX]);
        if (!body || !bodies_.try_emplace(*body, 0).second) continue;
        places_.push_back({column(name, "x"), column(column_of(*body, names_[kY]), "y"),
                           has(kConfidence)
                               ? column(column_of(*body, names_[kConfidence]), "confidence")
                               : kNone});
        file_.tracks.push_back({*body, {}, {}, {}});
      }
      if (places_.empty()) (void)column(names_[kX], "x");  // no such column: refused
    }
    if (body_ == kNone && file_.tracks.empty()) {
      file_.tracks.push_back({std::filesystem::path(file_.source).stem().string(), {}, {}, {}});
      file_.remarks.push_back("no column is body=: one body, " + printable(file_.tracks[0].body));
    }
  }
  /// Finds a column of times besides the column of frames, to check --fps. Columns of places and
  /// the like are no times, whatever their names end in.
  void find_other_times() {
    const auto is_used = [&](std::size_t i) {
      return i == when_ || i == body_ ||
             std::any_of(places_.begin(), places_.end(), [&](const Places& at) {
               return i == at.x || i == at.y || i == at.confidence;
             });
    };
    for (std::size_t i = 0; i < table_.columns().size() && other_time_ == kNone; ++i)
      if (!is_used(i)) {
        const std::string name = in_small_letters(table_.columns()[i]);
        if (name == "time" || name == "t") other_time_ = i;
        for (const StatedUnit& stated : stated_of(i))
          if (stated.unit && stated.unit->kind == UnitKind::time) {
            other_time_ = i;
            other_unit_ = *stated.unit;
            other_is_stated_ = true;
          }
      }
  }

  /// True if the row, directly after the header, states units of the columns.
  bool is_unit_row() {
    if (!may_be_units_) return false;
    const Places& at = places_.front();
    const auto when = table_.number(table_[when_]);
    const bool is_text = !table_.number(table_[at.x]) && !table_.number(table_[at.y]) &&
                         (!when || std::isnan(*when));
    if (is_text && held_.size() < kMostUnitRows) {
      held_.push_back(table_.line());
      units_.assign(table_.fields().begin(), table_.fields().end());
      return true;
    }
    may_be_units_ = false;
    if (held_.empty()) return false;
    // TrackMate writes three rows, whatever their units; other programs write one row of units.
    if (is_text ||
        (held_.size() < kMostUnitRows && !(unit_called(units_[at.x]) && unit_called(units_[at.y]))))
      refuse_held();
    file_.unit_rows = std::ssize(held_);
    file_.remarks.push_back(
        (held_.size() == 1 ? "a row of units"
                           : std::to_string(held_.size()) + " rows of descriptions and units") +
        " behind the header left out, x in " + printable(units_[at.x]));
    held_.clear();
    return false;
  }
  [[noreturn]] void refuse_held() const {
    const std::size_t x = places_.front().x;
    table_.refuse(held_.back(),
                  "column " + printable(table_.columns()[x]) + ": " + in_quotes(units_[x]) +
                      " is no number, nor are there three rows of descriptions and units behind "
                      "the header, as TrackMate writes, or one of units");
  }

  double number(std::size_t at) {
    const auto value = table_.number(table_[at]);
    if (!value)
      table_.refuse("column " + printable(table_.columns()[at]) + ": " +
                    in_quotes(std::string(table_[at])) + " is no number" +
                    (at == when_ && table_[at].find(':') != std::string_view::npos
                         ? " (a time of day? Give seconds, or frame= and --fps)"
                         : ""));
    return *value;
  }

  void take() {
    std::int32_t body = 0;
    if (body_ != kNone) {
      const std::string name(table_[body_]);
      if (says_nothing(name)) {
        ++file_.no_body;
        return;
      }
      body =
          bodies_.try_emplace(name, static_cast<std::int32_t>(file_.tracks.size())).first->second;
      if (static_cast<std::size_t>(body) == file_.tracks.size())
        file_.tracks.push_back({name, {}, {}, {}});
    }
    const double when = number(when_);
    if (std::isnan(when) || (has(kFrame) && !is_frame(when)))
      table_.refuse("column " + printable(table_.columns()[when_]) + ": " +
                    in_quotes(std::string(table_[when_])) +
                    (has(kFrame) ? " is no whole number of at most 10^12" : " is no time"));
    for (const Places& at : places_)
      rows_.push_back({body++, static_cast<std::uint32_t>(table_.line()), when, number(at.x),
                       number(at.y), at.confidence == kNone ? 0.0 : number(at.confidence)});
    if (std::exchange(is_first_row_, false) && has(kFrame)) find_other_times();
    if (other_time_ != kNone) compare_times(rows_.back());
  }

  /// Compares the times of a body's first frames with its frame numbers. Values that do not always
  /// increase are no clock.
  void compare_times(const Row& row) {
    const auto time = table_.number(table_[other_time_]);
    if (!time || std::isnan(*time)) return;
    const auto [at, is_new] = seen_.try_emplace(row.body, row.when, *time);
    const double frames = row.when - at->second.first, later = *time - at->second.second;
    at->second = {row.when, *time};
    if (is_new || frames == 0.0) return;
    seconds_a_frame_.push_back(other_unit_.in_si(later) / frames);
    if (later * frames <= 0.0) seconds_a_frame_.clear();
    if (later * frames <= 0.0 || seconds_a_frame_.size() >= kMostTimes) other_time_ = kNone;
  }
  void warn_of_times() {
    constexpr double kOff = 0.1;
    if (seconds_a_frame_.empty()) return;
    const auto middle = seconds_a_frame_.begin() + std::ssize(seconds_a_frame_) / 2;
    std::nth_element(seconds_a_frame_.begin(), middle, seconds_a_frame_.end());
    const auto is_near = [&](double frames) {
      return std::abs(*middle * *options_.fps / frames - 1.0) <= kOff;
    };
    // Times may count frames; times without a stated unit may be in ms or microseconds.
    if (is_near(1.0) || is_near(*options_.fps)) return;
    if (!other_is_stated_ && (is_near(1e3) || is_near(1e6))) return;
    file_.warnings.push_back(file_.source + ": --fps " + shortest(*options_.fps) +
                             " is a frame every " + rounded(1.0 / *options_.fps) +
                             " s, but by its times a frame takes " + rounded(*middle) +
                             " s (median): one of both is wrong, and velocities with it");
  }

  [[noreturn]] void refuse_nobody() const {
    if (file_.no_body > 0)
      throw std::invalid_argument(file_.source + ": column " + printable(names_[kBody]) +
                                  " names no body in any of " + std::to_string(file_.no_body) +
                                  " lines: leave body= out if there is one body");
    throw std::invalid_argument(file_.source + ": has no line of any body");
  }

  /// The units that the file states for a column: by the row of units, and by its name.
  [[nodiscard]] std::vector<StatedUnit> stated_of(std::size_t at) const {
    std::vector<StatedUnit> all{unit_in_name(table_.columns()[at])};
    const std::string text = units_.empty() ? std::string() : units_[at];
    if (text.find_first_not_of(" ()[]") != text.npos)
      all.insert(all.begin(), {text, "in the row of units", unit_called(text), true,
                               file_.unit_rows == kMostUnitRows});
    return all;
  }
  [[nodiscard]] std::string words_of(std::size_t at) const {
    return "column " + printable(table_.columns()[at]);
  }

  /// The time in s of a frame number, or of a time in the file's unit.
  double seconds_of(double when) const {
    return has(kFrame) ? when / *options_.fps : time_unit_ ? time_unit_->in_si(when) : when;
  }
  void find_units() {
    const std::string name = printable(table_.columns()[when_]);
    const std::vector<StatedUnit> stated = stated_of(when_);
    if (has(kFrame)) {
      for (const StatedUnit& s : stated)
        if (s.unit && s.unit->kind == UnitKind::time)
          throw std::invalid_argument(file_.source + ": " + words_of(when_) + " is " + s.words() +
                                      ", no numbers of frames: time=" + name +
                                      " in place of frame= of --columns");
    } else {
      time_unit_ = time_unit_of(stated, file_.source + ": " + words_of(when_),
                                "give frame=" + name +
                                    " of --columns in place of time=, and frames per second, "
                                    "--fps N");
      if (time_unit_ && time_unit_->in_si(1.0) != 1.0)
        for (const StatedUnit& s : stated)
          if (s.unit) {
            file_.remarks.push_back(words_of(when_) + " is " + s.words() + ": converted to s");
            break;
          }
    }
    for (const Places& at : places_)
      require_same_unit(metres_per_unit_of(stated_of(at.x), stated_of(at.y), words_of(at.x),
                                           words_of(at.y), file_, options_),
                        at);
  }
  void require_same_unit(double metres, const Places& at) {
    if (&at != places_.data() && metres != file_.metres_per_unit)
      throw std::invalid_argument(file_.source + ": " + words_of(at.x) +
                                  " is in another unit than " + words_of(places_.front().x) +
                                  ": all must be in the same");
    file_.metres_per_unit = metres;
  }

  /// Drops body -1 among bodies numbered from 0: clustering and tracking give it to places without
  /// a body.
  void drop_minus_one() {
    const auto whole = [](const std::string& name) { return Table::whole(name); };
    std::optional<std::size_t> none;
    for (std::size_t i = 0; i < file_.tracks.size(); ++i) {
      const auto number = whole(file_.tracks[i].body);
      if (!number || *number < -1 || (*number == -1 && none)) return;
      if (*number == -1) none = i;
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
    if (body_ != kNone) drop_minus_one();
    warn_of_times();
    std::stable_sort(rows_.begin(), rows_.end(), [](const Row& a, const Row& b) {
      return a.body != b.body ? a.body < b.body : a.when < b.when;
    });
    TrackMaker maker(file_, options_);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const Row& row = rows_[i];
      Track& track = file_.tracks[static_cast<std::size_t>(row.body)];
      if (i > 0 && rows_[i - 1].body == row.body && rows_[i - 1].when == row.when)
        table_.refuse(row.line,
                      "body " + in_quotes(track.body) + " has a place in " +
                          (has(kFrame) ? "frame " : "the time ") + shortest(row.when) +
                          " already (line " + std::to_string(rows_[i - 1].line) +
                          "): a body is at one place at a time" +
                          (body_ == kNone ? "; does a column tell bodies apart (body=)?" : ""));
      maker.add(track, seconds_of(row.when), row.x, row.y,
                has(kConfidence) ? std::optional(row.confidence) : std::nullopt);
    }
    rows_ = {};
    if (options_.fps && !has(kFrame))
      require_steps(steps_of(file_), file_.source, *options_.fps,
                    "--fps " + shortest(*options_.fps),
                    words_of(when_) + (time_unit_ ? "" : " (in s)"));
    file_.interval = options_.fps ? 1.0 / *options_.fps : median_step(file_);
  }

  static constexpr std::size_t kMostUnitRows = 3, kMostTimes = 10'000;

  const TrackOptions& options_;
  Table& table_;
  NamedColumns names_;
  TrackFile file_;
  std::size_t body_ = kNone, when_ = kNone, other_time_ = kNone;  // columns
  std::vector<Places> places_;  // of each body; a single one if bodies have a column
  bool may_be_units_ = true, is_first_row_ = true, other_is_stated_ = false;
  std::vector<std::int64_t> held_;      // lines that may state units
  std::vector<std::string> units_;      // fields of the last such line
  std::optional<TrackUnit> time_unit_;  // stated by the file
  TrackUnit other_unit_{UnitKind::time};
  // Last frame and time, by body.
  std::unordered_map<std::int32_t, std::pair<double, double>> seen_;
  std::vector<double> seconds_a_frame_;
  std::unordered_map<std::string, std::int32_t> bodies_;
  std::vector<Row> rows_;
};

}  // namespace

TrackFile read_track_table(const std::string& path, const TrackOptions& options) {
  const NamedColumns names =
      options.columns.empty() ? NamedColumns{} : named_columns(options.columns);
  Table table(path, [&](const Table::Names& line) {
    return is_of_deeplabcut(line) || (!options.columns.empty() && has_columns(line, names));
  });
  if (table.columns().empty()) throw std::invalid_argument(path + ": is empty");
  if (is_of_deeplabcut(table.columns())) return read_deeplabcut(table, options);
  return TrackTable(table, names, options).read();
}

}  // namespace gatewalk::lattice
