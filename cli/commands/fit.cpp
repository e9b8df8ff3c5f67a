// SPDX-License-Identifier: MIT
#include "cli/render/fit.h"

#include <fmt/core.h>

#include "cli/arguments.h"
#include "cli/choosing.h"
#include "cli/fitted.h"
#include "cli/ranged.h"

namespace gatewalk::cli {
namespace {

constexpr int kMostScenes = 1000;

std::vector<double> point_of(const Eigen::MatrixXd& draws, Eigen::Index draw) {
  return {draws.row(draw).begin(), draws.row(draw).end()};
}

}  // namespace

int run_fit(const Arguments& arguments) {
  Options options(
      "fit SCENE SEEN.csv [MORE.csv ...] --free KEY=LOW:HIGH [options]",
      "Which numbers of the scene an experiment speaks for: their posterior, all of them anywhere "
      "in their\n"
      "ranges alike before. The chances of final gates and endings come from full trials at points "
      "of the\n"
      "ranges, more and more of them where the counts are likely. Counts: as of validate "
      "--observed, of one start;\n"
      "lines of trials may have time_s, when a body left the field. Of recorded passages "
      "(runs.csv) each is\n"
      "carried out from where it began. Cells of a program: its numbers, parameters.KEY.",
      "gatewalk fit scenes/field.toml counts.csv --free forces.propulsion_N=5:9 --free "
      "forces.random_N=10:40");
  options.scene();
  options.positional_list(
      "counts",
      "what the experiment saw (CSV: gate_x,gate_y,count; ending,count; or, for both, "
      "trial,ending,gate_x,gate_y; also with time_s; files with the same columns are added up; or "
      "passages: runs.csv)");
  options.add_texts(
      "free", "KEY=LOW:HIGH",
      fmt::format(
          "a number of the scene, or of the program, and its range (at most {}; may be repeated)",
          lattice::kMostFitted));
  options.add_count(
      "trials", "N",
      fmt::format("full trials, or passages, all points together; {} or more for each number",
                  lattice::least_trials_of_fit(1)),
      "400000");
  options.add_texts("start", "D,VX,VY", "where bodies started (default: the scene's start)");
  options.add_seed();
  add_cell_program(options);
  options.output_file(
      "output", "FILE.toml",
      "write the scene in which the counts are likeliest, with --scenes others too");
  options.add_count(
      "scenes", "N",
      "with -o FILE.toml, write N scenes drawn from the posterior as FILE-1.toml, ...");
  options.output_file("draws", "FILE.csv", "write the posterior, a line for each draw");
  options.output_file("inference-data", "FILE.nc", "write it as ArviZ reads it (InferenceData)",
                      Options::Content::binary);
  options.add_kept();
  options.add_strict();
  options.add_figure("the posterior of each number and of each pair");
  if (!options.parse(arguments)) return kFine;
  Subject s = field_to_run(options, "what was seen is");
  const auto ranged = ranges_of(options, s, "free", lattice::kMostFitted);
  if (!ranged) throw UsageError("--free KEY=LOW:HIGH says which numbers are to be found: give one");
  const auto numbers = static_cast<int>(ranged->ranges.size());
  const std::vector<std::string> seen = options.texts("counts");
  if (!ranged->scene && options.has("output"))
    throw UsageError("-o: writes scenes of gates; a program's numbers are given by --set");
  const lattice::FitOptions how{
      .trials = options.count("trials", lattice::least_trials_of_fit(numbers)),
      .seed = options.seed()};
  if (options.has("scenes") && !options.has("output"))
    throw UsageError("--scenes: needs -o FILE.toml, beside which they are written");
  std::vector<std::string> scenes;
  if (options.has("scenes"))
    scenes = files_of_draws(options, options.count("scenes", 1, kMostScenes));
  const lattice::ProblemAt at = problem_at(*ranged, s, types_in(seen));
  const lattice::FitData data = data_to_fit(options, s, *ranged, at, seen, how.trials);
  s.settle(options);
  const FittedScene fitted{ranged->ranges, s.problem.field, s.settled,
                           lattice::fit(numbers, at, data, how, options.work()),
                           s.provenance(options)};
  const lattice::Fit& fit = fitted.fit;
  options.give_out(fitted, table_of(fitted));
  if (options.has("draws")) options.write(options.text("draws"), draws_csv(fitted));
  if (options.has("inference-data"))
    options.write(options.text("inference-data"), inference_data(fitted));
  if (const std::string path = options.text("output"); !path.empty()) {
    options.write(path, lattice::scene_file(scene_at(*ranged, s, point_of(fit.draws, fit.best))));
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      const auto draw =
          (2 * static_cast<Eigen::Index>(i) + 1) * fit.draws.rows() / (2 * std::ssize(scenes));
      options.write(scenes[i],
                    lattice::scene_file(scene_at(*ranged, s, point_of(fit.draws, draw))));
    }
  }
  for (const std::string& warning : warnings_of(fitted)) options.warn(warning);
  (void)status_of(options, fit.health);
  options.draw([&] { return figure_of(fitted); });
  return exit_status(options, is_clean(fitted));
}

}  // namespace gatewalk::cli
