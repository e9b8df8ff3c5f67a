// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>

#include "cli/render/panel.h"
#include "cli/render/work_precision.h"

namespace gatewalk::cli {
namespace {

using dynamics::ChartPoint;
using dynamics::WorkPrecision;

/// Colour and marker (filled) of a method.
Pen pen_of(const std::string& method) {
  if (method == "paper") return {.colour = kSecondColour, .mark = 5, .size = 0.7};
  if (method == "stable") return {.colour = kFirstColour, .mark = 7, .size = 0.7};
  if (method == "moreau") return {.colour = kThirdColour, .mark = 9, .size = 0.7};
  if (method == "penalty") return {.colour = kFifthColour, .mark = 13, .size = 0.7};
  return {.colour = kFourthColour, .mark = 15, .size = 0.7};
}

// What is marked, in the panels, there in the colour of a method, and in the key.
constexpr Pen kUsual{kInk, 1.2, 6, 1.2}, kFault{kInk, 2, 2, 0.7}, kLess{kInk, 1.2, 10, 0.9},
    kParted{kInk, 1.2, 8, 0.9};
constexpr Pen kLimit{.colour = kInk, .width = 0.8, .dashes = 2},
    kOwn{.colour = kInk, .width = 0.8, .dashes = 3};

/// A point's error (infinite: half of the trials or more parted; NaN: none), its standard error,
/// and what it must reach to be told from no error.
struct Drawn {
  double error, spread, bound;

  [[nodiscard]] bool parted() const { return !std::isnan(error) && !std::isfinite(height()); }
  /// Where it is drawn.
  [[nodiscard]] double height() const { return std::max(error, bound); }
};

/// One of the errors of a chart: the bound that the reference sets to all, and its own error.
struct OutcomeKind {
  double limit, own;
  std::function<Drawn(const ChartPoint&)> value;
};
OutcomeKind outcomes_of(const WorkPrecision& chart) {
  return {chart.outcome_limit(), chart.reference.own.outcomes.total_variation,
          [&chart](const ChartPoint& p) {
            const dynamics::WeakError& e = p.errors.outcomes;
            return Drawn{e.total_variation, e.standard_error, chart.outcome_bound(p.errors)};
          }};
}
OutcomeKind positions_of(const WorkPrecision& chart) {
  return {chart.position_limit(), chart.reference.own.strong.position,
          [&chart](const ChartPoint& p) {
            const dynamics::StrongError& e = p.errors.strong;
            const bool parted = !std::isfinite(e.position) && e.compared + e.parted > 0;
            return Drawn{parted ? HUGE_VAL : e.position, std::nan(""), chart.position_limit()};
          }};
}

/// Of a logarithmic axis.
struct Range {
  double low = HUGE_VAL, high = 0.0;

  void see(double x) {
    if (!(x > 0.0) || !std::isfinite(x)) return;
    low = std::min(low, x);
    high = std::max(high, x);
  }
  /// With room on both sides; one that has seen nothing has some, too.
  [[nodiscard]] Range wider(double below, double above) const {
    return high > 0.0 ? Range{low / below, high * above} : Range{0.1, 1.0};
  }
};

/// The same for all scenes: they can be compared.
struct Ranges {
  Range time, outcomes, positions;

