// SPDX-License-Identifier: MIT
#include <algorithm>

#include "cli/command.h"
#include "cli/fields/text.h"
#include "cli/render/stability.h"
#include "dynamics/base/work.h"
#include "dynamics/disc/study/accuracy.h"

namespace gatewalk::cli {

int run_stability(const Arguments& arguments) {
  Options options(
      "stability -o DIR [options]",
      "Maps where each method breaks: step and stiffness, step and damping, restitution and\n"
      "impulse threshold, first contact near a joint, grazing a tip. Writes stability.csv,\n"
      "stability.json and a figure per map. The maps have scenes of their own; for a scene of\n"
      "yours there are gatewalk chart and run.method = \"auto\".",
      "gatewalk stability -o results/stability --quick");
  const std::size_t methods = dynamics::chart_methods().size();
  std::vector<std::string> figures;  // one for each kind
  const auto planned = dynamics::stability_maps(true);
  for (std::size_t i = 0; i < planned.size(); i += methods)
    figures.push_back(figure_name(planned[i]));
  std::vector<std::string> written{"stability.csv", "stability.json"};
  written.insert(written.end(), figures.begin(), figures.end());
  options.output_folder("folder to write to", written);
  const Option quick = options.add_flag("quick", "coarser maps");
  options.add_seed();
  options.add_figure("all maps in one figure");
  options.without_scene("the maps have scenes of their own");
  if (!options.parse(arguments)) return kFine;
  const ResultFolder folder(options, written);

  const StabilityResult result{
      dynamics::run_maps({.quick = static_cast<bool>(quick), .seed = options.seed()},
                         options.work()),
      options.provenance()};
  const auto& maps = result.maps;
  folder.write("stability.csv", csv_of(maps), "stability.json", result);
  for (std::size_t kind = 0; kind < figures.size(); ++kind)
    folder.draw(figures[kind], figure_of(std::span(maps).subspan(kind * methods, methods)));
  options.give_out(result, table_of(maps));
  double slowest = 0.0;
  for (const auto& m : maps)
    slowest = std::max(slowest, *std::max_element(m.seconds.begin(), m.seconds.end()));
  options.remark("the slowest point took " + fixed(slowest, 2) + " s");
  options.draw([&] { return figure_of(maps); });
  return kFine;
}

}  // namespace gatewalk::cli
