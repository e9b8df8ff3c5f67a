// SPDX-License-Identifier: MIT
#include "cli/render/matrix.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "cli/fields/json_value.h"
#include "cli/fields/text.h"
#include "cli/fields/text_table.h"
#include "cli/render/choice.h"
#include "cli/render/health.h"
#include "cli/render/panel.h"
#include "cli/render/version.h"
#include "lattice/pool/tree_chain.h"
#include "lattice/source/cell_matrix.h"
#include "lattice/text/digits.h"
#include "markov/formats/counts.h"

namespace gatewalk::cli {
namespace {

using namespace dynamics;

/// Whether some rows of an imported matrix count each run with its mirror image.
bool counts_images(const lattice::MatrixFile& file) {
  const std::vector<std::int64_t> per_run = lattice::counts_per_run(file);
  return std::find(per_run.begin(), per_run.end(), 2) != per_run.end();
}

/// The number of runs behind an imported matrix whose rows say how often they count each run.
std::int64_t imported_runs_of(const lattice::MatrixFile& file) {
  const std::vector<std::int64_t> per_run = lattice::counts_per_run(file);
  double runs = 0.0;
  for (int s = 0; s < file.transitions.space.size(); ++s)
    runs += static_cast<double>(file.transitions.trials[s]) /
            static_cast<double>(per_run[static_cast<std::size_t>(s)]);
  return std::llround(runs);
}

/// The number of gate runs behind the counts. For trees the file's record gives it, because mirror
/// images are counted too, and first runs of trials are rows of their own.
std::int64_t gate_runs_of(const lattice::MatrixFile& file, const std::string& path) {
  const auto states = recorded_states(file, path);
  if (file.transitions.space.has_trees() && states && states->trees)
    return states->trees->gate_runs;
  if (counts_images(file)) return imported_runs_of(file);
  std::int64_t runs = file.transitions.totals().runs;
  for (const auto& [name, of_type] : file.types) runs += of_type.totals().runs;
  return runs;
}

/// The shares of a row's trials that enter the next gate through each boundary, then trapped.
std::vector<double> outcome_shares(const Transitions& t, int row) {
  const auto faces = std::ssize(t.space.section().faces);
  std::vector<double> share(static_cast<std::size_t>(faces) + 1, 0.0);
  if (t.trials[row] == 0) return share;
  for (const auto& [column, n] : t.rows[row]) {
    const int b = column == t.space.trapped() ? static_cast<int>(faces) : t.space.face(column);
    share[static_cast<std::size_t>(b)] +=
        static_cast<double>(n) / static_cast<double>(t.trials[row]);
  }
  return share;
}

/// "[-24.7, -8.95]": three digits, so that a line has room.
std::string short_range(const std::array<double, 2>& range) {
  return range[0] == range[1] ? digits(range[0], 3)
                              : fmt::format("[{}, {}]", digits(range[0], 3), digits(range[1], 3));
}

/// "18.2", "100", or "." for none: at most four characters.
std::string short_share(double share) {
  const std::string text = fixed(100.0 * share, 1);
  return share == 0.0 ? "." : text == "100.0" ? "100" : text;
}

std::string row_table(const Transitions& t) {
  const Section& section = t.space.section();
  const bool has_names = !section.named.empty(), has_clamped = t.totals().clamped_share() > 0.0;
  std::vector<TextColumn> columns{{"in", 4}};
  if (has_names) columns.push_back({"name", -kFit, 0, "", "  "});
  columns.push_back({"from", -kFit, 0, "", "  "});
  for (const Coordinate& c : section.coordinates) {
    const std::string unit = behind_number(c.unit);
    columns.push_back(
        {c.name + (unit.empty() ? "" : fmt::format(" ({})", unit.substr(1))), -kFit, 0, "", " "});
  }
  columns.push_back({"counts", 7});
  if (has_clamped) columns.push_back({"clamped", 8});
  for (const Face& face : section.faces)
    columns.push_back({face.name, std::max(5, static_cast<int>(face.name.size()) + 1), 0, "",
                       &face == &section.faces.front() ? " |" : ""});
  columns.push_back({"trap", 5});
  TextTable table(std::move(columns));
  for (const int row : lattice::shown_order(t.space)) {
    const StateRange range = t.space.range(row);
    std::vector<TextCell> cells{lattice::shown_number(t.space, row)};
    if (has_names) cells.emplace_back(name_of(section, range.middle()));
    cells.emplace_back(section.faces[range.face].name);
    for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis)
      cells.emplace_back(short_range(range.at[axis]));
    cells.emplace_back(t.trials[row]);
    if (has_clamped) cells.emplace_back(t.clamped[row]);
    for (const double share : outcome_shares(t, row)) cells.emplace_back(short_share(share));
    table.row(cells);
  }
  return "\nRows: the state of a body that enters a gate; the shares, in %, are the ways in which "
         "it "
         "enters the\nnext gate, and trapped\n" +
         table.text();
}

/// The outputs of a row in the order in which states are shown: state in the matrix, and count.
std::map<int, std::pair<int, std::int64_t>> outputs_of(const Transitions& t, int row) {
  std::map<int, std::pair<int, std::int64_t>> outputs;
  for (const auto& [column, count] : t.rows[row])
    outputs[lattice::shown_number(t.space, column)] = {column, count};
  return outputs;
}

std::string outputs_table(const Transitions& t, int shown) {
  const int row = lattice::shown_order(t.space)[static_cast<std::size_t>(shown)];
  TextTable table({{"", 6}, {"", 9}, {"", 0, 0, "", "  "}});
  for (const auto& [number, output] : outputs_of(t, row)) {
    const auto& [column, count] = output;
    table.row({number, count,
               column == t.space.trapped() ? "trapped"
                                           : text_of(t.space.section(), t.space.range(column))});
  }
  return fmt::format("\nState {}: the states that follow, with their counts\n{}", shown,
                     table.text());
}

/// The types of gates of a file with several: the name and matrix of each, and its gate runs, if
/// the file has them.
struct TypeOfFile {
  std::string name;
  const Transitions& matrix;
  std::optional<std::int64_t> gate_runs{};
};
std::vector<TypeOfFile> types_of(const lattice::MatrixFile& file) {
  std::vector<TypeOfFile> types;
  if (file.types.empty()) return types;
  if (const auto cell = file.text.find(lattice::kCellText); cell != file.text.end()) {
    for (const std::string& name : lattice::parse_cell_file(cell->second, "").types)
      types.push_back({name, types.empty() ? file.transitions : file.types.at(name)});
  } else {
    types.push_back({"of the scene", file.transitions});
    for (const auto& [name, t] : file.types) types.push_back({name, t});
  }
  for (const markov::NamedArray& array : file.arrays)
    if (array.name == lattice::kRunTypes) {
      for (TypeOfFile& type : types) type.gate_runs = 0;
      for (const double type : array.values) {
        if (!(type >= 0.0 && type < static_cast<double>(types.size())))
          throw markov::BadFile("a gate run has a type of gate that the file does not have");
        ++*types[static_cast<std::size_t>(type)].gate_runs;
      }
    }
  return types;
}

/// A table of the types of gates, if there are several; `counted`: what gate runs are here.
std::string types_table(const lattice::MatrixFile& file, const std::string& counted) {
  const std::vector<TypeOfFile> types = types_of(file);
  if (types.empty()) return "";
  const bool has_runs = types.front().gate_runs.has_value();  // else counts are gate runs
  TextTable table({{"Type of gate", -kFit},
                   {has_runs ? counted : "", kFit, 0, "", "  "},
                   {has_runs ? "counts of the chain" : "counts", kFit, 0, "", "  "},
                   {"entries above 0", kFit, 0, "", "  "},
                   {"rows without runs", kFit, 0, "", "  "}});
  for (const TypeOfFile& type : types) {
    const auto total = type.matrix.totals();
    table.row({type.name, type.gate_runs ? std::to_string(*type.gate_runs) : "", total.runs,
               total.nonzeros, total.empty_rows});
  }
  return table.text();
}

// ---- Keys of results ----

void describe_size(Fields& out, const Transitions& t) {
  out.count({"inputs", "1", "number of rows: states in which a gate is entered"}, t.space.size());
  out.count(
      {"outputs", "1", "number of columns: states in which the next gate is entered, and trapped"},
      t.space.size() + 1);
}
void describe_counts(Fields& out, const Transitions::Totals& total) {
  out.count(
      {"counts", "1",
       "sum of all counts: runs, with their mirror images where these count too, and those that "
       "rare memories share"},
      total.runs);
}
void describe_nonzeros(Fields& out, const Transitions::Totals& total) {
  out.count({"nonzeros", "1", "matrix entries that are not zero"}, total.nonzeros);
}
void describe_clamped_share(Fields& out, const Transitions::Totals& total) {
  out.number({"clamped_share", "1",
              "share of the crossings that lie outside all bins and count in the nearest bin"},
             total.clamped_share());
}
void describe_empty_rows(Fields& out, const Transitions::Totals& total) {
  out.count({"rows_never_sampled", "1", "number of rows without any run"}, total.empty_rows);
}

void describe_types(Fields& out, const lattice::MatrixFile& file) {
  out.optional(!file.types.empty(), [&](Fields& f) {
    f.object(
        {"types", "matrices of the field's other types of gates, by type"}, [&](Fields& types) {
          for (const TypeOfFile& of : types_of(file))
            if (&of.matrix != &file.transitions)
              types.object(Label(of.name, "matrix of the gates of this type").varying("<type>"),
                           [&](Fields& type) {
                             const auto total = of.matrix.totals();
                             type.count({"gate_runs", "1",
                                         "gate runs through gates of this type; null: the file "
                                         "has no runs"},
                                        of.gate_runs);
                             describe_counts(type, total);
                             describe_nonzeros(type, total);
                             describe_clamped_share(type, total);
                             describe_empty_rows(type, total);
                           });
        });
  });
}

void describe_row(Fields& out, const Transitions& t, int row) {
  const StateRange range = t.space.range(row);
  const Section& section = t.space.section();
  out.count({"input", "1", "number of the state; states count from 0"},
            lattice::shown_number(t.space, row));
  out.text({"boundary", "boundary of the gate through which the state enters"},
           section.faces[range.face].name);
  const std::string name = name_of(section, range.middle());
  out.optional(!name.empty(), [&](Fields& f) {
    f.text({"name", "name of the state, in a chain imported from elsewhere"}, name);
  });
  for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis)
    out.range(Field(section.coordinates[axis].key, "its own",
                    "range of the coordinate that the state covers; the key names the unit")
                  .varying("<coordinate>"),
              range.at[axis]);
  out.count({"trials", "1", "counts of the row: runs from this state"}, t.trials[row]);
  out.count({"clamped", "1", "crossings of these runs that lie outside all bins"}, t.clamped[row]);
  out.list({"outputs", "the outputs of this row that were counted"}, outputs_of(t, row),
           [](Fields& f, const auto& output) {
             f.count({"output", "1",
                      "number of the state entered next, from 0; the last output is trapped"},
                     output.first);
             f.count({"count", "1", "count of this output"}, output.second.second);
           });
}

