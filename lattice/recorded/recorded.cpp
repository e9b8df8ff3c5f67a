// SPDX-License-Identifier: MIT
#include "lattice/recorded/recorded.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "dynamics/cells/cell.h"
#include "lattice/text/csv.h"
#include "lattice/text/digits.h"
#include "lattice/text/edit_distance.h"
#include "lattice/text/table.h"
#include "lattice/text/toml_text.h"
#include "markov/formats/file.h"

namespace gatewalk::lattice {
namespace {

using dynamics::Costs;
using dynamics::Entry;
using dynamics::Fate;
using dynamics::Section;

constexpr std::size_t kBytesAtOnce = 1 << 20;  // bytes written at once
constexpr double kSameClock = 1e-9;  // relative tolerance of times against trapped_after_s
constexpr const char* kNumber = "a number, such as 0.25 or -2.5e-1";

// ---- Columns

/// The columns of a table, in the order of writing.
std::vector<std::string> column_names(const CellFile& cells, bool with_type) {
  std::vector<std::string> names{"body", "trial"};
  if (with_type) names.emplace_back("type");
  for (const std::string begin : {"", "out_"}) {
    names.emplace_back(begin.empty() ? "in" : "out");
    for (const auto& coordinate : cells.map.section.coordinates)
      names.push_back(begin + coordinate.name);
  }
  for (const auto& cost : cells.map.section.costs) names.push_back(cost.key);
  return names;
}

std::string with_commas(const std::vector<std::string>& names) {
  std::string line;
  for (const std::string& name : names) line += (line.empty() ? "" : ",") + name;
  return line;
}

constexpr std::size_t kMostColumns = 5 + 2 * dynamics::kMostCoordinates + dynamics::kMostCosts;

/// Index of each column.
struct Columns {
  std::size_t body = 0, trial = 0, in = 0, out = 0;
  std::size_t type = kMostColumns;  // no such column
  std::array<std::size_t, dynamics::kMostCoordinates> in_at{}, out_at{};
  std::array<std::size_t, dynamics::kMostCosts> costs{};
};

/// Names in the order of first occurrence.
class NameTable {
 public:
  [[nodiscard]] std::size_t place_of(std::string_view name) {
    const auto found = places_.find(name);
    if (found != places_.end()) return found->second;
    return places_.emplace(std::string(name), places_.size()).first->second;
  }
  [[nodiscard]] std::size_t size() const { return places_.size(); }

 private:
  struct Hash {
    using is_transparent = void;
    std::size_t operator()(std::string_view text) const {
      return std::hash<std::string_view>()(text);
    }
  };
  std::unordered_map<std::string, std::size_t, Hash, std::equal_to<>> places_;
};

// ---- Reading

bool is_header_of_runs(const Table::Names& names) {
  constexpr std::array<const char*, 4> kAlways{"body", "trial", "in", "out"};
  return std::all_of(kAlways.begin(), kAlways.end(),
                     [&](const char* name) { return Table::column_in(names, name).has_value(); });
}

class RunsReader {
 public:
  RunsReader(const std::string& path, const CellFile& cells, CostColumns costs)
      : table_(path, &is_header_of_runs),
        cells_(cells),
        section_(cells.map.section),
        cost_columns_(costs) {
    runs_.passages.begin(section_);
  }

  [[nodiscard]] RecordedRuns read() {
    if (table_.columns().empty())
      throw std::invalid_argument(table_.lines().name() + ": is empty: the columns must be " +
                                  with_commas(needed()));
    read_columns();
    while (table_.next()) add_passage();
    if (runs_.passages.empty())
      throw std::invalid_argument(table_.lines().name() +
                                  ": has no passage below the line of its columns");
    for (std::string& text : table_.remarks()) runs_.remarks.push_back(std::move(text));
    require_each_trial_once();
    return std::move(runs_);
  }

