// SPDX-License-Identifier: MIT
#include "cli/render/landscape.h"

#include <fmt/core.h>

#include "cli/render/choice.h"
#include "cli/render/csv.h"
#include "cli/render/gate_runs.h"
#include "cli/render/health.h"
#include "cli/render/quantity.h"
#include "cli/render/text.h"
#include "cli/render/text_table.h"
#include "dynamics/base/share.h"

namespace gatewalk::cli {

using dynamics::GridPasses;

namespace {

void describe(Fields& out, const Label& l, const dynamics::Pass& pass) {
  out.object(l, [&](Fields& f) {
    f.number({"x_m", "m", "x of the pass, the highest point of the path"}, pass.x);
    f.number({"y_m", "m", "y of the pass, the highest point of the path"}, pass.y);
    f.number({"energy_J", "J", "potential energy at the pass"}, pass.energy);
    f.number({"begins_at_J", "J", "potential energy where the path begins"}, pass.start_energy);
    f.number({"barrier_J", "J", "energy_J minus begins_at_J"}, pass.barrier());
    f.points({"way_m", "m", "the path: x and y of each of its grid points"}, pass.way);
  });
}

void describe(Fields& out, const GridPasses& grid) {
  out.number({"grid_m", "m", "largest distance between neighbouring grid points"}, grid.spacing);
  describe(
      out,
      {"from_start",
       "of all paths from the start to the far boundary, the one whose highest point is lowest"},
      grid.from_start);
  describe(out,
           {"from_basin",
            "of all paths from the basin below the start to the far boundary, the one whose "
            "highest point is lowest"},
           grid.from_basin);
  const std::vector<std::array<double, 2>>& way = grid.from_basin.way;
  const auto basin = way.empty() ? std::array<double, 2>{} : way.front();
  out.numbers(
      {"basin_m", "m",
       "x and y of the basin below the start; without a basin on the way, of the far boundary"},
      {basin[0], basin[1]});
  out.number({"above_start_J", "J", "from_basin.energy_J minus from_start.begins_at_J"},
             grid.above_start());
}

const char* beams_word(dynamics::BeamsThatPush beams) {
  if (beams == dynamics::kBothBeams) return "both";
  return beams[dynamics::kLeft] ? "left" : "right";
}

/// "measured: 5.1 % of 1000 trials traverse, 95 % [3.9, 6.6]"
std::string measured_line(const dynamics::GateTally& tally) {
  const auto [from, to] = dynamics::share_interval(tally.traversed(), tally.trials);
  return fmt::format(
      "measured: {} of {} trials traverse, 95 % [{}, {}]\n",
      percent(static_cast<double>(tally.traversed()), static_cast<double>(tally.trials)),
      tally.trials, fixed(100.0 * from, 1), fixed(100.0 * to, 1));
}

}  // namespace

void describe(Fields& out, const LandscapeResult& result) {
  const dynamics::Passes& passes = result.passes;
  out.number({"spacing_m", "m", "largest distance between neighbouring points of the coarse grid"},
             passes.coarse.spacing);
  out.text(Label("beams", "beams that resist the body").one_of({"both", "left", "right"}),
           beams_word(passes.beams));
  out.number({"start_kinetic_energy_J", "J", "kinetic energy of the body at the start"},
             passes.kinetic_energy);
  out.list({"passes", "lowest passes through the gate, on the coarse grid and on the fine grid"},
           std::vector{&passes.coarse, &passes.fine},
           [](Fields& f, const GridPasses* grid) { describe(f, *grid); });
  out.if_any({"measured", "simulated runs of the gate, by outcome"}, result.measured,
             [&](Fields& runs, const auto& value) {
               const dynamics::GateTally tally = value;
               describe(runs, tally);
               describe_method(runs, result.method);
               describe_status(runs, tally.health);
             });
  describe_made_by(out, result.made_by);
}

std::string csv_of(const dynamics::Landscape& l) {
  Csv csv("x_m,y_m,elastic_J,total_J");
  for (std::size_t i = 0; i < l.y.size(); ++i)
    for (std::size_t j = 0; j < l.x.size(); ++j)
      csv.row(l.x[j], l.y[i], l.elastic(i, j), l.total(i, j));
  return csv.text();
}

std::string table_of(const LandscapeResult& result, const dynamics::GateParams& p) {
  const dynamics::Passes& passes = result.passes;
  TextTable table({{"", -22},
                   {"pass at x", 13},
                   {"y", 12},
                   {"above the start", 18},
                   {"above the basin", 18},
                   {"basin at x", 13},
                   {"y", 12}});
  const dynamics::Scale scale = dynamics::scale_of(p);
  const auto place = [&](double x) { return reading(x, "m", 0.01 * scale.length); };
  const auto energy = [&](double e) { return reading(e, "J", 0.01 * scale.energy()); };
  for (const GridPasses* grid : {&passes.coarse, &passes.fine}) {
    const std::string name = "grid " + quantity(grid->spacing, "m");
    if (grid->downhill()) {
      table.row({name, "  no basin on the way: downhill to the far boundary"});
      continue;
    }
    const auto& [x, y] = grid->from_basin.way.front();
    table.row({name, place(grid->from_basin.x), place(grid->from_basin.y),
               energy(grid->above_start()), energy(grid->from_basin.barrier()), place(x),
               place(y)});
  }
  return fmt::format(
      "{}Between grid points the pass may lie lower: hence the finer grid.\nThe start has {} of "
      "kinetic energy: {}.\n{}",
      table.text(), energy(passes.kinetic_energy),
      passes.fine.above_start() > passes.kinetic_energy
          ? "too little for the pass without work of the random force"
          : "as energies go enough, but hits and dampers take theirs: a body that comes to rest in "
            "a basin must climb out of it",
      result.measured ? measured_line(*result.measured) : "");
}

}  // namespace gatewalk::cli