/// The factor on Table III's bins per axis, or else the name of the bins.
std::string bins_text(const StateRecord& states) {
  return states.bins && states.bins->factor ? lattice::toml_float(*states.bins->factor)
                                            : states.kind;
}

/// The key "matrix", for commands that write a matrix.
void describe_path(Fields& out, const std::string& path) {
  out.text({"matrix", "path of the matrix file that was written"}, path);
}

/// The file's record under `key`, as `read` understands it; nullopt if there is none.
template <class Read>
auto record_in(const lattice::MatrixFile& file, const std::string& path, const std::string& key,
               const Read& read) -> std::optional<decltype(read(Json()))> {
  const auto text = file.text.find(key);
  if (text == file.text.end()) return {};
  const char* const what = key == "method"   ? "chosen method"
                           : key == "status" ? "status"
                                             : "state space";
  const std::string damaged = fmt::format("{}: its record of the {} is damaged", path, what);
  try {
    const Json json = parsed_json(text->second);
    if (json.is_null()) return {};
    return read(json);
  } catch (const Json::exception&) {
    throw markov::BadFile(damaged);
  } catch (const std::invalid_argument&) {
    throw markov::BadFile(damaged);
  }
}

}  // namespace

std::optional<StateRecord> recorded_states(const lattice::MatrixFile& file,
                                           const std::string& path) {
  return record_in(file, path, lattice::kStatesText, [&](const Json&) {
    return state_record(file.text.at(lattice::kStatesText), file.transitions.space.section());
  });
}

