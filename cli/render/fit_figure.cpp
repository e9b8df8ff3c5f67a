// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "cli/render/fit.h"
#include "cli/render/text.h"

namespace gatewalk::cli {
namespace {

constexpr std::size_t kBins = 24;  // of a panel

/// Where the draws of a number lie, in its unit: all but a thousandth at each end, with a margin.
std::array<double, 2> shown_range(const FittedScene& f, std::size_t k) {
  std::vector<double> sorted(f.fit.draws.col(static_cast<Eigen::Index>(k)).begin(),
                             f.fit.draws.col(static_cast<Eigen::Index>(k)).end());
  std::sort(sorted.begin(), sorted.end());
  const double low = sorted[sorted.size() / 1000],
               high = sorted[sorted.size() - 1 - sorted.size() / 1000];
  const double margin = std::max(0.1 * (high - low), 1e-6);
  return {f.ranges[k].at(std::max(0.0, low - margin)),
          f.ranges[k].at(std::min(1.0, high + margin))};
}

std::size_t bin_of(double x, const std::array<double, 2>& range) {
  const double at = (x - range[0]) / (range[1] - range[0]) * static_cast<double>(kBins);
  return static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(kBins) - 1.0));
}
double middle(std::size_t bin, const std::array<double, 2>& range) {
  return range[0] +
         (static_cast<double>(bin) + 0.5) / static_cast<double>(kBins) * (range[1] - range[0]);
}

/// Numbers that stand clear of each other, and of those of the next panel: none at its very ends.
std::string tics_of(const std::array<double, 2>& range, double side) {
  constexpr double kLetter = 8.0, kApart = 14.0, kAside = 12.0;  // points
  const double span = range[1] - range[0];
  std::string list;
  for (double parts = 4.0; parts > 0.4; parts -= 0.5) {
    const double step = tic_step(span, parts);
    std::size_t longest = 0;
    list.clear();
    for (double at = std::ceil(range[0] / step); at * step <= range[1]; at += 1.0) {
      const double from_end = std::min(at * step - range[0], range[1] - at * step);
      const std::string number = digits(at * step);
      if (from_end / span * side < kAside) continue;
      list += (list.empty() ? "" : ", ") + number;
      longest = std::max(longest, number.size());
    }
    if (step / span * side > kLetter * static_cast<double>(longest) + kApart) break;
  }
  if (list.find(',') == list.npos) {  // one number makes no scale
    const double step = tic_step(span, 8.0);
    const auto near = [&](double share) {
      return digits(std::round((range[0] + share * span) / step) * step);
    };
    list = near(0.25) + ", " + near(0.75);
  }
  return "(" + list + ")";
}

/// Where there are many, a letter, which the upper right corner explains.
std::string axis_name(const FittedScene& f, std::size_t k) {
  return literal(f.ranges.size() > 2 ? std::string(1, static_cast<char>('a' + k))
                                     : f.ranges[k].key);
}

}  // namespace

Figure figure_of(const FittedScene& f) {
  const std::size_t numbers = f.ranges.size();
  constexpr double kLeft = 84, kTop = 40, kGap = 10;
  const double side = std::min(300.0, (478.0 - kLeft + kGap) / static_cast<double>(numbers) - kGap);
  const Sheet sheet{static_cast<int>(kTop + static_cast<double>(numbers) * (side + kGap) + 60)};
  std::string out = std::string("set multiplot\n") + kSequential +
                    sheet.text("posterior after " + std::to_string(f.fit.observed) + " " +
                                   counted(f) + "; dashed: 95 %",
                               8, 18);
  if (numbers > 2)
    for (std::size_t k = 0; k < numbers; ++k)
      out += sheet.text(std::string(1, static_cast<char>('a' + k)) + ": " + f.ranges[k].key,
                        kLeft + side + kGap, kTop + 10 + 20 * static_cast<double>(k), kSmallFont);
  std::vector<std::array<double, 2>> ranges;
  for (std::size_t k = 0; k < numbers; ++k) ranges.push_back(shown_range(f, k));
  const Eigen::Index draws = f.fit.draws.rows();
  for (std::size_t down = 0; down < numbers; ++down)
    for (std::size_t right = 0; right <= down; ++right) {
      const double left = kLeft + static_cast<double>(right) * (side + kGap),
                   top = kTop + static_cast<double>(down) * (side + kGap);
      const std::string name = "$p" + std::to_string(down) + "_" + std::to_string(right);
      const bool lowest = down + 1 == numbers;
      out += sheet.margins({left, left + side, top, top + side}) + kFrame + "set xrange [" +
             digits(ranges[right][0]) + ":" + digits(ranges[right][1]) + "]\nset xtics " +
             tics_of(ranges[right], side) + "\n" + (lowest ? "" : "set format x ''\n") +
             (lowest ? Sheet::x_axis(axis_name(f, right)) : "set xlabel\n");
      if (right == down) {
        std::vector<double> counts(kBins, 0.0);
        for (Eigen::Index i = 0; i < draws; ++i)
          counts[bin_of(f.ranges[down].at(f.fit.draws(i, static_cast<Eigen::Index>(down))),
                        ranges[down])] += 1.0;
        std::string data;
        for (std::size_t b = 0; b < kBins; ++b)
          data += digits(middle(b, ranges[down])) + " " + digits(counts[b]) + "\n";
        const lattice::FittedNumber& n = f.fit.numbers[down];
        out += data_block(name, data) + "set border 1\nunset ytics\nset ylabel\nset yrange [0:*]\n";
        for (const double end : n.interval) {
          const std::string x = digits(f.ranges[down].at(end));
          out += "set arrow from " + x + ", graph 0 to " + x +
                 ", graph 1 nohead front dt 2 lw 1.2 lt -1\n";
        }
        out += "plot " + name + " using 1:2 with boxes fs solid lc rgb '" + kFirstColour +
               "'\nunset arrow\n";
      } else {
        std::vector<double> counts(kBins * kBins, 0.0);
        for (Eigen::Index i = 0; i < draws; ++i)
          counts[bin_of(f.ranges[down].at(f.fit.draws(i, static_cast<Eigen::Index>(down))),
                        ranges[down]) *
                     kBins +
                 bin_of(f.ranges[right].at(f.fit.draws(i, static_cast<Eigen::Index>(right))),
                        ranges[right])] += 1.0;
        std::string data;
        for (std::size_t b = 0; b < counts.size(); ++b)
          if (counts[b] > 0.0)
            data += digits(middle(b % kBins, ranges[right])) + " " +
                    digits(middle(b / kBins, ranges[down])) + " " + digits(counts[b]) + "\n";
        const auto half = [](const std::array<double, 2>& range) {
          return 0.5 * (range[1] - range[0]) / static_cast<double>(kBins);
        };
        out +=
            data_block(name, data) + "set yrange [" + digits(ranges[down][0]) + ":" +
            digits(ranges[down][1]) + "]\nset ytics " + tics_of(ranges[down], side) + "\n" +
            (right == 0 ? "set format y '%g'\nset ylabel " + axis_name(f, down) + " offset 0.8,0\n"
                        : "set format y ''\nset ylabel\n") +
            "unset colorbox\nplot " + name + cells(half(ranges[right]), half(ranges[down])) + "\n";
      }
      out += "unset label\nset format x '%g'\nset format y '%g'\n";
    }
  return {Sheet::kWidth, sheet.height, out + "unset multiplot\n", kFont};
}

}  // namespace gatewalk::cli
