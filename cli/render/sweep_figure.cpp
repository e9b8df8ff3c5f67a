// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "cli/render/panel.h"
#include "cli/render/sweep.h"
#include "cli/render/text.h"
#include "dynamics/base/share.h"

namespace gatewalk::cli {
namespace {

using lattice::SweepAxis;
using lattice::SweepPoint;

/// The values as numbers, if all are.
std::optional<std::vector<double>> numbers_of(const SweepAxis& axis) {
  std::vector<double> numbers;
  for (const std::string& v : axis.values) {
    double x = 0.0;
    const auto read = std::from_chars(v.data(), v.data() + v.size(), x);
    if (read.ec != std::errc() || read.ptr != v.data() + v.size()) return std::nullopt;
    numbers.push_back(x);
  }
  return numbers;
}

/// Values at 0, 1, 2 ... of an axis of that many points; not all have tics where they would touch.
Axis axis_of(const SweepAxis& axis, double points_per_value, bool upright) {
  std::size_t longest = 1;
  for (const std::string& v : axis.values) longest = std::max(longest, v.size());
  const double wants = upright ? 18.0 : 8.0 * static_cast<double>(longest) + 8.0;
  const auto step = static_cast<std::size_t>(std::ceil(wants / points_per_value));
  std::vector<Tic> tics;
  for (std::size_t i = 0; i < axis.values.size(); i += step)
    tics.push_back({axis.values[i], static_cast<double>(i)});
  return {verbatim(axis.key), -0.5, static_cast<double>(axis.values.size()) - 0.5,
          tics_of(tics) + " noenhanced"};
}

std::string about(const std::vector<SweepPoint>& points) {
  return fmt::format("one gate, {} trials a point", points.front().tally.trials);
}

/// Shares of all over one key, with their intervals.
Figure curves(const SweepAxis& axis, const std::vector<SweepPoint>& points) {
  struct Curve {
    const char *name, *colour;
    int marker;
    std::int64_t (*count)(const dynamics::GateTally&);
  };
  const Curve curves[] = {
      {"traversed", kFirstColour, 7, [](const dynamics::GateTally& t) { return t.traversed(); }},
      {"exited", kSecondColour, 5, [](const dynamics::GateTally& t) { return t.exited(); }},
      {"trapped", kThirdColour, 9,
       [](const dynamics::GateTally& t) { return t[dynamics::Outcome::trapped]; }}};
  const auto numbers = numbers_of(axis);
  const Box box{78, 488, 66, 306};
  Panels out;
  Panel& panel = out.add(box);
  for (const Curve& c : curves) {
    Rows& rows = out.data(std::string("$") + c.name);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const dynamics::GateTally& t = points[i].tally;
      const auto [low, high] = dynamics::share_interval(c.count(t), t.trials);
      rows.add(numbers ? (*numbers)[i] : static_cast<double>(i),
               100.0 * static_cast<double>(c.count(t)) / static_cast<double>(t.trials), 100.0 * low,
               100.0 * high);
    }
    panel.draw(rows, "1:2:3:4", numbers ? "yerrorlines" : "yerrorbars",
               {c.colour, 1.5, c.marker, 0.8}, c.name);
  }
  panel.say(about(points), 8, 18);
  panel.key = {"right center horizontal maxrows 1 width -3 samplen 2", 480, 42};
  panel.grid = std::string("ytics") + kThin;
  panel.y = {"% of trials", 0, 100};
  if (numbers) {
    const auto [low, high] = std::minmax_element(numbers->begin(), numbers->end());
    const double margin = *high > *low  ? 0.04 * (*high - *low)
                          : *low != 0.0 ? 0.5 * std::abs(*low)
                                        : 1.0;
    panel.x = {verbatim(axis.key), *low - margin, *high + margin};
  } else {
    panel.x = axis_of(axis, box.width() / static_cast<double>(axis.values.size()), false);
  }
  return out.figure(370);
}

/// The traversed over two keys.
Figure map_of(const SweepAxis& up, const SweepAxis& right, const std::vector<SweepPoint>& points) {
  const std::size_t columns = right.values.size(), rows = up.values.size();
  Panels out;
  Rows& map = out.data("$map");
  for (std::size_t i = 0; i < points.size(); ++i) {
    const dynamics::GateTally& t = points[i].tally;
    const double share = 100.0 * static_cast<double>(t.traversed()) / static_cast<double>(t.trials);
    map.add(i % columns, i / columns, share,
            share > 0.0 && share < 0.05 ? "<.1" : fixed(share, share < 9.95 ? 1 : 0));
  }
  std::size_t longest = 1;
  for (const std::string& v : up.values) longest = std::max(longest, v.size());
  // The upright name of the axis takes 8 points a letter.
  const double name = 8.0 * static_cast<double>(up.key.size());
  const double left = 70.0 + 8.0 * static_cast<double>(std::min<std::size_t>(longest, 12));
  const double wide = 420.0 - left,
               tall = std::max(name, std::clamp(26.0 * static_cast<double>(rows), 120.0, 420.0));
  const double width = wide / static_cast<double>(columns),
               height = tall / static_cast<double>(rows);
  Panel& panel = out.add({left, left + wide, 44, 44 + tall});
  panel.say(about(points) + ": traversed, %", 8, 18);
  panel.x = axis_of(right, width, false);
  panel.y = axis_of(up, height, true);
  panel.colours = {0, 100, panel.box.beside(12, 12), "25"};
  panel.draw_cells(map);
  if (width >= 28 && height >= 16) panel.draw_numbers(100.0);
  return out.figure(static_cast<int>(panel.box.bottom + 66));
}

}  // namespace

Figure figure_of(const std::vector<SweepAxis>& axes, const std::vector<SweepPoint>& points) {
  if (axes.size() == 1) return curves(axes[0], points);
  if (axes.size() == 2) return map_of(axes[0], axes[1], points);
  throw std::invalid_argument("a figure of a sweep shows one key or two");
}

}  // namespace gatewalk::cli
