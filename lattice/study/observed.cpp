#include "lattice/study/observed.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <stdexcept>
#include <string_view>

#include "lattice/scene/csv.h"
#include "lattice/scene/toml_text.h"

namespace gatewalk::lattice {
namespace {

using Fields = std::vector<std::string>;

constexpr const char* kTables = "gate_x,gate_y,count or ending,count";

std::string quoted(const std::string& text) {
  std::string shown = "\"";
  return shown.append(printable(text)).append("\"");
}

/// A table of counts as its file has it.
struct CountTable {
  struct Row {
    std::size_t line;
    Fields fields;
  };
  std::string path;
  Fields columns;
  std::vector<Row> rows;

  [[nodiscard]] bool is_of_endings() const { return columns.size() == 2; }
  [[noreturn]] void refuse(std::size_t line, const std::string& what) const {
    throw std::invalid_argument(path + ":" + std::to_string(line) + ": " + what);
  }
  [[nodiscard]] const std::string& at(const Row& row, std::string_view column) const {
    const auto found = std::find(columns.begin(), columns.end(), column);
    return row.fields[static_cast<std::size_t>(found - columns.begin())];
  }
  /// A whole number in [low, high]; `because` says why.
  [[nodiscard]] std::int64_t whole(const Row& row, std::string_view column, std::int64_t low,
                                   std::int64_t high, const std::string& because) const {
    const std::string& text = at(row, column);
    std::int64_t value = 0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
    if (read.ec != std::errc() || read.ptr != text.data() + text.size() || value < low ||
        value > high)
      refuse(row.line, "column " + std::string(column) + ": " +
                           (text.empty() ? "nothing" : quoted(text)) +
                           " is not permitted: must be a whole number from " + std::to_string(low) +
                           " to " + std::to_string(high) + because);
    return value;
  }
};

Fields sorted(Fields fields) {
  std::sort(fields.begin(), fields.end());
  return fields;
}

void require_columns(const CountTable& table, std::size_t line) {
  static const Fields kOfGates{"count", "gate_x", "gate_y"}, kOfEndings{"count", "ending"};
  const auto known = [](const Fields& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  for (const std::string& column : table.columns)
    if (!known(kOfGates, column) && !known(kOfEndings, column))
      table.refuse(line, "unknown column " + quoted(column) + ": the first line must be " +
                             kTables + ", with commas between");
  if (const Fields columns = sorted(table.columns); columns != kOfGates && columns != kOfEndings)
    table.refuse(line, std::string("the columns must be ") + kTables + ", each once");
}

CountTable read_table(const std::string& path) {
  constexpr std::uintmax_t kMostBytes = 100'000'000;
  std::error_code none;  // of pipes and the like
  if (const auto size = std::filesystem::file_size(path, none); !none && size > kMostBytes)
    throw std::invalid_argument(path + ": has " + std::to_string(size) +
                                " bytes, more than a table of counts");
  const auto lines = lines_of(path);
  if (!lines) throw std::invalid_argument("--observed " + path + ": cannot be read");
  CountTable table{path, {}, {}};
  for (std::size_t i = 0; i < lines->size(); ++i) {
    const std::string& text = (*lines)[i];
    const std::size_t line = i + 1, first = text.find_first_not_of(" \t");
    if (first == text.npos || text[first] == '#') continue;
    auto fields = csv_fields(text);
    if (!fields) table.refuse(line, "a quotation mark is not closed, or not at a field's end");
    if (table.columns.empty()) {
      table.columns = std::move(*fields);
      require_columns(table, line);
      continue;
    }
    if (fields->size() != table.columns.size())
      table.refuse(line, "has " + std::to_string(fields->size()) + " fields, the first line " +
                             std::to_string(table.columns.size()));
    table.rows.push_back({line, std::move(*fields)});
  }
  if (table.columns.empty())
    throw std::invalid_argument(path + ": is empty: the first line must be " + kTables);
  return table;
}

std::int64_t count_of(const CountTable& table, const CountTable::Row& row) {
  return table.whole(row, "count", 0, 1'000'000'000, "");
}

void add_gates(Observed& observed, const CountTable& table, const FieldParams& field) {
  CellCounts& gates = observed.seen.final_gates;
  gates = CellCounts::Zero(field.rows, field.columns);
  markov::CellCounts given = gates;  // by which line
  for (const CountTable::Row& row : table.rows) {
    const auto x =
        table.whole(row, "gate_x", -field.start_column(), field.columns - 1 - field.start_column(),
                    " (field.columns = " + std::to_string(field.columns) + ")");
    const auto y = table.whole(row, "gate_y", 0, field.rows - 1,
                               " (field.rows = " + std::to_string(field.rows) + ")");
    const std::int64_t column = x + field.start_column();
    if (given(y, column) > 0)
      table.refuse(row.line, "gate_x = " + std::to_string(x) + ", gate_y = " + std::to_string(y) +
                                 " was given in line " + std::to_string(given(y, column)) +
                                 " already");
    given(y, column) = static_cast<std::int64_t>(row.line);
    gates(y, column) = count_of(table, row);
  }
  if (gates.sum() == 0)
    throw std::invalid_argument(table.path + ": has no trial: its counts add up to 0");
}

void add_endings(Observed& observed, const CountTable& table) {
  std::string all;
  for (const EndingName& e : kEndingNames) all += (all.empty() ? "" : ", ") + std::string(e.key);
  for (const CountTable::Row& row : table.rows) {
    const std::string& name = table.at(row, "ending");
    const auto known = std::find_if(kEndingNames.begin(), kEndingNames.end(),
                                    [&](const EndingName& e) { return e.key == name; });
    if (known == kEndingNames.end())
      table.refuse(row.line,
                   "column ending: " + quoted(name) + " is not permitted: must be one of " + all);
    const auto e = static_cast<std::size_t>(known->ending);
    if (observed.listed[e]) table.refuse(row.line, "ending " + name + " was given already");
    observed.listed[e] = true;
    observed.seen.endings[e] = count_of(table, row);
  }
  if (!observed.seen.has_endings())
    throw std::invalid_argument(table.path + ": has no trial: its counts add up to 0");
}

}  // namespace

Observed read_observed(const std::vector<std::string>& paths, const FieldParams& field) {
  Observed observed;
  std::string of_gates, of_endings;
  for (const std::string& path : paths) {
    const CountTable table = read_table(path);
    std::string& other = table.is_of_endings() ? of_endings : of_gates;
    if (!other.empty())
      throw std::invalid_argument("--observed " + path + ": " + other + " has " +
                                  (table.is_of_endings() ? "endings" : "final gates") +
                                  " too; at most one file of each is permitted");
    other = path;
    if (table.is_of_endings())
      add_endings(observed, table);
    else
      add_gates(observed, table, field);
  }
  const SeenEndings of_the_endings{{}, observed.seen.endings};
  if (observed.seen.has_gates() && observed.seen.has_endings() &&
      observed.seen.trials() != of_the_endings.trials())
    throw std::invalid_argument(
        of_gates + " has " + std::to_string(observed.seen.trials()) + " trials, " + of_endings +
        " " + std::to_string(of_the_endings.trials()) + ": both must be of the same trials");
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

ObservedComparison compare_observed(const SeenEndings& seen, const FieldTally& dynamics,
                                    const markov::FinalDistribution& chain,
                                    const std::vector<markov::FinalDistribution>& replicates,
                                    std::int64_t null_draws, std::uint64_t seed) {
  ObservedComparison c;
  c.seen = seen;
  if (seen.has_endings()) c.endings = EndingShares(seen.endings, seen.trials());
  if (seen.has_gates()) {
    c.dynamics_gates = compare(seen.final_gates, dynamics.final_gates, null_draws, seed);
    c.chain_gates = compare(seen.final_gates, chain.final_cells, null_draws, seed);
  }
  c.against_dynamics = judge(seen, {dynamics.final_gates, dynamics.endings}, null_draws, seed);
  c.against_chain = judge(seen, chain, replicates, null_draws, seed);
  // Where chance changes nothing, everything else is a finding: at any level.
  const double single_level = std::min(c.against_dynamics.single_level, Judgement::kLevel);
  c.least = least_differences(seen, chain, single_level, seed);
  return c;
}

}  // namespace gatewalk::lattice
