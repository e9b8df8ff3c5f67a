// SPDX-License-Identifier: MIT
#include "lattice/study/observed.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string_view>

#include "lattice/text/csv.h"
#include "lattice/text/table.h"
#include "lattice/text/toml_text.h"
#include "markov/predict.h"

namespace gatewalk::lattice {
namespace {

using Fields = std::vector<std::string>;

constexpr const char* kTables =
    "trial,ending, trial,gate_x,gate_y, or all four (with endings also time_s), "
    "gate_x,gate_y,count, "
    "or ending,count";

std::string quoted(const std::string& text) {
  std::string shown = "\"";
  return shown.append(printable(text)).append("\"");
}

/// A table as in its file, with column names in lower case.
struct CountTable {
  struct Row {
    std::int64_t line;
    Fields fields;
    std::optional<double> time{};  // NaN: empty; nullopt: no number
  };
  std::string path;
  Fields columns;
  std::vector<Row> rows;

  [[nodiscard]] bool has(std::string_view column) const {
    return std::find(columns.begin(), columns.end(), column) != columns.end();
  }
  [[noreturn]] void refuse(std::int64_t line, const std::string& what) const {
    throw std::invalid_argument(path + ":" + std::to_string(line) + ": " + what);
  }
  [[nodiscard]] const std::string& at(const Row& row, std::string_view column) const {
    const auto found = std::find(columns.begin(), columns.end(), column);
    return row.fields[static_cast<std::size_t>(found - columns.begin())];
  }
  /// A whole number in [low, high]; `because` explains the limits in the message.
  [[nodiscard]] std::int64_t whole(const Row& row, std::string_view column, std::int64_t low,
                                   std::int64_t high, const std::string& because) const {
    const std::string& text = at(row, column);
    const auto value = Table::whole(text);
    if (!value || *value < low || *value > high)
      refuse(row.line, "column " + std::string(column) + ": " +
                           (text.empty() ? "nothing" : quoted(text)) +
                           " is not permitted: must be a whole number from " + std::to_string(low) +
                           " to " + std::to_string(high) + because);
    return *value;
  }
};

void require_columns(const CountTable& table, const Table& file) {
  static const std::array<Fields, 7> kPermitted{
      {{"count", "gate_x", "gate_y"},
       {"count", "ending"},
       {"ending", "trial"},
       {"gate_x", "gate_y", "trial"},
       {"ending", "gate_x", "gate_y", "trial"},
       {"ending", "time_s", "trial"},
       {"ending", "gate_x", "gate_y", "time_s", "trial"}}};
  Fields sorted = table.columns;
  std::sort(sorted.begin(), sorted.end());
  if (std::find(kPermitted.begin(), kPermitted.end(), sorted) != kPermitted.end()) return;
  std::string unknown;
  for (const std::string& column : table.columns)
    if (column != "count" && column != "trial" && column != "ending" && column != "gate_x" &&
        column != "gate_y" && column != "time_s")
      unknown = "unknown column " + quoted(column) + ": ";
  table.refuse(file.header_line(), unknown + "the columns must be " + kTables +
                                       ", each once; there are " + file.column_words());
}

CountTable read_table(const std::string& path, std::vector<std::string>& remarks) {
  constexpr std::uintmax_t kMostBytes = 100'000'000;
  std::error_code none;  // pipes and the like have no size
  if (const auto size = std::filesystem::file_size(path, none); !none && size > kMostBytes)
    throw std::invalid_argument(path + ": has " + std::to_string(size) +
                                " bytes, more than a table of counts");
  Table file(path, [](const Table::Names& names) {
    const auto has = [&](const char* name) { return Table::column_in(names, name).has_value(); };
    return (has("count") || has("trial")) && (has("ending") || has("gate_x"));
  });
  if (file.columns().empty())
    throw std::invalid_argument(path + ": is empty: the columns must be " + kTables);
  CountTable table{path, {}, {}};
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < file.columns().size(); ++i) {
    const std::string& name = file.columns()[i];
    if (Table::is_index(name)) {
      remarks.push_back(path + ": column " + std::to_string(i + 1) + " has no name: left out");
    } else if (file.column(name) == i) {
      kept.push_back(i);
      table.columns.push_back(in_small_letters(name));
    }
  }
  require_columns(table, file);
  while (file.next()) {
    CountTable::Row row{file.line(), {}};
    for (std::size_t i = 0; i < kept.size(); ++i) {
      row.fields.emplace_back(file[kept[i]]);
      if (table.columns[i] == "time_s") row.time = file.number(file[kept[i]]);
    }
    table.rows.push_back(std::move(row));
  }
  for (const std::string& text : file.remarks()) remarks.push_back(path + ": " + text);
  return table;
}

std::int64_t count_of(const CountTable& table, const CountTable::Row& row) {
  return table.whole(row, "count", 0, 1'000'000'000, "");
}

void require_trials(const CountTable& table, std::int64_t trials, std::int64_t went_back) {
  if (trials == 0)
    throw std::invalid_argument(table.path + ": has no trial" +
                                (went_back > 0 ? " that did not go back" : "") +
                                (table.has("count") ? ": its counts add up to 0" : ""));
}

/// The gate of a row, as row and column of the field.
std::array<std::int64_t, 2> counted_gate(const CountTable& table, const CountTable::Row& row,
                                         const FieldParams& field) {
  const auto x =
      table.whole(row, "gate_x", -field.start_column(), field.columns - 1 - field.start_column(),
                  " (field.columns = " + std::to_string(field.columns) + ")");
  const auto y = table.whole(row, "gate_y", 0, field.rows - 1,
                             " (field.rows = " + std::to_string(field.rows) + ")");
  return {y, x + field.start_column()};
}

void add_gates(Observed& observed, const CountTable& table, const FieldParams& field) {
  CellCounts& gates = observed.seen.final_gates;
  gates = CellCounts::Zero(field.rows, field.columns);
  markov::CellCounts given = gates;  // line that gave each gate
  for (const CountTable::Row& row : table.rows) {
    const auto [y, column] = counted_gate(table, row, field);
    if (given(y, column) > 0)
      table.refuse(row.line, "gate_x = " + table.at(row, "gate_x") +
                                 ", gate_y = " + table.at(row, "gate_y") + " was given in line " +
                                 std::to_string(given(y, column)) + " already");
    given(y, column) = row.line;
    gates(y, column) = count_of(table, row);
  }
  require_trials(table, gates.sum(), 0);
}

/// The ending in a row; nullopt: the body went back.
std::optional<std::size_t> ending_of(const CountTable& table, const CountTable::Row& row) {
  const std::string& name = table.at(row, "ending");
  if (const auto ending = ending_named(name)) {
    if (*ending == kWentBack.ending) return {};
    return static_cast<std::size_t>(*ending);
  }
  std::string all;
  for (const EndingName& e : kEndingNames) all += std::string(e.name) + ", ";
  table.refuse(row.line, "column ending: " + quoted(name) + " is not permitted: must be one of " +
                             all + "or went back");
}

/// Throws for a trial that was cut off although the field has no limit of gates.
void require_limit(const CountTable& table, const CountTable::Row& row, std::size_t ending,
                   const FieldParams& field) {
  if (static_cast<markov::Ending>(ending) != markov::Ending::cut_off || field.max_gates > 0) return;
  table.refuse(row.line,
               "a body cannot have been cut off: field.max_gates = 0 lets it go through any number "
               "of gates; give field.max_gates what the experiment allowed");
}

void add_endings(Observed& observed, const CountTable& table, const FieldParams& field) {
  bool back_listed = false;
  for (const CountTable::Row& row : table.rows) {
    const auto e = ending_of(table, row);
    bool& listed = e ? observed.listed[*e] : back_listed;
    if (listed) table.refuse(row.line, "ending " + table.at(row, "ending") + " was given already");
    listed = true;
    const std::int64_t count = count_of(table, row);
    if (e && count > 0) require_limit(table, row, *e, field);
    (e ? observed.seen.endings[*e] : observed.went_back) = count;
  }
  require_trials(table, SeenEndings{{}, observed.seen.endings}.trials(), observed.went_back);
}

/// Throws unless the final gate of a body that left the field lies on the side that it left by.
/// Bodies may be trapped or cut off in any gate.
void require_at_side(const CountTable& table, const CountTable::Row& row, std::size_t ending,
                     const std::array<std::int64_t, 2>& gate, const FieldParams& field) {
  const std::int64_t gate_y = gate[0], gate_x = gate[1] - field.start_column();
  const auto require = [&](const std::string& name, std::int64_t given, std::int64_t value,
                           const std::string& why) {
    if (given == value) return;
    table.refuse(row.line, "a body that ended as " + quoted(table.at(row, "ending")) +
                               " cannot have " + name + " = " + std::to_string(given) +
                               ": must be " + std::to_string(value) + ", " + why);
  };
  const std::string columns = "(field.columns = " + std::to_string(field.columns) + ")";
  switch (static_cast<markov::Ending>(ending)) {
    case markov::Ending::far_edge:
      return require("gate_y", gate_y, field.rows - 1,
                     "the last row (field.rows = " + std::to_string(field.rows) + ")");
    case markov::Ending::left_edge:
      return require("gate_x", gate_x, -field.start_column(), "the first column " + columns);
    case markov::Ending::right_edge:
      return require("gate_x", gate_x, field.columns - 1 - field.start_column(),
                     "the last column " + columns);
    default:
      return;
  }
}

/// The time at which a body left the field, s; 0 if it did not.
double time_of(const CountTable& table, const CountTable::Row& row, std::size_t ending) {
  const auto e = static_cast<markov::Ending>(ending);
  const bool stayed = e == markov::Ending::trapped || e == markov::Ending::cut_off;
  if (stayed && says_nothing(table.at(row, "time_s"))) return 0.0;
  const double value = row.time.value_or(0.0);
  if (!(value > 0.0)) {
    const std::string& text = table.at(row, "time_s");
    table.refuse(row.line, "column time_s: " + (text.empty() ? "nothing" : quoted(text)) +
                               " is not permitted: must be the seconds until the body left the "
                               "field, above 0, such as 12.5");
  }
  return stayed ? 0.0 : value;
}

void add_lines(Observed& observed, const CountTable& table, const FieldParams& field) {
  const bool has_gates = table.has("gate_x"), has_endings = table.has("ending"),
             has_times = table.has("time_s");
  CellCounts& gates = observed.seen.final_gates;
  if (has_gates) gates = CellCounts::Zero(field.rows, field.columns);
  if (has_gates && has_endings) observed.gates_by_ending.fill(gates);
  if (has_endings)  // an ending without trials occurred 0 times; cut_off counts only if it occurs
    for (const EndingName& e : kEndingNames)
      observed.listed[static_cast<std::size_t>(e.ending)] = e.ending != markov::Ending::cut_off;
  std::map<std::string, std::int64_t, std::less<>> lines;
  for (const CountTable::Row& row : table.rows) {
    const std::string& trial = table.at(row, "trial");
    if (says_nothing(trial)) table.refuse(row.line, "column trial: has no name or number");
    if (const auto [first, is_new] = lines.emplace(trial, row.line); !is_new)
      table.refuse(row.line, "trial " + quoted(trial) + " was given in line " +
                                 std::to_string(first->second) + " already");
    std::optional<std::size_t> ending;
    if (has_endings) {
      ending = ending_of(table, row);
      if (!ending) {
        ++observed.went_back;
        continue;
      }
      require_limit(table, row, *ending, field);
      ++observed.seen.endings[*ending];
      observed.listed[*ending] = true;
    }
    if (has_times) observed.timed.push_back({*ending, -1, time_of(table, row, *ending)});
    if (!has_gates) continue;
    const auto gate = counted_gate(table, row, field);
    ++gates(gate[0], gate[1]);
    if (has_times) observed.timed.back().gate = gate[0] * field.columns + gate[1];
    if (!ending) continue;
    require_at_side(table, row, *ending, gate, field);
    ++observed.gates_by_ending[*ending](gate[0], gate[1]);
  }
  require_trials(table, static_cast<std::int64_t>(lines.size()) - observed.went_back,
                 observed.went_back);
}

void add(CellCounts& all, const CellCounts& some) {
  if (all.size() == 0)
    all = some;
  else if (some.size() > 0)
    all += some;
}

void add(Observed& all, const Observed& one) {
  add(all.seen.final_gates, one.seen.final_gates);
  const auto has_endings = [](const Observed& o) {
    return std::find(o.listed.begin(), o.listed.end(), true) != o.listed.end();
  };
  const bool is_first = !has_endings(all), has_any = has_endings(one);
  for (std::size_t e = 0; e < markov::kEndings; ++e) {
    all.seen.endings[e] += one.seen.endings[e];
    if (has_any) all.listed[e] = one.listed[e] && (is_first || all.listed[e]);
    add(all.gates_by_ending[e], one.gates_by_ending[e]);
  }
  all.timed.insert(all.timed.end(), one.timed.begin(), one.timed.end());
  all.went_back += one.went_back;
}

}  // namespace

Observed read_observed(const std::vector<std::string>& paths, const FieldParams& field) {
  require_different(paths);
  Observed observed;
  struct Recordings {
    std::string files;
    std::vector<bool> columns;  // of all files of this kind
  } of_gates, of_endings;
  for (const std::string& path : paths) {
    const CountTable table = read_table(path, observed.remarks);
    const std::vector<bool> columns{table.has("trial"), table.has("ending"), table.has("gate_x"),
                                    table.has("time_s")};
    const auto take = [&](Recordings& these, const char* what) {
      if (!these.files.empty() && these.columns != columns)
        throw std::invalid_argument(path + ": " + these.files + " has " + what +
                                    " too; files that are added up have the same columns");
      these = {these.files + (these.files.empty() ? "" : ", ") + path, columns};
    };
    if (table.has("ending")) take(of_endings, "endings");
    if (table.has("gate_x")) take(of_gates, "final gates");
    Observed one;
    if (table.has("trial"))
      add_lines(one, table, field);
    else if (table.has("ending"))
      add_endings(one, table, field);
    else
      add_gates(one, table, field);
    add(observed, one);
  }
  const SeenEndings of_the_endings{{}, observed.seen.endings};
  if (observed.seen.has_gates() && observed.seen.has_endings() &&
      observed.seen.trials() != of_the_endings.trials())
    throw std::invalid_argument(of_gates.files + " has " + std::to_string(observed.seen.trials()) +
                                " trials, " + of_endings.files + " " +
                                std::to_string(of_the_endings.trials()) +
                                ": both must be of the same trials");
  return observed;
}

namespace {

LeastDifferences least_differences(const SeenEndings& seen, const markov::FinalDistribution& model,
                                   double single_level, std::uint64_t seed) {
  LeastDifferences least;
  const std::int64_t n = seen.trials();
  if (seen.has_gates())
    least.final_gates = smallest_total_variation(gate_outcomes(model.final_cells), n, least.goal,
                                                 seed, single_level);
  if (!seen.has_endings()) return least;
  least.endings =
      smallest_total_variation(ending_outcomes(model.endings), n, least.goal, seed, single_level);
  for (const EndingName& e : kEndingNames) {
    const auto at = static_cast<std::size_t>(e.ending);
    least.by_ending[at] = smallest_difference(n, std::clamp(model.endings[at], 0.0, 1.0),
                                              {least.goal.power, single_level});
  }
  return least;
}

}  // namespace

ObservedComparison compare_observed(const SeenEndings& seen, int max_gates,
                                    const FieldTally& dynamics,
                                    const markov::FinalDistribution& chain,
                                    const std::vector<markov::FinalDistribution>& replicates,
                                    std::int64_t runs, std::int64_t null_draws,
                                    std::uint64_t seed) {
  if (max_gates == 0 && seen.endings[static_cast<std::size_t>(markov::Ending::cut_off)] > 0)
    throw std::invalid_argument("compare_observed: without a limit of gates nobody is cut off");
  ObservedComparison c;
  c.seen = seen;
  if (seen.has_endings()) {
    c.endings = EndingShares(seen.endings, seen.trials()).with_limit(max_gates);
  }
  if (seen.has_gates()) {
    c.dynamics_gates = compare(seen.final_gates, dynamics.final_cells, null_draws, seed);
    c.chain_gates = compare(seen.final_gates, chain.final_cells, null_draws, seed);
  }
  c.against_dynamics = joint_test(seen, {dynamics.final_cells, dynamics.endings}, null_draws, seed);
  c.against_chain = joint_test(seen, chain, replicates, runs, null_draws, seed);
  // A test without random variation finds any difference, at any level.
  const double single_level = std::min(c.against_dynamics.single_level, JointTest::kLevel);
  c.least = least_differences(seen, chain, single_level, seed);
  return c;
}

}  // namespace gatewalk::lattice
