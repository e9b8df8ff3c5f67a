// SPDX-License-Identifier: MIT
#include "lattice/source/source.h"

#include <fmt/core.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "lattice/field/gate_chain.h"
#include "lattice/pool/predict_pooled.h"
#include "lattice/pool/states_info.h"
#include "lattice/pool/tree_chain.h"
#include "lattice/scene/cell_file.h"
#include "lattice/scene/matrix.h"
#include "lattice/scene/scene_keys.h"
#include "lattice/scene/scene_problem.h"
#include "lattice/scene/scene_trials.h"
#include "lattice/scene/settle.h"
#include "lattice/scene/table4.h"
#include "lattice/scene/toml_file.h"
#include "lattice/source/cell_matrix.h"
#include "lattice/source/source_file.h"
#include "lattice/source/start_text.h"
#include "lattice/statistics/matrix_noise.h"

namespace gatewalk::lattice {
namespace {

/// Chains support field.fidelity "active" only: throws if the scene or an override asks for
/// another. If only the scene kept in a matrix does, adds a doubt instead.
void require_active(Source& s, const SourceOptions& options) {
  if (s.scene->field.fidelity == Fidelity::active) return;
  const std::string key = "field.fidelity",
                    value = fmt::format(" = \"{}\"", name_of(s.scene->field.fidelity));
  const bool is_set = std::any_of(options.overrides.begin(), options.overrides.end(),
                                  [&](const std::string& given) {
                                    const auto keys = keys_set_by(given);
                                    return std::find(keys.begin(), keys.end(), key) != keys.end();
                                  });
  if (s.file && !options.scene && !is_set) {
    s.doubts.push_back(
        fmt::format("{} (its scene): {}{} is of the full dynamics: a chain always has \"active\"",
                    s.path, key, value));
    return;
  }
  const auto given = s.scene->named.find(key);
  throw std::invalid_argument(fmt::format(
      "{}: {}{} is not permitted for a chain: it has \"active\", gatewalk lattice the others",
      given == s.scene->named.end() ? s.scene->source : given->second, key, value));
}

/// Sets the problem of a source that has path and scene.
void put_problem(Source& s, const SourceOptions& options) {
  require_active(s, options);
  s.problem = problem_without_cells(*s.scene);
  if (s.scene->gate.run.method != "auto") put_cells(s.problem, *s.scene);
  s.starts = {s.problem.start};
}

void put_trees(Source& s) {
  const TreeInfo trees = tree_info(*s.file, s.path);
  s.accuracy.accuracy = trees.accuracy_of_one();
  s.accuracy.per_leaf = trees.entries_per_leaf;
}

Source open_scene(const SourceFile& file, const SourceOptions& options) {
  Source s{.path = file.path()};
  s.scene = read_scene(file.toml(), options.overrides);
  s.pool = std::make_shared<RunPool>();
  put_problem(s, options);
  return s;
}

Source open_matrix(const SourceFile& file, const SourceOptions& options) {
  SceneMatrix m = scene_matrix(file.matrix(), file.own_scene(), file.path(),
                               options.scene ? &options.scene->toml() : nullptr, options.overrides);
  Source s{.path = file.path(), .scene = std::move(m.scene), .file = std::move(m.file)};
  if (options.scene)  // the scene kept in a matrix names every key
    s.doubts = keys_without_effect(*s.scene, RunsFrom::everywhere);
  put_problem(s, options);
  if (!has_runs(*s.file)) return s;
  put_trees(s);
  const bool in_memory = file.runs() && !options.scene && options.overrides.empty();
  s.pool =
      std::make_shared<RunPool>(in_memory ? *file.runs() : pool_of(*s.file, s.problem, s.path));
  return s;
}

/// Throws std::invalid_argument if the cell of a program differs from the cell of the file.
void require_same(const dynamics::Cell& cell, const CellFile& file, const std::string& path) {
  const dynamics::Section &program = cell.section(), &own = file.map.section;
  const auto refuse = [](const std::string& what) {
    throw std::invalid_argument("--cell-program: " + what);
  };
  const auto differ = [&](bool differs, const std::string& what, const std::string& there,
                          const std::string& here) {
    if (differs) refuse(fmt::format("{} {} of its cell, {} in {}", what, there, here, path));
  };
  const auto name = [&](const char* what, const auto& a, const auto& b) {
    differ(names_of(a) != names_of(b), what, names_of(a), names_of(b));
  };
  name("faces", program.faces, own.faces);
  name("coordinates", program.coordinates, own.coordinates);
  if (file.types.size() > 1)
    refuse(fmt::format("is a cell of one type, {} has {}", path, file.types.size()));
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
      refuse(fmt::format(
          "face {} of its cell has another mirror image, or other odd coordinates, than in {}",
          a.name, path));
  }
  for (const dynamics::CostInfo& cost : own.costs)
    if (std::none_of(program.costs.begin(), program.costs.end(),
                     [&](const dynamics::CostInfo& c) { return c.key == cost.key; }))
      refuse(fmt::format("its cell has no cost {}, which {} has", cost.key, path));
}

std::string keys_of(const std::vector<dynamics::CostInfo>& costs) {
  std::string text;
  for (const dynamics::CostInfo& cost : costs) text += (text.empty() ? "" : ", ") + cost.key;
  return text;
}

/// Opens a cell file, or a matrix of such cells, with the cell that carries bodies through.
Source open_cells(const SourceFile& file, const SourceOptions& options) {
  Source s{.path = file.path()};
  CellFile cells;
  if (file.is_matrix()) {
    if (!file.is_of_cells()) throw markov::BadFile(s.path + ": holds no cells");
    CellMatrix m = cell_matrix(file.matrix(), s.path, options.overrides);
    if (!m.pool)
      throw std::invalid_argument(s.path + ": is a chain that was made elsewhere, without runs");
    cells = std::move(m.cells);
    s.file = std::move(m.file);
    s.pool = std::make_shared<RunPool>(*std::move(m.pool));
    put_trees(s);
  } else {
    cells = read_cell_file(file.toml(), options.overrides);
    s.pool = std::make_shared<RunPool>();
  }
  const std::shared_ptr<const dynamics::Cell> cell = options.cell();
  require_same(*cell, cells, s.path);
  if (const std::string costs = keys_of(cell->section().costs),
      seen = keys_of(cells.map.section.costs);
      s.file && costs != seen)
    throw std::invalid_argument(fmt::format(
        "--cell-program: costs {} of its cell, {} of the runs in {}", costs, seen, s.path));
  s.problem = problem_of(cells, *s.pool);
  dynamics::CellMap& map = s.problem.cells.map;
  const std::vector<dynamics::Face> faces = std::exchange(map.section, cell->section()).faces;
  for (std::size_t f = 0; f < faces.size(); ++f) map.section.faces[f].usual = faces[f].usual;
  map.types.front().symmetric = cell->is_symmetric();
  cells.map = map;
  s.problem.cells.cells = {cell};
  s.starts = {cells.start};
  s.cells = std::make_shared<const CellFile>(std::move(cells));
  return s;
}

/// Opens recorded runs, or an imported chain.
Source open_recorded(const SourceFile& file, const SourceOptions& options) {
  CellMatrix m = cell_matrix(file.matrix(), file.path(), options.overrides);
  Source s{.path = file.path(), .file = std::move(m.file), .problem = std::move(m.problem)};
  s.starts = {m.cells.start};
  if (m.pool) {
    s.cells = std::make_shared<const CellFile>(std::move(m.cells));
    s.pool = std::make_shared<RunPool>(*std::move(m.pool));
    s.accuracy.accuracy = 1.0;  // accepts any accuracy that its runs give
    s.accuracy.per_leaf = tree_info(*s.file, s.path).entries_per_leaf;
    s.doubts = doubts_of(*s.pool, s.problem);
    return s;
  }
  if (const auto states = states_info(*s.file, s.path); !states || !states->is_imported())
    throw markov::BadFile(s.path + ": its runs are missing");
  s.is_imported = true;
  m.cells.map.section.named = s.problem.cells.map.section.named =
      s.file->transitions.space.section().named;
  s.cells = std::make_shared<const CellFile>(std::move(m.cells));
  return s;
}

/// Sentences on doubtful starts of recorded runs. Throws std::invalid_argument for a start in a
/// state that no body was seen to enter.
std::vector<std::string> doubts_of_starts(const Source& s) {
  const std::vector<dynamics::Transitions> matrices = s.matrices();
  const auto& seen = matrices[static_cast<std::size_t>(s.problem.start_type())];
  std::vector<std::string> doubts;
  for (const auto& start : s.starts) {
    if (!start) continue;
    const auto at = seen.space.index_of(*start);
    const std::string title = title_of(s.problem.map().section, start);
    if (seen.trials[static_cast<std::size_t>(at.state)] == 0)
      throw std::invalid_argument(
          title +
          ": nobody was seen to enter so, and what would become of such a body is not known");
    if (at.beyond)
      doubts.push_back(title +
                       " lies beyond all entries that were seen: its prediction is that of the "
                       "nearest state");
  }
  return doubts;
}

}  // namespace