std::optional<lattice::Settled> recorded_method(const lattice::MatrixFile& file,
                                                const std::string& path) {
  return record_in(file, path, "method", settled_from);
}

std::optional<dynamics::Health> recorded_health(const lattice::MatrixFile& file) try {
  return record_in(file, "", "status", health_from);
} catch (const markov::BadFile&) {
  return {};
}

std::string faults_recorded(const std::optional<dynamics::Health>& status) {
  return status ? complaint(*status) : "the record of numerical faults is missing or damaged.";
}

std::string beware_of_recorded(const std::optional<dynamics::Health>& status) {
  if (faults_recorded(status).empty()) return "";
  return status ? "Beware: the numerical method showed faults in the runs of this matrix.\n"
                : "Beware: the record of numerical faults of this matrix is missing or damaged.\n";
}

std::string states_words(const dynamics::StateSpace& space) {
  const auto starts = std::ssize(space.points());
  const std::string states = counted(space.size() - starts, "state", "states");
  return starts == 0 ? states : states + " and " + counted(starts, "start", "starts");
}

void require_keepable(const lattice::Scene& scene) {
  if (const auto bytes = lattice::to_toml(scene).size(); bytes > markov::kMostTextBytes)
    throw std::invalid_argument(fmt::format(
        "{}: the scene with its map has {} bytes, a matrix file keeps {}: take a random map, or a "
        "smaller one of the same types",
        scene.source, bytes, markov::kMostTextBytes));
}

