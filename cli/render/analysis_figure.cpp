// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "cli/render/analysis.h"
#include "cli/render/field_figure.h"
#include "cli/render/final_gates.h"
#include "cli/render/type_marks.h"

namespace gatewalk::cli {
namespace {

constexpr double kPanelLeft = 78;
constexpr const char* kCurveColours[] = {kFirstColour,  kSecondColour, kThirdColour,
                                         kFourthColour, kFifthColour,  "#666666"};

/// Draws a ring that is visible on any colour.
void draw_ring(Panel& panel, const Rows& rows) {
  panel.draw_outlined(rows, "", "points", {"#ffffff", 4, 6, 1.3}, {"#000000", 1.5, 6, 1.3});
}

/// Adds the place where the start enters its gate on the map of gates; nothing for a start drawn
/// from first entries.
void add_place_of_start(Rows& rows, const AnalysedField& f, const FieldMap& map) {
  if (!f.start) return;
  const dynamics::Face& face = f.shown.map.section.faces[static_cast<std::size_t>(f.start->face)];
  // The first coordinate is the place on a face if it is a length; else the middle of the face is
  // marked.
  const bool is_place = f.shown.map.section.coordinates.front().unit == "m";
  const double aside = is_place ? f.start->at[0] : 0.0;
  const double x = f.shown.field.start_column() - 0.5 * face.di_x +
                   (face.di_x == 0 ? aside / f.shown.width : 0.0),
               y = f.shown.field.start_row - 0.5 * face.di_y +
                   (face.di_y == 0 ? aside / f.shown.length : 0.0);
  const auto on = [](const FieldMap::Span& span, double gate) {
    return (gate - static_cast<double>(span.first) + 0.5) / static_cast<double>(span.block) - 0.5;
  };
  rows.add(on(map.columns, x), on(map.rows, y));
}

// Each function below draws a panel that begins at `top`, and returns where the next one begins.

/// How often gates are visited, the most frequent paths, and the starts.
double add_visits(Panels& out, const AnalysedField& f, double top) {
  const FieldMap map(f.analysis.totals.visits, f.shown.field.start_column(), 101, 101);
  Rows &visits = out.data("$visits"), &paths = out.data("$paths"), &begin = out.data("$begin");
  add_shares(visits, map, f.analysis.totals.visits);
  const auto most = std::min<std::size_t>(f.analysis.paths.paths.size(), 5);
  const bool blocks = map.rows.block > 1 || map.columns.block > 1;
  for (std::size_t k = 0; k < most && !blocks; ++k) {
    // Paths are shifted a little, so that they do not hide each other.
    const double aside = 0.09 * (static_cast<double>(k) - 0.5 * static_cast<double>(most - 1));
    for (const std::int64_t cell : f.analysis.paths.paths[k].cells)
      paths.add(static_cast<double>(cell % f.shown.field.columns - map.columns.first) + aside,
                static_cast<double>(cell / f.shown.field.columns - map.rows.first) + aside);
    paths.gap();
  }
  add_place_of_start(begin, f, map);

  const auto columns = static_cast<double>(map.columns.blocks()),
             rows = static_cast<double>(map.rows.blocks());
  const double cell = std::min(318.0 / columns, 300.0 / rows);
  const TypeMarks types(f.shown);
  Panel& panel = add_map(out, map,
                         {kPanelLeft, kPanelLeft + std::max(120.0, cell * columns), top + 50,
                          top + 50 + std::max(100.0, cell * rows)});
  panel.say("visits of each gate, per 100 bodies", 8, top + 18);
  add_colours(panel, RootScale(100.0 * map.blocks_of(f.analysis.totals.visits).maxCoeff()),
              panel.box.beside());
  panel.draw_cells(visits);
  panel.draw_outlined(paths, "", "lines", {"#ffffff", 2}, {kSecondColour, 1});
  const bool marked = types.draw_on(out, panel, map, "visits");
  draw_ring(panel, begin);
  std::string legend = begin.empty() ? "" : "ring: the start";
  if (!paths.empty())
    legend += (legend.empty() ? "" : "; ") + std::string("lines: most frequent ways to \"") +
              std::string(target_name(f)) + "\"";
  if (!legend.empty()) panel.say(legend, 8, top + 36, kSmallFont);
  types.add_legend(panel, panel.box.bottom + 52, marked);
  return panel.box.bottom + 62 + types.legend_height();
}

/// Distribution functions of the durations, by ending.
double add_durations(Panels& out, const AnalysedField& f, double top) {
  Panel panel({kPanelLeft, 372, top + 36, top + 196});
  std::vector<Layer> key;
  double longest = 0.0;
  std::size_t colour = 0;
  for (const EndingName& e : kAllEndingNames) {
    const DurationCurve curve = duration_curve(f.analysis, e.ending);
    const char* const ink = kCurveColours[colour++];
    if (curve.seconds.empty()) continue;
    longest = std::max(longest, curve.seconds.back());
    Rows& rows = out.data(std::string("$time_") + e.key);
    for (std::size_t i = 0; i < curve.seconds.size(); ++i)
      rows.add(curve.seconds[i], 100.0 * curve.share[i]);
    panel.draw(rows, "1:2", "lines", {ink, 2});
    key.push_back(entry("lines", {ink, 2}, e.name));
    if (!f.direct) continue;
    Rows dots(rows.name() + "_direct");
    const auto steps = f.direct->costs.durations(e.ending);
    for (int k = 1; k < 10 && !steps.empty(); ++k)
      dots.add(lattice::quantile(steps, 0.1 * k), 10 * k);
    if (!dots.empty())
      panel.draw(out.data(dots), "1:2", "points", {.colour = ink, .mark = 7, .size = 0.6});
  }
  if (panel.layers.empty()) return top;
  panel.say(f.direct ? "time, % of those that end so; points: full dynamics"
                     : "time, % of those that end so",
            8, top + 18);
  panel.x = {"time, s", 0, 1.02 * longest, digits(tic_step(longest, 5))};
  panel.y = {"% ended", 0, 100, "25"};
  panel.grid = std::string("ytics") + kThin;
  const Box box = out.add(std::move(panel)).box;
  out.add_key(388, box.top, std::move(key));
  return box.bottom + 62;
}

/// The probability of the target from other starts, by the first and the last coordinate. A
/// coordinate between these is the start's own.
double add_starts(Panels& out, const AnalysedField& f, double top) {
  const auto& coordinates = f.shown.map.section.coordinates;
  if (!f.start || coordinates.size() < 2) return top;
  const std::size_t across = 0, up = coordinates.size() - 1;
  const auto& seen = f.analysis.space.trees()[static_cast<std::size_t>(f.start->face)].seen;
  const double most = 100.0 * most_of_starts(f.analysis);
  if (!(seen[across][1] > seen[across][0] && seen[up][1] > seen[up][0] && most > 0.0)) return top;
  Rows rows("$starts");
  // The start may lie beyond all entries that were observed.
  const auto frame = [&](std::size_t k) {
    const double margin = 0.03 * (seen[k][1] - seen[k][0]), at = f.start->at[k];
    return std::array<double, 2>{at < seen[k][0] ? at - margin : seen[k][0],
                                 at > seen[k][1] ? at + margin : seen[k][1]};
  };
  const auto within = [](const std::array<double, 2>& range, const std::array<double, 2>& shown) {
    return std::array<double, 2>{std::max(range[0], shown[0]), std::min(range[1], shown[1])};
  };
  const auto holds_the_others = [&](const dynamics::StateRange& range) {
    for (std::size_t k = across + 1; k < up; ++k)
      if (f.start->at[k] < range.at[k][0] || f.start->at[k] >= range.at[k][1]) return false;
    return true;
  };
  for (const lattice::StartChance& s : f.analysis.starts) {
    if (std::isnan(s.chance.mean) || !holds_the_others(s.range)) continue;
    const auto x = within(s.range.at[across], frame(across)), y = within(s.range.at[up], frame(up));
    if (!(x[1] > x[0] && y[1] > y[0])) continue;
    rows.add(0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1]), 0.5 * (x[1] - x[0]), 0.5 * (y[1] - y[0]),
             std::sqrt(100.0 * s.chance.mean));
  }
  if (rows.empty()) return top;
  const auto axis = [&](std::size_t k) {  // "start vy, m/s"
    const std::string unit = dynamics::behind_number(coordinates[k].unit);
    const auto [low, high] = frame(k);
    return Axis{"start " + coordinates[k].name + (unit.empty() ? "" : "," + unit), low, high,
                digits(tic_step(high - low, 5))};
  };
  std::string title = "\"" + std::string(target_name(f)) + "\" by start, %";
  for (std::size_t k = across + 1; k < up; ++k)
    title += "; " + coordinates[k].name + " " + digits(f.start->at[k]) +
             dynamics::behind_number(coordinates[k].unit);
  Panel& panel = out.add({kPanelLeft, 372, top + 36, top + 216});
  panel.say(title + "; ring: the start", 8, top + 18);
  panel.x = axis(across);
  panel.y = axis(up);
  add_colours(panel, RootScale(most), panel.box.beside());
  panel.draw(out.data(rows), "1:2:3:4:5", kBars, {kByPalette});
  Rows& start = out.data("$start");
  start.add(f.start->at[across], f.start->at[up]);
  draw_ring(panel, start);
  return panel.box.bottom + 62;
}

