// SPDX-License-Identifier: MIT
#include "cli/render/best_start.h"

#include <algorithm>
#include <utility>

#include "cli/render/final_gates.h"
#include "cli/render/health.h"
#include "cli/render/json.h"
#include "cli/render/panel.h"
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
  const lattice::BestStart& found = f.found;
  const StartMap map = map_of(f, found.best.column);
  const bool two = f.ranges.size() > 1;
  Panels out;
  Rows& rows = out.data("$starts");
  double most = 0.0;
  for (std::size_t i = 0; i < map.chance.size(); ++i) {
    const double percent = 100.0 * map.chance[i];
    most = std::max(most, percent);
    if (two)
      rows.add(map.across[i % kParts], map.up[i / kParts], percent);
    else
      rows.add(map.across[i % kParts], percent);
  }
  const auto marked = [&](const char* name, const dynamics::Entry& entry) -> Rows& {
    Rows& place = out.data(name);
    place.add(
        entry.at[f.ranges[0].coordinate],
        two ? entry.at[f.ranges[1].coordinate] : 100.0 * found.chance({found.best.column, entry}));
    return place;
  };
  const Rows &best = marked("$best", found.best.entry), &own = marked("$own", f.own);
  const auto axis = [&](std::size_t r) {
    const dynamics::Coordinate& c = f.shown.map.section.coordinates[f.ranges[r].coordinate];
    const std::string unit = dynamics::behind_number(c.unit);
    return Axis{"start " + c.name + (unit.empty() ? "" : "," + unit), f.ranges[r].low,
                f.ranges[r].high, digits(tic_step(f.ranges[r].high - f.ranges[r].low, 5))};
  };
  const auto half = [](const lattice::CoordinateRange& r) {
    return 0.5 * (r.high - r.low) / kParts;
  };
  const Box box{70, 370, 36, 236};
  Panel& panel = out.add(box);
  const bool here = found.best.column == f.shown.field.start_column();  // as the own start
  panel.say("% crossed by start" +
                (f.columns.size() > 1 ? " in " + column_text(f, found.best.column) : "") +
                ", by the chain; x: best" + (here ? ", +: own" : ""),
            8, 18);
  panel.x = axis(0);
  if (two) {
    panel.y = axis(1);
    panel.colours = {0, most > 0.0 ? most : 1.0, box.beside(), "auto scale 0"};
    panel.draw_cells(rows, half(f.ranges[0]), half(f.ranges[1]));
  } else {
    panel.y = {"% crossed", 0};
    panel.draw(rows, "1:2", "lines", {.colour = kFirstColour, .width = 1.5});
  }
  panel.draw(best, "", "points", {kSecondColour, 2, 2, 1});
  if (here) panel.draw(own, "", "points", {kSecondColour, 2, 1, 1});

  const std::vector<ShareBar> bars{
      {"best", found.crossings.share(), found.crossings.interval_95()},
      {"own", found.crossings_of_own.share(), found.crossings_of_own.interval_95()}};
  const Box below{130, 330, box.bottom + 90, box.bottom + 90 + height_of_bars(bars.size())};
  add_share_bars(out, below, "$crossed", bars)
      .say("crossed, % of trials in full", 8, below.top - 14);
  return out.figure(static_cast<int>(below.bottom) + 12);
}

}  // namespace gatewalk::cli
