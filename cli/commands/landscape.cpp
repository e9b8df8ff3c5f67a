// SPDX-License-Identifier: MIT
#include "cli/render/landscape.h"

#include "cli/arguments.h"
#include "cli/fields/text.h"
#include "cli/next.h"
#include "cli/render/health.h"
#include "cli/render/scene.h"
#include "dynamics/base/kept_pieces.h"
#include "dynamics/disc/study/accuracy.h"

namespace gatewalk::cli {
namespace {

dynamics::BeamsThatPush beams_of(const std::string& name) {
  if (name != "both" && name != "left" && name != "right")
    throw UsageError("--beam " + name + ": must be both, left or right");
  return {name != "right", name != "left"};
}

double spacing_for(const NumberOption& given, const lattice::Scene& scene) {
  const auto [least, usual, most] = dynamics::spacings_for(scene.gate, scene.start);
  const double spacing = given ? given.value() : usual;
  if (!(spacing >= least && spacing <= most))
    throw UsageError("--spacing " + digits(spacing) + ": must lie in [" + digits(least) + ", " +
                     digits(most) + "] m");
  return spacing;
}

std::vector<std::string> next_of(const Options& options, std::int64_t trials) {
  NextCommands next(options);
  if (trials > 0) return next.add("gate", "--trials 1000", "simulates the gate alone").lines();
  return next.again("trials", "1000", "compares with simulated runs").lines();
}

}  // namespace

int run_landscape(const Arguments& arguments) {
  Options options("landscape SCENE -o DIR [options]",
                  "Finds how high the energy barrier of one gate is, and where a body can get "
                  "stuck before it.\n"
                  "landscape computes the potential energy of body and beams over the gate, Eqs. "
                  "(14) and (15) of the\n"
                  "paper, with beams deflected forward. It finds the path whose highest point is "
                  "lowest, and compares\n"
                  "this pass with the energy of the start and of the basin on the way. It writes "
                  "landscape.csv,\n"
                  "landscape.json and landscape.svg.",
                  "gatewalk landscape scenes/single_gate.toml -o landscape --trials 1000");
  options.scene();
  const std::vector<std::string> files{"landscape.csv", "landscape.json", "landscape.svg"};
  options.output_folder("folder to write to", files);
  const NumberOption spacing = options.add_number(
      "spacing", "M",
      "spacing of the grid, in m (default: a twentieth of body.radius_m, as in the paper)");
  const TextOption beam = options.add_text(
      "beam", "WHICH", "beams that resist: both, left or right (the other swings free: Fig. 6C)",
      "both");
  const CountOption trials_given =
      options.add_count("trials", "N", "also simulate N runs through the gate, to compare", "0");
  options.add_seed();
  options.add_strict();
  options.add_figure("the figure of the folder");
  options.add_details("the passes of both grids, and the numbers of the scene");
  options.most_used({"output", "trials", "beam", "set", "figure"});
  if (!options.parse(arguments)) return kFine;
  const auto beams = beams_of(beam.value());
  const std::int64_t trials = trials_given.value(0);
  lattice::Scene scene = options.read_scene();
  const double distance = spacing_for(spacing, scene);
  const ResultFolder folder(options, files);
  if (trials == 0) options.warn(lattice::terrain_without_effect(scene));

  LandscapeResult result{.passes = dynamics::passes(scene.gate, scene.start, distance, beams)};
  const std::string line = scene_line(scene);
  if (trials > 0) {
    result.method = settle_method(options, scene, lattice::RunsFrom::start);
    result.measured = dynamics::run_checked_trials(scene.gate, scene.start, options.seed(),
                                                   {"gate runs", {0, trials}}, options.work());
  }
  result.made_by = options.provenance(scene);
  folder.write("landscape.csv", csv_of(result.passes.coarse.landscape), "landscape.json", result);
  folder.draw("landscape.svg", figure_of(result.passes));
  const dynamics::Health health = result.measured ? result.measured->health : dynamics::Health();
  options.give_out(result, {answer_text(result, scene.gate) + beware_of(health),
                            details_text(result, scene.gate) + line, next_of(options, trials)});
  const int exit = status_of(options, health);
  options.draw([&] { return figure_of(result.passes); });
  return exit;
}

}  // namespace gatewalk::cli
