// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "cli/render/analysis.h"
#include "cli/render/field_figure.h"
#include "cli/render/final_gates.h"
#include "cli/render/text.h"
#include "cli/render/type_marks.h"

namespace gatewalk::cli {
namespace {

constexpr double kPanelLeft = 78;
constexpr const char* kCurveColours[] = {kFirstColour,  kSecondColour, kThirdColour,
                                         kFourthColour, kFifthColour,  "#666666"};

/// What the panels add to the script, and where the next one begins.
struct Script {
  const Sheet& sheet;
  std::string text;
  double top = 0.0;
};

/// A ring around what a mark is at, in whatever colours it stands.
std::string ringed(const std::string& data) {
  return ", " + data + " with points pt 6 ps 1.3 lw 4 lc rgb '#ffffff', " + data +
         " with points pt 6 ps 1.3 lw 1.5 lc rgb '#000000'";
}

/// Where the start enters its gate, on the map of gates; empty where bodies start as they were
/// seen.
std::string place_of_start(const AnalysedField& f, const FieldMap& map) {
  if (!f.start) return "";
  const dynamics::Face& face = f.shown.map.section.faces[static_cast<std::size_t>(f.start->face)];
  // The first coordinate is the place on a face; in the middle where it is no length.
  const bool is_place = f.shown.map.section.coordinates.front().unit == "m";
  const double aside = is_place ? f.start->at[0] : 0.0;
  const double x = f.shown.field.start_column() - 0.5 * face.di_x +
                   (face.di_x == 0 ? aside / f.shown.width : 0.0),
               y = -0.5 * face.di_y + (face.di_y == 0 ? aside / f.shown.length : 0.0);
  const auto on = [](const FieldMap::Span& span, double gate) {
    return (gate - static_cast<double>(span.first) + 0.5) / static_cast<double>(span.block) - 0.5;
  };
  return digits(on(map.columns, x)) + " " + digits(on(map.rows, y)) + "\n";
}

/// How often gates are visited, the most frequent ways, and where bodies start.
void add_visits(Script& out, const AnalysedField& f) {
  const FieldMap map(f.analysis.totals.visits, 101, 101);
  const markov::CellProbabilities shown = map.blocks_of(f.analysis.totals.visits);
  std::string rows;
  for (Eigen::Index r = 0; r < shown.rows(); ++r)
    for (Eigen::Index c = 0; c < shown.cols(); ++c)
      rows += std::to_string(c) + " " + std::to_string(r) + " " +
              digits(std::sqrt(100.0 * shown(r, c))) + "\n";
  const double side = 318.0, columns = static_cast<double>(shown.cols()),
               lines = static_cast<double>(shown.rows());
  const double cell = std::min(side / columns, 300.0 / lines);
  const Box box{kPanelLeft, kPanelLeft + std::max(120.0, cell * columns), out.top + 50,
                out.top + 50 + std::max(100.0, cell * lines)};
  const RootScale scale(100.0 * shown.maxCoeff());
  const bool blocks = map.rows.block > 1 || map.columns.block > 1;
  std::string paths;
  const auto most = std::min<std::size_t>(f.analysis.paths.paths.size(), 5);
  for (std::size_t k = 0; k < most && !blocks; ++k) {
    // A little aside each, so that they do not hide each other.
    const double aside = 0.09 * (static_cast<double>(k) - 0.5 * static_cast<double>(most - 1));
    for (const std::int64_t cell_of_path : f.analysis.paths.paths[k].cells) {
      const std::int64_t column = cell_of_path % f.shown.field.columns,
                         row = cell_of_path / f.shown.field.columns;
      paths += digits(static_cast<double>(column - map.columns.first) + aside) + " " +
               digits(static_cast<double>(row - map.rows.first) + aside) + "\n";
    }
    paths += "\n";
  }
  const std::string start = place_of_start(f, map);
  const TypeMarks types(f.shown);
  const TypeMarks::Drawn marks =
      types.on(map, (box.right - box.left) / columns, (box.bottom - box.top) / lines, "visits");
  out.text += types.legend(out.sheet, box.bottom + 52, marks.fits) + marks.data +
              data_block("$visits", rows) + data_block("$paths", paths) +
              data_block("$begin", start) + out.sheet.margins(box) + kSequential + "set cbrange " +
              scale.range() + "\n" + kFrame + "set xrange " + range_of(map.columns) +
              "\nset yrange " + range_of(map.rows) + "\nset xtics " +
              tics_of(map.columns, map.middle_column, box.right - box.left, 30) + "\nset ytics " +
              tics_of(map.rows, 0, box.bottom - box.top, 22) + "\n" +
              Sheet::map_axes(map.rows.first + map.rows.count) +
              out.sheet.text("visits of each gate, per 100 bodies", 8, out.top + 18) +
              scale.colours(out.sheet, {box.right + 12, box.right + 22, box.top, box.bottom}) +
              "plot $visits" + cells();
  if (!paths.empty())
    out.text +=
        ", $paths with lines lw 2 lc rgb '#ffffff', $paths with lines lw 1 lc rgb '#d55e00'";
  out.text += marks.plot;
  std::string legend;
  if (!start.empty()) {
    out.text += ringed("$begin");
    legend = "ring: the start";
  }
  out.text += "\nunset label\nunset colorbox\n";
  if (!paths.empty())
    legend += (legend.empty() ? "" : "; ") + std::string("lines: most frequent ways to \"") +
              std::string(target_name(f)) + "\"";
  if (!legend.empty()) out.text += out.sheet.text(legend, 8, out.top + 36, kSmallFont);
  out.top = box.bottom + 62 + types.legend_height();
}

/// Distribution functions of the durations, by ending.
void add_durations(Script& out, const AnalysedField& f) {
  std::vector<std::string> key;
  std::string data, plots;
  double longest = 0.0;
  std::size_t colour = 0;
  for (const EndingName& e : kAllEndingNames) {
    const DurationCurve curve = duration_curve(f.analysis, e.ending);
    const char* const ink = kCurveColours[colour++];
    if (curve.seconds.empty()) continue;
    longest = std::max(longest, curve.seconds.back());
    std::string rows;
    for (std::size_t i = 0; i < curve.seconds.size(); ++i)
      rows += digits(curve.seconds[i]) + " " + digits(100.0 * curve.share[i]) + "\n";
    const std::string name = std::string("$time_") + e.key;
    data += data_block(name, rows);
    const std::string style = std::string(" lw 2 lc rgb '") + ink + "'";
    plots += (plots.empty() ? "plot " : ", ") + name + " using 1:2 with lines" + style;
    key.push_back(std::string("with lines") + style + " title '" + e.name + "'");
    if (!f.direct) continue;
    std::string dots;
    const auto steps = f.direct->costs.durations(e.ending);
    for (int k = 1; k < 10 && !steps.empty(); ++k)
      dots += digits(lattice::quantile(steps, 0.1 * k)) + " " + std::to_string(10 * k) + "\n";
    if (dots.empty()) continue;
    data += data_block(name + "_direct", dots);
    plots += ", " + name + "_direct using 1:2 with points pt 7 ps 0.6 lc rgb '" + ink + "'";
  }
  if (plots.empty()) return;
  out.text += out.sheet.text(f.direct ? "time, % of those that end so; points: full dynamics"
                                      : "time, % of those that end so",
                             8, out.top + 18);
  const Box box{kPanelLeft, 372, out.top + 36, out.top + 196};
  out.text += data + kFrame + out.sheet.margins(box) + "set xrange [0:" + digits(1.02 * longest) +
              "]\nset yrange [0:100]\nset xtics " + digits(tic_step(longest, 5)) +
              "\nset ytics 25\nset grid ytics" + kThin + "\n" +
              Sheet::axes("'time, s'", "'% ended'") + plots + "\nunset label\nunset grid\n" +
              out.sheet.key(388, box.top, key);
  out.text += kFrame;
  out.top = box.bottom + 62;
}

/// The chance of the target from other starts, by the first and the last coordinate; one between
/// them is the start's own.
void add_starts(Script& out, const AnalysedField& f) {
  const auto& coordinates = f.shown.map.section.coordinates;
  if (!f.start || coordinates.size() < 2) return;
  const std::size_t across = 0, up = coordinates.size() - 1;
  const auto& seen = f.analysis.space.trees()[static_cast<std::size_t>(f.start->face)].seen;
  const double most = 100.0 * most_of_starts(f.analysis);
  if (!(seen[across][1] > seen[across][0] && seen[up][1] > seen[up][0] && most > 0.0)) return;
  std::string rows;
  // The start may lie beyond all entries that were seen.
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
    rows += digits(0.5 * (x[0] + x[1])) + " " + digits(0.5 * (y[0] + y[1])) + " " +
            digits(0.5 * (x[1] - x[0])) + " " + digits(0.5 * (y[1] - y[0])) + " " +
            digits(std::sqrt(100.0 * s.chance.mean)) + "\n";
  }
  if (rows.empty()) return;
  const RootScale scale(most);
  const Box box{kPanelLeft, 372, out.top + 36, out.top + 216};
  const auto range = [](const std::array<double, 2>& r) {
    return "[" + digits(r[0]) + ":" + digits(r[1]) + "]";
  };
  const auto axis = [&](std::size_t k) {  // "start vy, m/s"
    const std::string unit = dynamics::behind_number(coordinates[k].unit);
    return "'start " + coordinates[k].name + (unit.empty() ? "" : "," + unit) + "'";
  };
  std::string title = "\"" + std::string(target_name(f)) + "\" by start, %";
  for (std::size_t k = across + 1; k < up; ++k)
    title += "; " + coordinates[k].name + " " + digits(f.start->at[k]) +
             dynamics::behind_number(coordinates[k].unit);
  title += "; ring: the start";
  out.text +=
      data_block("$starts", rows) +
      data_block("$start", digits(f.start->at[across]) + " " + digits(f.start->at[up]) + "\n") +
      kFrame + out.sheet.margins(box) + kSequential + "set cbrange " + scale.range() +
      "\nset xrange " + range(frame(across)) + "\nset yrange " + range(frame(up)) + "\nset xtics " +
      digits(tic_step(frame(across)[1] - frame(across)[0], 5)) + "\nset ytics " +
      digits(tic_step(frame(up)[1] - frame(up)[0], 5)) + "\n" +
      Sheet::axes(axis(across), axis(up)) + out.sheet.text(title, 8, out.top + 18) +
      scale.colours(out.sheet, {box.right + 12, box.right + 22, box.top, box.bottom}) +
      "plot $starts using 1:2:3:4:5 with boxxyerror fillcolor palette fillstyle solid 1.0 "
      "noborder" +
      ringed("$start") + "\nunset label\nunset colorbox\n";
  out.top = box.bottom + 62;
}

/// What would change the target's chance most.
void add_parameters(Script& out, const AnalysedField& f) {
  const auto effects = sorted_effects(f);
  if (effects.empty()) return;
  std::string rows, tics;
  double low = 0.0, high = 0.0;
  for (std::size_t i = 0; i < effects.size(); ++i) {
    const auto& e = effects[i].elasticity;
    const std::string at = std::to_string(-static_cast<int>(i));
    const bool known = std::isfinite(e.interval[0]);  // else a point alone
    const double from = known ? e.interval[0] : e.mean, to = known ? e.interval[1] : e.mean;
    rows += digits(e.mean) + " " + at + " " + digits(from) + " " + digits(to) + "\n";
    const std::string name = literal(std::string(effects[i].key));
    tics += (tics.empty() ? "" : ", ") + name.substr(0, name.rfind(" noenhanced")) + " " + at;
    low = std::min(low, from);
    high = std::max(high, to);
  }
  if (!(high > low)) high = 1.0;  // nothing changes it
  const double margin = 0.05 * (high - low);
  const Box box{236, 488, out.top + 36, out.top + 36 + 22.0 * static_cast<double>(effects.size())};
  out.text += data_block("$effects", rows) + kFrame + out.sheet.margins(box) + "set xrange [" +
              digits(low - margin) + ":" + digits(high + margin) + "]\nset yrange [" +
              digits(0.5 - static_cast<double>(effects.size())) + ":0.5]\nset xtics " +
              digits(tic_step(high - low, 3)) + "\nset ytics (" + tics +
              ") noenhanced font ',12' scale 0\nset arrow 1 from 0," +
              digits(0.5 - static_cast<double>(effects.size())) + " to 0,0.5 nohead" + kThin +
              "\n" + Sheet::x_axis("'% more'") + "unset ylabel\n" +
              out.sheet.text("\"" + std::string(target_name(f)) +
                                 "\": % more often for 1 % more of each number, 95 %",
                             8, out.top + 18) +
              "plot $effects using 1:2:3:4 with xerrorbars pt 7 ps 0.6 lw 1.5 lc rgb '" +
              kFirstColour + "'\nunset label\nunset arrow 1\n";
  out.top = box.bottom + 66;
}

/// How much of the variance of the target's chance each number of --over makes.
void add_shares(Script& out, const AnalysedField& f) {
  if (!f.shares || std::isnan(f.shares->found.indices.variance.mean)) return;
  const lattice::SobolIndices& indices = f.shares->found.indices;
  const std::size_t n = f.shares->ranges.size();
  std::string first, total, tics;
  for (std::size_t i = 0; i < n; ++i) {
    const auto row = [&](const lattice::Mean95& index, double offset) {
      return digits(index.mean) + " " + digits(offset - static_cast<double>(i)) + " " +
             digits(index.interval[0]) + " " + digits(index.interval[1]) + "\n";
    };
    first += row(indices.first[i], 0.15);
    total += row(indices.total[i], -0.15);
    const std::string name = literal(f.shares->ranges[i].key);
    tics += (i == 0 ? "" : ", ") + name.substr(0, name.rfind(" noenhanced")) + " " +
            std::to_string(-static_cast<int>(i));
  }
  const Box box{236, 488, out.top + 36, out.top + 36 + 30.0 * static_cast<double>(n)};
  const auto plotted = [](const char* data, int type, const char* colour) {
    return std::string(data) + " using 1:2:3:4 with xerrorbars pt " + std::to_string(type) +
           " ps 0.7 lw 1.5 lc rgb '" + colour + "'";
  };
  out.text += data_block("$first", first) + data_block("$total", total) + kFrame +
              out.sheet.margins(box) + "set xrange [-0.05:1.05]\nset yrange [" +
              digits(0.5 - static_cast<double>(n)) + ":0.5]\nset xtics 0.2\nset ytics (" + tics +
              ") noenhanced font ',12' scale 0\n" + Sheet::x_axis("'share of the variance, 95 %'") +
              "unset ylabel\n" +
              out.sheet.text("variance of \"" + std::string(target_name(f)) +
                                 "\" by number: alone (dot), with others (ring)",
                             8, out.top + 18) +
              "plot " + plotted("$first", 7, kFirstColour) + ", " +
              plotted("$total", 6, kSecondColour) + "\nunset label\n";
  out.top = box.bottom + 66;
}

std::string drawn(const AnalysedField& f, const Sheet& sheet, double& height) {
  Script out{sheet, "set multiplot\nunset key\n", 0.0};
  add_visits(out, f);
  add_durations(out, f);
  add_starts(out, f);
  add_parameters(out, f);
  add_shares(out, f);
  height = out.top;
  return out.text + "unset multiplot\n";
}

}  // namespace

Figure figure_of(const AnalysedField& f) {
  // Places are parts of the sheet's height, which its panels make.
  double height = 0.0;
  (void)drawn(f, Sheet{1000}, height);
  const Sheet sheet{static_cast<int>(std::ceil(height))};
  return {Sheet::kWidth, sheet.height, drawn(f, sheet, height), kFont};
}

}  // namespace gatewalk::cli
