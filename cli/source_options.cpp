// SPDX-License-Identifier: MIT
#include "cli/source_options.h"

#include <fmt/core.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/cells/program.h"
#include "cli/fields/text.h"
#include "cli/render/choice.h"
#include "cli/render/matrix.h"
#include "lattice/recorded/recorded_pool.h"
#include "lattice/scene/terrain.h"
#include "lattice/text/digits.h"

namespace gatewalk::cli {
namespace {

using lattice::kParameters;  // for --set parameters.KEY=VALUE
using lattice::Source;

/// The values of --set that name the program's parameters, or those that name keys of the cell
/// file.
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

/// The cell that moves bodies: the caller's object, or the program of --cell-program.
std::shared_ptr<const dynamics::Cell> cell_of(const Options& options, const AskedProgram& program) {
  const std::vector<dynamics::Cell::Number> set = parameters_of(options);
  if (!options.cell()) {
    ProgramOptions how;
    if (program.timeout) how.timeout_s = program.timeout.value();
    return std::make_shared<ProgramCell>(program.command.value(), how, set);
  }
  if (!set.empty() || program.command || program.timeout)
    throw UsageError("a cell is given: --set parameters and --cell-program are for programs");
  return options.cell();
}

/// Gives the source the starts and the accuracy that the options ask for, and warns of what the
/// source cannot tell.
void take_options(const Options& options, const Asked& asked, Source& s) {
  if (s.is_recorded())
    refuse({asked.accuracy.gate_runs}, "for " + s.path +
                                           (s.is_imported ? ", a chain that was made elsewhere"
                                                          : ", whose runs were recorded"));
  if (s.pool) s.accuracy = accuracy_of(options, asked.accuracy, s.accuracy);
  const std::vector<std::string> of_starts = s.start_from(asked.starts.values());
  for (const std::string& text : s.doubts) options.warn(text);
  for (const std::string& text : of_starts) options.warn(text);
}

/// The scene with the values of --versus added to those of --set.
Source open_other(const Options& options, const Source& s, const std::vector<std::string>& versus) {
  std::vector<std::string> overrides = options.overrides();
  overrides.insert(overrides.end(), versus.begin(), versus.end());
  try {
    return Source::open(options.file(s.path), {.overrides = std::move(overrides)});
  } catch (const lattice::SceneError& e) {  // names overrides as --set, so the text is mended
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

/// The source of another group's recorded runs, to be compared with the first.
Source other_group(const Options& options, const Asked& asked, const Source& s,
                   const lattice::SourceFile& file) {
  if (!s.is_recorded() || s.is_imported || has_cell(options, asked.program) || !file.is_of_cells())
    throw UsageError(fmt::format(
        "--versus {}: two matrices are compared where both are of recorded runs", file.path()));
  Source other = Source::open(file, {.overrides = options.overrides()});
  take_options(options, asked, other);
  if (other.is_imported)
    throw UsageError(fmt::format("--versus {}: is a chain that was made elsewhere", file.path()));
  require_same_size(s.cells->field, other.cells->field);
  return other;
}

}  // namespace

Source open_source(const Options& options, const Asked& asked) {
  const lattice::SourceFile& file = options.file(asked.path.value());
  lattice::SourceOptions how;
  if (const std::string scene = asked.scene.value(); !scene.empty())
    how.scene = &options.file(scene);
  if (has_cell(options, asked.program)) {
    if (file.is_matrix() && !parameters_of(options).empty())
      throw UsageError(fmt::format(
          "--set parameters: {} holds runs of the program with its own: make a matrix with these",
          file.path()));
    how.overrides = overrides_of(options, false);
    how.cell = [&] { return cell_of(options, asked.program); };
  } else {
    refuse({asked.program.timeout}, "without --cell-program");
    how.overrides = options.overrides();
  }
  if (!file.is_matrix())
    (void)accuracy_of(options, asked.accuracy, {});  // throws before a cell program is started
  else if (!how.cell && !file.is_of_cells())
    warn_of_faults(options, *file.matrix(), file.path());
  Source s = Source::open(file, how);
  if (how.cell) options.depends_on(text_of(*s.problem.cells.cells.front()));
  take_options(options, asked, s);
  return s;
}

RecordedCells read_recorded(const Options& options, const std::string& path,
                            const TextOption& cell_file) {
  lattice::CellFile cells =
      lattice::read_cell_file(options.file(cell_file.value()).toml(), options.overrides());
  lattice::RecordedRuns runs = lattice::read_runs(path, cells);
  for (const std::string& text : runs.remarks) options.warn(path + ": " + text);
  const auto unknown = runs.unknown;
  lattice::RunPool pool = lattice::pool_of(std::move(runs));
  lattice::Problem problem = lattice::problem_of(cells, pool);
  for (const std::string& text : lattice::doubts_of(pool, problem)) options.warn(text);
  options.warn(lattice::faces_without_use(pool, problem));
  if (const std::string text = lattice::far_from_faces(pool, problem); !text.empty())
    options.warn(text);
  const auto& costs = problem.map().section.costs;
  for (std::size_t c = 0; c < costs.size(); ++c)
    if (unknown[c] > 0)
      options.warn(fmt::format("{} is blank in {} passages: analyze leaves it out", costs[c].key,
                               unknown[c]));
  return {std::move(cells), std::move(pool), std::move(problem)};
}

Source field_to_run(const Options& options, const Asked& asked, const std::string& made) {
  Source s = open_source(options, asked);
  if (s.file) throw UsageError(needs_scene(s.path));
  if (s.starts.size() > 1) throw UsageError("--start: " + made + " for one start");
  return s;
}

std::optional<Source> versus(const Options& options, const Asked& asked, const TextsOption& versus,
                             const Source& s) {
  if (!versus) return {};
  const std::vector<std::string> given = versus.values();
  if (given.size() == 1 && options.file(given.front()).is_matrix())
    return other_group(options, asked, s, options.file(given.front()));
  for (const std::string& text : given) {
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
  Source other = open_other(options, s, given);
  require_same_size(s.scene->field, other.scene->field);
  other.accuracy = s.accuracy;
  other.starts_given = s.starts_given;
  return other;
}

void choose_method(const Options& options, Source& s) {
  if (!s.scene || s.file) return;
  warn_of_keys(options, *s.scene, lattice::RunsFrom::everywhere);
  s.choose_method(options.seed(), options.work());
  if (s.pilot) options.warn(complaint(*s.pilot));
}

lattice::PooledPrediction predict(const Options& options, Source& s) {
  auto prediction = lattice::predict(s, options.work());
  warn_of(options, prediction, s.accuracy.accuracy, s.is_recorded());
  return prediction;
}

std::string where(const Source& s, std::size_t start) {
  return s.starts.size() > 1 ? s.name_of(start) + ": " : "";
}

std::string text_of(const dynamics::Cell& cell) {
  const dynamics::Section& section = cell.section();
  std::string costs;
  for (const dynamics::CostInfo& cost : section.costs)
    costs += (costs.empty() ? "" : ", ") + cost.key;
  std::string text = fmt::format("cell program: {}; {}; {}", names_of(section.faces),
                                 names_of(section.coordinates), costs);
  for (const dynamics::Cell::Number& n : cell.numbers())
    text += fmt::format("; {} = {}", n.key, digits(n.value));
  return text;
}

std::string needs_scene(const std::string& path) {
  return path + ": is a matrix (HDF5), and a scene (TOML) is needed here";
}

void refuse(std::initializer_list<Option> options, const std::string& where) {
  for (const Option& option : options)
    if (option) throw UsageError(fmt::format("--{} has no meaning {}", option.name(), where));
}

bool has_cell(const Options& options, const AskedProgram& program) {
  return program.command || options.cell();
}

AskedProgram add_cell_program(Options& options) {
  const TextOption command = options.add_text(
      "cell-program", "COMMAND",
      "SCENE is a cell file (cell.toml), and this command carries bodies through its "
      "cells (cli/site/reference/cell_program.md); --set parameters.KEY=VALUE changes a "
      "parameter of it");
  return {command,
          options.add_number("cell-timeout", "S",
                             "seconds that the program may be silent while an answer is awaited "
                             "(default: 60)")};
}

}  // namespace gatewalk::cli
