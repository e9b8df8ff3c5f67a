// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cli/render/landscape.h"
#include "cli/render/panel.h"
#include "cli/render/quantity.h"
#include "cli/render/recording.h"
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
void add_beams(Rows& beams, const Scene& scene, const lattice::FieldGates& gates, const Window& w,
               double metre) {
  const auto& b = scene.gate.beams;  // joints, which all gates have in common
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
        beams.add((middle + side * b.joint_x) / metre, y / metre, -side * beam / metre, 0);
    }
}

}  // namespace

Figure figure_of(const Scene& scene, const Recordings& recordings) {
  std::vector<const Recording*> runs;
  for (const Recording& r : recordings.runs)
    if (runs.size() < kMostDrawn) runs.push_back(&r);
  const Window w = window_of(scene, runs);
  const Sized metre = readable_unit("m", std::max({w.top, w.right, -w.left}));
  Panels out;
  std::vector<const Rows*> ways;
  Rows ends("$ends");
  for (const Recording* run : runs) {
    Rows& way = out.data(fmt::format("$way{}", run->trial));
    const std::size_t stride = run->moments.size() / 4000 + 1;  // no more than can be seen
    for (std::size_t i = 0; i < run->moments.size(); i += stride) {
      const auto [x, y] = place(scene, run->moments[i]);
      way.add(x / metre.size, y / metre.size);
    }
    const auto [x, y] = place(scene, run->moments.back());
    way.add(x / metre.size, y / metre.size);
    ends.add(x / metre.size, y / metre.size, scene.gate.body.radius / metre.size);
    ways.push_back(&way);
  }
  const bool over_landscape = !recordings.across_field;
  const double wide = w.right - w.left, tall = w.top - w.bottom;
  const double room = over_landscape ? 320.0 : 414.0, scale = std::min(room / wide, 560.0 / tall);
  Panel& panel = out.add({78, 78 + scale * wide, 44, 44 + scale * tall});
  const int height = static_cast<int>(panel.box.bottom + (over_landscape ? 84 : 62));
  const std::string title =
      runs.size() == 1 ? fmt::format("trial {}: {}", runs.front()->trial, runs.front()->ending)
                       : fmt::format("{} trials{}", runs.size(),
                                     runs.size() < recordings.runs.size()
                                         ? fmt::format(" of {}", recordings.runs.size())
                                         : "");
  panel.say(title + "; disc: where it ended", 8, 18);
  panel.border = 15;
  panel.x = {fmt::format("x ({})", metre.name), w.left / metre.size, w.right / metre.size,
             digits(tic_step(wide / metre.size, std::max(1.0, panel.box.width() / 70.0)))};
  panel.y = {fmt::format("y ({})", metre.name), w.bottom / metre.size, w.top / metre.size};
  if (over_landscape) {
    const dynamics::Landscape l =
        dynamics::landscape(scene.gate, std::min(0.0, w.bottom), scene.gate.run.traverse_y / 120.0);
    const double highest = ceiling_of(l);
    const Sized joule = readable_unit("J", highest);
    Rows& ground = out.data("$ground");
    add_rows(ground, l, metre, joule, highest);
    panel.colours = {kFree, highest / joule.size, panel.box.beside(14, 12), "",
                     fmt::format("potential energy ({})", joule.name)};
    panel.say(fmt::format("cut at {}; no colour: {}", short_energy(highest, joule), kHole), 8,
              height - 12, kSmallFont);
    panel.draw(ground, "1:2:4", "image pixels");
  }
  for (const Rows* way : ways)
    if (over_landscape)
      panel.draw_outlined(*way, "1:2", "lines", {"#000000", 3}, {"#ffffff", 1.2});
    else
      panel.draw(*way, "1:2", "lines", {kFirstColour, 1.5});
  const Rows& discs = out.data(std::move(ends));
  Rows& beams = out.data("$beams");
  add_beams(beams, scene, recordings.gates, w, metre.size);
  panel.draw(beams, "1:2:3:4", "vectors nohead", {kSecondColour, 2});
  panel.more = "set style fill empty border\n";
  panel.draw(discs, "1:2:3", "circles", {over_landscape ? "#ffffff" : kInk});
  return out.figure(height);
}

}  // namespace gatewalk::cli