std::map<std::string, std::string> texts_of(const MadeMatrix& made, const lattice::Scene& scene,
                                            const dynamics::Health& health) {
  std::map<std::string, std::string> text = {
      {"title", "gatewalk input-output matrix of one gate, Eq. (16), as counts"},
      {"scene", lattice::to_toml(scene)},
      {"seed", std::to_string(made.made_by.seed.value())},
      {"bins", bins_text(made.states)},
      {"state_space", attribute_of(made.states)},
      {"program", std::string("gatewalk ") + kVersion},
      {"commit", kCommit},
      {"command", made.made_by.command},
      {"status", attribute_of(health)}};
  if (made.trials_per_row) text["trials_per_row"] = std::to_string(*made.trials_per_row);
  if (made.method) text["method"] = attribute_of(*made.method);
  return text;
}

void describe(Fields& out, const MadeMatrix& made) {
  const Transitions& t = made.file.transitions;
  const auto total = t.totals();
  describe_path(out, made.path);
  describe_size(out, t);
  out.if_any({"trials_per_row", "1", "number of gate runs from each state"}, made.trials_per_row);
  out.given({"bins", "1",
             "bins per axis as a multiple of the paper's Table III; or auto, scene, tree (see "
             "state_space.bins)"},
            bins_text(made.states));
  describe_nonzeros(out, total);
  describe_clamped_share(out, total);
  describe_state_space(out, made.states);
  describe_types(out, made.file);
  describe_method(out, made.method);
  describe_status(out, t.health);
  describe_made_by(out, made.made_by);
}

namespace {

/// "m.nc: transition matrix of 87 states (87 rows, 88 columns, the last one: trapped)"
std::string size_line(const Transitions& t, const std::string& path) {
  const int n = t.space.size();
  return fmt::format("{}: transition matrix of {} ({} rows, {} columns, the last one: trapped)\n",
                     path, states_words(t.space), n, n + 1);
}

/// What a matrix counts: "gate runs", "recorded passages", "counted steps", or "counted runs" if
/// some rows count mirror images; "probabilities" if the matrix was imported with probabilities in
/// the place of counts.
const char* counted_of(const lattice::MatrixFile& file, const std::optional<StateRecord>& states) {
  if (states && states->are_probabilities) return "probabilities";
  if (states && states->is_imported())
    return counts_images(file) ? "counted runs" : "counted steps";
  return states && states->trees && !states->trees->accuracy ? "recorded passages" : "gate runs";
}

}  // namespace

