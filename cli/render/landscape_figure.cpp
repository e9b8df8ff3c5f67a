// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "cli/render/figure.h"
#include "cli/render/landscape.h"
#include "cli/render/quantity.h"
#include "cli/render/text.h"

namespace gatewalk::cli {

using dynamics::Landscape;

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

std::string rows_of(const Landscape& l, const Sized& metre, const Sized& joule, double ceiling) {
  const auto energy = [&](double e) {
    return std::isfinite(e) ? digits(std::min(e, ceiling) / joule.size) : "NaN";
  };
  // No more points than can be seen.
  const std::size_t stride = std::max<std::size_t>(1, std::max(l.x.size(), l.y.size()) / 200);
  std::string rows;
  for (std::size_t i = 0; i < l.y.size(); i += stride) {
    for (std::size_t j = 0; j < l.x.size(); j += stride)
      rows += digits(l.x[j] / metre.size) + " " + digits(l.y[i] / metre.size) + " " +
              energy(l.elastic(i, j)) + " " + energy(l.total(i, j)) + "\n";
    rows += "\n";
  }
  return rows;
}

namespace {

/// The number of the grid point nearest to x.
Eigen::Index nearest(const std::vector<double>& grid, double x) {
  const double spacing = (grid.back() - grid.front()) / static_cast<double>(grid.size() - 1);
  return std::lround((x - grid.front()) / spacing);
}

/// Of a way over a landscape: "x y distance total".
std::string rows_of(const dynamics::Pass& pass, const Landscape& l, const Sized& metre,
                    const Sized& joule) {
  std::string rows;
  double gone = 0.0;
  for (std::size_t i = 0; i < pass.way.size(); ++i) {
    const auto [x, y] = pass.way[i];
    if (i > 0) gone += std::hypot(x - pass.way[i - 1][0], y - pass.way[i - 1][1]);
    rows += digits(x / metre.size) + " " + digits(y / metre.size) + " " +
            digits(gone / metre.size) + " " +
            digits(l.total(nearest(l.y, y), nearest(l.x, x)) / joule.size) + "\n";
  }
  return rows;
}

/// The y axis has its name nearer, by letters, where its numbers are long, as with a step of 0.05.
std::string named_axes(const std::string& x, const std::string& y, const std::string& step_y) {
  constexpr std::size_t kShort = 3;
  const std::size_t more = std::max(step_y.size(), kShort) - kShort;
  return Sheet::x_axis(x) + "set ylabel " + y + " offset " +
         digits(0.8 + static_cast<double>(more)) + ",0\n";
}

/// Black below white: seen on every colour of a map.
std::string outlined(const std::string& data, const std::string& wide, const std::string& narrow) {
  return ", " + data + " with " + wide + " lc rgb '#000000', " + data + " with " + narrow +
         " lc rgb '#ffffff'";
}

}  // namespace

Figure figure_of(const dynamics::Passes& passes) {
  const Landscape& l = passes.coarse.landscape;
  const dynamics::GridPasses& fine = passes.fine;
  const dynamics::Pass& pass = fine.downhill() ? fine.from_start : fine.from_basin;
  const double ceiling = ceiling_of(l);
  const double wide = l.x.back() - l.x.front(), deep = l.y.back() - l.y.front();
  const Sized metre = readable_unit("m", std::max(wide, deep)), joule = readable_unit("J", ceiling);
  const auto length = [&](double x) { return digits(x / metre.size); };
  const auto energy = [&](double e) { return digits(e / joule.size); };
  const std::string m = " (" + metre.name + ")'";

  const double scale = std::min(145.0 / wide, 320.0 / deep);
  constexpr double kBetween = 40;  // for half a number of either map
  const Box first{82, 82 + scale * wide, 36, 36 + scale * deep};
  const Box second{first.right + kBetween, first.right + kBetween + scale * wide, first.top,
                   first.bottom};
  const Box profile{82, 488, first.bottom + 100, first.bottom + 240};
  const Sheet sheet{static_cast<int>(profile.bottom + 84)};
  // Both what the way rises to and the start's energy, off the axis.
  const double at_start_energy = fine.from_start.start_energy + passes.kinetic_energy;
  double lowest = at_start_energy, highest = at_start_energy;
  for (const auto& [way_x, way_y] : pass.way) {
    const Landscape& on = fine.landscape;
    const double e = on.total(nearest(on.y, way_y), nearest(on.x, way_x));
    lowest = std::min(lowest, e);
    highest = std::max(highest, e);
  }
  const double margin = highest > lowest ? 0.06 * (highest - lowest) : 0.5 * joule.size;
  const auto [x, y] = fine.from_start.way.front();
  const std::string step_y = digits(tic_step(deep / metre.size, 5)),
                    step_energy = digits(tic_step(ceiling / joule.size, 5));
  const std::string at_pass = data_block("$pass", length(pass.x) + " " + length(pass.y) + "\n"),
                    at_start = data_block("$start", length(x) + " " + length(y) + "\n");
  return {
      Sheet::kWidth, sheet.height,
      std::string(kSequential) + data_block("$grid", rows_of(l, metre, joule, ceiling)) +
          data_block("$way", rows_of(pass, fine.landscape, metre, joule)) + at_pass + at_start +
          "set multiplot\n" + kFrame + "set xrange [" + length(l.x.front()) + ":" +
          length(l.x.back()) + "]\nset yrange [" + length(l.y.front()) + ":" + length(l.y.back()) +
          "]\nset cbrange [0:" + energy(ceiling) + "]\nunset colorbox\nset xtics " +
          digits(tic_step(wide / metre.size, 3)) + "\nset ytics " + step_y + "\n" +
          named_axes("'x" + m, "'y" + m, step_y) + sheet.margins(first) +
          sheet.text("beams, Eq. (14)", first.left, 18) +
          "plot $grid using 1:2:3 with image\nunset label\n" + sheet.margins(second) +
          "unset ylabel\nset format y ''\nset cblabel '" + joule.name +
          "' offset -1.5,0\nset cbtics " + step_energy +
          " offset -0.8,0\nset colorbox user origin screen " +
          sheet.at(second.right + 12, second.bottom) + " size screen " +
          digits(12.0 / Sheet::kWidth) + "," + digits((second.bottom - second.top) / sheet.height) +
          "\n" + sheet.text("with propulsion, Eq. (15)", second.left, 18) +
          sheet.text("maps: cut at " + short_energy(ceiling, joule) + "; no colour: " + kHole, 8,
                     sheet.height - 12, kSmallFont) +
          "plot $grid using 1:2:4 with image" +
          outlined("$way using 1:2", "lines lw 3.5", "lines lw 1.5") +
          outlined("$start using 1:2", "points pt 5 ps 1", "points pt 5 ps 0.6") +
          outlined("$pass using 1:2", "points pt 7 ps 1.1", "points pt 7 ps 0.7") +
          "\nunset label\n" + sheet.margins(profile) +
          "set format y '%g'\nset xrange [0:*]\nset xtics autofreq\nset yrange [" +
          energy(lowest - margin) + ":" + energy(highest + margin) + "]\nset ytics " + step_energy +
          "\n" +
          named_axes(std::string("'along the lowest way from the ") +
                         (fine.downhill() ? "start" : "basin") + m,
                     "'energy (" + joule.name + ")'", step_energy) +
          "set key off\nplot $way using 3:4 with lines lw 2 lc rgb '" + kFirstColour + "', " +
          energy(at_start_energy) + " with lines lt -1 dt 2\n" +
          sheet.key(82, first.bottom + 58, {"with points pt 5 ps 0.8 lt -1 title 'start'"}) +
          sheet.key(160, first.bottom + 58, {"with points pt 7 ps 0.9 lt -1 title 'pass'"}) +
          sheet.key(246, first.bottom + 58, {"with lines lt -1 dt 2 title 'energy of the start'"}) +
          "unset multiplot\n",
      kFont};
}

}  // namespace gatewalk::cli
