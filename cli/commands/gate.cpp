// SPDX-License-Identifier: MIT
#include "cli/arguments.h"
#include "cli/render/choice.h"
#include "cli/render/gate_runs.h"
#include "cli/render/health.h"
#include "cli/render/scene.h"
#include "dynamics/base/kept_pieces.h"
#include "dynamics/disc/study/accuracy.h"

namespace gatewalk::cli {

int run_gate(const Arguments& arguments) {
  Options options("gate SCENE [options]",
                  "Runs one gate many times from the scene's start and counts how the runs end.",
                  "gatewalk gate scenes/single_gate.toml --set beams.stiffness_left_Nm_per_rad=300 "
                  "--trials 1000 --json -");
  options.scene();
  options.add_trials_and_seed("runs of the gate");
  options.add_first_trial();
  options.add_kept({"gate runs"});
  options.add_strict();
  options.add_figure("a bar per outcome");
  if (!options.parse(arguments)) return kFine;
  lattice::Scene scene = options.read_scene();
  const auto settled = settle_method(options, scene, lattice::RunsFrom::start);

  const GateResult result{
      dynamics::run_checked_trials(scene.gate, scene.start, options.seed(),
                                   {"gate runs", options.trial_range()}, options.work()),
      settled, options.provenance(scene)};
  options.work().end_part();

  options.give_out(result, scene_line(scene) + table_of(result.tally) + method_line(settled));
  const int exit = status_of(options, result.tally.health);
  options.draw([&] { return figure_of(result.tally); });
  return exit;
}

}  // namespace gatewalk::cli
