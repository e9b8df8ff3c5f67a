// SPDX-License-Identifier: MIT
#include "cli/exchange/imported.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>

#include "cli/fields/csv.h"
#include "lattice/text/csv.h"
#include "lattice/text/digits.h"
#include "lattice/text/table.h"
#include "lattice/text/toml_text.h"

namespace gatewalk::cli {
namespace {

using lattice::shortest;

/// The name of a face that has none: its move, such as "ahead" or "right".
std::string name_of_move(int x, int y) {
  if (x == 0 && y == 1) return "ahead";
  if (x == 0 && y == -1) return "back";
  if (x == 1 && y == 0) return "right";
  if (x == -1 && y == 0) return "left";
  const auto sign = [](int n) { return (n < 0 ? "m" : "") + std::to_string(std::abs(n)); };
  return fmt::format("move_{}_{}", sign(x), sign(y));
}

/// The first state of each face, in the order of the states.
std::vector<const ForeignState*> faces_of(const std::vector<ForeignState>& states) {
  std::vector<const ForeignState*> faces;
  for (const ForeignState& s : states)
    if (std::none_of(faces.begin(), faces.end(), [&](const auto* f) { return f->face == s.face; }))
      faces.push_back(&s);
  return faces;
}

/// How many steps of a whole number stand for probability 1: as many as doubles resolve, but so few
/// that sums over all rows do not overflow.
double steps_of(std::int64_t states) {
  int bits = 53;
  while (bits > 20 && std::ldexp(static_cast<double>(states) + 1.0, bits) > std::ldexp(1.0, 62))
    --bits;
  return std::ldexp(1.0, bits);
}

constexpr double kOff = 1e-9;  // how far the sum of a row of doubles may be from 1

/// How far rounding may have moved the sum of a row: half a unit of the last digit of each number.
/// Zero for numbers of one or two digits, which a person wrote and meant exactly.
double rounding_of(const SparseTable& table, std::size_t begin, std::size_t end, bool floats) {
  constexpr int kFewestDigits = 3;
  if (table.precision.digits < kFewestDigits) return 0.0;
  double most = 0.0;
  for (std::size_t k = begin; k < end; ++k) {
    const double value = table.entries[k].value;
    if (value == 0.0) continue;
    // A number without trailing zeros hides its last digit. The table shows it, by digits after the
    // point or by significant digits.
    const double last =
        std::max(std::pow(10.0, -table.precision.decimals),
                 std::pow(10.0, std::floor(std::log10(value)) + 1.0 - table.precision.digits));
    most += 0.5 * std::max(last, floats ? double{std::numeric_limits<float>::epsilon()} : 0.0);
  }
  constexpr double kTies = 1.0 + 1e-6;  // for sums that are off by exactly this much
  return most * kTies;
}

std::string row_text(const SparseTable::Entry& e) {
  return fmt::format("row {} (counted from 0)", e.row);
}

constexpr const char* kEffective =
    "round effective counts to whole numbers, which keeps error bars, or divide each row by its "
    "sum, "
    "which makes probabilities, without error bars";

/// Replaces the probabilities of each row by whole numbers of steps, which sum to steps_of().
void in_steps(const std::string& path, SparseTable& table) {
  const double steps = steps_of(table.rows);
  // Numbers that were floats, or texts with no more digits than floats have.
  const bool floats =
      table.precision.digits <= std::numeric_limits<float>::max_digits10 ||
      std::all_of(table.entries.begin(), table.entries.end(), [](const SparseTable::Entry& e) {
        return e.value == double{static_cast<float>(e.value)};
      });
  std::string scaled;
  for (std::size_t begin = 0, end = 0; begin < table.entries.size(); begin = end) {
    double sum = 0.0;
    for (; end < table.entries.size() && table.entries[end].row == table.entries[begin].row; ++end)
      sum += table.entries[end].value;
    if (const double off = std::abs(sum - 1.0); sum != 0.0 && off > kOff) {
      if (off > rounding_of(table, begin, end, floats))
        throw std::runtime_error(
            fmt::format("{}: {} sums to {}: probabilities of a row sum to 1, counts are whole "
                        "numbers (integer, count); {}",
                        path, row_text(table.entries[begin]), shortest(sum), kEffective));
      if (scaled.empty()) scaled = row_text(table.entries[begin]) + " to " + shortest(sum);
      for (std::size_t k = begin; k < end; ++k) table.entries[k].value /= sum;
    }
    double left = sum == 0.0 ? 0.0 : steps;
    std::size_t largest = begin;
    for (std::size_t k = begin; k < end; ++k) {
      SparseTable::Entry& e = table.entries[k];
      if (e.value > table.entries[largest].value) largest = k;
    }
    for (std::size_t k = begin; k < end; ++k) {
      SparseTable::Entry& e = table.entries[k];
      if (k == largest) continue;
      e.value = std::round(e.value * steps);
      left -= e.value;
    }
    table.entries[largest].value = left;
  }
  if (!scaled.empty())
    table.understood.push_back(fmt::format(
        "rows sum to 1 but for the rounding of their numbers ({}): divided by their sums", scaled));
  std::erase_if(table.entries, [](const SparseTable::Entry& e) { return e.value == 0.0; });
}

/// Whether a table of reals holds whole numbers, as counts are. Notes in `understood` what the
/// numbers are taken for.
bool are_counts(SparseTable& table) {
  const auto is_whole = [](const SparseTable::Entry& e) { return e.value == std::floor(e.value); };
  if (table.entries.empty() || !std::all_of(table.entries.begin(), table.entries.end(), is_whole))
    return false;
  std::map<std::int64_t, double> sums;
  for (const SparseTable::Entry& e : table.entries) sums[e.row] += e.value;
  const auto any_above = [&](double low) {
    return std::any_of(sums.begin(), sums.end(), [&](const auto& s) { return s.second > low; });
  };
  if (!any_above(0.0)) return false;
  const bool counts = any_above(1.0);
  table.understood.emplace_back(
      counts ? "whole numbers, written as reals: counts"
             : "each row is a single 1, a real: probabilities (as integers they would be counts of "
               "one run each)");
  return counts;
}

/// Counts each step of the trajectories. -1 is a gap, which cuts a trajectory into two.
SparseTable counts_of(const std::string& path, const Trajectories& all, std::int64_t states) {
  constexpr std::int64_t kGap = -1;
  std::map<std::pair<std::int64_t, std::int64_t>, std::int64_t> counts;
  std::int64_t cut = 0, pieces = 0;
  for (std::size_t t = 0; t < all.size(); ++t) {
    const auto& one = all[t];
    const bool has_gaps = std::find(one.begin(), one.end(), kGap) != one.end();
    cut += has_gaps ? 1 : 0;
    for (std::size_t k = 0; k < one.size(); ++k) {
      if (one[k] == kGap) continue;
      const bool is_last = k + 1 == one.size() || one[k + 1] == kGap;
      if (one[k] < 0 || one[k] > (is_last ? states : states - 1))
        throw std::runtime_error(
            fmt::format("{}: trajectory {}, step {} (counted from 0): there is no state {} (0 to "
                        "{}; at the end {}: trapped; -1: a gap)",
                        path, t, k, one[k], states - 1, states));
      pieces += has_gaps && is_last ? 1 : 0;
      if (k > 0 && one[k - 1] != kGap) ++counts[{one[k - 1], one[k]}];
    }
  }
  if (counts.empty())
    throw std::runtime_error(path +
                             ": no trajectory has a second state: one column? a line is a "
                             "trajectory, its states between blanks; of .npz an array is one");
  SparseTable table{states, states + 1, {}, true};
  for (const auto& [place, n] : counts)
    table.entries.push_back({place.first, place.second, static_cast<double>(n)});
  if (cut > 0)
    table.understood.push_back(fmt::format(
        "-1 is a gap: {} of {} trajectories are cut there, into {}", cut, all.size(), pieces));
  return table;
}

}  // namespace

std::vector<ForeignState> read_states(const std::string& path,
                                      std::vector<std::string>* understood) {
  using lattice::Table;
  Table file(path, [](const Table::Names& names) {
    return Table::column_in(names, "state") && Table::column_in(names, "move_x") &&
           Table::column_in(names, "move_y");
  });
  if (!file.has_header())
    file.refuse(std::max<std::int64_t>(1, file.header_line()),
                "must name the columns state,move_x,move_y[,name][,face]; there are " +
                    file.column_words());
  std::vector<ForeignState> states;
  std::set<std::string> names;
  std::map<std::string, std::pair<int, int>> moves;  // by face
  while (file.next()) {
    const auto refuse = [&](const std::string& what) { file.refuse(what); };
    const auto field = [&](const char* name) {
      const auto at = file.column(name);
      return !at || lattice::says_nothing(file[*at]) ? std::string() : std::string(file[*at]);
    };
    const auto whole = [&](const char* name) {
      const std::string text = field(name);
      const double value = file.number(text).value_or(HUGE_VAL);
      if (value != std::floor(value) || !(std::abs(value) <= 1e6))
        refuse(fmt::format("{} \"{}\" is no whole number", name, lattice::printable(text)));
      return static_cast<int>(value);
    };
    if (whole("state") != std::ssize(states))
      refuse(fmt::format("state must be {}: they are numbered from 0, in order", states.size()));
    const auto name = file.column("name");
    ForeignState s{name ? std::string(file[*name]) : std::string(), field("face"), whole("move_x"),
                   whole("move_y")};
    if (file.column(lattice::kCountsPerRun)) {
      s.counts_per_run = whole(lattice::kCountsPerRun);
      if (s.counts_per_run != 1 && s.counts_per_run != 2)
        refuse(std::string(lattice::kCountsPerRun) +
               " must be 1, or 2 where a run is counted with its mirror "
               "image");
    }
    if (s.move_x == 0 && s.move_y == 0) refuse("the move must lead to another cell");
    constexpr int kFarthest = 1000;  // as in a cell file
    if (std::abs(s.move_x) > kFarthest || std::abs(s.move_y) > kFarthest)
      refuse(fmt::format("a move must lead {} cells at most", kFarthest));
    if (s.name.empty()) s.name = std::to_string(states.size());
    if (s.name == "trapped" || !names.insert(s.name).second)
      refuse(fmt::format("name \"{}\" is taken", lattice::printable(s.name)));
    if (s.face.empty()) s.face = name_of_move(s.move_x, s.move_y);
    if (!lattice::is_name(s.face) || s.face == "trapped" || s.face == "lost")
      refuse(
          fmt::format("face \"{}\" must be a name: a letter, then letters, digits and _, neither "
                      "trapped nor lost",
                      lattice::printable(s.face)));
    const auto [move, is_new] = moves.try_emplace(s.face, s.move_x, s.move_y);
    if (move->second != std::pair(s.move_x, s.move_y))
      refuse(fmt::format("face {} has another move than before", s.face));
    if (is_new && moves.size() > dynamics::kMostFaces)
      refuse(fmt::format(
          "there are more than {} faces: states that are entered by one move may share one",
          dynamics::kMostFaces));
    states.push_back(std::move(s));
    if (states.size() > static_cast<std::size_t>(dynamics::kMostStates))
      refuse(fmt::format("there are more than {} states", dynamics::kMostStates));
  }
  if (states.empty()) throw std::runtime_error(path + ": holds no states");
  for (std::int64_t k = 0; k < std::ssize(states); ++k)
    if (const std::string& name = states[static_cast<std::size_t>(k)].name;
        name != std::to_string(k))
      if (const auto number = Table::whole(name);
          number && *number >= 0 && *number < std::ssize(states))
        throw std::runtime_error(
            fmt::format("{}: \"{}\" is the name of state {} and the number of another, which count "
                        "from 0: give states names that are no numbers, or none",
                        path, lattice::printable(name), k));
  if (understood)
    for (const std::string& remark : file.remarks()) understood->push_back(path + ": " + remark);
  return states;
}

std::string states_csv(const lattice::MatrixFile& file,
                       const std::vector<std::int64_t>& counts_per_run) {
  const dynamics::StateSpace& space = file.transitions.space;
  const dynamics::Section& section = space.section();
  std::string text = "state,name,face,move_x,move_y";
  for (const dynamics::Coordinate& c : section.coordinates)
    text += fmt::format(",{0}_low,{0}_high", c.key);
  if (!counts_per_run.empty()) text += std::string(",") + lattice::kCountsPerRun;
  const std::vector<std::string> names = lattice::state_names(file);
  for (const int s : lattice::shown_order(space)) {
    const dynamics::Face& face = section.faces[static_cast<std::size_t>(space.face(s))];
    text += fmt::format("\n{},{},{},{},{}", lattice::shown_number(space, s),
                        csv_text(names[static_cast<std::size_t>(s)]), csv_text(face.name),
                        face.di_x, face.di_y);
    const dynamics::StateRange range = space.range(s);
    for (std::size_t c = 0; c < section.coordinates.size(); ++c)
      text += fmt::format(",{},{}", shortest(range.at[c][0]), shortest(range.at[c][1]));
    if (!counts_per_run.empty())
      text += fmt::format(",{}", counts_per_run[static_cast<std::size_t>(s)]);
  }
  return text + "\n";
}

ForeignMatrix read_foreign(const std::string& path, const std::vector<ForeignState>& states) {
  const std::int64_t n = std::ssize(states);
  std::vector<std::string> names;
  for (const ForeignState& s : states) names.push_back(s.name);
  names.emplace_back("trapped");
  const auto ends_in = [&](std::string_view ending) { return lattice::has_ending(path, ending); };
  const bool npz = ends_in(".npz");
  std::vector<NumpyArray> arrays;
  if (npz) arrays = read_npz(path);
  ForeignMatrix matrix;
  if (ends_in(".dtrajs") || (npz && hold_trajectories(arrays))) {
    matrix.table = counts_of(
        path, npz ? trajectories_of(path, std::move(arrays)) : read_trajectories(path), n);
    matrix.trajectories = true;
    return matrix;
  }
  if (ends_in(".mtx"))
    matrix.table = read_matrix_market(path);
  else if (ends_in(".csv"))
    matrix.table = read_csv(path, n, names);
  else if (npz)
    matrix.table = table_of(path, arrays);
  else
    throw std::runtime_error(
        path + ": must end in .mtx, .csv, .npz or .dtrajs" +
        (ends_in(".tra") || ends_in(".drn") || ends_in(".umb")
             ? ": a model checker's chain is one of a whole field, import takes that of one cell "
               "(export --gate -o FILE.mtx); of a .tra of one cell sed -e '1cfrom,to,probability' "
               "-e 's/ /,/g' makes a .csv"
             : ""));
  SparseTable& table = matrix.table;
  if (!table.whole && !table.probabilities) table.whole = are_counts(table);
  const auto is_of_trapped = [n](const SparseTable::Entry& e) { return e.row == n; };
  if (table.rows == n + 1 && table.columns == n + 1 &&
      std::all_of(table.entries.begin(), table.entries.end(), [&](const SparseTable::Entry& e) {
        return !is_of_trapped(e) || e.column == n || e.value == 0.0;
      })) {
    table.rows = n;
    std::erase_if(table.entries, is_of_trapped);
    table.understood.emplace_back("the last state, which is never left, is trapped");
  }
  if (table.rows != n || (table.columns != n && table.columns != n + 1))
    throw std::runtime_error(
        fmt::format("{0}: is {1} x {2}; of {3} states it must be {3} x {4}, the last column "
                    "trapped, or {3} x {3}",
                    path, table.rows, table.columns, n, n + 1));
  table.columns = n + 1;
  for (const SparseTable::Entry& e : table.entries)
    if (!(e.value >= 0.0) || !std::isfinite(e.value) ||
        (table.whole && (e.value != std::floor(e.value) || e.value > 1e15)))
      throw std::runtime_error(
          fmt::format("{}: row {}, column {} (counted from 0): {}{}{}", path, e.row, e.column,
                      shortest(e.value), table.whole ? " is no count" : " is no probability",
                      table.whole && e.value > 0.0 && std::isfinite(e.value)
                          ? fmt::format(": counts are whole numbers of runs; {}", kEffective)
                          : ""));
  matrix.probabilities = !table.whole;
  if (matrix.probabilities) in_steps(path, table);
  double sum = 0.0;
  for (const SparseTable::Entry& e : table.entries) sum += e.value;
  if (sum > std::ldexp(1.0, 62))
    throw std::runtime_error(fmt::format("{}: its counts add up to {}, more than a matrix may have",
                                         path, shortest(sum)));
  return matrix;
}

std::string cell_text(const std::vector<ForeignState>& states, double width, double length) {
  std::string text = fmt::format("[cell]\nwidth_m = {}\nlength_m = {}\nsymmetric = false\n",
                                 lattice::toml_float(width), lattice::toml_float(length));
  for (const ForeignState* face : faces_of(states)) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (std::size_t s = 0; s < states.size(); ++s)
      if (states[s].face == face->face) {
        low = std::min(low, static_cast<double>(s) - 0.5);
        high = std::max(high, static_cast<double>(s) + 0.5);
      }
    text += fmt::format(
        "\n[[cell.faces]]\nname = \"{}\"\nmove = [{}, {}]\nusual.state = [{}, {}]\n", face->face,
        face->move_x, face->move_y, lattice::toml_float(low), lattice::toml_float(high));
  }
  return text +
         "\n[[cell.coordinates]]\nname = \"state\"\nunit = \"1\"\nscale = 1.0\nwords = \"number of "
         "the "
         "state\"\n";
}

