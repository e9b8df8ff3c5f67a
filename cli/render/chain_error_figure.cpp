// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "cli/render/chain_error.h"
#include "cli/render/panel.h"

namespace gatewalk::cli {
namespace {

using lattice::ChainErrorChart;

/// How curves look. Bins finer and coarser than the usual ones are thin.
struct CurveLook {
  const char* with;
  Pen pen;
};
constexpr CurveLook kDirect{"lines", {kInk, 1.5}},
    kNoise{"lines", {.colour = kInk, .width = 0.8, .dashes = 3}}, kOthers{"lines", {kInk, 0.4}},
    kUniform{"linespoints", {kSecondColour, 1.5, 5, 0.5}},
    kVisited{"linespoints", {kFourthColour, 1.5, 13, 0.6}},
    kTree{"linespoints", {kFirstColour, 1.5, 7, 0.6}};

/// Bins nearest to the usual ones.
bool is_usual(const ChainErrorChart& chart, const lattice::ChainCurve& curve) {
  const auto off = [](const lattice::ChainCurve& c) { return std::abs(std::log(c.factor)); };
  return std::none_of(chart.curves.begin(), chart.curves.end(), [&](const auto& other) {
    return !other.trials.empty() && off(other) < off(curve);
  });
}

/// What the axes must show: places of errors and seconds above zero.
struct Extent {
  double low = HUGE_VAL, high = 0.0;

  void see(double x) {
    if (x > 0.0) low = std::min(low, x);
    high = std::max(high, x);
  }
};

/// Total variation over seconds, for one start; the truth's noise as a level.
void draw_curves(Panels& out, Panel& panel, const ChainErrorChart& chart, std::size_t s,
                 Extent& seconds, Extent& errors) {
  const std::string of = fmt::format("_{}", s);
  const double noise = chart.truths[s].floor.total_variation;
  errors.see(noise);
  panel.draw_level(noise, kNoise.pen);
  const auto add = [&](Rows& rows, double second, double error) {
    seconds.see(second);
    errors.see(error);
    rows.add(second, error);
  };
  const auto draw = [&](Rows rows, const CurveLook& look) {
    if (!rows.empty()) panel.draw(out.data(std::move(rows)), "1:2", look.with, look.pen);
  };
  Rows direct("$direct" + of), trees("$tree" + of);
  for (const lattice::DirectSimulation& d : chart.direct[s])
    add(direct, d.seconds, d.drawn.total_variation);
  draw(direct, kDirect);
  for (std::size_t c = 0; c < chart.curves.size(); ++c) {
    Rows chain(fmt::format("$chain{}{}", c, of));
    for (const lattice::ChainPoint& p : chart.points)
      if (p.curve == c) add(chain, p.seconds(s), p.error(s));
    const lattice::ChainCurve& curve = chart.curves[c];
    draw(chain, !is_usual(chart, curve) ? kOthers : curve.visited ? kVisited : kUniform);
  }
  for (const lattice::TreePoint& p : chart.trees[s]) add(trees, p.seconds, p.error.total_variation);
  draw(trees, kTree);
}

/// Which of the curves there are.
void add_keys(Panels& out, const ChainErrorChart& chart) {
  const auto named = [](const CurveLook& look, const std::string& name) {
    return entry(look.with, look.pen, verbatim(name));
  };
  std::vector<Layer> chains,
      others{named(kDirect, "direct simulation"), named(kNoise, "noise of the truth")};
  bool finer = false;
  for (const lattice::ChainCurve& curve : chart.curves) {
    if (curve.trials.empty()) continue;
    if (!is_usual(chart, curve))
      finer = true;
    else
      chains.push_back(named(curve.visited ? kVisited : kUniform, "chain, " + name_of(curve)));
  }
  if (std::any_of(chart.trees.begin(), chart.trees.end(),
                  [](const auto& points) { return !points.empty(); }))
    chains.push_back(named(kTree, "chain of trees"));
  if (finer) others.push_back(named(kOthers, "chain, coarser and finer bins"));
  out.add_key(78, 6, std::move(chains));
  out.add_key(270, 6, std::move(others));
}

}  // namespace

Figure figure_of(const ChainErrorChart& chart) {
  const std::size_t starts = chart.truths.size(), columns = starts > 1 ? 2 : 1;
  constexpr double kHead = 70, kPanel = 168, kRow = 232;
  const double wide = columns == 1 ? 406.0 : 184.0;
  Panels out;
  add_keys(out, chart);
  std::vector<Panel*> panels;
  Extent seconds, errors;
  for (std::size_t s = 0; s < starts; ++s) {
    const double left = s % columns == 0 ? 82 : 298,
                 top = kHead + kRow * static_cast<double>(s / columns) + 26;
    panels.push_back(&out.add({left, left + wide, top, top + kPanel}));
    panels[s]->say(name_of(chart.truths[s]), left, top - 12, kSmallFont);
    draw_curves(out, *panels[s], chart, s, seconds, errors);
  }
  // Of nothing that has a place on such axes: some place.
  for (Extent* extent : {&seconds, &errors})
    if (!std::isfinite(extent->low)) *extent = {0.1, 1.0};
  const double low = seconds.low / 1.4, high = 1.4 * seconds.high;
  for (std::size_t s = 0; s < starts; ++s) {
    Panel& panel = *panels[s];
    const bool first = s % columns == 0;
    panel.x = {s + columns >= starts ? "seconds on one thread" : "", low, high,
               fmt::format("({})", tics_1_2_5(low, high, wide))};
    panel.y = {first ? "total variation" : "",
               0.6 * errors.low,
               std::max(1.0, 1.4 * errors.high),
               "",
               "%g",
               first};
    panel.x.logarithmic = panel.y.logarithmic = true;
    panel.grid = kThin;
  }
  return out.figure(
      static_cast<int>(kHead + kRow * static_cast<double>((starts - 1) / columns + 1)) + 24);
}

}  // namespace gatewalk::cli
