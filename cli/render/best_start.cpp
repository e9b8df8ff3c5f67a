// SPDX-License-Identifier: MIT
#include "cli/render/best_start.h"

#include <algorithm>
#include <utility>

#include "cli/render/final_gates.h"
#include "cli/render/health.h"
#include "cli/render/json.h"
#include "cli/render/plan.h"
#include "cli/render/start.h"
#include "cli/render/text.h"

namespace gatewalk::cli {
namespace {

constexpr int kParts = 40;  // of each range in a map

std::string column_text(const FoundStart& f, int column) {
  return "i_x " + std::to_string(column - f.shown.field.start_column());
}

/// The start of a column that the chain takes for the best, on the map.
double best_in(const FoundStart& f, int column) {
  const std::vector<double> chance = map_of(f, column).chance;
  return *std::max_element(chance.begin(), chance.end());
}

std::string verdict(const FoundStart& f) {
  if (f.found.own)
    return "no start was found that is better than the own one by more than chance\n";
  const std::string gain = gain_text(f.found.gain);
  if (f.found.gain.interval_95[0] > 0.0) return "it gains " + gain + " points over the own start\n";
  return "it is not shown to gain anything over the own start: " + gain +
         " points; a smaller --accuracy\nshows a smaller gain, if there is one\n";
}

}  // namespace

StartMap map_of(const FoundStart& f, int column) {
  StartMap map;
  const auto middles = [](const lattice::CoordinateRange& range) {
    std::vector<double> all;
    for (int i = 0; i < kParts; ++i)
      all.push_back(range.low + (i + 0.5) * (range.high - range.low) / kParts);
    return all;
  };
  lattice::TrialStart at{column, f.found.best.entry};
  const bool two = f.ranges.size() > 1;
  map.across = middles(f.ranges[0]);
  map.up = two ? middles(f.ranges[1]) : std::vector<double>{0.0};
  for (const double y : map.up)
    for (const double x : map.across) {
      at.entry.at[f.ranges[0].coordinate] = x;
      if (two) at.entry.at[f.ranges[1].coordinate] = y;
      map.chance.push_back(f.found.chance(at));
    }
  return map;
}

Json to_json(const FoundStart& f) {
  const dynamics::Section& section = f.shown.map.section;
  const lattice::BestStart& found = f.found;
  Json json;
  json["crossed"] = found.crossings.share();
  json["interval_95"] = found.crossings.interval_95();
  json["trials"] = found.crossings.trials;
  json["chain"] = found.chance(found.best);
  json["start"] = to_json(section, Start(found.best.entry));
  json["start"]["i_x"] = found.best.column - f.shown.field.start_column();
  json["is_own"] = found.own;
  json["own"] = {{"start", to_json(section, Start(f.own))},
                 {"crossed", found.crossings_of_own.share()},
                 {"interval_95", found.crossings_of_own.interval_95()}};
  json["gain"] = found.gain.difference;
  json["gain_95"] = gain_95(found.gain);
  for (const lattice::CoordinateRange& range : f.ranges)
    json["ranges"][section.coordinates[range.coordinate].key] = {range.low, range.high};
  for (const int column : f.columns) {
    const StartMap map = map_of(f, column);
    Json of{{"i_x", column - f.shown.field.start_column()}};
    const auto name = [&](std::size_t r) {
      return section.coordinates[f.ranges[r].coordinate].key;
    };
    of[name(0)] = map.across;
    if (f.ranges.size() > 1) of[name(1)] = map.up;
    for (std::size_t row = 0; row < map.up.size(); ++row)
      of["chance"].push_back(std::vector<double>(
          map.chance.begin() + static_cast<std::ptrdiff_t>(row * kParts),
          map.chance.begin() + static_cast<std::ptrdiff_t>((row + 1) * kParts)));
    json["starts"].push_back(std::move(of));
  }
  json["rounds"] = found.rounds;
  json["settled"] = found.settled;
  json["gate_runs"] = found.gate_runs;
  json["seconds"] = f.seconds;
  json["status"] = to_json(found.health);
  return json;
}

std::string table_of(const FoundStart& f) {
  const dynamics::Section& section = f.shown.map.section;
  const lattice::BestStart& found = f.found;
  const bool several = f.columns.size() > 1;
  const auto line = [&](const std::string& name, const lattice::TrialStart& start,
                        const lattice::Crossings& crossings) {
    return "  " + padded(name, -6) +
           padded(with_interval(crossings.share(), crossings.interval_95()), 22) + "   " +
           title_of(section, start.entry) + (several ? ", " + column_text(f, start.column) : "") +
           "\n";
  };
  std::string table =
      "chance to cross: " + with_interval(found.crossings.share(), found.crossings.interval_95()) +
      " % of " + std::to_string(found.crossings.trials) + " trials by which nothing was chosen\n" +
      verdict(f) + "\n" + padded("crossed, %", 30) + "\n" +
      line("best", found.best, found.crossings) +
      line("own", {f.shown.field.start_column(), f.own}, found.crossings_of_own);
  if (several) {
    table += "\nthe best start of each column, by the chain:\n";
    for (const int column : f.columns)
      table += padded(column_text(f, column), 10) +
               padded(fixed(100.0 * best_in(f, column), 2) + " %", 12) + "\n";
  }
  return table + std::to_string(found.gate_runs) + " gate runs in " + std::to_string(found.rounds) +
         (found.rounds == 1 ? " round, " : " rounds, ") + fixed(f.seconds, 1) + " s\n";
}

Figure figure_of(const FoundStart& f) {
  const dynamics::Section& section = f.shown.map.section;
  const lattice::BestStart& found = f.found;
  const StartMap map = map_of(f, found.best.column);
  const auto axis = [&](std::size_t r) {
    const dynamics::Coordinate& c = section.coordinates[f.ranges[r].coordinate];
    const std::string unit = dynamics::behind_number(c.unit);
    return "'start " + c.name + (unit.empty() ? "" : "," + unit) + "'";
  };
  const auto range = [](const lattice::CoordinateRange& r) {
    return "[" + digits(r.low) + ":" + digits(r.high) + "]";
  };
  const auto tics = [](const lattice::CoordinateRange& r) {
    return digits(tic_step(r.high - r.low, 5));
  };
  const auto place = [&](const dynamics::Entry& entry) {
    return digits(entry.at[f.ranges[0].coordinate]) + " " +
           digits(f.ranges.size() > 1 ? entry.at[f.ranges[1].coordinate]
                                      : 100.0 * found.chance({found.best.column, entry})) +
           "\n";
  };
  const std::vector<ShareBar> bars{
      {"best", found.crossings.share(), found.crossings.interval_95()},
      {"own", found.crossings_of_own.share(), found.crossings_of_own.interval_95()}};
  const Box box{70, 370, 36, 236};
  const Box bars_box{130, 330, box.bottom + 90, box.bottom + 90 + height_of_bars(bars.size())};
  const Sheet sheet{static_cast<int>(bars_box.bottom) + 12};
  const bool two = f.ranges.size() > 1;
  std::string rows;
  double most = 0.0;
  for (std::size_t i = 0; i < map.chance.size(); ++i) {
    const double percent = 100.0 * map.chance[i];
    most = std::max(most, percent);
    rows += digits(map.across[i % kParts]) + " " +
            (two ? digits(map.up[i / kParts]) + " " : std::string()) + digits(percent) + "\n";
  }
  const auto half = [](const lattice::CoordinateRange& r) {
    return 0.5 * (r.high - r.low) / kParts;
  };
  std::string plot =
      two ? std::string(kSequential) + "set cbrange [0:" + digits(most > 0.0 ? most : 1.0) +
                "]\nset cbtics auto scale 0\nset colorbox user origin screen " +
                sheet.at(box.right + 12, box.bottom) + " size screen " +
                digits(10.0 / Sheet::kWidth) + "," + digits((box.bottom - box.top) / sheet.height) +
                "\nset yrange " + range(f.ranges[1]) + "\nset ytics " + tics(f.ranges[1]) + "\n" +
                Sheet::axes(axis(0), axis(1)) + "plot $starts" +
                cells(half(f.ranges[0]), half(f.ranges[1]))
          : "set yrange [0:*]\nset ytics auto\n" + Sheet::axes(axis(0), "'% crossed'") +
                "plot $starts using 1:2 with lines lw 1.5 lc rgb '" + std::string(kFirstColour) +
                "'";
  const auto marked = [](int type) {
    return " with points pt " + std::to_string(type) + " ps 1 lw 2 lc rgb '" + kSecondColour + "'";
  };
  const bool here = found.best.column == f.shown.field.start_column();  // as the own start
  const std::string column = f.columns.size() > 1 ? " in " + column_text(f, found.best.column) : "";
  return {Sheet::kWidth, sheet.height,
          "set multiplot\n" + data_block("$starts", rows) +
              data_block("$best", place(found.best.entry)) + data_block("$own", place(f.own)) +
              sheet.margins(box) + kFrame + "set xrange " + range(f.ranges[0]) + "\nset xtics " +
              tics(f.ranges[0]) + "\n" +
              sheet.text("% crossed by start" + column + ", by the chain; x: best" +
                             (here ? ", +: own" : ""),
                         8, 18) +
              plot + ", $best" + marked(2) + (here ? ", $own" + marked(1) : "") +
              "\nunset label\nunset colorbox\n" +
              sheet.text("crossed, % of trials in full", 8, bars_box.top - 14) +
              share_bars(sheet, bars_box, "$crossed", bars) + "unset multiplot\n",
          kFont};
}

}  // namespace gatewalk::cli
