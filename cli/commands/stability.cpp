#include <algorithm>
#include <filesystem>

#include "cli/command.h"
#include "cli/render/report.h"
#include "cli/render/stability.h"
#include "cli/terminal/output.h"
#include "cli/version.h"
#include "dynamics/study/accuracy.h"

namespace gatewalk::cli {

int run_stability(const std::vector<std::string>& arguments) {
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
  options.add()("quick", "coarser maps");
  add_seed(options);
  options.without_scene("the maps have scenes of their own");
  if (!options.parse(arguments)) return kFine;
  const std::string folder = options.text("output");
  const auto file = [&](const std::string& name) {
    return (std::filesystem::path(folder) / name).string();
  };
  require_folder(folder);

  const auto maps =
      dynamics::run_maps({.quick = options.has("quick"), .seed = options.seed()}, options.work());

  Json json = to_json(maps);
  json["made_by"] = {{"program", "gatewalk"},
                     {"version", kVersion},
                     {"commit", kCommit},
                     {"command", options.canonical()},
                     {"seed", options.seed()}};
  // Old figures shall not stand beside new numbers.
  for (const std::string& figure : figures) std::filesystem::remove(file(figure));
  write_text_atomically(file("stability.csv"), csv_of(maps));
  write_text_atomically(file("stability.json"), text_of(json) + "\n");
  for (std::size_t kind = 0; kind < figures.size(); ++kind)
    draw(file(figures[kind]), std::span(maps).subspan(kind * methods, methods));
  options.give_out(json, table_of(maps));
  double slowest = 0.0;
  for (const auto& m : maps)
    slowest = std::max(slowest, *std::max_element(m.seconds.begin(), m.seconds.end()));
  remark(options, "the slowest point took " + fixed(slowest, 2) + " s");
  return kFine;
}

}  // namespace gatewalk::cli