const TomlFile& SourceFile::toml() const {
  if (!toml_) toml_ = TomlFile::read(path_);
  return *toml_;
}

const std::shared_ptr<const MatrixFile>& SourceFile::matrix() const {
  if (!matrix_) matrix_ = std::make_shared<const MatrixFile>(read_matrix(path_));
  return matrix_;
}

bool SourceFile::is_of_cells() const { return matrix()->text.contains(kCellText); }

const Scene& SourceFile::own_scene() const {
  if (is_of_cells())
    throw markov::BadFile(
        path_ + ": is a chain of recorded runs, or of another program's cells, and not of a scene");
  if (!own_scene_) own_scene_ = lattice::own_scene(*matrix(), path_);
  return *own_scene_;
}

void SourceFile::keep_in_memory() {
  if (!is_of_cells() && has_runs(*matrix()))
    runs_ = pool_of(*matrix(), problem_of(own_scene()), path_);
  else if (!is_of_cells())
    (void)own_scene();
}

Source Source::open(const std::string& path, const SourceOptions& options) {
  return open(SourceFile(path), options);
}

Source Source::of(Problem problem) {
  Source s{.path = problem.source, .pool = std::make_shared<RunPool>()};
  s.starts = {problem.start};
  s.problem = std::move(problem);
  return s;
}

