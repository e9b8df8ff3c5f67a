#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "cli/render/chain_error.h"
#include "cli/render/figure.h"
#include "cli/render/text.h"

namespace gatewalk::cli {
namespace {

using lattice::ChainAnswer;
using lattice::ChainErrorChart;
using lattice::ChainPoint;
using lattice::DirectSimulation;
using lattice::FinalGateError;

/// Coarse to fine (Okabe and Ito's colours).
constexpr std::array<const char*, 5> kColours{"#e69f00", "#d55e00", "#009e73", "#0072b2",
                                              "#cc79a7"};
const std::string kDirect = " with lines lc rgb '#000000' lw 2";
const std::string kNoise = " with lines lc rgb '#888888' lw 1.5 dt 3";
const std::string kChain = " with linespoints pt 7 ps 0.5 lw 2";
const std::string kSampling = " with lines lw 1.2 dt 2";
const std::string kTree = " with linespoints pt 5 ps 0.7 lw 2.5 lc rgb '#56b4e9'";
const std::string kVisited = " with linespoints pt 6 ps 0.6 lw 1.2";

std::string colour(const ChainErrorChart& chart, std::size_t curve) {
  std::size_t place = 0;  // among those of uniform starts: the same bins have the same colour
  while (chart.curves[place].factor != chart.curves[curve].factor) ++place;
  return std::string(" lc rgb '") + kColours[place % kColours.size()] + "'";
}

/// What the axes must show.
struct Extent {
  double least_seconds = lattice::ChainSummary::kNever, most_seconds = 0.0;
  double least_tv = least_seconds, least_lack = least_seconds;  // lack: 1 - corrcoef

  void see(const FinalGateError& e) {
    least_tv = std::min(least_tv, positive(e.total_variation));
    least_lack = std::min(least_lack, positive(1.0 - e.corrcoef));
  }
  void see(double seconds) {
    least_seconds = std::min(least_seconds, positive(seconds));
    most_seconds = std::max(most_seconds, seconds);
  }
  [[nodiscard]] std::string seconds_range() const {
    // A figure with a power of ten on its axis, or it has no number there.
    const double low =
        std::min(0.7 * least_seconds, std::pow(10.0, std::floor(std::log10(1.4 * most_seconds))));
    return "[" + digits(low) + ":" + digits(1.4 * most_seconds) + "]";
  }

 private:
  /// For logarithmic axes: others have no place there.
  static double positive(double x) { return x > 0.0 ? x : lattice::ChainSummary::kNever; }
};

Extent extent_of(const ChainErrorChart& chart) {
  Extent extent;
  for (std::size_t s = 0; s < chart.truths.size(); ++s) {
    extent.see(chart.truths[s].floor);
    for (const ChainPoint& p : chart.points) {
      extent.see(p.seconds(s));
      extent.see(p.answers[s].exact);
    }
    for (const lattice::TreePoint& p : chart.trees[s]) {
      extent.see(p.seconds);
      extent.see(p.error);
    }
  }
  return extent;
}

/// $chain_CURVE_START: seconds, total variation, 1 - corrcoef, sampling; $direct_START and
/// $tree_START: the first three.
std::string data_of(const ChainErrorChart& chart) {
  std::string out;
  for (std::size_t s = 0; s < chart.truths.size(); ++s) {
    const std::string of = std::to_string(s);
    for (std::size_t c = 0; c < chart.curves.size(); ++c) {
      std::string rows;
      for (const ChainPoint& p : chart.points) {
        if (p.curve != c) continue;
        const ChainAnswer& a = p.answers[s];
        rows += digits(p.seconds(s)) + " " + digits(p.error(s)) + " " +
                digits(1.0 - a.exact.corrcoef) + " " + digits(a.sampling) + "\n";
      }
      out += data_block("$chain_" + std::to_string(c) + "_" + of, rows);
    }
    std::string rows;
    for (const DirectSimulation& d : chart.direct[s])
      rows += digits(d.seconds) + " " + digits(d.drawn.total_variation) + " " +
              digits(1.0 - d.drawn.corrcoef) + "\n";
    out += data_block("$direct_" + of, rows);
    rows.clear();
    for (const lattice::TreePoint& p : chart.trees[s])
      rows += digits(p.seconds) + " " + digits(p.error.total_variation) + " " +
              digits(1.0 - p.error.corrcoef) + "\n";
    if (!rows.empty()) out += data_block("$tree_" + of, rows);
  }
  return out;
}

bool has_trees(const ChainErrorChart& chart) {
  return std::any_of(chart.trees.begin(), chart.trees.end(),
                     [](const auto& points) { return !points.empty(); });
}

/// Where panels and key are, in pixels.
struct Layout {
  static constexpr int kLeft = 95, kPanel = 310, kGap = 14, kPanelHeight = 300, kTop = 35,
                       kKeyRow = 20;
  int panels, wide, width, height, key_columns, key_rows;

