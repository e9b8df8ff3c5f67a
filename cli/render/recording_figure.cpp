// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>

#include "cli/render/figure.h"
#include "cli/render/landscape.h"
#include "cli/render/quantity.h"
#include "cli/render/recording.h"
#include "cli/render/text.h"
#include "dynamics/disc/landscape.h"

namespace gatewalk::cli {
namespace {

using lattice::Recording;
using lattice::Recordings;
using lattice::Scene;

/// Where a body is in the whole field, from the middle of the first gate's lower edge (m).
std::array<double, 2> place(const Scene& scene, const lattice::Moment& m) {
  const dynamics::BodyState& b = m.sample.state.body;
  return {b.x + 2.0 * scene.gate.beams.joint_x * m.i_x, b.y + scene.gate.run.traverse_y * m.i_y};
}

struct Window {
  double left, right, bottom, top;  // m
};

/// Whole gates that hold all ways.
Window window_of(const Scene& scene, const std::vector<const Recording*>& runs) {
  const double half = scene.gate.beams.joint_x, deep = scene.gate.run.traverse_y;
  Window w{-half, half, 0.0, deep};
  for (const Recording* run : runs)
    for (const lattice::Moment& m : run->moments) {
      w.left = std::min(w.left, (2 * m.i_x - 1) * half);
      w.right = std::max(w.right, (2 * m.i_x + 1) * half);
      w.top = std::max(w.top, (m.i_y + 1) * deep);
      w.bottom = std::min(w.bottom, place(scene, m)[1] - scene.gate.body.radius);
    }
  return w;
}

/// Beams at rest of every gate in the window: "x y dx dy" from joint to tip.
std::string beams_of(const Scene& scene, const lattice::FieldGates& gates, const Window& w,
                     double metre) {
  const auto& b = scene.gate.beams;  // joints, which all gates have in common
  std::string out;
  const auto columns = std::lround((w.right - w.left) / (2.0 * b.joint_x)),
             rows = std::lround(w.top / scene.gate.run.traverse_y);
  const long first = std::lround(w.left / (2.0 * b.joint_x) + 0.5);  // i_x
  for (long r = 0; r < rows; ++r)
    for (long c = 0; c < columns; ++c) {
      const double beam =
          gates.at(static_cast<int>(first + c) + scene.field.start_column(), static_cast<int>(r))
              .beams.length;
      const double middle = w.left + static_cast<double>(2 * c + 1) * b.joint_x,
                   y = b.joint_y + static_cast<double>(r) * scene.gate.run.traverse_y;
      for (const double side : {-1.0, 1.0})
        out += digits((middle + side * b.joint_x) / metre) + " " + digits(y / metre) + " " +
               digits(-side * beam / metre) + " 0\n";
    }
  return out;
}

}  // namespace

Figure figure_of(const Scene& scene, const Recordings& recordings) {
  std::vector<const Recording*> runs;
  for (const Recording& r : recordings.runs)
    if (runs.size() < kMostDrawn) runs.push_back(&r);
  const Window w = window_of(scene, runs);
  const Sized metre = readable_unit("m", std::max({w.top, w.right, -w.left}));
  const auto length = [&](double x) { return digits(x / metre.size); };
  std::string data, lines, ends;
  for (const Recording* run : runs) {
    std::string way;
    const std::size_t stride = run->moments.size() / 4000 + 1;  // no more than can be seen
    for (std::size_t i = 0; i < run->moments.size(); i += stride) {
      const auto [x, y] = place(scene, run->moments[i]);
      way += length(x) + " " + length(y) + "\n";
    }
    const auto [x, y] = place(scene, run->moments.back());
    way += length(x) + " " + length(y) + "\n";
    data += data_block("$way" + std::to_string(run->trial), way);
    ends += length(x) + " " + length(y) + " " + length(scene.gate.body.radius) + "\n";
  }
  const bool over_landscape = !recordings.across_field;
  const double wide = w.right - w.left, tall = w.top - w.bottom;
  const double room = over_landscape ? 320.0 : 414.0, scale = std::min(room / wide, 560.0 / tall);
  const Box box{78, 78 + scale * wide, 44, 44 + scale * tall};
  const Sheet sheet{static_cast<int>(box.bottom + (over_landscape ? 84 : 62))};
  std::string out, notes, plot = "plot ";
  if (over_landscape) {
    const dynamics::Landscape l =
        dynamics::landscape(scene.gate, std::min(0.0, w.bottom), scene.gate.run.traverse_y / 120.0);
    const double highest = ceiling_of(l);
    const Sized joule = readable_unit("J", highest);
    Rows ground("$ground");
    add_rows(ground, l, metre, joule, highest);
    data += data_block("$ground", ground.text());
    out += std::string(kSequential) + "set cbrange [*:" + digits(highest / joule.size) +
           "]\nset cblabel 'potential energy (" + joule.name +
           ")'\nset colorbox user origin screen " + sheet.at(box.right + 14, box.bottom) +
           " size screen " + digits(12.0 / Sheet::kWidth) + "," +
           digits((box.bottom - box.top) / sheet.height) + "\n";
    notes = sheet.text("cut at " + short_energy(highest, joule) + "; no colour: " + kHole, 8,
                       sheet.height - 12, kSmallFont);
    plot += "$ground using 1:2:4 with image pixels, ";
  }
  for (const Recording* run : runs) {
    const std::string way = "$way" + std::to_string(run->trial) + " using 1:2 with lines ";
    plot += over_landscape ? way + "lw 3 lc rgb '#000000', " + way + "lw 1.2 lc rgb '#ffffff', "
                           : way + "lw 1.5 lc rgb '" + kFirstColour + "', ";
  }
  plot +=
      std::string("$beams using 1:2:3:4 with vectors nohead lw 2 lc rgb '") + kSecondColour + "', ";
  const std::string title =
      runs.size() == 1
          ? "trial " + std::to_string(runs.front()->trial) + ": " + runs.front()->ending
          : std::to_string(runs.size()) + " trials" +
                (runs.size() < recordings.runs.size()
                     ? " of " + std::to_string(recordings.runs.size())
                     : "");
  return {Sheet::kWidth, sheet.height,
          data + data_block("$ends", ends) +
              data_block("$beams", beams_of(scene, recordings.gates, w, metre.size)) + out +
              sheet.margins(box) + sheet.text(title + "; disc: where it ended", 8, 18) + notes +
              kFrame + "set border 15\n" +
              Sheet::axes("'x (" + metre.name + ")'", "'y (" + metre.name + ")'") + "set xrange [" +
              length(w.left) + ":" + length(w.right) + "]\nset yrange [" + length(w.bottom) + ":" +
              length(w.top) + "]\nset xtics " +
              digits(tic_step(wide / metre.size, std::max(1.0, (box.right - box.left) / 70.0))) +
              "\n" + plot + "$ends using 1:2:3 with circles " +
              (over_landscape ? "lc rgb '#ffffff'" : "lt -1") + " fs empty border\n",
          kFont};
}

}  // namespace gatewalk::cli