Source Source::open(const SourceFile& file, const SourceOptions& options) {
  if (options.scene && (options.cell || !file.is_matrix() || file.is_of_cells()))
    throw std::invalid_argument(
        fmt::format("{}: is no matrix of a scene; a second one, \"{}\", has no meaning beside it",
                    file.path(), options.scene->path()));
  return options.cell         ? open_cells(file, options)
         : !file.is_matrix()  ? open_scene(file, options)
         : file.is_of_cells() ? open_recorded(file, options)
                              : open_matrix(file, options);
}

std::vector<std::string> Source::start_from(const std::vector<std::string>& texts) {
  const StartsBy by = is_recorded() ? StartsBy::any_face_or_seen : StartsBy::any_face;
  starts_given = !texts.empty();
  if (starts_given) starts.clear();
  for (const std::string& text : texts)
    if (!is_imported) {
      starts.push_back(start_in(text, problem.map().section, by));
    } else if (const auto state = named_state(*file, text)) {
      starts.emplace_back(state);
    } else {
      throw std::invalid_argument(
          fmt::format("--start {}: {} has no state of that name or number", text, path));
    }
  if (is_recorded() && !is_imported) {
    problem.start = starts.front().value_or(problem.start);
    return doubts_of_starts(*this);
  }
  problem.start = entries().front();
  if (scene && starts_given) require_inside(entries(), *scene);
  return {};
}

void Source::choose_method(std::uint64_t seed, const dynamics::Work& work) {
  if (!scene || file) return;
  if (auto chosen = settle_method(*scene, RunsFrom::everywhere, seed, work))
    pilot = std::make_shared<const Settled>(*std::move(chosen));
  put_cells(problem, *scene);
}

std::vector<dynamics::Entry> Source::entries() const {
  std::vector<dynamics::Entry> entries;
  for (const auto& start : starts) {
    if (!start)
      throw std::invalid_argument(path +
                                  ": has no [start], and --start does not say where trials start");
    entries.push_back(*start);
  }
  return entries;
}

std::string Source::name_of(std::size_t start) const {
  return starts_given ? title_of(problem.map().section, starts[start]) : "the start";
}

std::vector<dynamics::Transitions> Source::matrices() const {
  if (!file) {
    if (!pool || pool->starts.empty())
      throw std::invalid_argument(path + ": has no gate runs: predict() makes them");
    return matrices_of(problem, *pool, entries(), accuracy.per_leaf);
  }
  return scene ? matrices_of(*file, *scene) : matrices_of(*file, *cells);
}

std::optional<Settled> settled_of(const Source& s) {
  return s.pilot ? std::optional(*s.pilot) : std::nullopt;
}

SceneMatrix scene_matrix_of(const Source& s) { return {s.file, *s.scene}; }

CountedField counted_of(const Source& s) {
  CountedField field = counted_field(s.problem.map(), s.matrices());
  const auto states = states_info(*s.file, s.path);
  field.exact = states && states->are_probabilities;
  if (auto per_run = s.is_imported ? counts_per_run(*s.file) : std::vector<std::int64_t>();
      !per_run.empty()) {
    field.small_rows = true;
    field.images = {std::move(per_run)};
  }
  return field;
}

double bin_of_durations(const Source& s, std::uint64_t seed) {
  if (s.scene) return bin_of_durations(s.scene->gate);
  if (s.cells->trapped_after) return *s.cells->trapped_after / 1000.0;
  constexpr std::int64_t kSome = 100;
  FieldCosts some(1.0);
  (void)field_trials(s.problem, {0, kSome}, seed, {},
                     [&](const FieldTrials& each) { some.add(each); });
  const double mean = some.all().mean(0);
  return mean > 0.0 ? mean / 1000.0 : 1.0;
}

PooledPrediction predict(Source& s, const dynamics::Work& work) {
  if (!s.pool)
    throw std::invalid_argument(s.path + ": has no trees, and no gate runs that could be added to");
  if (s.is_recorded()) return predict_recorded(s.problem, *s.pool, s.starts, s.accuracy);
  if (s.problem.cells.cells.empty()) s.choose_method(s.accuracy.seed, work);
  if (s.pool.use_count() > 1) s.pool = std::make_shared<RunPool>(*s.pool);
  return predict_pooled(s.problem, *s.pool, s.entries(), s.accuracy, work);
}

}  // namespace gatewalk::lattice
