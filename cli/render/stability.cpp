// SPDX-License-Identifier: MIT
#include "cli/render/stability.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "cli/fields/csv.h"
#include "cli/fields/text.h"
#include "cli/fields/text_table.h"
#include "cli/render/panel.h"

namespace gatewalk::cli {

using dynamics::FinishedMap;
using dynamics::MapAxis;

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
  std::vector<dynamics::Verdict> seen;
  for (std::size_t v = 0; v < dynamics::kVerdictNames.size(); ++v)
    if (std::any_of(maps.begin(), maps.end(), [v](const FinishedMap& m) {
          return m.count(static_cast<dynamics::Verdict>(v)) > 0;
        }))
      seen.push_back(static_cast<dynamics::Verdict>(v));
  std::vector<TextColumn> columns{{"", -24}, {"", -11}};
  for (const dynamics::Verdict v : seen) columns.push_back({std::string(dynamics::name_of(v)), 13});
  TextTable table(columns);
  for (const FinishedMap& m : maps) {
    std::vector<TextCell> cells{m.map.name, m.map.method};
    for (const dynamics::Verdict v : seen) {
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

namespace {

/// One colour per verdict, in their order: pale while the numbers hold.
constexpr std::array<const char*, dynamics::kVerdictNames.size()> kColours{
    "#e3f1dc",  // ok
    "#ffe169",  // missed hit
    "#a9c3d9",  // no formula
    "#f2a04e",  // too fast
    "#d987e0",  // outcomes off
    "#d04a00",  // energy
    "#9066c9",  // penetration
    "#7a1010",  // beyond bound
    "#1f5fae",  // stuck
    "#111111",  // not finite
    "#8f8f8f",  // refused
};
static_assert(kColours.back() != nullptr, "one colour per verdict");

constexpr double kPanelWidth = 128, kPanelHeight = 112;

/// An axis as gnuplot draws it. Grazing's delta runs over both signs and 24 decades: it is drawn by
/// number. A zero on a logarithmic axis stands one place below the first value.
struct DrawnAxis {
  std::vector<double> low, high;  // edges of each value's cell
  bool logarithmic, by_number;
  std::string tics;

  explicit DrawnAxis(const MapAxis& axis)
      : logarithmic(axis.logarithmic && axis.values.front() >= 0.0),
        by_number(axis.logarithmic && !logarithmic) {
    const std::vector<double>& v = axis.values;
    std::vector<double> at = v;  // places, in the measure in which cells are even
    for (std::size_t i = 0; i < v.size(); ++i)
      if (by_number)
        at[i] = static_cast<double>(i);
      else if (logarithmic && v[i] > 0.0)
        at[i] = std::log(v[i]);
    const bool zero_first = logarithmic && v.front() == 0.0;
    if (zero_first) at[0] = 2 * at[1] - at[2];
    set_edges(at);
    if (by_number || zero_first)
      tics = tics_by_hand(v, at);
    else if (logarithmic)
      tics = digits(std::pow(10.0, std::ceil(std::log10(high.back() / low.front()) / 3.5)));
    else
      tics = digits(tic_step(high.back() - low.front(), 3));
  }

  [[nodiscard]] double drawn(double place) const { return logarithmic ? std::exp(place) : place; }

  void set_edges(const std::vector<double>& at) {
    const std::size_t n = at.size();
    for (std::size_t i = 0; i < n; ++i) {
      const double before = i > 0 ? at[i - 1] : 2 * at[0] - at[1];
      const double after = i + 1 < n ? at[i + 1] : 2 * at[n - 1] - at[n - 2];
      low.push_back(drawn(0.5 * (before + at[i])));
      high.push_back(drawn(0.5 * (at[i] + after)));
    }
  }

  /// Zero and whole decades, not that next to it; of an axis by number only one of them and the
  /// middle.
  [[nodiscard]] std::string tics_by_hand(const std::vector<double>& v,
                                         const std::vector<double>& at) const {
    std::vector<Tic> list;
    const auto tic = [&](double place, const std::string& text) {
      list.push_back({text, drawn(place)});
    };
    for (std::size_t i = 0; i < v.size(); ++i) {
      const double decade = std::log10(std::abs(v[i]));
      const long whole = std::lround(decade);
      if (v[i] == 0.0)
        tic(at[i], "0");
      else if (by_number ? whole == -6
                         : i > 1 && std::abs(decade - static_cast<double>(whole)) < 1e-9)
        tic(at[i], fmt::format("{}10^{{{}}}", v[i] < 0 ? "-" : "", whole));
    }
    if (by_number) tic(0.5 * (at.front() + at.back()), "0");
    return tics_of(list);
  }

  [[nodiscard]] Axis axis(std::string_view name) const {
    return {verbatim(std::string(name)),    low.front(), high.back(), tics,
            logarithmic ? "10^{%L}" : "%g", true,        logarithmic};
  }
};

/// A box for each point, for boxxyerror.
void add_boxes(Rows& rows, const FinishedMap& m, const DrawnAxis& x, const DrawnAxis& y) {
  for (std::size_t iy = 0; iy < m.map.y.values.size(); ++iy)
    for (std::size_t ix = 0; ix < m.map.x.values.size(); ++ix) {
      const char* colour = kColours[static_cast<std::size_t>(m.at(ix, iy).verdict)];
      rows.add(std::sqrt(x.low[ix]) * std::sqrt(x.high[ix]), 0, x.low[ix], x.high[ix], y.low[iy],
               y.high[iy], std::string("0x") + (colour + 1));
    }
}

/// The maps of one kind, three methods in a row, and a key in the place of the sixth.
class PanelGroup {
 public:
  PanelGroup(std::span<const FinishedMap> maps, double top, std::string tag)
      : maps_(maps), top_(top), tag_(std::move(tag)) {
    for (const FinishedMap& m : maps_)
      for (const dynamics::Border& border : dynamics::borders(m.map))
        if (std::find(borders_.begin(), borders_.end(), border.label) == borders_.end())
          borders_.push_back(border.label);
  }

  [[nodiscard]] double end() const {
    return row_of(1) + kPanelHeight + 70 + 20 * static_cast<double>((borders_.size() + 1) / 2);
  }

  void draw_on(Panels& out) const {
    const dynamics::StabilityMap& map = maps_.front().map;
    out.say(std::string(map.title), 8, top_ + 14);
    for (std::size_t i = 0; i < maps_.size(); ++i) add_panel(out, i);
    std::vector<Layer> verdicts;
    for (std::size_t v = 0; v < kColours.size(); ++v)
      if (std::any_of(maps_.begin(), maps_.end(), [v](const FinishedMap& m) {
            return m.count(static_cast<dynamics::Verdict>(v)) > 0;
          }))
        verdicts.push_back(entry("points", {.colour = kColours[v], .mark = 5, .size = 1.4},
                                 verbatim(std::string(dynamics::kVerdictNames[v]))));
    out.add_key(left_of(2), row_of(1), std::move(verdicts));
    for (std::size_t i = 0; i < borders_.size(); ++i)
      out.add_key(i % 2 == 0 ? 70 : 270,
                  end() - 8 - 20 * static_cast<double>((borders_.size() + 1) / 2 - i / 2),
                  {entry("lines", {.colour = kInk, .width = 1.5, .dashes = static_cast<int>(i + 1)},
                         verbatim(borders_[i]))});
  }

 private:
  [[nodiscard]] static double left_of(std::size_t column) {
    return 76 + (kPanelWidth + 16) * static_cast<double>(column);
  }
  [[nodiscard]] double row_of(std::size_t row) const {
    return top_ + 52 + 196 * static_cast<double>(row);
  }

  /// Known borders of a map, the same one in the same dashes everywhere, seen on every colour.
  void draw_borders(Panels& out, Panel& panel, const dynamics::StabilityMap& map,
                    const std::string& tag) const {
    for (const dynamics::Border& border : dynamics::borders(map)) {
      const auto place = std::find(borders_.begin(), borders_.end(), border.label);
      const int dash = static_cast<int>(place - borders_.begin()) + 1;
      Rows& rows = out.data(fmt::format("{}B{}", tag, dash));
      for (std::size_t k = 0; k < border.x.size(); ++k) rows.add(border.x[k], border.y[k]);
      panel.draw_outlined(rows, "1:2", "lines", {"#ffffff", 3.5},
                          {.colour = "#000000", .width = 1.5, .dashes = dash});
    }
  }

  void add_panel(Panels& out, std::size_t i) const {
    const dynamics::StabilityMap& map = maps_[i].map;
    const DrawnAxis x(map.x), y(map.y);
    const double left = left_of(i % 3), top = row_of(i / 3);
    // A label under the middle one serves its whole row, but for one that has another axis.
    const bool named = i % 3 == 1 || (i == 3 && map.x.label != maps_.back().map.x.label);
    Rows& rows = out.data(tag_ + std::to_string(i));
    add_boxes(rows, maps_[i], x, y);
    Panel& panel = out.add({left, left + kPanelWidth, top, top + kPanelHeight});
    if (i == 0)
      panel.texts.push_back(
          {verbatim(std::string(map.y.label)), 10, row_of(1) - 20, kFont, "center rotate by 90"});
    panel.say(map.method, left, top - 12);
    panel.x = x.axis(named ? map.x.label : "");
    panel.y = y.axis("");
    if (i % 3 != 0) panel.y.tics = kNoTics;
    panel.draw(rows, "1:2:3:4:5:6:7", kBars, {kOwnColour});
    draw_borders(out, panel, map, rows.name());
  }

  std::span<const FinishedMap> maps_;
  double top_;
  std::string tag_;
  std::vector<std::string> borders_;  // labels, in the order of their dashes
};

}  // namespace

Figure figure_of(std::span<const FinishedMap> maps) {
  std::vector<PanelGroup> groups;
  double height = 0.0;
  for (std::size_t begin = 0, end = 0; begin < maps.size(); begin = end) {
    while (end < maps.size() && maps[end].map.kind == maps[begin].map.kind) ++end;
    groups.emplace_back(maps.subspan(begin, end - begin), height,
                        fmt::format("$map{}_", groups.size()));
    height = groups.back().end();
  }
  Panels out;
  for (const PanelGroup& group : groups) group.draw_on(out);
  return out.figure(static_cast<int>(height));
}

}  // namespace gatewalk::cli
