// SPDX-License-Identifier: MIT
#include "cli/render/best_start.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "cli/fields/text.h"
#include "cli/fields/text_table.h"
#include "cli/render/choice.h"
#include "cli/render/crossings.h"
#include "cli/render/final_gates.h"
#include "cli/render/panel.h"
#include "cli/render/start.h"
#include "lattice/source/start_text.h"

namespace gatewalk::cli {
namespace {

constexpr int kParts = 40;  // parts of each range in a map

std::string column_text(const FoundStart& f, int column) {
  return fmt::format("i_x {}", column - f.shown.field.start_column());
}

/// The best start in a column, by the chain.
double best_in(const FoundStart& f, int column) {
  const std::vector<double> chance = map_of(f, column).chance;
  return *std::max_element(chance.begin(), chance.end());
}

std::string gain_verdict(const FoundStart& f) {
  if (f.found.own)
    return "The scene's own start is the best known: none was found that is better by more than "
           "chance.\n";
  return gain_sentence(f.found.gain, "The best start", "the scene's own");
}

void describe_column(Fields& out, const FoundStart& f, int column) {
  out.count({"i_x", "1", "column of gates in which bodies enter; 0: the field's start column"},
            column - f.shown.field.start_column());
}

/// The map of a column.
void describe_map(Fields& out, const FoundStart& f, int column) {
  const StartMap map = map_of(f, column);
  describe_column(out, f, column);
  const auto middles = [&](std::size_t range, const std::vector<double>& numbers) {
    const dynamics::Coordinate& c = f.shown.map.section.coordinates[f.ranges[range].coordinate];
    out.numbers(Field(c.key, "its own",
                      "values of the coordinate for which the grid gives the chance; the key names "
                      "their unit")
                    .varying("<coordinate>"),
                numbers);
  };
  middles(0, map.across);
  if (f.ranges.size() > 1) middles(1, map.up);
  const markov::CellProbabilities chance = Eigen::Map<const markov::CellProbabilities>(
      map.chance.data(), std::ssize(map.up), std::ssize(map.across));
  out.grid(
      {"chance", "1",
       "chance to cross by the chain: columns by the first range, rows by the second if given"},
      chance);
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

void describe(Fields& out, const FoundStart& f) {
  const lattice::BestStart& found = f.found;
  const dynamics::Section& section = f.shown.map.section;
  describe_chance(out, found.crossings, found.chance(found.best));
  out.object({"start", "the best start"}, [&](Fields& start) {
    describe(start, section, found.best.entry);
    describe_column(start, f, found.best.column);
  });
  out.flag({"is_own",
            "whether the scene's own start is kept: none was better by more than a standard error, "
            "or not in new trials"},
           found.own);
  out.object({"own", "the start of the scene, or of --start"}, [&](Fields& own) {
    describe_start(own, {"start", "entry of the body into the field"}, section, f.own);
    describe_crossed(own, "share of trials from this start that crossed", found.crossings_of_own);
  });
  describe_gain(out,
                "share crossed from the best start less that from the own start, in new trials",
                found.gain);
  out.object(
      {"ranges", "the ranges that were searched, by the keys of start"}, [&](Fields& ranges) {
        for (const lattice::CoordinateRange& range : f.ranges) {
          const dynamics::Coordinate& c = section.coordinates[range.coordinate];
          ranges.numbers(Field(c.key, "its own",
                               "lowest and highest value that was searched; the key names the unit")
                             .varying("<coordinate>"),
                         {range.low, range.high});
        }
      });
  out.list({"starts", "chance to cross by start, a map for each column that was searched"},
           f.columns, [&](Fields& map, int column) { describe_map(map, f, column); });
  describe_search(out, found, f.seconds);
  describe_method(out, f.method);
  describe_made_by(out, f.made_by);
}

std::string answer_text(const FoundStart& f) {
  const lattice::BestStart& found = f.found;
  const bool several = f.columns.size() > 1;
  TextTable table({{"", -8}, {"crossed, %", 22}, {}});
  const auto line = [&](const char* name, const lattice::TrialStart& start,
                        const lattice::Crossings& crossings) {
    table.row({name, with_interval(crossings.share(), crossings.interval_95()),
               "   " + lattice::title_of(f.shown.map.section, start.entry) +
                   (several ? ", " + column_text(f, start.column) : "")});
  };
  line("  best", found.best, found.crossings);
  line("  own", {f.shown.field.start_column(), f.own}, found.crossings_of_own);
  return chance_text(found.crossings, " from the best start") + gain_verdict(f) + table.text() +
         basis_text(found);
}

std::string details_text(const FoundStart& f) {
  std::string text = "\n";
  if (f.columns.size() > 1) {
    text += "Chance to cross from the best start of each column, by the chain:\n";
    TextTable columns({{"", 10}, {"", 12, 2, "%"}});
    for (const int column : f.columns)
      columns.row({column_text(f, column), 100.0 * best_in(f, column)});
    text += columns.text();
  }
  return text + fmt::format("{}Time: {} s.\n", method_line(f.method), fixed(f.seconds, 1));
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
  const bool here = found.best.column == f.shown.field.start_column();  // in the scene's own column
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

  const double end = add_crossings(out, box.bottom + 90, "crossed, % of trials in full",
                                   {{"best", found.crossings}, {"own", found.crossings_of_own}});
  return out.figure(static_cast<int>(end) + 12);
}

}  // namespace gatewalk::cli
