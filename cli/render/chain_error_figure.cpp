// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <vector>

#include "cli/render/chain_error.h"
#include "cli/render/figure.h"
#include "cli/render/text.h"

namespace gatewalk::cli {
namespace {

using lattice::ChainErrorChart;

// What is drawn, and its name in the key. Bins finer and coarser than the usual ones are thin.
const std::string kDirect = " with lines lt -1 lw 1.5";
const std::string kNoise = " with lines lt -1 lw 0.8 dt 3";
const std::string kOthers = " with lines lt -1 lw 0.4";
const std::string kUniform =
    std::string(" with linespoints pt 5 ps 0.5 lw 1.5 lc rgb '") + kSecondColour + "'";
const std::string kVisited =
    std::string(" with linespoints pt 13 ps 0.6 lw 1.5 lc rgb '") + kFourthColour + "'";
const std::string kTree =
    std::string(" with linespoints pt 7 ps 0.6 lw 1.5 lc rgb '") + kFirstColour + "'";

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
struct Curves {
  std::string blocks, plot;
  Extent seconds, errors;

  Curves(const ChainErrorChart& chart, std::size_t s) {
    const std::string of = "_" + std::to_string(s);
    const double noise = chart.truths[s].floor.total_variation;
    errors.see(noise);
    plot = "plot " + digits(noise) + kNoise;
    std::string rows;
    for (const lattice::DirectSimulation& d : chart.direct[s])
      rows += row(d.seconds, d.drawn.total_variation);
    add("$direct" + of, rows, kDirect);
    for (std::size_t c = 0; c < chart.curves.size(); ++c) {
      const lattice::ChainCurve& curve = chart.curves[c];
      rows.clear();
      for (const lattice::ChainPoint& p : chart.points)
        if (p.curve == c) rows += row(p.seconds(s), p.error(s));
      add("$chain" + std::to_string(c) + of, rows,
          !is_usual(chart, curve) ? kOthers
          : curve.visited         ? kVisited
                                  : kUniform);
    }
    rows.clear();
    for (const lattice::TreePoint& p : chart.trees[s])
      rows += row(p.seconds, p.error.total_variation);
    add("$tree" + of, rows, kTree);
  }

 private:
  std::string row(double second, double error) {
    seconds.see(second);
    errors.see(error);
    return digits(second) + " " + digits(error) + "\n";
  }
  void add(const std::string& name, const std::string& rows, const std::string& look) {
    if (rows.empty()) return;
    blocks += data_block(name, rows);
    plot += ", " + name + " using 1:2" + look;
  }
};

/// Which of the curves there are.
std::string key_of(const ChainErrorChart& chart, const Sheet& sheet) {
  const auto entry = [](const std::string& look, const std::string& name) {
    return look.substr(1) + " title " + literal(name);
  };
  std::vector<std::string> chains,
      others{entry(kDirect, "direct simulation"), entry(kNoise, "noise of the truth")};
  bool finer = false;
  for (const lattice::ChainCurve& curve : chart.curves) {
    if (curve.trials.empty()) continue;
    if (!is_usual(chart, curve))
      finer = true;
    else
      chains.push_back(entry(curve.visited ? kVisited : kUniform, "chain, " + name_of(curve)));
  }
  if (std::any_of(chart.trees.begin(), chart.trees.end(),
                  [](const auto& points) { return !points.empty(); }))
    chains.push_back(entry(kTree, "chain of trees"));
  if (finer) others.push_back(entry(kOthers, "chain, coarser and finer bins"));
  return sheet.key(78, 6, chains) + sheet.key(270, 6, others);
}

}  // namespace

Figure figure_of(const ChainErrorChart& chart) {
  const std::size_t starts = chart.truths.size(), columns = starts > 1 ? 2 : 1;
  constexpr double kHead = 70, kPanel = 168, kRow = 232;
  const Sheet sheet{
      static_cast<int>(kHead + kRow * static_cast<double>((starts - 1) / columns + 1)) + 24};
  std::vector<Curves> curves;
  Extent seconds, errors;
  for (std::size_t s = 0; s < starts; ++s) {
    curves.emplace_back(chart, s);
    for (const double x : {curves[s].seconds.low, curves[s].seconds.high}) seconds.see(x);
    for (const double x : {curves[s].errors.low, curves[s].errors.high}) errors.see(x);
  }
  // Of nothing that has a place on such axes: some place.
  for (Extent* extent : {&seconds, &errors})
    if (!std::isfinite(extent->low)) *extent = {0.1, 1.0};
  const double low = seconds.low / 1.4, high = 1.4 * seconds.high;
  const double wide = columns == 1 ? 406.0 : 184.0;
  std::string out = "set multiplot\n" + key_of(chart, sheet) + kFrame +
                    "set logscale xy\nset format y '%g'\nset grid" + kThin + "\nset xrange [" +
                    digits(low) + ":" + digits(high) + "]\nset xtics (" +
                    tics_1_2_5(low, high, wide) + ")\nset yrange [" + digits(0.6 * errors.low) +
                    ":" + digits(std::max(1.0, 1.4 * errors.high)) + "]\n";
  for (std::size_t s = 0; s < starts; ++s) {
    const double left = s % columns == 0 ? 82 : 298,
                 top = kHead + kRow * static_cast<double>(s / columns) + 26;
    out += curves[s].blocks + sheet.margins({left, left + wide, top, top + kPanel}) +
           sheet.text(name_of(chart.truths[s]), left, top - 12, kSmallFont) +
           (s % columns == 0 ? "set format y '%g'\n" : "set format y ''\n") +
           Sheet::axes(s + columns >= starts ? "'seconds on one thread'" : "''",
                       s % columns == 0 ? "'total variation'" : "''") +
           curves[s].plot + "\nunset label\n";
  }
  return {Sheet::kWidth, sheet.height, out + "unset multiplot\n", kFont};
}

}  // namespace gatewalk::cli
