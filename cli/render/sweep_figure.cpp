// SPDX-License-Identifier: MIT
#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "cli/render/figure.h"
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

/// In gnuplot's quotes, as it stands.
std::string quoted(const std::string& text) {
  const std::string whole = literal(text);
  return whole.substr(0, whole.rfind(" noenhanced"));
}

/// Values as tics 0, 1, 2 ... of an axis of that many points; not all where they would touch.
std::string tics_of(const SweepAxis& axis, double points_per_value, bool upright) {
  std::size_t longest = 1;
  for (const std::string& v : axis.values) longest = std::max(longest, v.size());
  const double wants = upright ? 18.0 : 8.0 * static_cast<double>(longest) + 8.0;
  const auto step = static_cast<std::size_t>(std::ceil(wants / points_per_value));
  std::string list;
  for (std::size_t i = 0; i < axis.values.size(); i += step)
    list += (i ? ", " : "") + quoted(axis.values[i]) + " " + std::to_string(i);
  return "(" + list + ")";
}

std::string about(const std::vector<SweepPoint>& points) {
  return "one gate, " + std::to_string(points.front().tally.trials) + " trials a point";
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
  const Sheet sheet{370};
  const Box box{78, 488, 66, 306};
  const auto n = static_cast<double>(axis.values.size());
  std::string data, plots;
  for (const Curve& c : curves) {
    std::string rows;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const dynamics::GateTally& t = points[i].tally;
      const auto [low, high] = dynamics::share_interval(c.count(t), t.trials);
      const double x = numbers ? (*numbers)[i] : static_cast<double>(i);
      rows += digits(x) + " " +
              digits(100.0 * static_cast<double>(c.count(t)) / static_cast<double>(t.trials)) +
              " " + digits(100.0 * low) + " " + digits(100.0 * high) + "\n";
    }
    const std::string name = std::string("$") + c.name, marker = std::to_string(c.marker);
    data += data_block(name, rows);
    plots += (plots.empty() ? "plot " : ", ") + name + " using 1:2:3:4 with " +
             (numbers ? "yerrorlines" : "yerrorbars") + " lc rgb '" + c.colour + "' lw 1.5 pt " +
             marker + " ps 0.8 title '" + c.name + "'";
  }
  std::string out =
      data + kFrame + sheet.margins(box) + sheet.text(about(points), 8, 18) + "set key at screen " +
      sheet.at(480, 42) + " right center horizontal maxrows 1 width -3 samplen 2\nset grid ytics" +
      kThin + "\nset yrange [0:100]\n" + Sheet::axes(literal(axis.key), "'% of trials'");
  if (numbers) {
    const auto [low, high] = std::minmax_element(numbers->begin(), numbers->end());
    const double margin = *high > *low  ? 0.04 * (*high - *low)
                          : *low != 0.0 ? 0.5 * std::abs(*low)
                                        : 1.0;
    out += "set xrange [" + digits(*low - margin) + ":" + digits(*high + margin) + "]\n";
  } else {
    out += "set xrange [-0.5:" + digits(n - 0.5) + "]\nset xtics " +
           tics_of(axis, (box.right - box.left) / n, false) + " noenhanced\n";
  }
  return {Sheet::kWidth, sheet.height, out + plots + "\n", kFont};
}

/// The traversed over two keys.
Figure map_of(const SweepAxis& up, const SweepAxis& right, const std::vector<SweepPoint>& points) {
  const std::size_t columns = right.values.size(), rows = up.values.size();
  std::string data;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const dynamics::GateTally& t = points[i].tally;
    const double share = 100.0 * static_cast<double>(t.traversed()) / static_cast<double>(t.trials);
    data += std::to_string(i % columns) + " " + std::to_string(i / columns) + " " + digits(share) +
            " " + (share > 0.0 && share < 0.05 ? "<.1" : fixed(share, share < 9.95 ? 1 : 0)) + "\n";
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
  const Box box{left, left + wide, 44, 44 + tall};
  const Sheet sheet{static_cast<int>(box.bottom + 66)};
  std::string out = kSequential + data_block("$map", data) + sheet.margins(box) +
                    sheet.text(about(points) + ": traversed, %", 8, 18) + kFrame +
                    "set cbrange [0:100]\n"
                    "set cbtics 25\nset colorbox user origin screen " +
                    sheet.at(box.right + 12, box.bottom) + " size screen " +
                    digits(12.0 / Sheet::kWidth) + "," + digits(tall / sheet.height) +
                    "\nset xrange [-0.5:" + digits(static_cast<double>(columns) - 0.5) +
                    "]\nset yrange [-0.5:" + digits(static_cast<double>(rows) - 0.5) +
                    "]\nset xtics " + tics_of(right, width, false) + " noenhanced\nset ytics " +
                    tics_of(up, height, true) + " noenhanced\n" +
                    Sheet::axes(literal(right.key), literal(up.key)) + "plot $map" + cells();
  if (width >= 28 && height >= 16)
    out += ", '' using 1:2:4:" + ink(100.0) + " with labels tc rgb variable font '," +
           std::to_string(kSmallFont) + "'";
  return {Sheet::kWidth, sheet.height, out + "\n", kFont};
}

}  // namespace

Figure figure_of(const std::vector<SweepAxis>& axes, const std::vector<SweepPoint>& points) {
  if (axes.size() == 1) return curves(axes[0], points);
  if (axes.size() == 2) return map_of(axes[0], axes[1], points);
  throw std::invalid_argument("a figure of a sweep shows one key or two");
}

}  // namespace gatewalk::cli
