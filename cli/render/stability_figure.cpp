// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "cli/render/panel.h"
#include "cli/render/stability.h"

namespace gatewalk::cli {
namespace {

using dynamics::FinishedMap;
using dynamics::MapAxis;
using dynamics::Verdict;

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
      if (std::any_of(maps_.begin(), maps_.end(),
                      [v](const FinishedMap& m) { return m.count(static_cast<Verdict>(v)) > 0; }))
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
