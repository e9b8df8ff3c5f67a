#include "cli/arguments.h"
#include "cli/render/analysis.h"
#include "cli/render/exits.h"
#include "cli/render/field_figure.h"
#include "cli/render/field_netcdf.h"
#include "cli/render/field_runs.h"
#include "cli/render/json.h"
#include "cli/render/scene.h"
#include "cli/render/text.h"
#include "cli/subject.h"
#include "cli/terminal/output.h"
#include "lattice/cells/recorded_pool.h"
#include "lattice/scene/scene_trials.h"
#include "lattice/study/trials.h"

namespace gatewalk::cli {
namespace {

/// Trials through the field, and what they are of.
struct Run {
  ShownField shown;
  dynamics::Entry start;
  Json made_by;
  lattice::FieldCosts costs;
  lattice::ExitCounts exits;
  std::optional<RunScene> scene{};  // of gates
  lattice::FieldTally tally;
};

Run run_scene(const Options& options) {
  RunScene scene{options.read_scene()};
  scene.settled = settle_method(options, scene.scene, lattice::RunsFrom::everywhere);
  const lattice::FieldParams& field = scene.scene.field;
  Run run{ShownField(scene.scene),
          dynamics::entry_of(scene.scene.start),
          to_json(options.provenance(scene.scene)),
          lattice::FieldCosts(lattice::bin_of_durations(scene.scene.gate)),
          lattice::ExitCounts(field),
          scene,
          lattice::FieldTally(field)};
  run.tally = lattice::field_trials(scene.scene, options.trials(), options.seed(), options.work(),
                                    &run.costs, &run.exits);
  return run;
}

/// Of any cells; writes the tables of --passages and --cell-file.
Run run_cells(const Options& options) {
  Subject s = open_subject(options, "scene");
  if (s.file) throw UsageError(s.path + ": is a matrix, and bodies are to be run: give a scene");
  s.settle(options);
  const lattice::FieldParams& field = s.problem.field;
  Run run{s.shown(),
          s.problem.start,
          s.made_by(options),
          lattice::FieldCosts(s.bin_of_durations(options)),
          lattice::ExitCounts(field),
          s.scene ? std::optional(RunScene{*s.scene, s.settled}) : std::nullopt,
          lattice::FieldTally(field)};
  lattice::RecordedRuns runs;
  runs.passages.begin(s.problem.map().section);
  const auto take = [&](const lattice::FieldTrials& each) {
    lattice::add_trials(runs, each, s.problem.start);
  };
  const bool keep = options.has("passages");
  run.tally =
      lattice::field_trials(s.problem, options.trials(), options.seed(), options.work(), &run.costs,
                            &run.exits, keep ? lattice::TakeTrials(take) : lattice::TakeTrials());
  const lattice::CellFile cells = lattice::cells_of(s.problem);
  if (keep) {
    options.keep_old(options.text("passages"));
    lattice::write_runs(options.text("passages"), cells, runs);
  }
  if (options.has("cell-file")) options.write(options.text("cell-file"), lattice::to_toml(cells));
  return run;
}

}  // namespace

int run_lattice(const Arguments& arguments) {
  Options options(
      "lattice SCENE [options]",
      "Runs the full dynamics through the field, gate by gate, and counts the final gates.",
      "gatewalk lattice scenes/field.toml --trials 10000 --seed 1 --json lattice.json");
  options.scene();
  options.add_trials_and_seed("trials through the field");
  options.add_strict();
  add_cell_program(options);
  options.output_file("passages", "FILE.csv",
                      "write every passage through a gate as a table of recorded runs "
                      "(lattice/cells/README.md)");
  options.output_file("cell-file", "FILE.toml", "write what such a table's cells are (cell.toml)");
  options.output_file("netcdf", "FILE.nc", kNetcdfHelp, Options::Content::binary);
  options.add_figure("where bodies end, and how");
  if (!options.parse(arguments)) return kFine;
  const dynamics::Stopwatch watch;
  const bool any_cells =
      options.has("cell-program") || options.has("passages") || options.has("cell-file");
  const Run run = any_cells ? run_cells(options) : run_scene(options);
  const double seconds = watch.seconds();
  const lattice::FieldExits exits = lattice::exits_of(run.exits);

  Json json = to_json(run.tally, run.shown, run.scene);
  json["exits"] = to_json(exits, run.shown);
  json["costs"] = to_json(run.costs, run.shown);
  json["made_by"] = run.made_by;
  const FieldPicture picture("full dynamics, " + std::to_string(run.tally.trials) + " trials",
                             run.tally, exits);
  if (options.has("netcdf"))
    options.write(options.text("netcdf"),
                  netcdf_of({{picture, run.start}}, run.shown.map.section, json["made_by"]));
  options.give_out(json, table_of(run.tally, run.shown, run.scene) + table_of(exits, run.shown) +
                             table_of(run.costs, run.shown));
  options.remark(fixed(seconds, 2) + " s");
  options.warn(too_few_gates(run.shown));
  const int exit = status_of(options, run.tally.health);
  options.draw([&] { return figure_of({picture}, run.shown); });
  return exit;
}

}  // namespace gatewalk::cli
