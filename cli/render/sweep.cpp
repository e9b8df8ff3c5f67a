// SPDX-License-Identifier: MIT
#include "cli/render/sweep.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "cli/fields/csv.h"
#include "cli/fields/text.h"
#include "cli/fields/text_table.h"
#include "cli/render/choice.h"
#include "cli/render/gate_runs.h"
#include "cli/render/health.h"
#include "cli/render/panel.h"
#include "cli/render/scene.h"
#include "dynamics/base/share.h"
#include "lattice/text/text_stream.h"

namespace gatewalk::cli {
namespace {

using dynamics::Outcome;
using dynamics::share_interval;
using lattice::SweepAxis;
using lattice::SweepPoint;

/// A share, as part of a whole. `right_of_traversed` is the share of right traversals among the
/// left and right ones, as in the paper's Fig. 12.
struct Part {
  const char* name;
  std::int64_t part, whole;
};
std::vector<Part> shares_of(const dynamics::GateTally& t) {
  return {{"traversed", t.traversed(), t.trials},
          {"traversed_left", t[Outcome::traversed_left], t.trials},
          {"traversed_right", t[Outcome::traversed_right], t.trials},
          {"exited", t.exited(), t.trials},
          {"trapped", t[Outcome::trapped], t.trials},
          {"right_of_traversed", t[Outcome::traversed_right],
           t[Outcome::traversed_left] + t[Outcome::traversed_right]}};
}

/// "5.1 [3.9, 6.6]", in %; "-" if there are no runs.
std::string share_text(const Part& s) {
  if (s.whole == 0) return "-";
  const auto [low, high] = share_interval(s.part, s.whole);
  return fmt::format("{} [{}, {}]",
                     fixed(100.0 * static_cast<double>(s.part) / static_cast<double>(s.whole), 1),
                     fixed(100.0 * low, 1), fixed(100.0 * high, 1));
}

void describe(Fields& out, const std::vector<SweepAxis>& axes, const SweepPoint& p) {
  out.object({"at", "values of the varied keys at this point"}, [&](Fields& at) {
    for (std::size_t i = 0; i < axes.size(); ++i)
      at.given(
          Field(axes[i].key, "its own", "value of this key of the scene; the key names the unit")
              .varying("<key>"),
          p.values[i]);
  });
  const Part right = shares_of(p.tally).back();
  describe(out, p.tally);
  out.optional(right.whole > 0, [&](Fields& f) {
    f.estimate({right.name, "1", "traversed_right / (traversed_left + traversed_right)"},
               static_cast<double>(right.part) / static_cast<double>(right.whole),
               share_interval(right.part, right.whole));
  });
  describe_method(out, p.settled);
  describe_status(out, p.tally.health);
}

}  // namespace

void describe(Fields& out, const SweepResult& result) {
  out.list({"vary", "the keys of the scene that are varied"}, result.axes,
           [](Fields& f, const SweepAxis& axis) {
             f.text({"key", "name of the varied key of the scene"}, axis.key);
             f.givens({"values", "its own",
                       "values of this key, in their order; the key names the unit"},
                      axis.values);
           });
  out.list({"points", "every combination of the values, the last key varying fastest"},
           result.points,
           [&](Fields& f, const SweepPoint& point) { describe(f, result.axes, point); });
  describe_made_by(out, result.made_by);
}

std::string csv_of(const SweepResult& result) {
  lattice::TextStream out;
  for (const SweepAxis& axis : result.axes) out << axis.key << ',';
  out << "method,trials";
  for (const auto& [outcome, key, words] : dynamics::kOutcomeNames) out << ',' << key << "_count";
  for (const Part& s : shares_of({}))
    out << ',' << s.name << ',' << s.name << "_low," << s.name << "_high";
  out << ",clean\n";
  for (const SweepPoint& p : result.points) {
    const dynamics::GateTally& t = p.tally;
    for (const std::string& value : p.values) out << csv_text(value) << ',';
    out << p.scene.gate.run.method << ',' << t.trials;
    for (const std::int64_t n : t.counts) out << ',' << n;
    for (const Part& s : shares_of(t)) {
      if (s.whole == 0) {
        out << ",,,";  // no share of nothing
        continue;
      }
      const auto [low, high] = share_interval(s.part, s.whole);
      for (const double x : {static_cast<double>(s.part) / static_cast<double>(s.whole), low, high})
        out << ',' << digits(x, 8);
    }
    out << ',' << t.health.clean() << '\n';
  }
  return out.str();
}

namespace {

/// Columns of the varied keys: headed by short keys, or by letters that `legend` explains.
struct KeyColumns {
  std::string legend{};
  std::vector<TextColumn> columns{};