std::string summary_table(const lattice::MatrixFile& file, const std::string& path) {
  const Transitions& t = file.transitions;
  const auto total = t.totals();
  const auto states = recorded_states(file, path);
  const bool is_imported = states && states->is_imported();
  const std::string runs =
      states && states->are_probabilities
          ? "given as probabilities"
          : fmt::format("from {} {}", gate_runs_of(file, path), counted_of(file, states));
  std::int64_t nonzeros = total.nonzeros;
  for (const auto& [name, of_type] : file.types) nonzeros += of_type.totals().nonzeros;
  std::string text =
      size_line(t, path) + fmt::format("{} entries{} are above 0, {}.\n", nonzeros,
                                       file.types.empty() ? "" : " of all types", runs);
  if (!t.space.has_trees() && !is_imported)
    text += fmt::format("{} of the crossings lie outside the bins and count in the nearest bin.\n",
                        percent(total.clamped_share(), 1.0));
  return text + types_table(file, counted_of(file, states));
}

void describe(Fields& out, const ShownMatrix& shown) {
  const auto& [path, file] = shown;
  const Transitions& t = file.transitions;
  const auto total = t.totals();
  const double cells = static_cast<double>(t.space.size()) * (t.space.size() + 1);
  describe_size(out, t);
  out.count({"gate_runs", "1", "gate runs behind the matrix"}, gate_runs_of(file, path));
  describe_counts(out, total);
  describe_nonzeros(out, total);
  out.number({"density", "1", "share of the matrix entries that are not zero"},
             static_cast<double>(total.nonzeros) / cells);
  describe_clamped_share(out, total);
  describe_empty_rows(out, total);
  describe_types(out, file);
  out.list({"rows", "rows of the matrix, one for each input"}, lattice::shown_order(t.space),
           [&](Fields& f, int row) { describe_row(f, t, row); });
  const auto states = recorded_states(file, path);  // a file of another program may have none
  out.optional(states.has_value(),
               [&](Fields& f) { describe_state_space(f, states.value_or(StateRecord())); });
  out.object({"text", "other texts that the file keeps"}, [&](Fields& f) {
    for (const auto& [key, value] : file.text)
      f.text(Label(key, "attribute of this name in the file").varying("<attribute>"), value);
  });
}

void describe(Fields& out, const ImportedMatrix& imported) {
  describe(out, imported.matrix);
  describe_path(out, imported.matrix.path);
  out.texts(
      {"understood",
       "choices that import made where a file can be read in more than one way, a sentence each"},
      imported.understood);
  describe_made_by(out, imported.made_by);
}

void describe(Fields& out, const CellMatrixResult& built) {
  describe(out, built.matrix);
  describe_path(out, built.matrix.path);
  describe_recorded(out, built.recorded);
  describe_made_by(out, built.made_by);
}

