#include "cli/commands/recorded.h"

#include <charconv>
#include <cmath>

#include "cli/arguments.h"
#include "cli/cells/program.h"
#include "cli/render/field_figure.h"
#include "cli/render/json.h"
#include "cli/render/matrix.h"
#include "cli/render/pooled_prediction.h"
#include "cli/render/recorded.h"
#include "cli/render/scene.h"
#include "cli/render/start.h"
#include "cli/render/text.h"

namespace gatewalk::cli {
namespace {

using Starts = std::vector<std::optional<dynamics::Entry>>;

/// "0.01,0,0.2", "W:0.01,0,0.2" or "seen".
std::optional<dynamics::Entry> parse_start(const std::string& text,
                                           const dynamics::Section& section) {
  if (text == "seen") return {};
  const auto wrong = [&] {
    return UsageError("--start " + text + ": must be seen, or " +
                      std::to_string(section.coordinates.size()) + " numbers " +
                      names_of(section.coordinates, ",") + ", behind a face " +
                      names_of(section.faces, " or ") + " and a colon unless it is the first");
  };
  dynamics::Entry entry;
  const std::size_t colon = text.find(':');
  if (colon != std::string::npos) {
    while (entry.face < std::ssize(section.faces) &&
           section.faces[static_cast<std::size_t>(entry.face)].name != text.substr(0, colon))
      ++entry.face;
    if (entry.face == std::ssize(section.faces)) throw wrong();
  }
  const char* at = text.data() + (colon == std::string::npos ? 0 : colon + 1);
  const char* const end = text.data() + text.size();
  for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis) {
    if (axis > 0 && (at == end || *at++ != ',')) throw wrong();
    const auto [next, error] = std::from_chars(at, end, entry.at[axis]);
    if (error != std::errc() || !std::isfinite(entry.at[axis])) throw wrong();
    at = next;
  }
  if (at != end) throw wrong();
  return entry;
}

/// Those given, else the cell file's.
Starts starts_of(const Options& options, const lattice::CellFile& cells) {
  Starts starts;
  for (const std::string& text : options.texts("start"))
    starts.push_back(parse_start(text, cells.map.section));
  if (starts.empty()) starts.push_back(cells.start);
  return starts;
}

void warn_of(const Options& options, const lattice::CellMatrix& m, const Starts& starts) {
  for (const std::string& text : doubts(m.pool, m.problem)) options.warn(text);
  for (const auto& start : starts)
    if (start && m.file.transitions.space.index_of(*start).beyond)
      options.warn(title_of(m.cells.map.section, *start) +
                   " lies beyond all entries that were seen: its prediction is that of the "
                   "nearest state");
}

Json provenance_of(const Options& options, const lattice::CellFile& cells) {
  Json json = to_json(options.provenance());
  json["cell"] = lattice::to_toml(cells);
  return json;
}

std::vector<FieldPicture> pictures_of(const lattice::PooledPrediction& prediction,
                                      const lattice::CellFile& cells) {
  std::vector<FieldPicture> pictures;
  for (const lattice::StartAnswer& a : prediction.starts)
    pictures.emplace_back("prediction, " + std::to_string(cells.field.columns) + " x " +
                              std::to_string(cells.field.rows) + " cells",
                          a.final, a.endings, a.exits);
  return pictures;
}

}  // namespace

void add_cell(Options& options) {
  options.input_file("cell",
                     "SCENE is a table of recorded runs (runs.csv) through cells as this file "
                     "(cell.toml) says: lattice/cells/README.md");
}

int build_recorded(const Options& options) {
  for (const char* other :
       {"accuracy", "gate-runs", "starts", "start", "states", "trials", "bins", "strict"})
    if (options.has(other))
      throw UsageError(std::string("--") + other + " has no meaning for recorded runs");
  const std::string path = options.text("output");
  lattice::CellFile cells = lattice::read_cell_file(options.text("cell"), options.overrides());
  const lattice::RecordedRuns runs = lattice::read_runs(options.text("scene"), cells);
  const lattice::RunPool pool = lattice::pool_of(runs);
  const lattice::Problem problem = lattice::problem_of(cells, pool);
  for (const std::string& text : doubts(pool, problem)) options.warn(text);
  Json states = {{"bins", "tree"},
                 {"entries_per_leaf", dynamics::kEntriesPerLeaf},
                 {"gate_runs", pool.gate_runs()},
                 {"starts_of_their_own", Json::array()},
                 {"range", nullptr},
                 {"states_bias", 0.0}};
  auto matrices = lattice::cell_matrices(problem, pool, dynamics::kEntriesPerLeaf);
  states["states"] = matrices.front().space.size();
  const Json made_by = provenance_of(options, cells);
  const lattice::MatrixFile file = lattice::cell_matrix_file(
      std::move(matrices), cells, pool,
      {{"title", "gatewalk counts of passages through recorded cells"},
       {"state_space", states.dump()},
       {"program", "gatewalk " + made_by.at("version").get<std::string>()},
       {"commit", made_by.at("commit")},
       {"command", options.canonical()}});
  options.keep_old(path);
  lattice::write_matrix(path, file);
  Json json = to_json(file, path);
  json["matrix"] = path;
  json["recorded"] = to_json(pool);
  json["made_by"] = made_by;
  options.give_out(json, summary_table(file, path) + table_of(pool));
  return kFine;
}

