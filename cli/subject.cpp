// SPDX-License-Identifier: MIT
#include "cli/subject.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <ranges>
#include <utility>

#include "cli/arguments.h"
#include "cli/cells/program.h"
#include "cli/exchange/imported.h"
#include "cli/loaded_matrix.h"
#include "cli/render/matrix.h"
#include "cli/render/recorded.h"
#include "cli/render/text.h"
#include "dynamics/disc/disc_section.h"
#include "lattice/cells/cell_matrix.h"
#include "lattice/scene/scene_trials.h"
#include "lattice/study/trials.h"
#include "lattice/text/digits.h"

namespace gatewalk::cli {
namespace {

using lattice::kParameters;  // --set parameters.KEY=VALUE

/// The starts that are given, else `own`.
void put_starts(Subject& s, const Options& options, const Start& own, StartsFrom from) {
  s.given = options.has("start");
  for (const std::string& text : options.texts("start"))
    s.starts.push_back(parse_start(text, s.problem.map().section, from));
  if (s.starts.empty()) s.starts.push_back(own);
}

/// Behind a matrix its scene may be given; empty without one.
std::string second_scene(const Options& options, const std::string& name) {
  return name == "scene" ? "" : options.text("scene");
}

/// Before settle() chooses a method, if it is to choose one: any that takes every gate will do.
lattice::Problem unsettled_problem(lattice::Scene scene) {
  if (scene.gate.run.method == "auto") scene.gate.run.method = "paper";
  return lattice::problem_of(scene);
}

/// Of a scene, also of a matrix's: it has its path and scene.
void put_problem(Subject& s, const Options& options) {
  require_active(options, *s.scene);
  s.problem = unsettled_problem(*s.scene);
  put_starts(s, options, s.problem.start, StartsFrom::first_face);
  if (s.given) lattice::require_inside(given_starts(options), *s.scene);
  s.problem.start = *s.starts.front();
}

Subject open_scene(const Options& options, const std::string& path) {
  Subject s{.path = path, .scene = lattice::read_scene(options.file(path), options.overrides())};
  s.pool.emplace();
  s.how = accuracy_of(options);
  put_problem(s, options);
  return s;
}

Subject open_matrix(const Options& options, const std::string& name, const std::string& path) {
  lattice::SceneMatrix m =
      read_matrix(options, path, second_scene(options, name), options.overrides());
  Subject s{.path = path, .scene = std::move(m.scene), .file = std::move(m.file)};
  put_problem(s, options);
  s.how = accuracy_of(options);
  if (!lattice::has_runs(*s.file)) return s;
  if (!options.has("accuracy")) s.how.accuracy = accuracy_of(*s.file, path);
  s.how.per_leaf = entries_per_leaf(*s.file, path);
  const LoadedMatrix* const loaded = options.loaded(path);
  const bool as_loaded =
      loaded && loaded->pool && second_scene(options, name).empty() && options.overrides().empty();
  s.pool = as_loaded ? *loaded->pool : lattice::pool_of(*s.file, s.problem, path);
  return s;
}

/// As lattice::read_cell_matrix; of a file in memory, if it is there.
lattice::CellMatrix read_cell_matrix(const Options& options, const std::string& path,
                                     const std::vector<std::string>& overrides) {
  const LoadedMatrix* const loaded = options.loaded(path);
  return loaded ? lattice::cell_matrix(loaded->file, path, overrides)
                : lattice::read_cell_matrix(path, overrides);
}

/// Those of the program, and those of the cell file.
std::vector<std::string> overrides_of(const Options& options, bool of_program) {
  std::vector<std::string> chosen;
  for (const std::string& text : options.overrides())
    if (text.starts_with(kParameters) == of_program)
      chosen.push_back(of_program ? text.substr(kParameters.size()) : text);
  return chosen;
}

std::vector<dynamics::Cell::Number> parameters_of(const Options& options) {
  std::vector<dynamics::Cell::Number> set;
  for (const std::string& text : overrides_of(options, true)) {
    const std::size_t equals = text.find('=');
    std::string_view rest = text;
    rest = equals == std::string::npos ? "" : rest.substr(equals + 1);
    const auto value = lattice::take_number(rest);
    if (!value || !rest.empty() || !std::isfinite(*value))
      throw UsageError(fmt::format("--set {}{}: must be KEY=NUMBER", kParameters, text));
    set.push_back({text.substr(0, equals), *value});
  }
  return set;
}

std::string names(const std::vector<dynamics::CostInfo>& costs) {
  return fmt::format("{}",
                     fmt::join(costs | std::views::transform(&dynamics::CostInfo::key), ", "));
}

/// The cell that carries bodies through: the one given, or that of --cell-program.
std::shared_ptr<const dynamics::Cell> cell_of(const Options& options) {
  const std::vector<dynamics::Cell::Number> set = parameters_of(options);
  if (!options.cell()) {
    ProgramOptions how;
    if (options.has("cell-timeout")) how.timeout_s = options.number("cell-timeout");
    return std::make_shared<ProgramCell>(options.text("cell-program"), how, set);
  }
  if (!set.empty() || options.has("cell-program") || options.has("cell-timeout"))
    throw UsageError("a cell is given: --set parameters and --cell-program are for programs");
  return options.cell();
}

/// Throws UsageError where the cell of a program is not that of a file.
void require_same(const dynamics::Cell& cell, const lattice::CellFile& file,
                  const std::string& path) {
  const dynamics::Section &program = cell.section(), &own = file.map.section;
  const auto differ = [&](bool differs, const std::string& what, const std::string& there,
                          const std::string& here) {
    if (differs)
      throw UsageError(
          fmt::format("--cell-program: {} {} of its cell, {} in {}", what, there, here, path));
  };
  const auto name = [&](const char* what, const auto& a, const auto& b) {
    differ(names_of(a) != names_of(b), what, names_of(a), names_of(b));
  };
  name("faces", program.faces, own.faces);
  name("coordinates", program.coordinates, own.coordinates);
  if (file.types.size() > 1)
    throw UsageError(
        fmt::format("--cell-program: is a cell of one type, {} has {}", path, file.types.size()));
  for (std::size_t c = 0; c < own.coordinates.size(); ++c) {
    const dynamics::Coordinate &a = program.coordinates[c], &b = own.coordinates[c];
    differ(a.key != b.key && a.unit != b.unit, fmt::format("the unit of {} is", a.name), a.unit,
           b.unit);
  }
  const bool symmetric = cell.is_symmetric();
  differ(symmetric != file.map.types.front().symmetric, "symmetric is",
         symmetric ? "true" : "false", symmetric ? "false" : "true");
  const auto move_of = [](const dynamics::Face& face) {
    return fmt::format("[{}, {}]", face.di_x, face.di_y);
  };
  for (std::size_t f = 0; f < own.faces.size(); ++f) {
    const dynamics::Face &a = program.faces[f], &b = own.faces[f];
    differ(move_of(a) != move_of(b), fmt::format("the move of face {} is", a.name), move_of(a),
           move_of(b));
    if (symmetric && (a.mirror != b.mirror || a.odd != b.odd))
      throw UsageError(
          fmt::format("--cell-program: face {} of its cell has another mirror image, or other odd "
                      "coordinates, than in {}",
                      a.name, path));
  }
  for (const dynamics::CostInfo& cost : own.costs)
    if (std::none_of(program.costs.begin(), program.costs.end(),
                     [&](const dynamics::CostInfo& c) { return c.key == cost.key; }))
      throw UsageError(
          fmt::format("--cell-program: its cell has no cost {}, which {} has", cost.key, path));
}

}  // namespace

std::string told_by(const dynamics::Cell& cell) {
  std::string text = fmt::format("cell program: {}; {}; {}", names_of(cell.section().faces),
                                 names_of(cell.section().coordinates), names(cell.section().costs));
  for (const dynamics::Cell::Number& n : cell.numbers())
    text += fmt::format("; {} = {}", n.key, digits(n.value));
  return text;
}

Subject open_program(const Options& options, const std::string& path) {
  Subject s{.path = path};
  const std::vector<std::string> overrides = overrides_of(options, false);
  s.how = accuracy_of(options);
  if (options.file(path).is_matrix()) {
    if (!parameters_of(options).empty())
      throw UsageError(fmt::format(
          "--set parameters: {} holds runs of the program with its own: make a matrix with these",
          path));
    lattice::CellMatrix m = read_cell_matrix(options, path, overrides);
    s.cells = std::move(m.cells);
    s.file = std::move(m.file);
    if (!m.pool) throw UsageError(path + ": is a chain that was made elsewhere, without runs");
    s.pool = std::move(m.pool);
    s.how.per_leaf = entries_per_leaf(*s.file, path);
    if (!options.has("accuracy")) s.how.accuracy = accuracy_of(*s.file, path);
  } else {
    s.cells = lattice::read_cell_file(options.file(path), overrides);
    s.pool.emplace();
  }
  const std::shared_ptr<const dynamics::Cell> cell = cell_of(options);
  require_same(*cell, *s.cells, path);
  if (s.file && names(cell->section().costs) != names(s.cells->map.section.costs))
    throw UsageError(fmt::format("--cell-program: costs {} of its cell, {} of the runs in {}",
                                 names(cell->section().costs), names(s.cells->map.section.costs),
                                 path));
  options.depends_on(told_by(*cell));
  s.problem = lattice::problem_of(*s.cells, *s.pool);
  dynamics::CellMap& map = s.problem.cells.map;
  const std::vector<dynamics::Face> faces = std::exchange(map.section, cell->section()).faces;
  for (std::size_t f = 0; f < faces.size(); ++f) map.section.faces[f].usual = faces[f].usual;
  map.types.front().symmetric = cell->is_symmetric();
  s.cells->map = map;
  s.problem.cells.cells = {cell};
  put_starts(s, options, s.cells->start, StartsFrom::any_face);
  s.problem.start = s.entries().front();
  return s;
}

namespace {

/// Of a chain that was made elsewhere a start is a state, by its name or number.
void put_foreign_starts(Subject& s, const Options& options) {
  s.given = options.has("start");
  for (const std::string& text : options.texts("start")) {
    const auto start = foreign_start(*s.file, text);
    if (!start)
      throw UsageError(
          fmt::format("--start {}: {} has no state of that name or number", text, s.path));
    s.starts.emplace_back(start);
  }
  if (s.starts.empty()) s.starts.push_back(s.cells->start);
  s.problem.start = s.entries().front();
}

Subject open_recorded(const Options& options, const std::string& path) {
  lattice::CellMatrix m = read_cell_matrix(options, path, options.overrides());
  refuse(options, {"gate-runs"},
         "for " + path +
             (m.pool ? ", whose runs were recorded" : ", a chain that was made elsewhere"));
  Subject s{.path = path,
            .cells = std::move(m.cells),
            .file = std::move(m.file),
            .pool = std::move(m.pool),
            .problem = std::move(m.problem)};
  if (!s.pool) {
    if (const auto states = recorded_states(*s.file, path); !states || !states->is_imported())
      throw markov::BadFile(path + ": its runs are missing");
    s.foreign = true;
    s.cells->map.section.named = s.problem.cells.map.section.named =
        s.file->transitions.space.section().named;
    put_foreign_starts(s, options);
    return s;
  }
  s.how = accuracy_of(options);
  if (!options.has("accuracy")) s.how.accuracy = 1.0;  // whatever its runs give
  s.how.per_leaf = entries_per_leaf(*s.file, path);
  put_starts(s, options, s.cells->start, StartsFrom::any_face_or_seen);
  s.problem.start = s.starts.front().value_or(s.problem.start);
  for (const std::string& text : doubts(*s.pool, s.problem)) options.warn(text);
  const std::vector<dynamics::Transitions> matrices = s.matrices();
  const auto& seen = matrices[static_cast<std::size_t>(s.problem.start_type())];
  for (const Start& start : s.starts)
    if (start && seen.trials[static_cast<std::size_t>(seen.space.index_of(*start).state)] == 0)
      throw UsageError(
          title_of(s.problem.map().section, start) +
          ": nobody was seen to enter so, and what would become of such a body is not known");
  for (const Start& start : s.starts)
    if (start && s.file->transitions.space.index_of(*start).beyond)
      options.warn(title_of(s.problem.map().section, start) +
                   " lies beyond all entries that were seen: its prediction is that of the "
                   "nearest state");
  return s;
}

}  // namespace

namespace {

/// The scene with --versus on top of --set.
lattice::Scene read_other(const Options& options) {
  std::vector<std::string> overrides = options.overrides();
  const std::vector<std::string> versus = options.texts("versus");
  overrides.insert(overrides.end(), versus.begin(), versus.end());
  try {
    return lattice::read_scene(options.file(options.text("scene")), overrides);
  } catch (const lattice::SceneError& e) {  // it names overrides as --set gives them
    const std::string what = e.what();
    for (const std::string& key : versus)
      if (what.starts_with("--set " + key))
        throw UsageError("--versus" + what.substr(what.find(' ')));
    throw;
  }
}

void require_same_size(const lattice::FieldParams& now, const lattice::FieldParams& then) {
  if (then.columns != now.columns || then.rows != now.rows)
    throw UsageError(
        "--versus: field.columns and field.rows must stay: final gates of fields of different "
        "sizes cannot be compared");
}

/// Recorded runs of another group of bodies.
Subject other_group(const Options& options, const Subject& s, const std::string& path) {
  if (!s.is_recorded() || s.foreign || !lattice::is_of_cells(path) || has_cell(options))
    throw UsageError(fmt::format(
        "--versus {}: two matrices are compared where both are of recorded runs", path));
  Subject other = open_recorded(options, path);
  if (other.foreign)
    throw UsageError(fmt::format("--versus {}: is a chain that was made elsewhere", path));
  require_same_size(s.cells->field, other.cells->field);
  return other;
}

}  // namespace

std::optional<Subject> versus(const Options& options, const Subject& s) {
  if (!options.has("versus")) return {};
  if (const std::vector<std::string> given = options.texts("versus");
      given.size() == 1 && options.file(given.front()).is_matrix())
    return other_group(options, s, given.front());
  for (const std::string& text : options.texts("versus")) {
    if (text.find('=') != text.npos) continue;
    std::error_code error;
    throw UsageError(
        "--versus " + text +
        (!std::filesystem::exists(text, error)
             ? ": there is no such file; must be the matrix of another group's recorded runs, or "
               "KEY=VALUE, for example forces.random_N=20"
         : options.file(text).is_matrix()
             ? ": a matrix of another group's recorded runs is given once, and alone"
             : ": is no matrix; of two scenes give each key in which the other one differs, as "
               "--versus KEY=VALUE"));
  }
  if (!s.scene || s.file)
    throw UsageError(
        fmt::format("--versus KEY=VALUE is of a scene, which {} is not; of recorded runs give "
                    "another group's matrix",
                    s.path));
  Subject other = s;
  other.scene = read_other(options);
  require_active(options, *other.scene);
  require_same_size(s.scene->field, other.scene->field);
  other.problem = unsettled_problem(*other.scene);
  other.starts = {other.problem.start};
  return other;
}

Start parse_start(const std::string& text, const dynamics::Section& section, StartsFrom from) {
  const bool seen = from == StartsFrom::any_face_or_seen, faces = from != StartsFrom::first_face;
  if (seen && text == "seen") return {};
  const auto wrong = [&] {
    std::string units;
    for (const dynamics::Coordinate& c : section.coordinates)
      units += (units.empty() ? "" : ", ") + (c.unit == "m s-1" ? "m/s" : c.unit);
    return UsageError(
        fmt::format("--start {}: must be {}{} numbers {} ({}){}", text, seen ? "seen, or " : "",
                    section.coordinates.size(), names_of(section.coordinates, ","), units,
                    faces ? fmt::format(", behind a face {} and a colon unless it is the first",
                                        names_of(section.faces, " or "))
                          : ""));
  };
  dynamics::Entry entry;
  const std::size_t colon = faces ? text.find(':') : std::string::npos;
  if (colon != std::string::npos) {
    while (entry.face < std::ssize(section.faces) &&
           section.faces[static_cast<std::size_t>(entry.face)].name != text.substr(0, colon))
      ++entry.face;
    if (entry.face == std::ssize(section.faces)) throw wrong();
  }
  std::string_view rest = text;
  if (colon != std::string::npos) rest.remove_prefix(colon + 1);
  for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis) {
    if (axis > 0 && !lattice::take_mark(rest, ',')) throw wrong();
    const auto number = lattice::take_number(rest);
    if (!number || !std::isfinite(*number)) throw wrong();
    entry.at[axis] = *number;
  }
  if (!rest.empty()) throw wrong();
  return entry;
}