 private:
  void read_columns() {
    const std::vector<std::string>& given = table_.columns();
    const std::vector<std::string> known = column_names(cells_, true);
    std::vector<bool> is_known(given.size());
    for (const std::string& name : known)
      if (const auto at = table_.column(name)) is_known[*at] = true;
    for (std::size_t i = 0; i < given.size(); ++i) {
      if (is_known[i] || std::find(given.begin(), given.end(), given[i]) !=
                             given.begin() + static_cast<std::ptrdiff_t>(i))
        continue;
      if (Table::is_index(given[i])) {
        runs_.remarks.push_back("column " + std::to_string(i + 1) + " has no name: left out");
        continue;
      }
      const std::string meant = meant_name(given[i], known);
      table_.refuse(table_.header_line(),
                    "unknown column \"" + printable(given[i]) + "\"" +
                        (meant.empty() ? "" : " (did you mean " + meant + "?)") +
                        ": the columns must be " + with_commas(known) + ", as " + cells_.source +
                        " has faces, coordinates and costs");
    }
    const auto place = [&](const std::string& name) {
      const auto found = table_.column(name);
      if (!found)
        table_.refuse(table_.header_line(), "column " + name + " is missing: the columns must be " +
                                                with_commas(needed()) + "; there are " +
                                                table_.column_words());
      return *found;
    };
    columns_.body = place("body");
    columns_.trial = place("trial");
    columns_.in = place("in");
    columns_.out = place("out");
    for (std::size_t c = 0; c < section_.coordinates.size(); ++c) {
      columns_.in_at[c] = place(section_.coordinates[c].name);
      columns_.out_at[c] = place("out_" + section_.coordinates[c].name);
    }
    for (std::size_t c = 0; c < section_.costs.size(); ++c) {
      const std::string& key = section_.costs[c].key;
      const bool must = c == 0 || cost_columns_ == CostColumns::all;
      columns_.costs[c] = must || table_.column(key) ? place(key) : kMostColumns;
    }
    if (cells_.types.size() > 1 || table_.column("type")) columns_.type = place("type");
  }

  [[nodiscard]] std::vector<std::string> needed() const {
    std::vector<std::string> names = column_names(cells_, cells_.types.size() > 1);
    if (cost_columns_ == CostColumns::as_there_are)
      names.resize(names.size() - (section_.costs.size() - 1));
    return names;
  }

  [[noreturn]] void refuse(std::size_t column, const std::string& what) const {
    table_.refuse("column " + table_.columns()[column] + ": " + what);
  }
  [[noreturn]] void refuse_value(std::size_t column, const std::string& allowed) const {
    const std::string_view given = table_[column];
    refuse(column, (given.empty() ? "nothing" : "\"" + printable(given) + "\"") +
                       " is not permitted: must be " + allowed);
  }

  [[nodiscard]] double number(std::size_t column, const char* allowed = kNumber) {
    const auto value = table_.number(table_[column]);
    if (!value || std::isnan(*value)) refuse_value(column, allowed);
    return *value;
  }
  /// Index of the face; the number of faces for an unknown name.
  [[nodiscard]] std::size_t face_named(std::string_view name) const {
    std::size_t f = 0;
    while (f < section_.faces.size() && section_.faces[f].name != name) ++f;
    return f;
  }

  void add_passage() {
    const Entry entry = entry_in();
    if (begins_trial())
      begin_trial(entry);
    else
      require_goes_on(entry);
    const CellPassage passage = passage_in();
    require_open(entry, passage);
    runs_.trapped += passage.fate == Fate::trapped;
    runs_.lost += passage.fate == Fate::broken;
    runs_.passages.push_back(passage);
    ++runs_.trials.back().count;
    last_ = passage;
    last_line_ = table_.line();
    if (constexpr std::size_t kFirst = 1000;
        runs_.passages.size() == kFirst && table_.lines().bytes() > 0)
      runs_.passages.reserve(
          static_cast<std::size_t>(1.01 * kFirst * static_cast<double>(table_.lines().bytes()) /
                                   static_cast<double>(table_.lines().bytes_read())));
  }

  Entry entry_in() {
    Entry entry;
    const std::size_t face = face_named(table_[columns_.in]);
    if (face == section_.faces.size())
      refuse_value(columns_.in,
                   "a face of " + cells_.source + ", one of " + dynamics::names_of(section_.faces));
    entry.face = static_cast<int>(face);
    for (std::size_t c = 0; c < section_.coordinates.size(); ++c)
      entry.at[c] = number(columns_.in_at[c]);
    return entry;
  }

  /// Refuses passages through walls of their cell's type.
  void require_open(const Entry& entry, const CellPassage& passage) const {
    if (passage.type >= cells_.walls.size()) return;
    for (std::size_t f = 0; f < section_.faces.size(); ++f) {
      if ((cells_.walls[passage.type] >> f & 1) == 0) continue;
      const dynamics::Face &wall = section_.faces[f],
                           &out = section_.faces[static_cast<std::size_t>(passage.entry.face)];
      const bool enters = static_cast<std::size_t>(entry.face) == f;
      const bool leaves =
          passage.fate == Fate::left && out.di_x == -wall.di_x && out.di_y == -wall.di_y;
      if (enters || leaves)
        refuse(enters ? columns_.in : columns_.out,
               "a body cannot " + std::string(enters ? "enter" : "leave") + " by face " +
                   (enters ? wall.name : out.name) + ": type " + cells_.types[passage.type] +
                   " of " + cells_.source + " has a wall at " + wall.name);
    }
  }