  explicit Ranges(const std::vector<WorkPrecision>& charts) {
    for (const WorkPrecision& chart : charts) {
      const auto see = [&](Range& range, const OutcomeKind& kind) {
        range.see(kind.limit);
        for (const ChartPoint& p : chart.points)
          if (p.ran()) range.see(kind.value(p).height());
      };
      see(outcomes, outcomes_of(chart));
      see(positions, positions_of(chart));
      for (const ChartPoint& p : chart.points) time.see(p.least_microseconds());
    }
    time = time.wider(1.3, 1.3);
    outcomes = outcomes.wider(4.0, 2.0);
    positions = positions.wider(20.0, 10.0);
  }
};

/// Least time per trial against error, all methods. What is below its bound is drawn there, as
/// less than that; what has parted, on top.
void draw_methods(Panels& out, Panel& panel, const WorkPrecision& chart, const OutcomeKind& kind,
                  const Range& range, const std::string& tag) {
  const auto level = [&](double at, const Pen& pen) {
    if (at > range.low && std::isfinite(at)) panel.draw_level(at, pen);
  };
  level(kind.limit, kLimit);
  level(kind.own, kOwn);
  bool compared = false;
  for (std::size_t begin = 0, end = 0; begin < chart.points.size(); begin = end) {
    const std::string& method = chart.points[begin].setting.method;
    const auto rows_of = [&](const char* what) {
      return Rows(fmt::format("${}{}{}", tag, method, what));
    };
    Rows line = rows_of("line"), bars = rows_of("bars"), good = rows_of("good"),
         fault = rows_of("fault"), less = rows_of("less"), parted = rows_of("parted"),
         usual = rows_of("usual");
    for (; end < chart.points.size() && chart.points[end].setting.method == method; ++end) {
      const ChartPoint& p = chart.points[end];
      if (!p.ran()) continue;
      const Drawn drawn = kind.value(p);
      const auto [error, spread, bound] = drawn;
      if (std::isnan(error)) continue;
      const double time = p.least_microseconds(),
                   at = drawn.parted() ? range.high / 1.6 : drawn.height();
      if (p.setting.usual) usual.add(time, at);
      if (drawn.parted()) {
        parted.add(time, at);
        continue;
      }
      line.add(time, at);
      (error < bound ? less : p.verdict == dynamics::Verdict::fine ? good : fault).add(time, at);
      if (error >= bound && std::isfinite(spread))
        bars.add(time, std::max(error - 2 * spread, 0.1 * error), error + 2 * spread);
    }
    const Pen own = pen_of(method);
    const auto draw = [&](Rows& rows, const char* columns, const char* with, Pen pen,
                          const char* colour) {
      if (rows.empty()) return;
      compared = true;
      pen.colour = colour;
      panel.draw(out.data(std::move(rows)), columns, with, pen);
    };
    draw(line, "1:2", "lines", {.width = 1}, own.colour);
    draw(bars, "1:2:(0):($3-$2)", "vectors heads size graph 0.015,90", {.width = 0.8}, own.colour);
    draw(good, "1:2", "points", own, own.colour);
    draw(fault, "1:2", "points", kFault, own.colour);
    draw(less, "1:2", "points", kLess, own.colour);
    draw(parted, "1:2", "points", kParted, own.colour);
    draw(usual, "1:2", "points", kUsual, kInk);
  }
  if (!compared) panel.more = "set label 'nothing to compare' at graph 0.5,0.5 center\n";
}

/// Settings that the method refused, in lines as wide as the figure: "refused: penalty 0.02 to
/// 0.01 s".
std::vector<std::string> refused_lines(const WorkPrecision& chart) {
  constexpr std::size_t kLongest = 76;
  const auto refused = [&](std::size_t i, const std::string& method) {
    return i < chart.points.size() && !chart.points[i].ran() &&
           chart.points[i].setting.method == method;
  };
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < chart.points.size(); ++i) {
    const dynamics::Setting& first = chart.points[i].setting;
    if (!refused(i, first.method)) continue;
    while (refused(i + 1, first.method)) ++i;
    const dynamics::Setting& last = chart.points[i].setting;
    std::string text = first.method + " " + digits(first.value);
    if (!(last == first)) text += " to " + digits(last.value);
    text += std::string(" ") + first.unit();
    if (lines.empty() || lines.back().size() + text.size() > kLongest)
      lines.push_back(lines.empty() ? "refused: " + text : text);
    else
      lines.back() += ", " + text;
  }
  return lines;
}

void add_keys(Panels& out, const std::vector<WorkPrecision>& charts) {
  std::vector<Layer> methods;
  for (const ChartPoint& p : charts.front().points)
    if (const std::string& method = p.setting.method;
        methods.empty() || methods.back().title.text != method)
      methods.push_back(entry("linespoints", pen_of(method), method));
  std::vector<Layer> marks{entry("points", kUsual, "usual setting"),
                           entry("points", kFault, "shows a fault"),
                           entry("points", kLess, "less than this")};
  const bool parted = std::any_of(charts.begin(), charts.end(), [](const WorkPrecision& chart) {
    return std::any_of(chart.points.begin(), chart.points.end(), [&](const ChartPoint& p) {
      return p.ran() && positions_of(chart).value(p).parted();
    });
  });
  if (parted) marks.push_back(entry("points", kParted, "half or more parted"));
  out.add_key(8, 6, std::move(methods));
  out.add_key(116, 6, std::move(marks));
  out.add_key(
      296, 6,
      {entry("lines", kLimit, "limit of the reference"), entry("lines", kOwn, "its own error")});
}

}  // namespace

Figure figure_of(const std::vector<WorkPrecision>& charts) {
  constexpr double kTop = 112, kPanel = 142, kBelow = 30, kLine = 16;
  const Ranges ranges(charts);
  const std::string tics = fmt::format("({})", tics_1_2_5(ranges.time.low, ranges.time.high, 160));
  Panels out;
  add_keys(out, charts);
  double top = kTop;
  for (std::size_t i = 0; i < charts.size(); ++i) {
    const WorkPrecision& chart = charts[i];
    out.say(chart.label, 8, top + 14);
    for (const std::string& line : refused_lines(chart))
      out.say(line, 8, (top += kLine) + 14, kSmallFont);
    top += 30;
    const auto add = [&](double left, const char* name, const OutcomeKind& kind, const Range& range,
                         const char* tag) {
      Panel& panel = out.add({left, left + 156, top, top + kPanel});
      panel.x = {i + 1 == charts.size() ? "µs per trial" : "", ranges.time.low, ranges.time.high,
                 tics};
      const double decades = std::log10(range.high / range.low);
      panel.y = {name, range.low, range.high, digits(std::pow(10.0, std::ceil(decades / 6.0))),
                 "10^{%L}"};
      panel.x.logarithmic = panel.y.logarithmic = true;
      panel.grid = kThin;
      draw_methods(out, panel, chart, kind, range, tag + std::to_string(i));
    };
    add(80, "total variation", outcomes_of(chart), ranges.outcomes, "weak");
    add(330, "exit off by (m)", positions_of(chart), ranges.positions, "strong");
    top += kPanel + kBelow;
  }
  return out.figure(static_cast<int>(top + 32));
}

}  // namespace gatewalk::cli
