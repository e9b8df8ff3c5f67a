// SPDX-License-Identifier: MIT
#include <algorithm>
#include <filesystem>

#include "cli/command.h"
#include "cli/fields/text.h"
#include "cli/render/limits.h"
#include "lattice/scene/scene.h"
#include "lattice/scene/settle.h"

namespace gatewalk::cli {
int run_chart_limits(const Arguments& arguments) {
  Options options("chart limits SCENE -o DIR [options]",
                  "Shows where each time-stepping method breaks near the numbers of a scene, how "
                  "you recognise it,\n"
                  "and what helps. chart limits maps a method's step against one number of the "
                  "scene at a time:\n"
                  "stiffness and damping of the beams, their mass, random force, speed of the "
                  "start, restitution,\n"
                  "impulse threshold, first contact near a joint, grazing a tip. Each point "
                  "simulates the gate from\n"
                  "the scene's start with every method, with the noise of a reference. The command "
                  "writes limits.csv,\n"
                  "limits.json and a figure for each number.",
                  "gatewalk chart limits scenes/walker.toml -o limits --quick");
  options.scene();
  std::vector<std::string> files{"limits.csv", "limits.json"};
  for (const auto& info : dynamics::limit_numbers()) files.push_back(figure_name(info.number));
  options.output_folder("folder to write to, made if missing", files);
  const Option quick = options.add_flag("quick", "coarser maps");
  const CountOption trials =
      options.add_count("trials", "N", "trials at each point (default: 100, with --quick 40)");
  options.add_seed();
  options.add_figure("all maps in one figure");
  options.add_details("the distance of each method from the faults of every number");
  options.most_used({"output", "quick", "trials", "set", "figure"});
  if (!options.parse(arguments)) return kFine;
  const lattice::Scene scene = options.read_scene();
  LimitsResult result{.label = std::filesystem::path(options.scene_file.value()).stem().string(),
                      .other_types = {},
                      .scene = {scene.gate,
                                scene.start,
                                {.quick = static_cast<bool>(quick),
                                 .trials = trials  ? trials.value(1, 100'000)
                                           : quick ? 40
                                                   : 100,
                                 .own_step = scene.named.contains("run.step_s"),
                                 .seed = options.seed()}},
                      .maps = {},
                      .limits = {},
                      .made_by = options.provenance(scene)};
  options.warn(lattice::terrain_without_effect(scene));
  if (scene.terrain)
    for (const auto& type : scene.terrain->types) result.other_types.push_back(type.name);
  const ResultFolder folder(options, files);

  result.maps =
      dynamics::run_maps(result.scene, dynamics::limit_maps(result.scene), options.work());
  result.limits = dynamics::limits_of(result.scene, result.maps);
  const auto& maps = result.maps;
  folder.write("limits.csv", csv_of(maps), "limits.json", result);
  for (std::size_t first = 0; first < maps.size(); first += result.limits.size())
    folder.draw(figure_name(maps[first].map.number),
                figure_of(result.scene, std::span(maps).subspan(first, result.limits.size())));
  options.give_out(result, {answer_text(result), details_text(result)});
  double slowest = 0.0;
  for (const auto& m : maps)
    slowest = std::max(slowest, *std::max_element(m.seconds.begin(), m.seconds.end()));
  options.remark("the slowest point took " + fixed(slowest, 2) + " s");
  options.draw([&] { return figure_of(result.scene, maps); });
  return kFine;
}

}  // namespace gatewalk::cli
