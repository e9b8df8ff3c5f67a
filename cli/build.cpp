#include "cli/auto.h"
#include "cli/command.h"
#include "cli/matrix.h"
#include "cli/report.h"
#include "cli/version.h"

namespace gatewalk::cli {

int run_build(const std::vector<std::string>& arguments) {
  Options options("build SCENE -o MATRIX.nc [options]",
                  "Fills the input-output matrix of one gate: for every input state (the 87 of\n"
                  "Table III, or more with --bins) N short runs, counted by where they come out.",
                  "gatewalk build scenes/field.toml --trials 100 --seed 1 -o matrix.nc");
  options.positional("scene", "scene file (TOML)", true);
  add_trials_and_seed(options, "runs per input state");
  add_strict(options);
  options.main_output_file("MATRIX.nc", "matrix file to write (NetCDF-4)", Options::Content::binary);
  options.add()("bins", po::value<double>()->default_value(1.0, "1")->value_name("FACTOR"),
                "bins per axis, as a multiple of Table III's: 2 makes 696 states, 0.5 makes 23");
  if (!options.parse(arguments)) return kFine;
  Scene scene = read_scene(options.text("scene"), options.overrides());
  const std::int64_t trials = options.count("trials");
  const Json settled = settle_method(options, scene, RunsFrom::everywhere);

  const double bins = options.get<double>("bins");
  const Stopwatch watch;
  lattice::MatrixFile file{build_matrix(scene, bins, trials, options.seed(), options.talk()), {}};
  const double seconds = watch.seconds();
  const dynamics::Transitions& t = file.transitions;
  file.text = {{"title", "gatewalk input-output matrix of one gate, Eq. (16), as counts"},
               {"scene", to_toml(scene)},
               {"seed", std::to_string(options.seed())},
               {"trials_per_row", std::to_string(trials)},
               {"bins", Json(bins).dump()},  // the shortest digits that read back the same
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
  if (!settled.is_null()) json["method"] = settled;
  json["status"] = to_json(t.health);
  json["made_by"] = manifest(options, scene);
  const std::string table =
      options.text("output") + ": " + std::to_string(t.space.size()) + " x " +
      std::to_string(t.space.size() + 1) + " matrix, " + std::to_string(total.runs) + " gate runs, " +
      std::to_string(total.nonzeros) + " nonzeros, " +
      percent(total.clamped_share(), 1.0) +
      " of the crossings clamped into the nearest bin\n";
  options.give_out(json, table + method_line(settled));
  remark(options, "built in " + fixed(seconds, 2) + " s");
  if (!t.health.clean()) warn(complaint(t.health));
  return exit_status(options, t.health.clean());
}

}  // namespace gatewalk::cli