  explicit Layout(const ChainErrorChart& chart)
      : panels(static_cast<int>(chart.truths.size())),
        wide(panels > 1 ? kPanel : 2 * kPanel),
        width(kLeft + panels * (wide + kGap)),
        key_columns(width / 400) {
    const bool has_visited = chart.curves.back().visited;
    const int uniform = static_cast<int>(chart.curves.size()) / (has_visited ? 2 : 1);
    key_rows = (uniform + 3 + has_visited + has_trees(chart) + key_columns - 1) / key_columns;
    height = kTop + 2 * kPanelHeight + kGap + 80 + kKeyRow * key_rows;
  }
  /// Sides of what is drawn next, from the left and from the top.
  [[nodiscard]] std::string margins(int left, int right, int top, int bottom) const {
    const auto at = [](const char* side, double share) {
      return std::string("set ") + side + "margin at screen " + digits(share) + "\n";
    };
    return at("l", static_cast<double>(left) / width) +
           at("r", static_cast<double>(right) / width) +
           at("t", 1.0 - static_cast<double>(top) / height) +
           at("b", 1.0 - static_cast<double>(bottom) / height);
  }
};

std::string plot(const std::vector<std::string>& items) {
  std::string out;
  for (const std::string& item : items) out += (out.empty() ? "plot " : ", \\\n  ") + item;
  return out + "\n";
}

/// Column 2 or 3 of the data over seconds, for one start; the truth's noise as a level.
std::string panel(const ChainErrorChart& chart, std::size_t s, int column, double noise) {
  const std::string of = std::to_string(s), shown = std::to_string(column);
  std::vector<std::string> items{digits(noise) + kNoise,
                                 "$direct_" + of + " using 1:" + shown + kDirect};
  for (std::size_t c = 0; c < chart.curves.size(); ++c) {
    if (chart.curves[c].trials.empty()) continue;
    const std::string data = "$chain_" + std::to_string(c) + "_" + of + " using 1:";
    const bool visited = chart.curves[c].visited;
    items.push_back(data + shown + (visited ? kVisited : kChain) + colour(chart, c));
    if (column == 2 && !visited) items.push_back(data + "4" + kSampling + colour(chart, c));
  }
  if (!chart.trees[s].empty()) items.push_back("$tree_" + of + " using 1:" + shown + kTree);
  return plot(items);
}

/// Both panels of one start, one above the other.
std::string panels_of(const ChainErrorChart& chart, std::size_t s, const Layout& layout,
                      const Extent& extent) {
  const FinalGateError& floor = chart.truths[s].floor;
  const int left = Layout::kLeft + static_cast<int>(s) * (layout.wide + Layout::kGap);
  const int below = Layout::kTop + Layout::kPanelHeight + Layout::kGap;
  const auto named = [&](const char* text) {
    return std::string("'") + (s == 0 ? text : "") + "'";
  };
  return layout.margins(left, left + layout.wide, Layout::kTop,
                        Layout::kTop + Layout::kPanelHeight) +
         "set title " + literal(name_of(chart.truths[s])) + " offset 0,-0.6\nunset xlabel\n" +
         "set format x ''\nset format y " + named("%g") + "\n" + "set yrange [" +
         digits(0.6 * extent.least_tv) + ":1]\n" + "set ylabel " + named("total variation") + "\n" +
         panel(chart, s, 2, floor.total_variation) +
         layout.margins(left, left + layout.wide, below, below + Layout::kPanelHeight) +
         "unset title\nset format x '%g'\n" +
         "set xlabel 'seconds on one thread: matrix and one prediction' font ',11'\n" +
         "set yrange [" + digits(0.6 * extent.least_lack) + ":1]\n" + "set ylabel " +
         named("1 - corrcoef") + "\n" + panel(chart, s, 3, 1.0 - floor.corrcoef);
}

/// The key, as a panel of its own: gnuplot makes a key no wider than its panel.
std::string key_of(const ChainErrorChart& chart, const Layout& layout) {
  std::vector<std::string> key{
      "NaN" + kNoise + " title " +
          literal("the truth's noise (" + std::to_string(chart.truths[0].tally.trials) +
                  " trials)"),
      "NaN" + kDirect + " title 'direct simulation'"};
  for (std::size_t c = 0; c < chart.curves.size(); ++c)
    if (!chart.curves[c].trials.empty() && !chart.curves[c].visited)
      key.push_back("NaN" + kChain + colour(chart, c) + " title " +
                    literal("chain, " + name_of(chart.curves[c]) + " (" +
                            std::to_string(chart.curves[c].space.size()) + " states)"));
  key.push_back("NaN" + kSampling + " lc rgb '#000000' title 'its part from sampling the matrix'");
  if (has_trees(chart)) key.push_back("NaN" + kTree + " title 'trees (predict --accuracy)'");
  if (chart.curves.back().visited)
    key.push_back("NaN" + kVisited + " lc rgb '#000000' title 'rows started where bodies enter'");
  return layout.margins(Layout::kLeft, layout.width - Layout::kGap,
                        layout.height - 10 - Layout::kKeyRow * layout.key_rows, layout.height - 5) +
         "unset logscale\nunset grid\nunset border\nunset tics\nunset xlabel\nunset ylabel\n" +
         "set xrange [0:1]\nset yrange [0:1]\n" + "set key center center horizontal maxcols " +
         std::to_string(layout.key_columns) + " Left reverse samplen 3\n" + plot(key);
}

}  // namespace

Figure figure_of(const ChainErrorChart& chart) {
  const Layout layout(chart);
  const Extent extent = extent_of(chart);
  std::string out = data_of(chart) +
                    "set multiplot\nset logscale xy\nset grid lc rgb '#dddddd' lt 1\nunset key\n" +
                    "set xrange " + extent.seconds_range() + "\n";
  for (std::size_t s = 0; s < chart.truths.size(); ++s) out += panels_of(chart, s, layout, extent);
  return {layout.width, layout.height, out + key_of(chart, layout) + "unset multiplot\n"};
}

}  // namespace gatewalk::cli