std::string answer_text(const ShownMatrix& matrix, const ShownRows& shown) {
  const auto& [path, file] = matrix;
  const Transitions& t = file.transitions;
  const auto total = t.totals();
  const std::int64_t cells = std::int64_t{t.space.size()} * (t.space.size() + 1);
  TextTable table({{"", -20, 0, "", "  "}, {}});
  const auto states = recorded_states(file, path);  // a file of another program may have none
  const std::string with = t.space.section().words ? "with those that memories share"
                           : t.space.has_trees() || counts_images(file) ? "with mirror images"
                                                                        : "";
  table.row({counted_of(file, states),
             states && states->are_probabilities
                 ? "given in the place of counts"
                 : std::to_string(gate_runs_of(file, path)) +
                       (with.empty() ? "" : fmt::format(" (counts, {}: {})", with, total.runs))});
  table.row({"entries above 0", fmt::format("{} of {} ({})", total.nonzeros, cells,
                                            percent(static_cast<double>(total.nonzeros),
                                                    static_cast<double>(cells)))});
  if (!t.space.has_trees() && !(states && states->is_imported()))
    table.row({"outside the bins", fmt::format("{} of the crossings, counted in the nearest bin",
                                               percent(total.clamped_share(), 1.0))});
  table.row({"rows without runs", total.empty_rows});
  const std::string faults =
      !file.text.contains("status") && file.text.contains(lattice::kCellText)
          ? std::string("none on record") + (lattice::has_runs(file) ? ": runs were recorded" : "")
          : faults_recorded(recorded_health(file));
  const std::string of_all = file.types.empty() ? "" : "in all types: ";
  std::string text =
      size_line(t, path) + table.text() + types_table(file, counted_of(file, states)) +
      wrapped("  numerical faults    " + (faults.empty() ? "none seen" : of_all + faults),
              std::string(22, ' '));
  if (shown.all) text += row_table(t);
  if (shown.one) text += outputs_table(t, *shown.one);
  return text;
}

std::string details_text(const ShownMatrix& matrix) {
  const auto& [path, file] = matrix;
  std::string text = "\n";
  for (const char* key : {"program", "commit", "command", "seed", "trials_per_row", "bins"})
    if (const auto it = file.text.find(key); it != file.text.end())
      text += wrapped(fmt::format("  {:<20}{}", key, it->second), std::string(22, ' '));
  if (const auto states = recorded_states(file, path)) text += states_line(*states);
  if (const auto scene = file.text.find("scene"); scene != file.text.end())
    text += "\nThe scene, as TOML\n" + scene->second;
  return text;
}

namespace {

/// A group of states in the figure: those of one boundary, the starts, or the column "trapped".
struct StateGroup {
  std::string name;
  int first, states, blocks;
  double from = 0.0, size = 0.0;  // px

  [[nodiscard]] double edge(int block) const { return from + size * block / blocks; }
};

constexpr double kSide = 330.0, kGap = 3.0, kLeast = 18.0;
constexpr int kMostBlocks = 120;  // approximately, each way

/// Gives each group a width in proportion to its blocks, but at least kLeast.
void place(std::vector<StateGroup>& groups) {
  const double room = kSide - kGap * static_cast<double>(groups.size() - 1);
  const auto taken = [&](double each) {
    double sum = 0.0;
    for (const StateGroup& g : groups) sum += std::max(kLeast, each * g.blocks);
    return sum;
  };
  double low = 0.0, high = room;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (taken(middle) < room ? low : high) = middle;
  }
  double at = 0.0;
  for (StateGroup& g : groups) {
    g.from = at;
    g.size = std::max(kLeast, low * g.blocks);
    at += g.size + kGap;
  }
}

std::vector<StateGroup> groups_of(const StateSpace& space, int per_block, bool with_trapped) {
  std::vector<StateGroup> groups;
  const auto add = [&](const std::string& name, int first, int states) {
    if (states > 0) groups.push_back({name, first, states, (states + per_block - 1) / per_block});
  };
  const int starts = static_cast<int>(space.points().size()), all = space.size();
  const auto faces = static_cast<int>(space.section().faces.size());
  for (int face = 0; face < faces; ++face) {
    const int first = space.first(face);
    const int next = face + 1 < faces ? space.first(face + 1) : all - starts;
    add(space.section().faces[face].name, first, next - first);
  }
  add(starts == 1 ? "start" : "starts", all - starts, starts);
  if (with_trapped) add("trapped", space.trapped(), 1);
  place(groups);
  return groups;
}

