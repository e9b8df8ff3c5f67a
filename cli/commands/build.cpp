#include "cli/arguments.h"
#include "cli/command.h"
#include "cli/render/choice.h"
#include "cli/render/matrix.h"
#include "cli/render/report.h"
#include "cli/render/states.h"
#include "cli/version.h"

namespace gatewalk::cli {

int run_build(const std::vector<std::string>& arguments) {
  Options options(
      "build SCENE -o MATRIX.nc [options]",
      "Fills the input-output matrix of one gate: for every input state (--bins says which)\n"
      "N short runs, counted by where they come out. In the paper's field states are the 87 of\n"
      "Table III, in any other they are made from what bodies do in a pilot of the full\n"
      "dynamics from the scene's start, which is a state of its own with more runs.",
      "gatewalk build scenes/field.toml --trials 100 --seed 1 -o matrix.nc");
  options.positional("scene", "scene file (TOML)", true);
  add_trials_and_seed(options, "runs per input state");
  add_strict(options);
  options.main_output_file("MATRIX.nc", "matrix file to write (NetCDF-4)",
                           Options::Content::binary);
  add_bins(options);
  if (!options.parse(arguments)) return kFine;
  lattice::Scene scene = lattice::read_scene(options.text("scene"), options.overrides());
  const std::int64_t trials = options.count("trials");
  const lattice::BinsChoice choice = bins_choice(options, scene);
  const Json settled = settle_method(options, scene, lattice::RunsFrom::everywhere);

  const Stopwatch pilot_watch;
  const lattice::States states = states_of(options, scene, choice, {scene.start});
  const double pilot_seconds = pilot_watch.seconds();
  const Json bins = states.choice.kind == lattice::BinsChoice::Kind::paper
                        ? Json(states.choice.factor)
                        : Json(states.choice.name());
  const Stopwatch watch;
  lattice::MatrixFile file{
      lattice::build_matrix(scene, states, trials, options.seed(), options.work()), {}};
  const double seconds = watch.seconds();
  lattice::check_outcomes(scene, lattice::RunsFrom::everywhere, options.seed(),
                          file.transitions.totals().runs, file.transitions.health, options.work());
  const dynamics::Transitions& t = file.transitions;
  file.text = {
      {"title", "gatewalk input-output matrix of one gate, Eq. (16), as counts"},
      {"scene", lattice::to_toml(scene)},
      {"seed", std::to_string(options.seed())},
      {"trials_per_row", std::to_string(trials)},
      {"bins", bins.is_string() ? states.choice.name()
                                : bins.dump()},  // the shortest digits that read back the same
      {"state_space", to_json(states).dump()},
      {"program", std::string("gatewalk ") + kVersion},
      {"commit", kCommit},
      {"command", options.canonical()},
      {"status", to_json(t.health).dump()}};
  if (!settled.is_null()) file.text["method"] = settled.dump();
  lattice::write_matrix(options.text("output"), file);

  const auto total = t.totals();
  Json json;
  json["matrix"] = options.text("output");
  json["inputs"] = t.space.size();
  json["outputs"] = t.space.size() + 1;
  json["trials_per_row"] = trials;
  json["bins"] = bins;
  json["nonzeros"] = total.nonzeros;
  json["clamped_share"] = total.clamped_share();
  json["state_space"] = to_json(states);
  if (!settled.is_null()) json["method"] = settled;
  json["status"] = to_json(t.health);
  json["made_by"] = manifest(options, scene);
  const std::string table =
      options.text("output") + ": " + std::to_string(t.space.size()) + " x " +
      std::to_string(t.space.size() + 1) + " matrix, " + std::to_string(total.runs) +
      " gate runs, " + std::to_string(total.nonzeros) + " nonzeros, " +
      percent(total.clamped_share(), 1.0) + " of the crossings clamped into the nearest bin\n";
  options.give_out(json, table + states_line(json["state_space"]) + method_line(settled));
  remark(options, "built in " + fixed(seconds, 2) + " s, pilot " + fixed(pilot_seconds, 2) + " s");
  warn_if_poor(states);
  if (!t.health.clean()) warn(complaint(t.health));
  return exit_status(options, t.health.clean());
}

}  // namespace gatewalk::cli