dynamics::Entry entry_of(const std::vector<ForeignState>& states, std::size_t state,
                         const dynamics::Section& section) {
  dynamics::Entry entry;
  while (section.faces[static_cast<std::size_t>(entry.face)].name != states[state].face)
    ++entry.face;
  entry.at[0] = static_cast<double>(state);
  return entry;
}

std::vector<int> places_of(const std::vector<ForeignState>& states,
                           const dynamics::StateSpace& space) {
  std::vector<int> places;
  for (std::size_t s = 0; s < states.size(); ++s)
    places.push_back(space.index_of(entry_of(states, s, space.section())).state);
  return places;
}

dynamics::Transitions transitions_of(const ForeignMatrix& matrix,
                                     const std::vector<ForeignState>& states,
                                     const lattice::CellFile& cells) {
  const dynamics::Section& section = cells.map.section;
  std::vector<dynamics::Bins> bins;
  for (const dynamics::Face& face : section.faces) {
    auto& edges = bins.emplace_back().edges[0];
    double before = 0.0;
    for (std::size_t s = 0; s < states.size(); ++s) {
      if (states[s].face != face.name) continue;
      const auto at = static_cast<double>(s);
      edges.push_back(edges.empty() ? at - 0.5 : 0.5 * (before + at));
      before = at;
    }
    edges.push_back(before + 0.5);
  }
  dynamics::Transitions t(dynamics::StateSpace(section, std::move(bins)));
  std::vector<int> place = places_of(states, t.space);
  place.push_back(t.space.trapped());
  for (const SparseTable::Entry& e : matrix.table.entries) {
    if (e.value == 0.0) continue;
    const auto row = static_cast<std::size_t>(place[static_cast<std::size_t>(e.row)]);
    const auto n = static_cast<std::int64_t>(e.value);
    t.rows[row][place[static_cast<std::size_t>(e.column)]] = n;
    t.trials[row] += n;
  }
  return t;
}

lattice::MatrixFile matrix_file(dynamics::Transitions t, const std::vector<ForeignState>& states,
                                std::map<std::string, std::string> text) {
  std::vector<double> number(static_cast<std::size_t>(t.space.size())), per_run(number.size());
  std::vector<std::string> names(number.size());
  const std::vector<int> place = places_of(states, t.space);
  for (std::size_t s = 0; s < states.size(); ++s) {
    const auto at = static_cast<std::size_t>(place[s]);
    number[at] = static_cast<double>(s);
    per_run[at] = states[s].counts_per_run;
    names[at] = states[s].name;
  }
  names.emplace_back("trapped");
  lattice::MatrixFile file{std::move(t), std::move(text)};
  file.arrays.push_back({lattice::kNumberOfState, "1",
                         "number of each state in the table it was made of", std::move(number),
                         "input_state", true});
  if (per_run.front() > 0.0)
    file.arrays.push_back({lattice::kCountsPerRun, "1",
                           "counts that a run makes in the row of each state; 2: its own and its "
                           "mirror image's; neighbouring rows that are equal are the same runs",
                           std::move(per_run), "input_state", true});
  lattice::name_states(file, std::move(names));
  return file;
}

}  // namespace gatewalk::cli