  explicit KeyColumns(const std::vector<SweepAxis>& axes) {
    constexpr std::size_t kMostWide = 30;
    std::size_t wide = 0;
    for (const SweepAxis& axis : axes) wide += axis.key.size() + 2;
    const bool letters = wide > kMostWide;
    for (std::size_t k = 0; k < axes.size(); ++k) {
      const std::string letter(1, static_cast<char>('a' + static_cast<char>(k)));
      columns.push_back({letters ? letter : axes[k].key, kFit, 0, "", "  "});
      if (letters) legend += fmt::format("  {}: {}\n", letter, axes[k].key);
    }
  }
};

/// A line for each of these points.
std::string table_of(const std::vector<SweepAxis>& axes,
                     const std::vector<const SweepPoint*>& points) {
  auto [legend, columns] = KeyColumns(axes);
  for (const char* heading : {"traversed, %", "of these right, %"})
    columns.push_back({heading, 21});
  for (const char* heading : {"exited, %", "trapped, %"}) columns.push_back({heading, 11});
  columns.push_back({});
  TextTable table(columns);
  for (const SweepPoint* p : points) {
    std::vector<TextCell> cells(p->values.begin(), p->values.end());
    const auto shares = shares_of(p->tally);
    const auto share = [&](std::size_t i) {
      return fixed(
          100.0 * static_cast<double>(shares[i].part) / static_cast<double>(shares[i].whole), 1);
    };
    for (const std::string& text :
         {share_text(shares[0]), share_text(shares[5]), share(3), share(4)})
      cells.emplace_back(text);
    if (!p->tally.health.clean()) cells.emplace_back("  faults");
    table.row(cells);
  }
  return legend + table.text();
}

// Points on the first screen if there are more than most_shown(); fewer below a legend.
constexpr std::size_t kShown = 8, kBelowLegend = 6;

/// The largest number of points that the first screen lists one and all; a legend of the keys
/// leaves room for fewer.
std::size_t most_shown(const std::vector<SweepAxis>& axes) {
  return std::max(kShown, 10 - (KeyColumns(axes).legend.empty() ? 0 : axes.size()));
}

}  // namespace

std::string answer_text(const SweepResult& result) {
  std::vector<const SweepPoint*> points;
  for (const SweepPoint& p : result.points) points.push_back(&p);
  std::string text;
  if (points.size() > most_shown(result.axes)) {  // shows those where most and fewest traverse
    std::ranges::stable_sort(points, [](const SweepPoint* a, const SweepPoint* b) {
      return a->tally.traversed() > b->tally.traversed();
    });
    const bool has_legend = !KeyColumns(result.axes).legend.empty();
    const auto half = static_cast<std::ptrdiff_t>((has_legend ? kBelowLegend : kShown) / 2);
    points.erase(points.begin() + half, points.end() - half);
    text = fmt::format(
        "{} of the points at which most runs traverse, and {} of those with fewest:\n", half, half);
  }
  return text + table_of(result.axes, points) +
         fmt::format("From {} of {}, all with the same random numbers; 95 % intervals.\n",
                     counted(std::ssize(result.points), "point", "points"),
                     counted(result.points.front().tally.trials, "trial", "trials"));
}

std::string details_text(const SweepResult& result, const lattice::Scene& scene) {
  std::string text = "\nAll other numbers are those of the scene:\n" + scene_line(scene);
  if (result.points.size() <= most_shown(result.axes)) return text;
  std::vector<const SweepPoint*> points;
  for (const SweepPoint& p : result.points) points.push_back(&p);
  return text + "\nAll points\n" + table_of(result.axes, points);
}

namespace {

/// The values as numbers; nullopt if one of them is not a number.
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

/// An axis with values at 0, 1, 2, ... that has this many points for each value. If tics would
/// touch, some are left out.
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

/// Draws shares with their intervals over one key.
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

/// Draws the share that traversed over two keys.
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
  // The upright name of the axis needs 8 points a letter.
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
