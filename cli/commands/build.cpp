#include "cli/arguments.h"
#include "cli/render/choice.h"
#include "cli/render/json.h"
#include "cli/render/matrix.h"
#include "cli/render/states.h"
#include "cli/render/text.h"
#include "dynamics/work.h"

namespace gatewalk::cli {

int run_build(const Arguments& arguments) {
  Options options(
      "build SCENE -o MATRIX.nc [options]",
      "Fills the input-output matrix of one gate: for every input state (--bins says which)\n"
      "N short runs, counted by where they come out. Where the gate has the paper's proportions\n"
      "and Table III's 87 bins resolve what bodies do, those are the states; else they are made\n"
      "from what bodies do in a pilot of the full dynamics from the scene's start, which is a\n"
      "state of its own with more runs.",
      "gatewalk build scenes/field.toml --trials 100 --seed 1 -o matrix.nc");
  options.scene();
  options.add_trials_and_seed("runs per input state");
  options.add_strict();
  options.main_output_file("MATRIX.nc", "matrix file to write (NetCDF-4)",
                           Options::Content::binary);
  add_bins(options);
  if (!options.parse(arguments)) return kFine;
  lattice::Scene scene = options.read_scene();
  const std::int64_t trials = options.trials();
  const lattice::BinsChoice choice = bins_choice(options, scene);
  const auto settled = settle_method(options, scene, lattice::RunsFrom::everywhere);

  const dynamics::Stopwatch pilot_watch;
  const lattice::States states = states_of(options, scene, choice, {scene.start});
  const double pilot_seconds = pilot_watch.seconds();
  const dynamics::Stopwatch watch;
  lattice::MatrixFile file{
      lattice::build_matrix(scene, states, trials, options.seed(), options.work()), {}};
  const double seconds = watch.seconds();
  const dynamics::Transitions& t = file.transitions;
  const std::string path = options.text("output");
  file.text = record_of(t, scene, states, settled, trials, options.provenance(scene));
  lattice::write_matrix(path, file);

  Json json = summary_json(t, states, settled, trials, path);
  json["made_by"] = to_json(options.provenance(scene));
  options.give_out(
      json, summary_table(t, path) + states_line(json["state_space"]) + method_line(settled));
  options.remark("built in " + fixed(seconds, 2) + " s, pilot " + fixed(pilot_seconds, 2) + " s");
  for (const std::string& text : complaints(states)) options.warn(text);
  return status_of(options, t.health);
}

}  // namespace gatewalk::cli
