#include "cli/command.h"
#include "cli/render/choice.h"
#include "cli/render/report.h"
#include "cli/terminal/progress.h"

namespace gatewalk::cli {

int run_gate(const std::vector<std::string>& arguments) {
  Options options("gate SCENE [options]",
                  "Runs one gate many times from the scene's start and counts how the runs end.",
                  "gatewalk gate scenes/single_gate.toml --set beams.stiffness_left_Nm_per_rad=300 "
                  "--trials 1000 --json -");
  options.positional("scene", "scene file (TOML)", true);
  add_trials_and_seed(options, "runs of the gate");
  add_strict(options);
  if (!options.parse(arguments)) return kFine;
  lattice::Scene scene = lattice::read_scene(options.text("scene"), options.overrides());
  const std::int64_t trials = options.count("trials");
  const Json settled = settle_method(options, scene, lattice::RunsFrom::start);

  dynamics::GateTally tally;
  run_in_batches("gate runs", trials, options.talk(), [&](std::int64_t first, std::int64_t n) {
    tally += dynamics::run_gate_trials(scene.gate, scene.start, options.seed(), {first, n});
  });

  lattice::check_outcomes(scene, lattice::RunsFrom::start, options.seed(), trials, tally.health,
                          options.work());

  Json json = to_json(tally);
  if (!settled.is_null()) json["method"] = settled;
  json["status"] = to_json(tally.health);
  json["made_by"] = manifest(options, scene);

  const auto line = [&](const char* name, std::int64_t n) {
    const auto [low, high] = share_interval(n, tally.trials);
    return padded(name, -18) + padded(std::to_string(n), 10) +
           padded(percent(static_cast<double>(n), static_cast<double>(tally.trials), 2), 11) +
           "   [" + fixed(100.0 * low, 2) + ", " + fixed(100.0 * high, 2) + "]\n";
  };
  std::string table =
      scene_line(scene) + padded("trials", -18) + padded(std::to_string(tally.trials), 10) +
      "   share     95 % interval\n" + line("traversed", tally.traversed()) +
      line("  left beam", tally.traversed_left) + line("  right beam", tally.traversed_right);
  if (tally.traversed_even > 0) table += line("  both evenly", tally.traversed_even);
  table += line("exited left", tally.exited_left) + line("exited right", tally.exited_right) +
           line("trapped", tally.trapped);
  if (tally.broken > 0) table += line("not finite", tally.broken);
  options.give_out(json, table + method_line(settled));
  if (!tally.health.clean()) warn(complaint(tally.health));
  return exit_status(options, tally.health.clean());
}

}  // namespace gatewalk::cli
