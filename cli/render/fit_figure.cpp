// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "cli/render/fit.h"
#include "cli/render/panel.h"

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
std::string range_tics(const std::array<double, 2>& range, double side) {
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
  return fmt::format("({})", list);
}

/// Where there are many, a letter, which the upper right corner explains.
std::string axis_name(const FittedScene& f, std::size_t k) {
  return f.ranges.size() > 2 ? std::string(1, static_cast<char>('a' + k)) : f.ranges[k].key;
}

/// How many draws lie in each bin of a number; of two, row by row.
std::vector<double> counts_of(const FittedScene& f, const std::vector<std::size_t>& numbers,
                              const std::vector<std::array<double, 2>>& ranges) {
  std::vector<double> counts(numbers.size() == 1 ? kBins : kBins * kBins, 0.0);
  for (Eigen::Index i = 0; i < f.fit.draws.rows(); ++i) {
    std::size_t bin = 0;
    for (const std::size_t k : numbers)
      bin = bin * kBins +
            bin_of(f.ranges[k].at(f.fit.draws(i, static_cast<Eigen::Index>(k))), ranges[k]);
    counts[bin] += 1.0;
  }
  return counts;
}

}  // namespace

Figure figure_of(const FittedScene& f) {
  const std::size_t numbers = f.ranges.size();
  constexpr double kLeft = 84, kTop = 40, kGap = 10;
  const double side = std::min(300.0, (478.0 - kLeft + kGap) / static_cast<double>(numbers) - kGap);
  std::vector<std::array<double, 2>> ranges;
  for (std::size_t k = 0; k < numbers; ++k) ranges.push_back(shown_range(f, k));
  const auto axis = [&](std::size_t k, bool named) {
    return Axis{named ? verbatim(axis_name(f, k)) : Caption(),
                ranges[k][0],
                ranges[k][1],
                range_tics(ranges[k], side),
                "%g",
                named};
  };
  Panels out;
  out.say(fmt::format("posterior after {} {}; dashed: 95 %", f.fit.observed, counted(f)), 8, 18);
  for (std::size_t k = 0; k < numbers && numbers > 2; ++k)
    out.say(axis_name(f, k) + ": " + f.ranges[k].key, kLeft + side + kGap,
            kTop + 10 + 20 * static_cast<double>(k), kSmallFont);
  for (std::size_t down = 0; down < numbers; ++down)
    for (std::size_t right = 0; right <= down; ++right) {
      const double left = kLeft + static_cast<double>(right) * (side + kGap),
                   top = kTop + static_cast<double>(down) * (side + kGap);
      Rows& rows = out.data(fmt::format("$p{}_{}", down, right));
      Panel& p = out.add({left, left + side, top, top + side});
      p.x = axis(right, down + 1 == numbers);
      if (right == down) {
        const std::vector<double> counts = counts_of(f, {down}, ranges);
        for (std::size_t b = 0; b < kBins; ++b) rows.add(middle(b, ranges[down]), counts[b]);
        p.y = {"", 0, kFree, kNoTics};
        p.border = 1;
        for (const double end : f.fit.numbers[down].interval)
          p.uprights.push_back(
              {f.ranges[down].at(end), {.colour = kInk, .width = 1.2, .dashes = 2}, true});
        p.draw(rows, "1:2", "boxes fs solid", {kFirstColour});
      } else {
        const std::vector<double> counts = counts_of(f, {down, right}, ranges);
        for (std::size_t b = 0; b < counts.size(); ++b)
          if (counts[b] > 0.0)
            rows.add(middle(b % kBins, ranges[right]), middle(b / kBins, ranges[down]), counts[b]);
        const auto half = [](const std::array<double, 2>& range) {
          return 0.5 * (range[1] - range[0]) / static_cast<double>(kBins);
        };
        p.y = axis(down, right == 0);
        p.colours = Colours{};
        p.draw_cells(rows, half(ranges[right]), half(ranges[down]));
      }
    }
  return out.figure(static_cast<int>(kTop + static_cast<double>(numbers) * (side + kGap) + 60));
}

}  // namespace gatewalk::cli
