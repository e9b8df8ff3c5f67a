#include "cli/arguments.h"
#include "cli/render/analysis.h"
#include "cli/render/exits.h"
#include "cli/render/field_figure.h"
#include "cli/render/field_netcdf.h"
#include "cli/render/field_runs.h"
#include "cli/render/json.h"
#include "cli/render/scene.h"
#include "cli/render/text.h"
#include "cli/terminal/output.h"
#include "lattice/scene/scene_trials.h"

namespace gatewalk::cli {

int run_lattice(const Arguments& arguments) {
  Options options(
      "lattice SCENE [options]",
      "Runs the full dynamics through the field, gate by gate, and counts the final gates.",
      "gatewalk lattice scenes/field.toml --trials 10000 --seed 1 --json lattice.json");
  options.scene();
  options.add_trials_and_seed("trials through the field");
  options.add_strict();
  options.output_file("netcdf", "FILE.nc", kNetcdfHelp, Options::Content::binary);
  options.add_figure("where bodies end, and how");
  if (!options.parse(arguments)) return kFine;
  lattice::Scene scene = options.read_scene();
  const std::int64_t trials = options.trials();
  const auto settled = settle_method(options, scene, lattice::RunsFrom::everywhere);

  const dynamics::Stopwatch watch;
  lattice::FieldCosts costs(lattice::bin_of_durations(scene.gate));
  lattice::ExitCounts counts(scene.field);
  const auto tally =
      lattice::field_trials(scene, trials, options.seed(), options.work(), &costs, &counts);
  const lattice::FieldExits exits = lattice::exits_of(counts);

  Json json = to_json(tally, scene, settled);
  json["exits"] = to_json(exits, scene);
  json["costs"] = to_json(costs, scene.gate);
  json["made_by"] = to_json(options.provenance(scene));
  if (options.has("netcdf"))
    options.write(
        options.text("netcdf"),
        netcdf_of({{FieldPicture("", tally, exits), lattice::own_start(scene)}}, json["made_by"]));
  options.give_out(
      json, table_of(tally, scene, settled) + table_of(exits, scene) + table_of(costs, scene.gate));
  options.remark(fixed(watch.seconds(), 2) + " s");
  options.warn(too_few_gates(scene));
  const int exit = status_of(options, tally.health);
  options.draw([&] {
    return figure_of({{"full dynamics, " + std::to_string(trials) + " trials", tally, exits}},
                     scene);
  });
  return exit;
}

}  // namespace gatewalk::cli