int predict_recorded(const Options& options) {
  const std::string path = options.text("matrix");
  for (const char* other : {"gate-runs", "first-runs", "row", "scene", "netcdf"})
    if (options.has(other))
      throw UsageError(std::string("--") + other + " has no meaning for " + path +
                       ", whose runs were recorded");
  const lattice::CellMatrix m = lattice::read_cell_matrix(path, options.overrides());
  const Starts starts = starts_of(options, m.cells);
  const int per_leaf = entries_per_leaf(m.file, path);
  auto prediction = lattice::predict_recorded(m.problem, m.pool, starts, per_leaf, options.seed());
  const ShownField shown(m.cells);
  const bool given = options.has("start");
  const double wanted = options.has("accuracy") ? accuracy_of(options).accuracy : 1.0;
  double worst = 0.0;
  for (const lattice::StartAnswer& a : prediction.starts)
    if (!(worst >= a.error.total_variation)) worst = a.error.total_variation;  // or not a number
  prediction.reached = !(worst > wanted);
  Json json = to_json(prediction, shown, wanted, given);
  std::string table = table_of(prediction, shown, given);
  json["recorded"] = to_json(m.pool);
  table += table_of(m.pool);
  LostBounds bounds{lattice::lost_share(m.pool), {}};
  if (bounds.lost > 0.0) {
    for (const auto fate : {lattice::LostFate::trapped, lattice::LostFate::left}) {
      const lattice::RunPool told =
          lattice::with_lost(m.pool, m.problem, fate, per_leaf, options.seed());
      bounds.final[static_cast<std::size_t>(fate)] =
          lattice::predict_whole(m.problem, told, {starts.front()}, per_leaf, options.seed())
              .front();
    }
    json["recorded"]["lost_bounds"] = to_json(bounds);
    table += table_of(bounds);
  }
  json["made_by"] = provenance_of(options, m.cells);
  options.give_out(json, table);
  warn_of(options, m, starts);
  options.warn(too_few_gates(shown));
  if (!prediction.reached)
    options.warn("the accuracy asked for, " + digits(wanted) +
                 ", was not reached: the error bar is " + fixed(worst, 4) +
                 ", and recorded runs cannot be added to");
  options.draw([&] { return figure_of(pictures_of(prediction, m.cells), shown); });
  return kFine;
}

void add_cell_program(Options& options) {
  options.add_text("cell-program", "COMMAND",
                   "SCENE is a cell file (cell.toml), and this command carries bodies through its "
                   "cells (cli/cells/PROGRAM.md)");
  options.add_number("cell-timeout", "S",
                     "seconds that the program may be silent while an answer is awaited "
                     "(default: 60)");
}

int predict_program(const Options& options) {
  const std::string path = options.text("matrix");
  for (const char* other : {"first-runs", "row", "scene", "netcdf"})
    if (options.has(other))
      throw UsageError(std::string("--") + other + " has no meaning beside --cell-program");
  const lattice::CellFile cells = lattice::read_cell_file(path, options.overrides());
  ProgramOptions how;
  if (options.has("cell-timeout")) how.timeout_s = options.number("cell-timeout");
  const auto cell = std::make_shared<ProgramCell>(options.text("cell-program"), how);
  const dynamics::Section& section = cells.map.section;
  if (names_of(cell->section().faces) != names_of(section.faces) ||
      names_of(cell->section().coordinates) != names_of(section.coordinates) ||
      cells.map.types.size() > 1)
    throw UsageError("--cell-program: its cell has faces " + names_of(cell->section().faces) +
                     " and coordinates " + names_of(cell->section().coordinates) + ", " + path +
                     " has " + names_of(section.faces) + " and " + names_of(section.coordinates) +
                     " (and must have one type)");
  const Starts starts = starts_of(options, cells);
  lattice::Problem problem = lattice::problem_of(cells, {});
  problem.cells.map.section = cell->section();
  for (std::size_t f = 0; f < section.faces.size(); ++f)
    problem.cells.map.section.faces[f].usual =
        lattice::problem_of(cells, {}).map().section.faces[f].usual;
  problem.cells.map.types.front().symmetric = cell->is_symmetric();
  problem.cells.cells = {cell};
  std::vector<dynamics::Entry> entries;
  for (const auto& start : starts) {
    if (!start)
      throw UsageError(path + ": has no [start], and --start does not say where trials start");
    entries.push_back(*start);
  }
  const lattice::AccuracyOptions wanted = accuracy_of(options);
  lattice::RunPool pool;
  const auto prediction = lattice::predict_pooled(problem, pool, entries, wanted, options.work());
  const ShownField shown(cells);
  const bool given = options.has("start");
  Json json = to_json(prediction, shown, wanted.accuracy, given);
  json["made_by"] = provenance_of(options, cells);
  options.give_out(json, table_of(prediction, shown, given));
  options.warn(too_few_gates(shown));
  cli::warn_of(options, prediction, wanted.accuracy);
  options.draw([&] { return figure_of(pictures_of(prediction, cells), shown); });
  return kFine;
}

}  // namespace gatewalk::cli
