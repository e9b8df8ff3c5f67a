// SPDX-License-Identifier: MIT
#include "cli/field_run.h"

#include "cli/actions.h"
#include "cli/arguments.h"
#include "cli/exchange/policy_file.h"
#include "cli/subject.h"
#include "lattice/cells/recorded_pool.h"
#include "lattice/scene/scene_trials.h"
#include "lattice/scene/table4.h"
#include "lattice/study/plan.h"
#include "lattice/study/trials.h"

namespace gatewalk::cli {
namespace {

FieldRun run_scene(const Options& options) {
  RunScene scene{options.read_scene()};
  scene.settled = settle_method(options, scene.scene, lattice::RunsFrom::everywhere);
  const lattice::FieldParams& field = scene.scene.field;
  FieldRun run{ShownField(scene.scene),
               dynamics::entry_of(scene.scene.start),
               options.provenance(scene.scene),
               lattice::FieldCosts(lattice::bin_of_durations(scene.scene.gate)),
               lattice::ExitCounts(field),
               scene,
               lattice::FieldTally(field)};
  run.tally = lattice::field_trials(scene.scene, options.trial_range(), options.seed(),
                                    options.work(), lattice::added_to(run.costs, run.exits));
  options.work().end_part();
  return run;
}

/// Before any trial.
FieldRun run_of(const Options& options, const Subject& s) {
  const lattice::FieldParams& field = s.problem.field;
  return {s.shown(),
          s.problem.start,
          s.provenance(options),
          lattice::FieldCosts(s.bin_of_durations(options)),
          lattice::ExitCounts(field),
          std::nullopt,
          lattice::FieldTally(field)};
}

/// Of any cells; writes the tables of --passages and --cell-file.
FieldRun run_cells(const Options& options) {
  Subject s = open_subject(options, "scene");
  if (s.file) throw UsageError(s.path + ": is a matrix, and bodies are to be run: give a scene");
  s.settle(options);
  FieldRun run = run_of(options, s);
  if (s.scene) run.scene = RunScene{*s.scene, s.settled};
  lattice::RecordedRuns runs;
  runs.passages.begin(s.problem.map().section);
  const bool keep = options.has("passages");
  const lattice::TakeTrials add = lattice::added_to(run.costs, run.exits);
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
    options.keep_old(options.text("passages"));
    lattice::write_runs(options.text("passages"), cells, runs);
  }
  if (options.has("cell-file")) options.write(options.text("cell-file"), lattice::to_toml(cells));
  return run;
}

/// Of bodies that do what a policy says.
FieldRun run_policy(const Options& options) {
  refuse(options, {"passages", "cell-file"}, "with --policy");
  Subject s = open_subject(options, "scene");
  if (s.file)
    throw UsageError(s.path +
                     ": is a matrix, and bodies that do what a policy says are to be run: "
                     "give what it was made for");
  Actions all = actions_of(options, s);
  const lattice::Policy policy = read_policy(options.text("policy"), all.made_for);
  FieldRun run = run_of(options, s);
  run.may_do = {all.names(), std::move(all.methods)};
  run.tally = lattice::policy_trials(all.actions, policy, options.trial_range(), options.seed(),
                                     options.work(), lattice::added_to(run.costs, run.exits));
  options.work().end_part();
  return run;
}

}  // namespace

PolicyGates policy_gates(const Options& options, const lattice::Scene& scene) {
  Actions all = actions_of(options, scene, lattice::own_start(scene).entry());
  std::vector<std::string> names = all.names();
  return {lattice::chosen_gates(names, std::move(all.scenes),
                                [policy = read_policy(options.text("policy"), all.made_for)](
                                    const lattice::Place& at, const dynamics::Entry& entry) {
                                  return policy.action(at, entry);
                                }),
          {std::move(names), std::move(all.methods)}};
}

FieldRun field_run(const Options& options) {
  if (options.has("policy")) return run_policy(options);
  const bool any_cells = has_cell(options) || options.has("passages") || options.has("cell-file");
  return any_cells ? run_cells(options) : run_scene(options);
}

}  // namespace gatewalk::cli
