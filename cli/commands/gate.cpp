// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include "cli/arguments.h"
#include "cli/fields/text.h"
#include "cli/next.h"
#include "cli/render/choice.h"
#include "cli/render/gate_runs.h"
#include "cli/render/health.h"
#include "cli/render/scene.h"
#include "cli/source_options.h"
#include "dynamics/base/kept_pieces.h"
#include "dynamics/disc/study/accuracy.h"

namespace gatewalk::cli {

int run_gate(const Arguments& arguments) {
  Options options("gate SCENE [options]",
                  "Simulates runs through one gate from the scene's start and counts how they end.",
                  "gatewalk gate scenes/single_gate.toml --set beams.stiffness_left_Nm_per_rad=300 "
                  "--trials 1000 --json -");
  const TextOption path = options.scene();
  options.add_trials_and_seed("runs of the gate");
  options.add_first_trial();
  options.add_kept({"gate runs"});
  options.add_strict();
  options.add_figure("a bar for each outcome");
  options.add_details("the numbers of the scene and how runs are simulated");
  options.most_used({"trials", "set", "seed", "figure", "json"});
  if (!options.parse(arguments)) return kFine;
  lattice::Scene scene = options.read_scene();
  const auto settled = settle_method(options, scene, lattice::RunsFrom::start);

  const GateResult result{
      dynamics::run_checked_trials(scene.gate, scene.start, options.seed(),
                                   {"gate runs", options.trial_range()}, options.work()),
      settled, options.provenance(scene)};
  options.work().end_part();

  options.give_out(
      result, {table_of(result.tally) +
                   wrapped(fmt::format(
                       "From {} through one gate from the scene's start. The 95 % intervals count "
                       "their sampling error.",
                       counted(result.tally.trials, "run", "runs"))) +
                   beware_of(result.tally.health),
               "\n" + scene_line(scene) + method_line(settled),
               NextCommands(options)
                   .add("trace", "--trials 5 --replay runs.html", "watch single runs")
                   .add("predict", "", "how bodies cross a field of gates")
                   .lines()});
  const int exit = status_of(options, result.tally.health);
  options.draw([&] { return figure_of(result.tally); });
  return exit;
}

}  // namespace gatewalk::cli