/// Adds a panel of numbers with intervals, a row for each name.
Panel& add_rows(Panels& out, double top, double row_height, const std::vector<Tic>& names,
                const std::string& title) {
  const auto n = static_cast<double>(names.size());
  Panel& panel = out.add({236, 488, top + 36, top + 36 + row_height * n});
  panel.say(title, 8, top + 18);
  panel.y = {"", 0.5 - n, 0.5, tics_of(names) + " noenhanced font ',12' scale 0"};
  return panel;
}

/// The parameters that change the target's probability most.
double add_parameters(Panels& out, const AnalysedField& f, double top) {
  const auto effects = sorted_effects(f);
  if (effects.empty()) return top;
  Rows& rows = out.data("$effects");
  std::vector<Tic> names;
  double low = 0.0, high = 0.0;
  for (const auto& effect : effects) {
    const auto& e = effect.elasticity;
    const bool known = std::isfinite(e.interval[0]);  // without an interval only a point is drawn
    const double from = known ? e.interval[0] : e.mean, to = known ? e.interval[1] : e.mean;
    names.push_back({std::string(effect.key), static_cast<double>(-std::ssize(names))});
    rows.add(e.mean, names.back().at, from, to);
    low = std::min(low, from);
    high = std::max(high, to);
  }
  if (!(high > low)) high = 1.0;  // no parameter has an effect
  const double margin = 0.05 * (high - low);
  Panel& panel = add_rows(
      out, top, 22.0, names,
      "\"" + std::string(target_name(f)) + "\": % more often for 1 % more of each number, 95 %");
  panel.x = {"% more", low - margin, high + margin, digits(tic_step(high - low, 3))};
  panel.uprights.push_back({0.0, {kInk, 0.2}});
  panel.draw(rows, "1:2:3:4", "xerrorbars", {kFirstColour, 1.5, 7, 0.6});
  return panel.box.bottom + 66;
}