std::vector<dynamics::Entry> Subject::entries() const {
  std::vector<dynamics::Entry> entries;
  for (const Start& start : starts) {
    if (!start)
      throw UsageError(path + ": has no [start], and --start does not say where trials start");
    entries.push_back(*start);
  }
  return entries;
}

std::vector<dynamics::Transitions> Subject::matrices() const {
  return scene ? lattice::matrices_of(*file, *scene) : lattice::matrices_of(*file, *cells);
}

lattice::CountedField Subject::counted() const {
  lattice::CountedField field = lattice::counted_field(problem.map(), matrices());
  const auto states = recorded_states(*file, path);
  field.exact = states && states->are_probabilities;
  if (auto per_run = foreign ? counts_per_run(*file) : std::vector<std::int64_t>();
      !per_run.empty()) {
    field.small_rows = true;
    field.images = {std::move(per_run)};
  }
  return field;
}

std::string Subject::name_of(std::size_t start) const {
  return given ? title_of(problem.map().section, starts[start]) : "the start";
}

std::string Subject::where(std::size_t start) const {
  return starts.size() > 1 ? name_of(start) + ": " : "";
}

double Subject::bin_of_durations(const Options& options) const {
  if (scene) return lattice::bin_of_durations(scene->gate);
  if (cells->trapped_after) return *cells->trapped_after / 1000.0;
  constexpr std::int64_t kSome = 100;
  lattice::FieldCosts some(1.0);
  (void)lattice::field_trials(problem, {0, kSome}, options.seed(), {},
                              [&](const lattice::FieldTrials& each) { some.add(each); });
  const double mean = some.all().mean(0);
  return mean > 0.0 ? mean / 1000.0 : 1.0;
}