  [[nodiscard]] bool begins_trial() const {
    return runs_.trials.empty() || table_[columns_.body] != body_ ||
           table_[columns_.trial] != trial_;
  }
  void begin_trial(const Entry& entry) {
    for (const std::size_t column : {columns_.body, columns_.trial})
      if (says_nothing(table_[column])) refuse_value(column, "a name or a number");
    body_ = table_[columns_.body];
    trial_ = table_[columns_.trial];
    const std::size_t body = bodies_.place_of(body_);
    if (body == runs_.bodies.size()) runs_.bodies.push_back(body_);
    runs_.trials.push_back({entry, static_cast<std::int32_t>(body), std::ssize(runs_.passages), 0});
    seen_.push_back({body, trial_number(), table_.line()});
  }
  /// A number for the trial's text: whole numbers stand for themselves, and different texts get
  /// different numbers.
  std::uint64_t trial_number() {
    constexpr std::uint64_t kText = std::uint64_t{1} << 63;
    std::uint64_t number = 0;
    const char* const end = trial_.data() + trial_.size();
    const auto read = std::from_chars(trial_.data(), end, number);
    if (read.ec == std::errc() && read.ptr == end && number < kText &&
        (trial_[0] != '0' || trial_.size() == 1))
      return number;
    return kText + texts_.place_of(trial_);
  }

  void require_goes_on(const Entry& entry) const {
    const auto line = [&] { return " (line " + std::to_string(last_line_) + ")"; };
    if (last_.fate != Fate::left)
      table_.refuse("trial " + printable(trial_) + " of body " + printable(body_) + " was " +
                    (last_.fate == Fate::trapped ? "trapped" : "lost") + " in the passage before" +
                    line() + ": none can follow; a body that is seen again begins another trial");
    if (entry.face != last_.entry.face)
      refuse_value(columns_.in, section_.faces[static_cast<std::size_t>(last_.entry.face)].name +
                                    ", by which the passage before" + line() + " went on");
    for (std::size_t c = 0; c < section_.coordinates.size(); ++c)
      if (entry.at[c] != last_.entry.at[c])
        refuse_value(columns_.in_at[c], shortest(last_.entry.at[c]) +
                                            ", with which the passage before" + line() +
                                            " went on: the same number");
  }

  CellPassage passage_in() {
    CellPassage passage{.fate = Fate::broken};
    if (columns_.type < kMostColumns) {
      const auto type = std::find(cells_.types.begin(), cells_.types.end(), table_[columns_.type]);
      if (type == cells_.types.end())
        refuse_value(columns_.type, "a type of cell of " + cells_.source + ", one of " +
                                        with_commas(cells_.types));
      passage.type = static_cast<std::uint8_t>(type - cells_.types.begin());
    }
    const std::string_view out = table_[columns_.out];
    const std::size_t face = face_named(out);
    if (face < section_.faces.size()) {
      passage.fate = Fate::left;
      passage.entry.face = static_cast<int>(face);
      for (std::size_t c = 0; c < section_.coordinates.size(); ++c)
        passage.entry.at[c] = number(columns_.out_at[c]);
    } else {
      if (out != "trapped" && out != "lost")
        refuse_value(columns_.out,
                     "trapped, lost, or the face by which the next cell is entered, "
                     "one of " +
                         dynamics::names_of(section_.faces));
      passage.fate = out == "trapped" ? Fate::trapped : Fate::broken;
      for (std::size_t c = 0; c < section_.coordinates.size(); ++c)
        if (!says_nothing(table_[columns_.out_at[c]]))
          refuse_value(columns_.out_at[c],
                       "blank, as a body that is " + std::string(out) + " enters no cell");
    }
    for (std::size_t c = 0; c < section_.costs.size(); ++c) passage.costs[c] = cost_in(c, passage);
    require_clock(passage);
    return passage;
  }

  /// The cost of a passage; cost 0 is the time.
  double cost_in(std::size_t cost, const CellPassage& passage) {
    const std::size_t column = columns_.costs[cost];
    const bool lost = passage.fate == Fate::broken;
    if (column == kMostColumns || (says_nothing(table_[column]) && (cost > 0 || lost))) {
      runs_.unknown[cost] += !lost;
      return std::numeric_limits<double>::quiet_NaN();
    }
    if (cost > 0) return number(column);
    const char* const allowed =
        lost ? "a number of seconds from 0, or blank" : "a number of seconds > 0";
    const double time = number(column, allowed);
    if (!(time > 0.0 || (lost && time == 0.0))) refuse_value(column, allowed);
    return time;
  }

