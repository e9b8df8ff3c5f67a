// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "cli/render/memory.h"
#include "cli/render/panel.h"

namespace gatewalk::cli {
namespace {

using lattice::GatesAhead;
using lattice::MemoryStudy;

constexpr double kPanelsLeft = 88, kPanelsRight = 492, kMemoryPanelHeight = 54, kPanelGap = 14,
                 kPanelsHead = 50, kScalesHeight = 110, kScalesHead = 82;
/// More ways than this would make panels too small to read.
constexpr std::size_t kMostWays = 6;
constexpr std::size_t kDrawnScales = 3;

/// One curve: what the kernel's powers say with its 95 %, and what was seen. Rows "gates low high
/// predicted seen".
void draw_curve(Panel& panel, const Rows& rows, const char* colour, const char* seen_colour) {
  panel.draw(rows, "1:2:3", "filledcurves fs transparent solid 0.25 noborder", {colour});
  panel.draw(rows, "1:4", "lines", {.colour = colour, .width = 1.2});
  panel.draw(rows, "1:5", "points", {.colour = seen_colour, .mark = 7, .size = 0.45});
}

/// Of the bodies that enter by one boundary, the share (%) that enters by another, k gates later.
struct Probabilities {
  Rows rows;
  double most = 0.0;

  Probabilities(const GatesAhead& ahead, std::size_t ways, std::size_t from, std::size_t to,
                std::string name = "")
      : rows(std::move(name)) {
    for (const GatesAhead::Step& s : ahead.steps) {
      const auto begin = static_cast<std::ptrdiff_t>(from * (ways + 1));
      const auto sum = [&](const std::vector<double>& shares) {
        double all = 0.0;
        for (std::size_t k = 0; k <= ways; ++k) all += shares[static_cast<std::size_t>(begin) + k];
        return all;
      };
      const std::size_t at = static_cast<std::size_t>(begin) + to;
      const double unit = 100.0 / sum(s.predicted), excess = s.seen[at] - s.predicted[at];
      if (!std::isfinite(unit)) continue;
      const double predicted = unit * s.predicted[at], seen = 100.0 / sum(s.seen) * s.seen[at],
                   low = std::max(0.0, predicted + unit * (excess - s.excess_95[at][1])),
                   high = predicted + unit * (excess - s.excess_95[at][0]);
      rows.add(s.gates, low, high, predicted, seen);
      most = std::max({most, high, seen, predicted});
    }
  }
};

/// An axis from 0, with a tic or two.
Axis up_to(double most, const char* name) {
  const double end = most > 0.0 ? 1.15 * most : 1.0;
  return {name, 0, end, "0," + digits(tic_step(end, 2.0))};
}

/// Ways by which somebody entered; the last column is trapped.
std::vector<std::size_t> entered_ways(const MemoryStudy& study) {
  const std::size_t ways = study.outcomes.size() - 1;
  std::vector<std::size_t> entered;
  for (std::size_t from = 0; from < ways; ++from)
    if (!Probabilities(study.ahead, ways, from, ways).rows.empty()) entered.push_back(from);
  return entered;
}

void add_ways(Panels& out, const MemoryStudy& study, double top) {
  const GatesAhead& ahead = study.ahead;
  const std::vector<std::string>& names = study.outcomes;
  const std::size_t ways = names.size() - 1;
  const std::vector<std::size_t> rows = entered_ways(study);
  std::vector<std::size_t> columns = rows;
  columns.push_back(ways);
  const double pitch = (kPanelsRight - kPanelsLeft) / static_cast<double>(columns.size());
  const auto left_of = [&](std::size_t i) { return kPanelsLeft + static_cast<double>(i) * pitch; };
  out.say("Chapman-Kolmogorov test: % of those who enter as at the left, some gates later", 8,
          top + 14, kSmallFont);
  out.say("line: powers of the kernel, with 95 % of chance; points: trials", 8, top + 28,
          kSmallFont);
  for (std::size_t i = 0; i < columns.size(); ++i)
    out.say(names[columns[i]], left_of(i) + 4, top + kPanelsHead - 6, kSmallFont);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const double above =
        top + kPanelsHead + static_cast<double>(k) * (kMemoryPanelHeight + kPanelGap);
    const bool lowest = k + 1 == rows.size();
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const Probabilities p(ahead, ways, rows[k], columns[i], fmt::format("$ahead{}_{}", k, i));
      Panel& panel =
          out.add({left_of(i), left_of(i) + pitch - 30, above, above + kMemoryPanelHeight});
      if (i == 0) panel.say(names[rows[k]], 8, above + 0.5 * kMemoryPanelHeight, kSmallFont);
      panel.tics_font = kSmallFont;
      panel.x = {lowest && i == columns.size() / 2 ? "gates" : "", ahead.steps.front().gates - 0.5,
                 ahead.steps.back().gates + 0.5, "2,2"};
      panel.x.numbers = lowest;
      panel.y = up_to(p.most, i == 0 ? "%" : "");
      panel.y.name_look = "font ',12' offset 2.2,0";
      draw_curve(panel, out.data(p.rows), kFirstColour, "black");
    }
  }
}

void add_scales(Panels& out, const MemoryStudy& study, double top) {
  const std::vector<GatesAhead::Step>& steps = study.ahead.steps;
  const char* const colours[] = {kFirstColour, kSecondColour, kThirdColour};
  const std::size_t count = std::min(kDrawnScales, steps.front().seen_scales.size());
  Panel panel(
      {kPanelsLeft, 0.5 * (kPanelsLeft + kPanelsRight), top + 26, top + 26 + kScalesHeight});
  panel.say("implied time scales of the same tables, in gates, over the lag", 8, top + 14,
            kSmallFont);
  double most = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    Rows rows(fmt::format("$scale{}", k));
    for (const GatesAhead::Step& s : steps) {
      if (!std::isfinite(s.seen_scales[k]) || !std::isfinite(s.scales_95[k][1])) continue;
      rows.add(s.gates, s.scales_95[k], s.predicted_scales[k], s.seen_scales[k]);
      most = std::max({most, s.scales_95[k][1], s.seen_scales[k]});
    }
    if (!rows.empty()) draw_curve(panel, out.data(rows), colours[k], colours[k]);
  }
  if (panel.layers.empty()) return;
  panel.x = {"lag, gates", steps.front().gates - 0.5, steps.back().gates + 0.5, "2,1"};
  panel.y = up_to(most, "time scale");
  out.add(std::move(panel));
}

}  // namespace

MorePanels panels_of(const MemoryStudy& study) {
  const GatesAhead& ahead = study.ahead;
  const std::size_t ways = study.outcomes.empty() ? 0 : study.outcomes.size() - 1;
  if (ahead.steps.empty() || ways == 0 || ways > kMostWays) return {};
  const double of_all =
      kPanelsHead + 34 +
      static_cast<double>(entered_ways(study).size()) * (kMemoryPanelHeight + kPanelGap);
  return {of_all + kScalesHead + kScalesHeight, [&study, of_all](Panels& out, double top) {
            add_ways(out, study, top);
            add_scales(out, study, top + of_all);
          }};
}

}  // namespace gatewalk::cli