/// The share of each number of --over in the variance of the target's probability.
double add_variances(Panels& out, const AnalysedField& f, double top) {
  if (!f.shares || std::isnan(f.shares->found.indices.variance.mean)) return top;
  const lattice::SobolIndices& indices = f.shares->found.indices;
  Rows &first = out.data("$first"), &total = out.data("$total");
  std::vector<Tic> names;
  for (std::size_t i = 0; i < f.shares->ranges.size(); ++i) {
    const auto at = static_cast<double>(-std::ssize(names));
    names.push_back({f.shares->ranges[i].key, at});
    first.add(indices.first[i].mean, at + 0.15, indices.first[i].interval);
    total.add(indices.total[i].mean, at - 0.15, indices.total[i].interval);
  }
  Panel& panel = add_rows(out, top, 30.0, names,
                          "variance of \"" + std::string(target_name(f)) +
                              "\" by number: alone (dot), with others (ring)");
  panel.x = {"share of the variance, 95 %", -0.05, 1.05, "0.2"};
  panel.draw(first, "1:2:3:4", "xerrorbars", {kFirstColour, 1.5, 7, 0.7});
  panel.draw(total, "1:2:3:4", "xerrorbars", {kSecondColour, 1.5, 6, 0.7});
  return panel.box.bottom + 66;
}

}  // namespace

Figure figure_of(const AnalysedField& f) {
  Panels out;
  double end = 0.0;
  for (const auto add : {add_visits, add_durations, add_starts, add_parameters, add_variances})
    end = add(out, f, end);
  return out.figure(static_cast<int>(std::ceil(end)));
}

}  // namespace gatewalk::cli
