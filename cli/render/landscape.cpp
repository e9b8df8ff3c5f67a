// SPDX-License-Identifier: MIT
#include "cli/render/landscape.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "cli/fields/csv.h"
#include "cli/fields/text.h"
#include "cli/fields/text_table.h"
#include "cli/render/choice.h"
#include "cli/render/gate_runs.h"
#include "cli/render/health.h"
#include "cli/render/panel.h"
#include "cli/render/quantity.h"
#include "dynamics/base/share.h"

namespace gatewalk::cli {

using dynamics::GridPasses;
using dynamics::Landscape;

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

/// "5.1 % [3.9, 6.6] of 1000 simulated runs traverse the gate."
std::string measured_line(const dynamics::GateTally& tally) {
  const auto [from, to] = dynamics::share_interval(tally.traversed(), tally.trials);
  return fmt::format(
      "{} [{}, {}] of {} simulated runs traverse the gate (95 %).\n",
      percent(static_cast<double>(tally.traversed()), static_cast<double>(tally.trials)),
      fixed(100.0 * from, 1), fixed(100.0 * to, 1), tally.trials);
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

namespace {

/// Texts of lengths and energies, rounded to what matters in the gate.
struct GateReadings {
  dynamics::Scale scale;

  explicit GateReadings(const dynamics::GateParams& p) : scale(dynamics::scale_of(p)) {}
  [[nodiscard]] std::string place(double x) const { return reading(x, "m", 0.01 * scale.length); }
  [[nodiscard]] std::string energy(double e) const {
    return reading(e, "J", 0.01 * scale.energy());
  }
};

}  // namespace

std::string answer_text(const LandscapeResult& result, const dynamics::GateParams& p) {
  const dynamics::Passes& passes = result.passes;
  const GridPasses& fine = passes.fine;
  const GateReadings show(p);
  std::string text;
  if (fine.downhill()) {
    text =
        "The easiest way through the gate goes downhill to the far boundary: there is no basin.\n";
  } else {
    const auto& [x, y] = fine.from_basin.way.front();
    text = wrapped(fmt::format(
               "The lowest pass through the gate is at x {}, y {}. It lies {} {} the energy of the "
               "start at rest.",
               show.place(fine.from_basin.x), show.place(fine.from_basin.y),
               show.energy(std::abs(fine.above_start())),
               fine.above_start() < 0.0 ? "below" : "above")) +
           wrapped(fmt::format(
               "A body that comes to rest in the basin on the way, at x {}, y {}, must climb {} to "
               "get out.",
               show.place(x), show.place(y), show.energy(fine.from_basin.barrier())));
  }
  text += wrapped(
      fmt::format("The start has {} of kinetic energy. {}", show.energy(passes.kinetic_energy),
                  fine.above_start() > passes.kinetic_energy
                      ? "This is too little for the pass without work of the random force."
                      : "This would be enough for the pass, but hits and dampers take energy."));
  if (result.measured) text += measured_line(*result.measured);
  return text + fmt::format("From the energy on a grid of {}, Eqs. (14) and (15) of the paper.\n",
                            quantity(fine.spacing, "m"));
}

std::string details_text(const LandscapeResult& result, const dynamics::GateParams& p) {
  TextTable table({{"", -14},
                   {"pass at x", 12},
                   {"y", 10},
                   {"above start", 15},
                   {"above basin", 15},
                   {"basin at x", 12},
                   {"y", 10}});
  const GateReadings show(p);
  for (const GridPasses* grid : {&result.passes.coarse, &result.passes.fine}) {
    const std::string name = "grid " + quantity(grid->spacing, "m");
    if (grid->downhill()) {
      table.row({name, "  no basin on the way: downhill to the far boundary"});
      continue;
    }
    const auto& [x, y] = grid->from_basin.way.front();
    table.row({name, show.place(grid->from_basin.x), show.place(grid->from_basin.y),
               show.energy(grid->above_start()), show.energy(grid->from_basin.barrier()),
               show.place(x), show.place(y)});
  }
  return "\n" + table.text() +
         "Between grid points the pass may lie lower, so the answer uses the finer grid.\n" +
         method_line(result.method);
}

double ceiling_of(const Landscape& l) {
  const auto middle = static_cast<Eigen::Index>(l.x.size() / 2);
  double highest = 0.0;
  for (Eigen::Index i = 0; i < l.total.rows(); ++i)
    if (const double e = l.total(i, middle); std::isfinite(e)) highest = std::max(highest, e);
  return 1.2 * highest;
}

std::string short_energy(double joules, const Sized& unit) {
  return digits(joules / unit.size, 3) + " " + unit.name;
}

void add_rows(Rows& rows, const Landscape& l, const Sized& metre, const Sized& joule,
              double ceiling) {
  const auto energy = [&](double e) {
    return std::isfinite(e) ? digits(std::min(e, ceiling) / joule.size) : "NaN";
  };
  // No more points than can be distinguished.
  const std::size_t stride = std::max<std::size_t>(1, std::max(l.x.size(), l.y.size()) / 200);
  for (std::size_t i = 0; i < l.y.size(); i += stride) {
    for (std::size_t j = 0; j < l.x.size(); j += stride)
      rows.add(l.x[j] / metre.size, l.y[i] / metre.size, energy(l.elastic(i, j)),
               energy(l.total(i, j)));
    rows.gap();
  }
}

namespace {

/// The index of the grid point nearest to x.
Eigen::Index nearest(const std::vector<double>& grid, double x) {
  const double spacing = (grid.back() - grid.front()) / static_cast<double>(grid.size() - 1);
  return std::lround((x - grid.front()) / spacing);
}

/// The y axis. Its title stands closer, by letters, if the numbers are long, as with a step of
/// 0.05.
Axis upright_axis(const std::string& name, double low, double high, double step) {
  constexpr std::size_t kShort = 3;
  const std::string number = digits(step);
  const std::size_t more = std::max(number.size(), kShort) - kShort;
  return {.name = name,
          .low = low,
          .high = high,
          .tics = number,
          .name_look = "offset " + digits(0.8 + static_cast<double>(more)) + ",0"};
}

/// Draws a mark in black and white, visible on every colour of a map.
void draw_mark(Panel& panel, const Rows& place, int mark, double size, double inside) {
  panel.draw_outlined(place, "1:2", "points", {.colour = "#000000", .mark = mark, .size = size},
                      {.colour = "#ffffff", .mark = mark, .size = inside});
}

}  // namespace

Figure figure_of(const dynamics::Passes& passes) {
  const Landscape& l = passes.coarse.landscape;
  const dynamics::GridPasses& fine = passes.fine;
  const dynamics::Pass& pass = fine.downhill() ? fine.from_start : fine.from_basin;
  const double ceiling = ceiling_of(l);
  const double wide = l.x.back() - l.x.front(), deep = l.y.back() - l.y.front();
  const Sized metre = readable_unit("m", std::max(wide, deep)), joule = readable_unit("J", ceiling);
  const double scale = std::min(145.0 / wide, 320.0 / deep);
  constexpr double kBetween = 40;  // for half a number of either map
  const Box first{82, 82 + scale * wide, 36, 36 + scale * deep};
  const Box second{first.right + kBetween, first.right + kBetween + scale * wide, first.top,
                   first.bottom};
  const Box profile{82, 488, first.bottom + 100, first.bottom + 240};
  const int height = static_cast<int>(profile.bottom + 84);

  Panels out;
  Rows &grid = out.data("$grid"), &way = out.data("$way"), &at_pass = out.data("$pass"),
       &at_start = out.data("$start");
  add_rows(grid, l, metre, joule, ceiling);
  // The axis also shows the highest point of the path and the start's energy.
  const double start_energy = fine.from_start.start_energy + passes.kinetic_energy;
  double lowest = start_energy, highest = start_energy, gone = 0.0;
  for (std::size_t i = 0; i < pass.way.size(); ++i) {
    const auto [x, y] = pass.way[i];
    if (i > 0) gone += std::hypot(x - pass.way[i - 1][0], y - pass.way[i - 1][1]);
    const Landscape& on = fine.landscape;
    const double e = on.total(nearest(on.y, y), nearest(on.x, x));
    lowest = std::min(lowest, e);
    highest = std::max(highest, e);
    way.add(x / metre.size, y / metre.size, gone / metre.size, e / joule.size);
  }
  const double margin = highest > lowest ? 0.06 * (highest - lowest) : 0.5 * joule.size;
  at_pass.add(pass.x / metre.size, pass.y / metre.size);
  const auto [start_x, start_y] = fine.from_start.way.front();
  at_start.add(start_x / metre.size, start_y / metre.size);

  const std::string m = " (" + metre.name + ")";
  const double energy_step = tic_step(ceiling / joule.size, 5);
  Panel& beams = out.add(first);
  beams.say("beams, Eq. (14)", first.left, 18);
  beams.x = {"x" + m, l.x.front() / metre.size, l.x.back() / metre.size,
             digits(tic_step(wide / metre.size, 3))};
  beams.y = upright_axis("y" + m, l.y.front() / metre.size, l.y.back() / metre.size,
                         tic_step(deep / metre.size, 5));
  beams.colours = {0, ceiling / joule.size};
  beams.draw(grid, "1:2:3", "image");

  Panel& total = out.add(second);
  total.say("with propulsion, Eq. (15)", second.left, 18);
  total.say("maps: cut at " + short_energy(ceiling, joule) + "; no colour: " + kHole, 8,
            height - 12, kSmallFont);
  total.x = beams.x;
  total.y = {"", beams.y.low, beams.y.high, beams.y.tics};
  total.y.numbers = false;
  total.colours = {0,
                   ceiling / joule.size,
                   second.beside(12, 12),
                   digits(energy_step) + " offset -0.8,0",
                   joule.name,
                   "offset -1.5,0"};
  total.draw(grid, "1:2:4", "image");
  total.draw_outlined(way, "1:2", "lines", {"#000000", 3.5}, {"#ffffff", 1.5});
  draw_mark(total, at_start, 5, 1, 0.6);
  draw_mark(total, at_pass, 7, 1.1, 0.7);

  Panel& along = out.add(profile);
  along.x = {
      std::string("along the lowest way from the ") + (fine.downhill() ? "start" : "basin") + m, 0};
  along.y = upright_axis("energy (" + joule.name + ")", (lowest - margin) / joule.size,
                         (highest + margin) / joule.size, energy_step);
  along.y.format = "%g";
  along.draw(way, "3:4", "lines", {kFirstColour, 2});
  along.draw_level(start_energy / joule.size, {.colour = kInk, .dashes = 2});
  const double key = first.bottom + 58;
  out.add_key(82, key, {entry("points", {.colour = kInk, .mark = 5, .size = 0.8}, "start")});
  out.add_key(160, key, {entry("points", {.colour = kInk, .mark = 7, .size = 0.9}, "pass")});
  out.add_key(246, key, {entry("lines", {.colour = kInk, .dashes = 2}, "energy of the start")});
  return out.figure(height);
}

}  // namespace gatewalk::cli
