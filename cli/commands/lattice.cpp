// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include "cli/actions.h"
#include "cli/arguments.h"
#include "cli/exchange/policy_file.h"
#include "cli/fields/text.h"
#include "cli/next.h"
#include "cli/render/field_figure.h"
#include "cli/render/field_netcdf.h"
#include "cli/render/field_runs.h"
#include "cli/render/health.h"
#include "cli/render/scene.h"
#include "cli/source_options.h"
#include "dynamics/base/work.h"
#include "lattice/recorded/recorded_pool.h"
#include "lattice/scene/scene_trials.h"
#include "lattice/scene/table4.h"
#include "lattice/study/plan.h"
#include "lattice/study/trials.h"

namespace gatewalk::cli {
namespace {

struct LatticeCommand : Options {
  using Options::Options;
  TextOption path = scene();
  CountOption trials = add_trials_and_seed("trials through the field");
  CountOption first_trial = add_first_trial();
  TextOption checkpoint = add_kept({"field trials"});
  Option strict = add_strict();
  AskedProgram program = add_cell_program(*this);
  TextOption passages =
      output_file("passages", "FILE.csv",
                  "write each passage through a gate as a line of a table of recorded runs "
                  "(cli/site/reference/files.md)");
  TextOption cell_file = output_file(
      "cell-file", "FILE.toml", "write the cell file (cell.toml) that belongs to such a table");
  TextOption netcdf = output_file("netcdf", "FILE.nc", kNetcdfHelp, Options::Content::binary);
  TextOption policy =
      input_file("policy", "a result of gatewalk plan (FILE.json): bodies follow its policy");
  TextOption figure = add_figure("where bodies end, and how");
  Asked asked{.path = path, .program = program};
};

/// Runs trials through a scene of gates.
FieldRun run_gates(const LatticeCommand& options) {
  RunScene scene{options.read_scene()};
  scene.settled = settle_method(options, scene.scene, lattice::RunsFrom::everywhere);
  const lattice::FieldParams& field = scene.scene.field;
  FieldRun run{ShownField(scene.scene),
               dynamics::entry_of(scene.scene.gate, scene.scene.start),
               options.provenance(scene.scene),
               lattice::FieldCosts(lattice::bin_of_durations(scene.scene.gate)),
               scene,
               lattice::FieldTally(field)};
  run.tally = lattice::field_trials(scene.scene, options.trial_range(), options.seed(),
                                    options.work(), lattice::added_to(run.costs));
  options.work().end_part();
  return run;
}

/// A result before its first trial.
FieldRun empty_run(const LatticeCommand& options, const lattice::Source& s) {
  const lattice::FieldParams& field = s.problem.field;
  return {ShownField(s),         s.problem.start,
          options.provenance(s), lattice::FieldCosts(lattice::bin_of_durations(s, options.seed())),
          std::nullopt,          lattice::FieldTally(field)};
}

/// Runs trials through cells of any kind; writes the tables of --passages and --cell-file.
FieldRun run_cells(const LatticeCommand& options) {
  lattice::Source s = open_source(options, options.asked);
  if (s.file) throw UsageError(needs_scene(s.path));
  choose_method(options, s);
  FieldRun run = empty_run(options, s);
  if (s.scene) run.scene = RunScene{*s.scene, lattice::settled_of(s)};
  lattice::RecordedRuns runs;
  runs.passages.begin(s.problem.map().section);
  const bool keep = static_cast<bool>(options.passages);
  const lattice::TakeTrials add = lattice::added_to(run.costs);
  run.tally = lattice::field_trials(
      s.problem, options.trial_range(), options.seed(), options.work(),
      [&](const lattice::FieldTrials& each) {
        add(each);
        if (keep) lattice::add_trials(runs, each, s.problem.start);
      },
      keep);
  options.work().end_part();
  const lattice::CellFile cells = lattice::cells_of(s.problem);
  if (keep) {
    options.keep_old(options.passages.value());
    lattice::write_runs(options.passages.value(), cells, runs);
  }
  if (options.cell_file) options.write(options.cell_file.value(), lattice::to_toml(cells));
  return run;
}

/// Runs trials of bodies that follow a policy.
FieldRun run_policy(const LatticeCommand& options) {
  refuse({options.passages, options.cell_file}, "with --policy");
  lattice::Source s = open_source(options, options.asked);
  if (s.file) throw UsageError(needs_scene(s.path));
  Actions all = actions_of(options, s);
  const lattice::Policy policy = read_policy(options.policy.value(), all.made_for);
  FieldRun run = empty_run(options, s);
  run.may_do = {all.names(), std::move(all.methods)};
  run.tally = lattice::policy_trials(all.actions, policy, options.trial_range(), options.seed(),
                                     options.work(), lattice::added_to(run.costs));
  options.work().end_part();
  return run;
}

/// Runs the trials that --trials asks for; writes the tables of --passages and --cell-file.
FieldRun field_run(const LatticeCommand& options) {
  if (options.policy) return run_policy(options);
  const bool any_cells =
      has_cell(options, options.program) || options.passages || options.cell_file;
  return any_cells ? run_cells(options) : run_gates(options);
}

/// Commands to propose next.
std::vector<std::string> next_of(const LatticeCommand& options) {
  if (options.policy) return {};
  NextCommands next(options);
  next.add("predict", "", "a prediction with error bars, also of rare endings");
  if (!has_cell(options, options.program))
    next.add("trace", "--field --trials 5 --replay runs.html", "watch single bodies");
  return next.lines();
}

}  // namespace

int run_lattice(const Arguments& arguments) {
  LatticeCommand options(
      "lattice SCENE [options]",
      "Simulates trials of the full dynamics through the field, gate by gate, and counts how and "
      "in\n"
      "which gate they end. `gatewalk simulate` is another name of this command.\n\n"
      "Where bodies leave and what they take (time, work) are counted as well. For rare endings "
      "or\n"
      "many starts, gatewalk predict needs fewer trials for the same interval.",
      "gatewalk lattice scenes/field.toml --trials 10000 --seed 1 --json lattice.json");
  options.add_details("maps of the final gates, where bodies leave, times and costs, the scene");
  options.most_used({"trials", "set", "seed", "figure", "json"});
  if (!options.parse(arguments)) return kFine;
  const dynamics::Stopwatch watch;
  const FieldRun run = field_run(options);
  const double seconds = watch.seconds();
  const FieldPicture picture(fmt::format("full dynamics, {} trials", run.tally.trials),
                             ends_of(run.tally, run.shown.field), lattice::exits_of(run.tally),
                             run.start);
  if (options.netcdf)
    options.write(options.netcdf.value(), netcdf_of({picture}, run.shown, run.made_by));
  options.give_out(
      run, {answer_text(run) + beware_of(run.tally.health), details_text(run), next_of(options)});
  options.remark(fixed(seconds, 2) + " s");
  options.warn(too_few_gates(run.shown));
  const int exit = status_of(options, run.tally.health);
  options.draw([&] { return figure_of({picture}, run.shown); });
  return exit;
}

}  // namespace gatewalk::cli