  /// Throws unless exactly the passages that took trapped_after_s are trapped.
  void require_clock(const CellPassage& passage) const {
    if (!cells_.trapped_after) return;
    const double time = passage.costs[0], limit = *cells_.trapped_after;
    const std::string named = "cell.trapped_after_s = " + shortest(limit) + " of " + cells_.source;
    if (passage.fate == Fate::trapped && time < limit * (1.0 - kSameClock))
      refuse_value(
          columns_.costs[0],
          "at least " + named + " where out is trapped; a body that was seen no longer is lost");
    if (passage.fate != Fate::trapped && time > limit * (1.0 + kSameClock))
      refuse_value(columns_.costs[0], "at most " + named +
                                          "; a body that stayed longer is trapped, and its trial "
                                          "ends there");
  }

  void require_each_trial_once() {
    const auto key = [](const SeenTrial& t) { return std::tie(t.body, t.trial, t.line); };
    const auto before = [&](const SeenTrial& a, const SeenTrial& b) { return key(a) < key(b); };
    if (!std::is_sorted(seen_.begin(), seen_.end(), before))
      std::sort(seen_.begin(), seen_.end(), before);
    const auto twice =
        std::adjacent_find(seen_.begin(), seen_.end(), [](const SeenTrial& a, const SeenTrial& b) {
          return a.body == b.body && a.trial == b.trial;
        });
    if (twice != seen_.end())
      table_.refuse(twice[1].line,
                    "this trial of body " + printable(runs_.bodies[twice->body]) +
                        " began in line " + std::to_string(twice->line) +
                        " already: the passages of a trial must stand one behind the other");
  }

  struct SeenTrial {
    std::size_t body;
    std::uint64_t trial;
    std::int64_t line;
  };

  Table table_;
  const CellFile& cells_;
  const Section& section_;
  CostColumns cost_columns_;
  Columns columns_;
  RecordedRuns runs_;
  NameTable bodies_, texts_;
  std::vector<SeenTrial> seen_;
  std::string body_, trial_;                // of the current trial
  CellPassage last_{.fate = Fate::broken};  // last passage of the current trial
  std::int64_t last_line_ = 0;
};

/// Calls use(entry) for all entries into cells, in order.
template <class Use>
void each_recorded_entry(const RecordedRuns& runs, const Use& use) {
  for (const RecordedTrial& trial : runs.trials) {
    use(trial.start);
    const auto passages = runs.of_trial(trial);
    for (std::size_t i = 0; i + 1 < passages.size(); ++i) use(passages[i].entry);
  }
}

void set_scales(CellFile& cells, const RecordedRuns& runs) {
  std::array<double, dynamics::kMostCoordinates> mean{}, squares{};
  const std::size_t coordinates = cells.map.section.coordinates.size();
  const auto n = static_cast<double>(runs.passages.size());
  each_recorded_entry(runs, [&](const Entry& entry) {
    for (std::size_t c = 0; c < coordinates; ++c) mean[c] += entry.at[c] / n;
  });
  each_recorded_entry(runs, [&](const Entry& entry) {
    for (std::size_t c = 0; c < coordinates; ++c)
      squares[c] += (entry.at[c] - mean[c]) * (entry.at[c] - mean[c]) / n;
  });
  for (std::size_t c = 0; c < coordinates; ++c) {
    if (cells.has_scale[c]) continue;
    dynamics::Coordinate& coordinate = cells.map.section.coordinates[c];
    coordinate.scale = squares[c] > 0.0 ? std::sqrt(squares[c]) : 1.0;
    if (!std::isfinite(coordinate.scale))
      throw std::invalid_argument(cells.source + ": coordinate " + coordinate.name +
                                  " was seen so far apart that it needs a scale of its own");
  }
}

// ---- Writing

class RunsWriter {
 public:
  RunsWriter(const CellFile& cells, const markov::WriteBytes& write)
      : cells_(cells), section_(cells.map.section), write_(write) {
    text_.reserve(2 * kBytesAtOnce);
    text_ = with_commas(column_names(cells, has_types())) + "\n";
  }