void Subject::settle(const Options& options) {
  if (!scene || file) return;
  settled = settle_method(options, *scene, lattice::RunsFrom::everywhere);
  problem = lattice::problem_of(*scene);
  problem.start = *starts.front();
}

Provenance Subject::provenance(const Options& options) const {
  if (scene) return options.provenance(*scene);
  Provenance made_by = options.provenance();
  made_by.cell = lattice::to_toml(*cells);
  return made_by;
}

Subject open_subject(const Options& options, const std::string& name) {
  const std::string path = options.text(name);
  const LoadedMatrix* const loaded = options.loaded(path);
  const bool program = has_cell(options),
             matrix = !program && (loaded || options.file(path).is_matrix()),
             of_cells = program || (loaded ? !loaded->scene : matrix && lattice::is_of_cells(path));
  if (const std::string second = second_scene(options, name);
      !second.empty() && (!matrix || of_cells))
    throw UsageError(
        fmt::format("{}: is no matrix of a scene; a second one, \"{}\", has no meaning beside it",
                    path, second));
  if (program) return open_program(options, path);
  refuse(options, {"cell-timeout"}, "without --cell-program");
  if (!matrix) return open_scene(options, path);
  return of_cells ? open_recorded(options, path) : open_matrix(options, name, path);
}

