// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "cli/render/memory.h"
#include "cli/render/text.h"

namespace gatewalk::cli {
namespace {

using lattice::GatesAhead;
using lattice::MemoryStudy;

constexpr double kPanelsLeft = 88, kPanelsRight = 492, kMemoryPanelHeight = 54, kPanelGap = 14,
                 kPanelsHead = 50, kScalesHeight = 110, kScalesHead = 82;
/// More ways than this would make panels too small to read.
constexpr std::size_t kMostWays = 6;
constexpr std::size_t kDrawnScales = 3;

const std::string kBand =
    std::string(" with filledcurves fs transparent solid 0.25 noborder lc rgb '");
const std::string kLine = " with lines lw 1.2 lc rgb '";
/// Sizes of letters at small panels, and at large ones.
const std::string kSmallTics = "set tics font ',12'\n", kTics = "set tics font ',15'\n";
const std::string kPoints = " with points pt 7 ps 0.45 lc rgb '";

/// One curve: what the kernel's powers say with its 95 %, and what was seen. Rows "gates low high
/// predicted seen".
std::string curve(const std::string& block, const char* colour, const char* seen_colour) {
  return block + " using 1:2:3" + kBand + colour + "', " + block + " using 1:4" + kLine + colour +
         "', " + block + " using 1:5" + kPoints + seen_colour + "'";
}

std::string line(int gates, double low, double high, double predicted, double seen) {
  return std::to_string(gates) + " " + digits(low) + " " + digits(high) + " " + digits(predicted) +
         " " + digits(seen) + "\n";
}

/// Of the bodies that enter by one boundary, the share (%) that enters by another, k gates later.
struct Probabilities {
  std::string rows;
  double most = 0.0;

  Probabilities(const GatesAhead& ahead, std::size_t ways, std::size_t from, std::size_t to) {
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
      rows += line(s.gates, low, high, predicted, seen);
      most = std::max({most, high, seen, predicted});
    }
  }
};

/// The upper end of an axis from 0, and the tic on it.
struct UpTo {
  double end, tic;
  explicit UpTo(double most) : end(most > 0.0 ? 1.15 * most : 1.0), tic(tic_step(end, 2.0)) {}
  [[nodiscard]] std::string commands() const {
    return "set yrange [0:" + digits(end) + "]\nset ytics 0," + digits(tic) + "\n";
  }
};

/// Ways by which somebody entered; the last column is trapped.
std::vector<std::size_t> entered_ways(const MemoryStudy& study) {
  const std::size_t ways = study.outcomes.size() - 1;
  std::vector<std::size_t> entered;
  for (std::size_t from = 0; from < ways; ++from)
    if (!Probabilities(study.ahead, ways, from, ways).rows.empty()) entered.push_back(from);
  return entered;
}

std::string of_ways(const MemoryStudy& study, const Sheet& sheet, double top) {
  const GatesAhead& ahead = study.ahead;
  const std::vector<std::string>& names = study.outcomes;
  const std::size_t ways = names.size() - 1;
  const std::vector<std::size_t> rows = entered_ways(study);
  std::vector<std::size_t> columns = rows;
  columns.push_back(ways);
  const double pitch = (kPanelsRight - kPanelsLeft) / static_cast<double>(columns.size());
  std::string out =
      sheet.text("Chapman-Kolmogorov test: % of those who enter as at the left, some gates later",
                 8, top + 14, kSmallFont);
  out += sheet.text("line: powers of the kernel, with 95 % of chance; points: trials", 8, top + 28,
                    kSmallFont);
  const auto left_of = [&](std::size_t i) { return kPanelsLeft + static_cast<double>(i) * pitch; };
  for (std::size_t i = 0; i < columns.size(); ++i)
    out += sheet.text(names[columns[i]], left_of(i) + 4, top + kPanelsHead - 6, kSmallFont);
  const int first = ahead.steps.front().gates, last = ahead.steps.back().gates;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const double above =
        top + kPanelsHead + static_cast<double>(k) * (kMemoryPanelHeight + kPanelGap);
    const bool lowest = k + 1 == rows.size();
    out += sheet.text(names[rows[k]], 8, above + 0.5 * kMemoryPanelHeight, kSmallFont);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const Probabilities p(ahead, ways, rows[k], columns[i]);
      const std::string block = "$ahead" + std::to_string(k) + "_" + std::to_string(i);
      out +=
          data_block(block, p.rows) + kFrame + kSmallTics +
          sheet.margins({left_of(i), left_of(i) + pitch - 30, above, above + kMemoryPanelHeight}) +
          "set xrange [" + digits(first - 0.5) + ":" + digits(last + 0.5) + "]\nset xtics 2,2" +
          (lowest ? "" : "\nset format x ''") + "\n" + UpTo(p.most).commands() +
          Sheet::x_axis(lowest && i == columns.size() / 2 ? "'gates'" : "''") + "set ylabel '" +
          (i == 0 ? "%" : "") + "' font ',12' offset 2.2,0\nplot " +
          curve(block, kFirstColour, "black") + "\nunset label\nset format x '% h'\n";
    }
  }
  return out + "set ylabel '' font ',15'\n";
}

std::string of_scales(const MemoryStudy& study, const Sheet& sheet, double top) {
  const std::vector<GatesAhead::Step>& steps = study.ahead.steps;
  const char* const colours[] = {kFirstColour, kSecondColour, kThirdColour};
  const std::size_t count = std::min(kDrawnScales, steps.front().seen_scales.size());
  std::string out = sheet.text("implied time scales of the same tables, in gates, over the lag", 8,
                               top + 14, kSmallFont);
  std::string plot;
  double most = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    std::string rows;
    for (const GatesAhead::Step& s : steps) {
      if (!std::isfinite(s.seen_scales[k]) || !std::isfinite(s.scales_95[k][1])) continue;
      rows += line(s.gates, s.scales_95[k][0], s.scales_95[k][1], s.predicted_scales[k],
                   s.seen_scales[k]);
      most = std::max({most, s.scales_95[k][1], s.seen_scales[k]});
    }
    if (rows.empty()) continue;
    const std::string block = "$scale" + std::to_string(k);
    out += data_block(block, rows);
    plot += (plot.empty() ? "plot " : ", ") + curve(block, colours[k], colours[k]);
  }
  if (plot.empty()) return out + "unset label\n";
  return out + kFrame + kTics +
         sheet.margins({kPanelsLeft, 0.5 * (kPanelsLeft + kPanelsRight), top + 26,
                        top + 26 + kScalesHeight}) +
         "set xrange [" + digits(steps.front().gates - 0.5) + ":" +
         digits(steps.back().gates + 0.5) + "]\nset xtics 2,1\n" + UpTo(most).commands() +
         Sheet::axes("'lag, gates'", "'time scale'") + plot + "\nunset label\n";
}

}  // namespace

MorePanels panels_of(const MemoryStudy& study) {
  const GatesAhead& ahead = study.ahead;
  const std::size_t ways = study.outcomes.empty() ? 0 : study.outcomes.size() - 1;
  if (ahead.steps.empty() || ways == 0 || ways > kMostWays) return {};
  const double of_all =
      kPanelsHead + 34 +
      static_cast<double>(entered_ways(study).size()) * (kMemoryPanelHeight + kPanelGap);
  return {of_all + kScalesHead + kScalesHeight, [&study, of_all](const Sheet& sheet, double top) {
            return of_ways(study, sheet, top) + of_scales(study, sheet, top + of_all);
          }};
}

}  // namespace gatewalk::cli