/// Probabilities (%) from the blocks of one group (rows) to those of another (columns); below zero
/// if no row of a block has runs.
std::vector<std::vector<double>> chances(const Transitions& t, const StateGroup& rows,
                                         const StateGroup& columns, int per_block) {
  std::vector<std::vector<double>> all(static_cast<std::size_t>(rows.blocks));
  for (int i = 0; i < rows.blocks; ++i) {
    std::vector<double>& sums = all[static_cast<std::size_t>(i)];
    sums.assign(static_cast<std::size_t>(columns.blocks), 0.0);
    int sampled = 0;
    for (int row = i * per_block; row < std::min(rows.states, (i + 1) * per_block); ++row) {
      const auto at = static_cast<std::size_t>(rows.first + row);
      std::int64_t runs = 0;
      for (const auto& [column, count] : t.rows[at]) runs += count;
      if (runs == 0) continue;
      ++sampled;
      for (auto it = t.rows[at].lower_bound(columns.first);
           it != t.rows[at].end() && it->first < columns.first + columns.states; ++it)
        sums[static_cast<std::size_t>((it->first - columns.first) / per_block)] +=
            100.0 * static_cast<double>(it->second) / static_cast<double>(runs);
    }
    for (double& s : sums) s = sampled == 0 ? -1.0 : s / sampled;
  }
  return all;
}

}  // namespace

Figure figure_of(const Transitions& t) {
  const int per_block = (t.space.size() - 1) / kMostBlocks + 1;
  const auto rows = groups_of(t.space, per_block, false),
             columns = groups_of(t.space, per_block, true);
  constexpr double kLeft = 84, kTop = 44;
  Panels out("unset key\n");
  Rows& cells = out.data("$cells");
  Panel& panel = out.add({kLeft, kLeft + kSide, kTop, kTop + kSide});
  double most = 0.0;
  int object = 0;
  const auto rectangle = [&](const StateGroup& r, int begin, int end, const StateGroup& c,
                             const char* colour) {
    panel.more += fmt::format(
        "set object {} rectangle from {},{} to {},{} behind fillcolor rgb '{}' fillstyle solid "
        "noborder\n",
        ++object, digits(c.from), digits(r.edge(begin)), digits(c.from + c.size),
        digits(r.edge(end)), colour);
  };
  for (const StateGroup& r : rows)
    for (const StateGroup& c : columns) {
      rectangle(r, 0, r.blocks, c, "#e4e4e4");
      const auto shares = chances(t, r, c, per_block);
      for (int i = 0; i < r.blocks; ++i)
        for (int k = 0; k < c.blocks; ++k) {
          const double share = shares[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
          if (share < 0.0 && k == 0) rectangle(r, i, i + 1, c, "#ffffff");
          if (share <= 0.0) continue;
          most = std::max(most, share);
          cells.add(0.5 * (c.edge(k) + c.edge(k + 1)), 0.5 * (r.edge(i) + r.edge(i + 1)), c.edge(k),
                    c.edge(k + 1), r.edge(i), r.edge(i + 1), std::sqrt(share));
        }
    }
  const auto name = [&](const std::string& text, double x, double y, const char* how) {
    panel.texts.push_back({text, x, y, kSmallFont, how, true});
  };
  for (const StateGroup& r : rows)
    name(r.name + (r.states > 1 ? fmt::format(" {}", r.states) : ""), -6, r.from + 0.5 * r.size,
         "right");
  for (const StateGroup& c : columns)
    name(c.name, c.from + 0.5 * c.size, kSide + 8,
         c.size > 8.0 * static_cast<double>(c.name.size()) ? "center offset 0,-0.3"
                                                           : "right rotate by 90");
  panel.say(
      fmt::format("transition matrix: {}, {} counts{}", states_words(t.space), t.totals().runs,
                  per_block > 1 ? fmt::format(", blocks of {}", per_block) : ""),
      8, 18);
  panel.say("down: how a gate is entered; across: how the next one is, or trapped", 8,
            panel.box.bottom + 76, kSmallFont);
  panel.say("grey: no run ended here; white: none began here", 8, panel.box.bottom + 96,
            kSmallFont);
  panel.border = 0;
  panel.x = {"", 0, kSide, kNoTics};
  panel.y = {"", kSide, 0, kNoTics};
  add_colours(panel, RootScale(most), panel.box.beside(14, 12));
  panel.draw(cells, "1:2:3:4:5:6:7", kBars, {kByPalette});
  return out.figure(static_cast<int>(panel.box.bottom + 112));
}

}  // namespace gatewalk::cli
