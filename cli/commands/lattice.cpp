#include "cli/arguments.h"
#include "cli/command.h"
#include "cli/render/choice.h"
#include "cli/render/report.h"
#include "cli/render/states.h"
#include "cli/terminal/progress.h"

namespace gatewalk::cli {

int run_lattice(const std::vector<std::string>& arguments) {
  Options options(
      "lattice SCENE [options]",
      "Runs the full dynamics through the field, gate by gate, and counts the final gates.",
      "gatewalk lattice scenes/field.toml --trials 10000 --seed 1 --json lattice.json");
  options.positional("scene", "scene file (TOML)", true);
  add_trials_and_seed(options, "trials through the field");
  add_strict(options);
  if (!options.parse(arguments)) return kFine;
  lattice::Scene scene = lattice::read_scene(options.text("scene"), options.overrides());
  const std::int64_t trials = options.count("trials");
  const Json settled = settle_method(options, scene, lattice::RunsFrom::everywhere);
  const auto space = lattice::fixed_space(scene);

  const Stopwatch watch;
  lattice::FieldTally tally(scene.field);
  run_in_batches("field trials", trials, options.talk(), [&](std::int64_t first, std::int64_t n) {
    tally +=
        lattice::run_field(scene.gate, scene.field, scene.start, space, options.seed(), {first, n});
    tally.final_gate_of_trial.clear();  // asked for by nobody
  });
  lattice::check_outcomes(scene, lattice::RunsFrom::everywhere, options.seed(), trials,
                          tally.health, options.work());

  Json json;
  const EndingShares shares(tally.endings, tally.trials);
  json["endings"] = endings(tally.endings);
  json["endings_95"] = endings_95(shares);
  json["final_gates"] = grid(tally.final_gates);
  json["trapped_gates"] = grid(tally.trapped_gates);
  json["departed_gates"] = grid(tally.departed_gates);
  json["trials"] = tally.trials;
  json["trapped"] = tally.trapped;
  json["left_field"] = tally.left_field;
  json["cut_off"] = tally.cut_off;
  json["not_finite"] = tally.broken;
  json["intervals_95"] = {{"trapped", share_interval(tally.trapped, tally.trials)},
                          {"left_field", share_interval(tally.left_field, tally.trials)},
                          {"cut_off", share_interval(tally.cut_off, tally.trials)}};
  Json entries;
  for (int b = 0; b < dynamics::kBoundaries; ++b)
    entries[std::string(dynamics::kBoundaryNames[b])] = {{"count", tally.entries[b]},
                                                         {"outside_bins", tally.clamped[b]}};
  json["entries_between_gates"] = std::move(entries);
  json["bins"] = scene.bins ? "scene" : "paper";  // what outside_bins counts by
  if (!settled.is_null()) json["method"] = settled;
  json["status"] = to_json(tally.health);
  json["made_by"] = manifest(options, scene);

  const auto n = static_cast<double>(tally.trials);
  std::string table =
      endings_text(shares, "of " + std::to_string(tally.trials) + " trials, 95 % intervals") +
      limits_text(scene) + scene_line(scene) + map_of(tally.final_gates.cast<double>() / n) +
      map_of_trapped(tally.trapped_gates.cast<double>() / n) + "left the field " +
      percent(static_cast<double>(tally.left_field), n, 2) + "\n";
  if (tally.broken > 0)
    table +=
        "stopped being finite numbers: " + percent(static_cast<double>(tally.broken), n, 4) + "\n";
  options.give_out(json, table + method_line(settled));
  remark(options, fixed(watch.seconds(), 2) + " s");
  warn_if_too_few_gates(scene);
  if (!tally.health.clean()) warn(complaint(tally.health));
  return exit_status(options, tally.health.clean());
}

}  // namespace gatewalk::cli
