// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>

#include "cli/render/figure.h"
#include "cli/render/text.h"
#include "cli/render/work_precision.h"

namespace gatewalk::cli {
namespace {

using dynamics::ChartPoint;
using dynamics::Verdict;
using dynamics::WorkPrecision;

/// Colour and marker (gnuplot's number, filled) of a method.
struct Look {
  const char* colour;
  int marker;
};
Look look_of(const std::string& method) {
  if (method == "paper") return {kSecondColour, 5};
  if (method == "stable") return {kFirstColour, 7};
  if (method == "moreau") return {kThirdColour, 9};
  if (method == "penalty") return {kFifthColour, 13};
  return {kFourthColour, 15};
}

/// "lc rgb '...'", for all that is of the method.
std::string colour_of(const std::string& method) {
  return std::string(" lc rgb '") + look_of(method).colour + "'";
}

// What is marked, in the panels and in the key.
constexpr char kUsual[] = "points pt 6 ps 1.2 lw 1.2";
constexpr char kFault[] = "points pt 2 ps 0.7 lw 2";
constexpr char kLess[] = "points pt 10 ps 0.9 lw 1.2";
constexpr char kParted[] = "points pt 8 ps 0.9 lw 1.2";
constexpr char kLimit[] = "lines lw 0.8 dt 2";
constexpr char kOwn[] = "lines lw 0.8 dt 3";

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
  [[nodiscard]] std::string text() const { return "[" + digits(low) + ":" + digits(high) + "]"; }
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
std::string panel(const WorkPrecision& chart, const OutcomeKind& kind, const Range& range,
                  const std::string& tag) {
  std::string blocks, plot = "plot ";
  const auto element = [&](const std::string& text) {
    plot += (plot == "plot " ? "" : ", ") + text;
  };
  const auto level = [&](double at, const char* look) {
    if (at > range.low && std::isfinite(at)) element(digits(at) + " with " + look + " lt -1");
  };
  level(kind.limit, kLimit);
  level(kind.own, kOwn);
  for (std::size_t begin = 0, end = 0; begin < chart.points.size(); begin = end) {
    const std::string& method = chart.points[begin].setting.method;
    std::string line, good, bars, fault, less, parted, usual;
    for (; end < chart.points.size() && chart.points[end].setting.method == method; ++end) {
      const ChartPoint& p = chart.points[end];
      if (!p.ran()) continue;
      const Drawn drawn = kind.value(p);
      const auto [error, spread, bound] = drawn;
      if (std::isnan(error)) continue;
      const std::string time = digits(p.least_microseconds()) + " ",
                        x_y = time + digits(drawn.parted() ? range.high / 1.6 : drawn.height()) +
                              "\n";
      if (p.setting.usual) usual += x_y;
      if (drawn.parted()) {
        parted += x_y;
        continue;
      }
      line += x_y;
      (error < bound ? less : p.verdict == Verdict::fine ? good : fault) += x_y;
      if (error >= bound && std::isfinite(spread))
        bars += time + digits(std::max(error - 2 * spread, 0.1 * error)) + " " +
                digits(error + 2 * spread) + "\n";
    }
    const Look look = look_of(method);
    const auto draw = [&](const char* what, const std::string& rows, const std::string& with) {
      if (rows.empty()) return;
      const std::string name = "$" + tag + method + what;
      blocks += data_block(name, rows);
      element(name + with);
    };
    const std::string colour = colour_of(method), points = " using 1:2 with ";
    draw("line", line, points + "lines lw 1" + colour);
    draw("bars", bars,
         " using 1:2:(0):($3-$2) with vectors heads size graph 0.015,90 lw 0.8" + colour);
    draw("good", good, points + "points ps 0.7 pt " + std::to_string(look.marker) + colour);
    draw("fault", fault, points + kFault + colour);
    draw("less", less, points + kLess + colour);
    draw("parted", parted, points + kParted + colour);
    draw("usual", usual, points + kUsual + " lt -1");
  }
  if (blocks.empty()) {
    element("NaN");
    blocks = "set label 'nothing to compare' at graph 0.5,0.5 center\n";
  }
  return blocks + "set ytics " +
         digits(std::pow(10.0, std::ceil(std::log10(range.high / range.low) / 6.0))) +
         "\nset yrange " + range.text() + "\n" + plot + "\n";
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

std::string key_of(const std::vector<WorkPrecision>& charts, const Sheet& sheet) {
  std::vector<std::string> methods;
  std::string last;
  for (const ChartPoint& p : charts.front().points) {
    if (p.setting.method == last) continue;
    last = p.setting.method;
    methods.push_back("with linespoints ps 0.7 pt " + std::to_string(look_of(last).marker) +
                      colour_of(last) + " title '" + last + "'");
  }
  const auto entry = [](const char* look, const char* name) {
    return std::string("with ") + look + " lt -1 title '" + name + "'";
  };
  std::vector<std::string> marks{entry(kUsual, "usual setting"), entry(kFault, "shows a fault"),
                                 entry(kLess, "less than this")};
  const bool parted = std::any_of(charts.begin(), charts.end(), [](const WorkPrecision& chart) {
    return std::any_of(chart.points.begin(), chart.points.end(), [&](const ChartPoint& p) {
      return p.ran() && positions_of(chart).value(p).parted();
    });
  });
  if (parted) marks.push_back(entry(kParted, "half or more parted"));
  return sheet.key(8, 6, methods) + sheet.key(116, 6, marks) +
         sheet.key(296, 6, {entry(kLimit, "limit of the reference"), entry(kOwn, "its own error")});
}

}  // namespace

Figure figure_of(const std::vector<WorkPrecision>& charts) {
  constexpr double kTop = 112, kPanel = 142, kBelow = 30, kLine = 16;
  double height = kTop;
  for (const WorkPrecision& chart : charts)
    height += 30 + kLine * static_cast<double>(refused_lines(chart).size()) + kPanel + kBelow;
  const Sheet sheet{static_cast<int>(height + 32)};
  const Ranges ranges(charts);
  std::string out = "set multiplot\n" + key_of(charts, sheet) + kFrame +
                    "set logscale xy\nset format y '10^{%L}'\nset grid" + kThin + "\nset xrange " +
                    ranges.time.text() + "\nset xtics (" +
                    tics_1_2_5(ranges.time.low, ranges.time.high, 160) + ")\n";
  double top = kTop;
  for (std::size_t i = 0; i < charts.size(); ++i) {
    const WorkPrecision& chart = charts[i];
    out += sheet.text(chart.label, 8, top + 14);
    for (const std::string& line : refused_lines(chart))
      out += sheet.text(line, 8, (top += kLine) + 14, kSmallFont);
    top += 30;
    const std::string label = i + 1 == charts.size() ? "'µs per trial'" : "''";
    const Box left{80, 236, top, top + kPanel}, right{330, 486, top, top + kPanel};
    out += sheet.margins(left) + Sheet::axes(label, "'total variation'") +
           panel(chart, outcomes_of(chart), ranges.outcomes, "weak" + std::to_string(i)) +
           "unset label\n" + sheet.margins(right) + Sheet::axes(label, "'exit off by (m)'") +
           panel(chart, positions_of(chart), ranges.positions, "strong" + std::to_string(i));
    top += kPanel + kBelow;
  }
  return {Sheet::kWidth, sheet.height, out + "unset multiplot\n", kFont};
}

}  // namespace gatewalk::cli
