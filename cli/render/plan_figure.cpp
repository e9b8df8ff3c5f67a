// SPDX-License-Identifier: MIT
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

/// A name as gnuplot shows it letter by letter.
std::string plain(const std::string& name) {
  std::string text;
  for (const char c : name) text += c == '_' ? std::string("\\_") : std::string(1, c);
  return text;
}

/// A colour for each action, dark to light, and their names beside them.
std::string colours_of(const PlannedField& p, const Sheet& sheet, const Box& box) {
  const auto n = static_cast<int>(p.actions.size());
  std::string tics, steps;
  for (int a = 0; a < n; ++a) {
    tics += (a == 0 ? "'" : ", '") + plain(p.actions[static_cast<std::size_t>(a)]) + "' " +
            std::to_string(a);
    const std::string colour = kShades[static_cast<std::size_t>(
        std::lround(static_cast<double>(a * (kShades.size() - 1)) / std::max(1, n - 1)))];
    for (const int edge : {a, a + 1})
      steps += (steps.empty() ? "" : ", ") + std::to_string(edge) + " '" + colour + "'";
  }
  const auto place = [&](double left, double top) { return sheet.at(left, top); };
  const bool few = p.actions.size() <= kShades.size();
  return (few ? "set palette defined (" + steps + ")\n" : std::string(kSequential)) +
         "set cbrange [-0.5:" + digits(static_cast<double>(n) - 0.5) + "]\nset cbtics (" + tics +
         ") scale 0\nset colorbox user origin screen " + place(box.left, box.bottom) +
         " size screen " + digits((box.right - box.left) / Sheet::kWidth) + "," +
         digits((box.bottom - box.top) / sheet.height) + "\n";
}

/// Chance to cross against what a trial takes, of the policies that take less.
std::string front_panel(const PlannedField& p, const Sheet& sheet, const Box& box) {
  const dynamics::CostInfo& cost = p.shown.map.section.costs[p.thrift->cost];
  double low = p.plan.front[0].spent.mean, high = low;
  double lowest = 1.0, highest = 0.0;
  std::string rows;
  for (const lattice::FrontPoint& point : p.plan.front) {
    const double mean = point.spent.mean;  // of few trials without an interval
    const bool few = std::isnan(point.spent.mean_95[0]);
    const auto [from, to] = few ? std::array<double, 2>{mean, mean} : point.spent.mean_95;
    const auto [least, most] = point.crossings.interval_95();
    low = std::min(low, from);
    high = std::max(high, to);
    lowest = std::min(lowest, least);
    highest = std::max(highest, most);
    for (const double x : {point.spent.mean, from, to - from, 100.0 * point.crossings.share(),
                           100.0 * least, 100.0 * (most - least)})
      rows += digits(x) + " ";
    rows += "\n";
  }
  const double margin = 0.05 * (high - low), step = tic_step(high - low, 3);
  return "set xrange [" + digits(low - margin) + ":" + digits(high + margin) +
         "]\nset yrange [*:*]\nset xtics " + digits(step) + "\nset ytics " +
         digits(tic_step(100.0 * (highest - lowest), 4)) + "\n" + data_block("$front", rows) +
         kFrame + sheet.margins(box) +
         Sheet::axes("'mean of a trial, " + plain(cost.unit) + "'", "'% crossed'") +
         "plot $front using 2:4:3:(0)" + kInterval + ", '' using 1:5:(0):6" + kInterval +
         ", '' using 1:4 with linespoints pt 7 ps 0.6 lw 1 lc rgb '#365c8d'\n";
}

}  // namespace