Subject field_to_run(const Options& options, const std::string& made) {
  Subject s = open_subject(options, "scene");
  if (s.file)
    throw UsageError(s.path + ": is a matrix, and new bodies are to be run: give a scene");
  if (s.starts.size() > 1) throw UsageError("--start: " + made + " for one start");
  return s;
}

lattice::PooledPrediction predict(const Options& options, Subject& s) {
  auto prediction = s.is_recorded() ? lattice::predict_recorded(s.problem, *s.pool, s.starts, s.how)
                                    : lattice::predict_pooled(s.problem, *s.pool, s.entries(),
                                                              s.how, options.work());
  warn_of(options, prediction, s.how.accuracy);
  return prediction;
}

void refuse(const Options& options, std::initializer_list<const char*> names,
            const std::string& where) {
  for (const char* name : names)
    if (options.has(name)) throw UsageError(fmt::format("--{} has no meaning {}", name, where));
}

bool has_cell(const Options& options) { return options.has("cell-program") || options.cell(); }

void add_cell_program(Options& options) {
  options.add_text("cell-program", "COMMAND",
                   "SCENE is a cell file (cell.toml), and this command carries bodies through its "
                   "cells (cli/cells/PROGRAM.md); --set parameters.KEY=VALUE changes a parameter "
                   "of it");
  options.add_number("cell-timeout", "S",
                     "seconds that the program may be silent while an answer is awaited "
                     "(default: 60)");
}

}  // namespace gatewalk::cli
