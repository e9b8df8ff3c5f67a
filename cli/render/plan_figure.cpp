// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cli/render/field_figure.h"
#include "cli/render/final_gates.h"
#include "cli/render/plan.h"
#include "cli/render/text.h"
#include "cli/render/type_marks.h"

namespace gatewalk::cli {
namespace {

/// Those of kSequential.
constexpr std::array<const char*, 8> kShades{"#440154", "#46327e", "#365c8d", "#277f8e",
                                             "#1fa187", "#4ac16d", "#a0da39", "#fde725"};

/// A name as gnuplot's tics show it letter by letter.
std::string escaped(const std::string& name) {
  std::string text;
  for (const char c : name) text += c == '_' ? std::string("\\_") : std::string(1, c);
  return text;
}

/// A colour for each action, dark to light, and their names beside them.
Colours colours_of(const PlannedField& p, const Box& bar) {
  const auto n = static_cast<int>(p.actions.size());
  std::vector<std::string> names;
  std::string steps;
  for (int a = 0; a < n; ++a) {
    names.push_back(escaped(p.actions[static_cast<std::size_t>(a)]));
    const std::string colour = kShades[static_cast<std::size_t>(
        std::lround(static_cast<double>(a * (kShades.size() - 1)) / std::max(1, n - 1)))];
    for (const int edge : {a, a + 1})
      steps += fmt::format("{}{} '{}'", steps.empty() ? "" : ", ", edge, colour);
  }
  Colours colours{-0.5, n - 0.5, bar, tics_of(names) + " scale 0"};
  if (p.actions.size() <= kShades.size())
    colours.palette = fmt::format("set palette defined ({})\n", steps);
  return colours;
}

/// Chance to cross against what a trial takes, of the policies that take less.
void add_front(Panels& out, const PlannedField& p, const Box& box) {
  const dynamics::CostInfo& cost = p.shown.map.section.costs[p.thrift->cost];
  double low = p.plan.front[0].spent.mean, high = low;
  double lowest = 1.0, highest = 0.0;
  Rows& rows = out.data("$front");
  for (const lattice::FrontPoint& point : p.plan.front) {
    const double mean = point.spent.mean;  // of few trials without an interval
    const bool few = std::isnan(point.spent.mean_95[0]);
    const auto [from, to] = few ? std::array<double, 2>{mean, mean} : point.spent.mean_95;
    const auto [least, most] = point.crossings.interval_95();
    low = std::min(low, from);
    high = std::max(high, to);
    lowest = std::min(lowest, least);
    highest = std::max(highest, most);
    rows.add(mean, from, to - from, 100.0 * point.crossings.share(), 100.0 * least,
             100.0 * (most - least), "");
  }
  const double margin = 0.05 * (high - low);
  Panel& panel = out.add(box);
  panel.say("policies that take less: " + cost.key, 8, box.top - 18);
  panel.x = {"mean of a trial, " + cost.unit, low - margin, high + margin,
             digits(tic_step(high - low, 3))};
  panel.y = {"% crossed", kFree, kFree, digits(tic_step(100.0 * (highest - lowest), 4))};
  panel.draw(rows, "2:4:3:(0)", kIntervals, kIntervalPen);
  panel.draw_again("1:5:(0):6", kIntervals, kIntervalPen);
  panel.draw_again("1:4", "linespoints", {.colour = "#365c8d", .width = 1, .mark = 7, .size = 0.6});
}

}  // namespace

Figure figure_of(const PlannedField& p) {
  const std::vector<MostTaken> most = most_taken(p);
  markov::CellProbabilities visits(p.shown.field.rows, p.shown.field.columns);
  for (std::size_t i = 0; i < most.size(); ++i) visits.data()[i] = most[i].visits;
  const auto [map, box] = SmallMap(visits);
  const TypeMarks types(p.shown);
  const double legend = box.bottom + 52, bars_top = legend + types.legend_height() + 30;

  Panels out;
  // In a block of several gates the one that most bodies visit stands for all.
  Rows& rows = out.data("$actions");
  for (Eigen::Index r = 0; r < map.rows.blocks(); ++r)
    for (Eigen::Index c = 0; c < map.columns.blocks(); ++c) {
      const MostTaken* shown = nullptr;
      for (const std::size_t gate : gates_in(map, r, c, p.shown.field))
        if (most[gate].shown && (!shown || most[gate].visits > shown->visits)) shown = &most[gate];
      if (shown) rows.add(c, r, shown->action, fixed(100.0 * shown->share, 0));
    }
  Panel& panel = add_map(out, map, box);
  panel.say("most frequent action in each gate that enough bodies visit, its %", 8, 18);
  panel.colours = colours_of(p, box.beside());
  panel.draw_cells(rows);
  if (numbers_fit(map, box)) panel.draw_numbers(static_cast<double>(p.actions.size() - 1));
  types.add_legend(panel, legend, types.draw_on(out, panel, map, "plan"));

  std::vector<ShareBar> bars{{"plan", p.plan.crossings.share(), p.plan.crossings.interval_95()}};
  if (const auto& by_cell = p.plan.by_cell)
    bars.push_back({"gate alone", by_cell->crossings.share(), by_cell->crossings.interval_95()});
  for (std::size_t a = 0; a < p.actions.size(); ++a)
    bars.push_back({escaped(p.actions[a]), p.plan.alone[a].share(), p.plan.alone[a].interval_95()});
  const double end = bars_top + height_of_bars(bars.size());
  add_share_bars(out, {130, 330, bars_top, end}, "$crossed", bars)
      .say("crossed, %, by the plan, by the gate alone and by each action", 8, bars_top - 14);
  if (p.plan.front.size() < 2) return out.figure(static_cast<int>(std::ceil(end + 12)));
  add_front(out, p, {70, 330, end + 56, end + 196});
  return out.figure(static_cast<int>(std::ceil(end + 252)));
}

}  // namespace gatewalk::cli