Figure figure_of(const PlannedField& p) {
  const std::vector<MostTaken> most = most_taken(p);
  markov::CellProbabilities visits(p.shown.field.rows, p.shown.field.columns);
  for (std::size_t i = 0; i < most.size(); ++i)
    visits(static_cast<Eigen::Index>(i) / visits.cols(),
           static_cast<Eigen::Index>(i) % visits.cols()) = most[i].visits;
  const SmallMap place(visits);
  const FieldMap& map = place.map;
  const Box& box = place.box;
  const double width = place.width(), height = place.height(), columns = place.columns,
               rows = place.rows;
  const TypeMarks types(p.shown);
  const double legend = box.bottom + 52, bars_top = legend + types.legend_height() + 30;
  std::vector<ShareBar> bars{{"plan", p.plan.crossings.share(), p.plan.crossings.interval_95()}};
  for (std::size_t a = 0; a < p.actions.size(); ++a)
    bars.push_back({plain(p.actions[a]), p.plan.alone[a].share(), p.plan.alone[a].interval_95()});
  if (const auto& by_cell = p.plan.by_cell)
    bars.insert(bars.begin() + 1,
                {"gate alone", by_cell->crossings.share(), by_cell->crossings.interval_95()});
  const Box bars_box{130, 330, bars_top, bars_top + height_of_bars(bars.size())};
  const bool with_front = p.plan.front.size() > 1;
  const Box front_box{70, 330, bars_box.bottom + 56, bars_box.bottom + 196};
  const Sheet sheet{
      static_cast<int>(std::ceil(with_front ? front_box.bottom + 56 : bars_box.bottom + 12))};

  // In a block of several gates the one that most bodies visit stands for all.
  std::string data;
  for (Eigen::Index r = 0; r < map.rows.blocks(); ++r)
    for (Eigen::Index c = 0; c < map.columns.blocks(); ++c) {
      const MostTaken* shown = nullptr;
      for (Eigen::Index i = 0; i < map.rows.block; ++i)
        for (Eigen::Index j = 0; j < map.columns.block; ++j) {
          const Eigen::Index row = map.rows.first + r * map.rows.block + i,
                             column = map.columns.first + c * map.columns.block + j;
          if (row < 0 || row >= visits.rows() || column < 0 || column >= visits.cols()) continue;
          const MostTaken& here = most[static_cast<std::size_t>(row * visits.cols() + column)];
          if (here.shown && (!shown || here.visits > shown->visits)) shown = &here;
        }
      if (shown)
        data += std::to_string(c) + " " + std::to_string(r) + " " + std::to_string(shown->action) +
                " " + fixed(100.0 * shown->share, 0) + "\n";
    }
  const TypeMarks::Drawn marks = types.on(map, width / columns, height / rows, "plan");
  std::string plot = "plot $actions" + cells();
  if (width / columns >= 26 && height / rows >= 15)
    plot += ", '' using 1:2:4:" + ink(static_cast<double>(p.actions.size() - 1)) +
            " with labels tc rgb variable font ',12'";
  return {
      Sheet::kWidth, sheet.height,
      "set multiplot\n" + data_block("$actions", data) + marks.data + sheet.margins(box) + kFrame +
          "set xrange " + range_of(map.columns) + "\nset yrange " + range_of(map.rows) +
          "\nset xtics " + tics_of(map.columns, map.middle_column, width, 30) + "\nset ytics " +
          tics_of(map.rows, 0, height, 22) + "\n" +
          Sheet::map_axes(map.rows.first + map.rows.count) +
          sheet.text("most frequent action in each gate that enough bodies visit, its %", 8, 18) +
          colours_of(p, sheet, {box.right + 12, box.right + 22, box.top, box.bottom}) +
          types.legend(sheet, legend, marks.fits) + plot + marks.plot +
          "\nunset label\nunset colorbox\n" +
          sheet.text("crossed, %, by the plan, by the gate alone and by each action", 8,
                     bars_top - 14) +
          share_bars(sheet, bars_box, "$crossed", bars) +
          (with_front ? "\nunset label\n" +
                            sheet.text("policies that take less: " +
                                           p.shown.map.section.costs[p.thrift->cost].key,
                                       8, front_box.top - 18) +
                            front_panel(p, sheet, front_box)
                      : "") +
          "unset multiplot\n",
      kFont};
}

}  // namespace gatewalk::cli
