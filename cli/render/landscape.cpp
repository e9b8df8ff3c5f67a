// SPDX-License-Identifier: MIT
#include "cli/render/landscape.h"

#include "cli/render/csv.h"
#include "cli/render/json.h"
#include "cli/render/quantity.h"
#include "cli/render/text.h"
#include "dynamics/base/share.h"

namespace gatewalk::cli {

using dynamics::GridPasses;

namespace {

Json to_json(const dynamics::Pass& pass) {
  return {{"x_m", pass.x},
          {"y_m", pass.y},
          {"energy_J", pass.energy},
          {"begins_at_J", pass.start_energy},
          {"barrier_J", pass.barrier()},
          {"way_m", pass.way}};
}

const char* beams_word(dynamics::BeamsThatPush beams) {
  if (beams == dynamics::kBothBeams) return "both";
  return beams[dynamics::kLeft] ? "left" : "right";
}

}  // namespace

Json to_json(const dynamics::Passes& passes) {
  Json json;
  json["spacing_m"] = passes.coarse.spacing;
  json["beams"] = beams_word(passes.beams);
  json["start_kinetic_energy_J"] = passes.kinetic_energy;
  json["passes"] = Json::array();
  for (const GridPasses* grid : {&passes.coarse, &passes.fine})
    json["passes"].push_back({{"grid_m", grid->spacing},
                              {"from_start", to_json(grid->from_start)},
                              {"from_basin", to_json(grid->from_basin)},
                              {"basin_m", grid->from_basin.way.front()},
                              {"above_start_J", grid->above_start()}});
  return json;
}

std::string csv_of(const dynamics::Landscape& l) {
  Csv csv("x_m,y_m,elastic_J,total_J");
  for (std::size_t i = 0; i < l.y.size(); ++i)
    for (std::size_t j = 0; j < l.x.size(); ++j)
      csv.row(l.x[j], l.y[i], l.elastic(i, j), l.total(i, j));
  return csv.text();
}

std::string table_of(const dynamics::Passes& passes, const dynamics::GateParams& p) {
  std::string table =
      padded("", -22) +
      "    pass at x           y   above the start   above the basin   basin at x           y\n";
  const dynamics::Scale scale = dynamics::scale_of(p);
  const auto place = [&](double x) { return reading(x, "m", 0.01 * scale.length); };
  const auto energy = [&](double e) { return reading(e, "J", 0.01 * scale.energy()); };
  for (const GridPasses* grid : {&passes.coarse, &passes.fine}) {
    table += padded("grid " + quantity(grid->spacing, "m"), -22);
    if (grid->downhill()) {
      table += "  no basin on the way: downhill to the far boundary\n";
      continue;
    }
    const auto& [x, y] = grid->from_basin.way.front();
    table += padded(place(grid->from_basin.x), 13) + padded(place(grid->from_basin.y), 12) +
             padded(energy(grid->above_start()), 18) +
             padded(energy(grid->from_basin.barrier()), 18) + padded(place(x), 13) +
             padded(place(y), 12) + "\n";
  }
  return table +
         "Between grid points the pass may lie lower: hence the finer grid.\nThe start has " +
         energy(passes.kinetic_energy) + " of kinetic energy: " +
         (passes.fine.above_start() > passes.kinetic_energy
              ? "too little for the pass without work of the random force.\n"
              : "as energies go enough, but hits and dampers take theirs: a body that comes to "
                "rest in a basin must climb out of it.\n");
}

std::string measured_line(const dynamics::GateTally& tally) {
  const auto [from, to] = dynamics::share_interval(tally.traversed(), tally.trials);
  return "measured: " +
         percent(static_cast<double>(tally.traversed()), static_cast<double>(tally.trials)) +
         " of " + std::to_string(tally.trials) + " trials traverse, 95 % [" +
         fixed(100.0 * from, 1) + ", " + fixed(100.0 * to, 1) + "]\n";
}

}  // namespace gatewalk::cli
