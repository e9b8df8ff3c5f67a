// SPDX-License-Identifier: MIT
#include "cli/render/stability.h"

#include <fmt/core.h>

#include <algorithm>

#include "cli/render/csv.h"
#include "cli/render/text.h"
#include "cli/render/text_table.h"

namespace gatewalk::cli {

using dynamics::FinishedMap;
using dynamics::Verdict;

namespace {

void describe(Fields& out, const dynamics::MapAxis& axis) {
  out.text({"name", "parameter along this axis, with its unit"}, axis.name);
  out.numbers({"values", "its own", "values of this parameter; the name gives the unit"},
              axis.values);
}

void describe(Fields& out, const FinishedMap& m) {
  const auto& [map, points, seconds] = m;
  out.text({"map", "name of the map"}, map.name);
  out.text({"method", "run.method of the trials"}, map.method);
  out.object({"x", "horizontal axis"}, [&](Fields& f) { describe(f, map.x); });
  out.object({"y", "vertical axis"}, [&](Fields& f) { describe(f, map.y); });
  TextRows status(map.y.values.size());
  for (std::size_t iy = 0; iy < status.size(); ++iy)
    for (std::size_t ix = 0; ix < map.x.values.size(); ++ix)
      status[iy].emplace_back(std::string(dynamics::name_of(m.at(ix, iy).verdict)));
  out.text_rows(
      {"status", "worst fault in the trials of each point, or ok; one row for each value of y"},
      status);
  out.list({"borders", "stability borders from theory, as lines"},
           points.empty() ? std::vector<dynamics::Border>() : dynamics::borders(map),
           [](Fields& f, const dynamics::Border& b) {
             f.text({"label", "formula of the border"}, b.label);
             f.numbers({"x", "its own", "coordinates of the line's points on the axis x"}, b.x);
             f.numbers({"y", "its own", "coordinates of the line's points on the axis y"}, b.y);
           });
}

}  // namespace

void describe(Fields& out, const StabilityResult& result) {
  const auto& [maps, made_by] = result;
  out.count({"trials_per_point", "1", "number of trials at each point"}, dynamics::kTrialsPerPoint);
  out.count(
      {"work_granted_per_point", "1",
       "limit of steps or evaluations for all trials of a point; beyond it the status is stuck"},
      dynamics::kMostWorkPerPoint);
  out.number({"holds_share", "1",
              "limit of the share of steps forced to hold; beyond it the status is stuck"},
             dynamics::Health::kPermittedHolds);
  out.list({"maps", "one map for each pair of axes and each method"}, maps,
           [](Fields& f, const FinishedMap& m) { describe(f, m); });
  describe_made_by(out, made_by);
}

std::string csv_of(const std::vector<FinishedMap>& maps) {
  Csv csv(
      "map,method,x_name,x,y_name,y,status,trials,not_finite,cut_short,penetrating,creating_energy,"
      "too_fast,beyond_bound,contacts_without_formula,forced_holds,steps,evaluations,"
      "worst_penetration_m,worst_energy_created_J,worst_speed_m_per_s");
  for (const FinishedMap& m : maps) {
    const std::string map(m.map.name), x(m.map.x.name), y(m.map.y.name);
    for (std::size_t iy = 0; iy < m.map.y.values.size(); ++iy)
      for (std::size_t ix = 0; ix < m.map.x.values.size(); ++ix) {
        const dynamics::MapPoint& p = m.at(ix, iy);
        const dynamics::Health& h = p.health;
        csv.row(map, m.map.method, x, m.map.x.values[ix], y, m.map.y.values[iy],
                std::string(dynamics::name_of(p.verdict)), h.runs, h.broken, p.out_of_work,
                h.penetrating, h.creating_energy, h.fast, h.unstable, h.undefined_contacts,
                h.forced_holds, h.steps, h.evaluations, h.worst_penetration, h.worst_energy_created,
                h.worst_speed);
      }
  }
  return csv.text();
}

std::string table_of(const std::vector<FinishedMap>& maps) {
  std::vector<Verdict> seen;
  for (std::size_t v = 0; v < dynamics::kVerdictNames.size(); ++v)
    if (std::any_of(maps.begin(), maps.end(),
                    [v](const FinishedMap& m) { return m.count(static_cast<Verdict>(v)) > 0; }))
      seen.push_back(static_cast<Verdict>(v));
  std::vector<TextColumn> columns{{"", -24}, {"", -11}};
  for (const Verdict v : seen) columns.push_back({std::string(dynamics::name_of(v)), 13});
  TextTable table(columns);
  for (const FinishedMap& m : maps) {
    std::vector<TextCell> cells{m.map.name, m.map.method};
    for (const Verdict v : seen) {
      const std::int64_t n = m.count(v);
      cells.push_back(n > 0 ? TextCell(n) : ".");
    }
    table.row(cells);
  }
  return fmt::format("Points of each map by the worst that their {} trials showed\n\n{}",
                     dynamics::kTrialsPerPoint, table.text());
}

std::string figure_name(const dynamics::StabilityMap& map) {
  return std::string(map.name) + ".svg";
}

}  // namespace gatewalk::cli