  void add(const std::string& body, std::int64_t trial, const RecordedTrial& of,
           const PassageTable::Rows& passages) {
    Entry entry = of.start;
    for (std::size_t i = 0; i < passages.size(); ++i) {
      const CellPassage passage = passages[i];
      require(passage, entry, i + 1 == passages.size(), body, trial);
      text_ += body;
      text_ += ',';
      add_digits(trial);
      if (has_types()) text_ += "," + cells_.types.at(passage.type);
      text_ += ',';
      add_entry(entry);
      text_ += ',';
      if (passage.fate == Fate::left)
        add_entry(passage.entry);
      else
        text_ += (passage.fate == Fate::trapped ? "trapped" : "lost") +
                 std::string(section_.coordinates.size(), ',');
      for (std::size_t c = 0; c < section_.costs.size(); ++c) {
        text_ += ',';
        if (!std::isnan(passage.costs[c])) add_digits(passage.costs[c]);
      }
      text_ += '\n';
      entry = passage.entry;
      if (text_.size() >= kBytesAtOnce) flush();
    }
  }
  void flush() {
    write_(text_);
    text_.clear();
  }

 private:
  [[nodiscard]] bool has_types() const { return cells_.types.size() > 1; }
  template <class Number>
  void add_digits(Number x) {
    std::array<char, 32> digits;
    text_.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), x).ptr);
  }
  void add_entry(const Entry& entry) {
    text_ += section_.faces.at(static_cast<std::size_t>(entry.face)).name;
    for (std::size_t c = 0; c < section_.coordinates.size(); ++c) {
      text_ += ',';
      add_digits(entry.at[c]);
    }
  }
  void require(const CellPassage& passage, const Entry& entry, bool is_last,
               const std::string& body, std::int64_t trial) const {
    const double time = passage.costs[0];
    bool good = passage.fate == Fate::broken ? !(time < 0.0) : time > 0.0;
    good = good && (is_last || passage.fate == Fate::left);
    for (std::size_t c = 0; c < section_.coordinates.size(); ++c)
      good = good && std::isfinite(entry.at[c]) && std::isfinite(passage.entry.at[c]);
    for (std::size_t c = 0; c < section_.costs.size(); ++c)
      good = good && !std::isinf(passage.costs[c]);
    if (!good)
      throw std::invalid_argument("write_runs: a passage of trial " + std::to_string(trial) +
                                  " of body " + printable(body) +
                                  " has a time <= 0, a number that is not finite, or others "
                                  "behind it though it did not leave");
  }

  const CellFile& cells_;
  const Section& section_;
  const markov::WriteBytes& write_;
  std::string text_;
};

}  // namespace

std::string body_field(const std::string& text) {
  if (says_nothing(text) || text.find_first_of("\r\n") != text.npos)
    throw std::invalid_argument("write_runs: a body must have a name without line ends, not \"" +
                                printable(text) + "\"");
  const bool plain = text.find_first_of(",\"") == text.npos && text.front() != '#' &&
                     trimmed(text).size() == text.size();
  if (plain) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::vector<EnteredPassage> entered_passages(const RecordedRuns& runs) {
  std::vector<EnteredPassage> all;
  for (const RecordedTrial& trial : runs.trials) {
    Entry from = trial.start;
    for (const CellPassage passage : runs.of_trial(trial)) {
      all.push_back({from, passage});
      from = passage.entry;
    }
  }
  return all;
}

bool has_columns(const std::string& path, std::initializer_list<std::string_view> columns) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;  // a pipe can be read only once
  const auto has_all = [&](const Table::Names& names) {
    return std::all_of(columns.begin(), columns.end(), [&](std::string_view column) {
      return Table::column_in(names, column).has_value();
    });
  };
  try {
    return Table(path, has_all).has_header();
  } catch (const std::invalid_argument&) {  // the reader of the table reports what is wrong with it
    return false;
  }
}

RecordedRuns read_runs(const std::string& path, CellFile& cells, CostColumns costs) {
  RecordedRuns runs = RunsReader(path, cells, costs).read();
  set_scales(cells, runs);
  return runs;
}

void write_runs(const std::string& path, const CellFile& cells, const RecordedRuns& runs) {
  std::vector<std::string> names;
  for (const std::string& body : runs.bodies) names.push_back(body_field(body));
  std::vector<std::int64_t> trials(runs.bodies.size());
  markov::replace_file(path, [&](const markov::WriteBytes& write) {
    RunsWriter writer(cells, write);
    for (const RecordedTrial& trial : runs.trials) {
      const auto body = static_cast<std::size_t>(trial.body);
      writer.add(names.at(body), ++trials[body], trial, runs.of_trial(trial));
    }
    writer.flush();
  });
}

}  // namespace gatewalk::lattice
