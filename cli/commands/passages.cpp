// SPDX-License-Identifier: MIT
#include <cmath>

#include "cli/command.h"
#include "cli/render/cut_tracks.h"
#include "lattice/recorded/cut_tracks.h"
#include "lattice/recorded/visits.h"
#include "lattice/source/source.h"
#include "lattice/source/source_file.h"
#include "lattice/text/digits.h"

namespace gatewalk::cli {
namespace {

struct PassagesCommand : Options {
  using Options::Options;
  TextsOption tracks =
      positional_list("tracks",
                      "tables with a line for each place (CSV), CSV of DeepLabCut, or NetCDF of "
                      "movement; several recordings make one RUNS.csv");
  TextOption cell_file =
      input_file("cell", "cell.toml: size of the cells, and what is measured of an entry");
  TextOption output =
      main_output_file("RUNS.csv", "write the passages, a line each", Options::Content::binary);
  NumberOption fastest = add_number(
      "fastest", "M/S",
      "highest speed from frame to frame, noise included; a faster step is a jump (must be "
      "given)");
  TextOption columns =
      add_text("columns", "MEANING=NAME,...",
               "columns of a table: body=..., frame=... or time=..., x=..., y=..., confidence=...; "
               "x=x*,y=y* where each body has columns of its own");
  NumberOption fps = add_number("fps", "N", "frames per second");
  NumberOption metres_per_unit =
      add_number("metres-per-unit", "X",
                 "length of one unit of x and y in metres, unless the file says it; 1: metres");
  TextOption key_point = add_text("key-point", "NAME", "the key point to take as the body's place");
  NumberOption confidence =
      add_number("confidence", "X", "take places with less confidence as not seen");
  TextOption origin = add_text(
      "origin", "X,Y", "lower left corner of column 0 and row 0, in the file's unit", "0,0");
  Option y_down =
      add_flag("y-down", "y grows downwards in the file, as in images (default: upwards)");
  TextOption cells =
      add_text("lattice", "COLUMNS,ROWS",
               "number of cells from the origin on; all: no limit (default: those of the field)");
  CountOption bridge = add_count("bridge", "N", "bridge gaps of up to N missing frames", "0");
  TextOption visits = output_file(
      "visits", "FILE.csv", "write when each body entered and left which cell, and by which faces");
  TextOption transitions =
      output_file("transitions", "FILE.csv",
                  "write how often bodies went from one cell to another, and after what mean time");
  TextOption figure = add_figure("all tracks over the cells, and where they were cut");
};

/// Reads two numbers with a comma between them.
std::array<double, 2> pair_of(const TextOption& option) {
  const std::string text = option.value();
  std::string_view rest = text;
  const auto first = lattice::take_number(rest);
  const bool has_comma = rest.starts_with(',');
  if (has_comma) rest.remove_prefix(1);
  const auto second = lattice::take_number(rest);
  if (!first || !has_comma || !second || !rest.empty() || !std::isfinite(*first) ||
      !std::isfinite(*second))
    throw UsageError("--" + option.name() + " " + text +
                     ": must be two numbers with a comma between");
  return {*first, *second};
}

lattice::TrackOptions track_options(const PassagesCommand& options) {
  const auto number = [](const NumberOption& option) {
    return option ? std::optional(option.value()) : std::nullopt;
  };
  const auto origin = pair_of(options.origin);
  return {.columns = options.columns.value(),
          .fps = number(options.fps),
          .metres_per_unit = number(options.metres_per_unit),
          .confidence = number(options.confidence),
          .key_point = options.key_point.value(),
          .origin_x = origin[0],
          .origin_y = origin[1],
          .y_down = static_cast<bool>(options.y_down)};
}

lattice::CutOptions cut_options(const PassagesCommand& options) {
  if (!options.fastest)
    throw UsageError(
        "missing --fastest M/S: how fast bodies can be; a faster step counts as a jump");
  lattice::CutOptions cut{.fastest = options.fastest.value(),
                          .bridge = static_cast<int>(options.bridge.value(0, 1000))};
  const std::string text = options.cells.value();
  cut.endless = text == "all";
  if (text.empty() || cut.endless) return cut;
  const auto [columns, rows] = pair_of(options.cells);
  const auto is_size = [](double x) { return x >= 1.0 && x <= 1e6 && x == std::floor(x); };
  if (!is_size(columns) || !is_size(rows))
    throw UsageError("--lattice " + text + ": must be two whole numbers from 1, or all");
  cut.columns = static_cast<int>(columns);
  cut.rows = static_cast<int>(rows);
  return cut;
}

std::vector<std::string> next_of(const CutResult& result, const std::string& runs,
                                 const std::string& cell) {
  if (runs == "-" || result.cut.is_off()) return {};
  return {"gatewalk build " + shell_quoted(runs) + " --cell " + shell_quoted(cell) +
          " -o chain.nc  # makes a chain of the passages"};
}

}  // namespace

int run_passages(const Arguments& arguments) {
  PassagesCommand options(
      "passages TRACKS... --cell CELL.toml -o RUNS.csv [options]",
      "Cuts the tracks of your animals or robots at the borders of cells into passages; gatewalk "
      "build\n"
      "makes a chain of them. Options give what the file does not say: units, frames per second, "
      "columns.\n"
      "A body that is in a cell during a gap or a jump of its track counts as lost there.",
      "gatewalk sample tracks -o tracks.csv\n"
      "  gatewalk sample cell -o cell.toml\n"
      "  gatewalk passages tracks.csv --cell cell.toml -o runs.csv --fastest 0.4 --fps 10 \\\n"
      "    --metres-per-unit 0.001 --columns body=TRACK_ID,frame=FRAME,x=POSITION_X,y=POSITION_Y");
  options.add_details("how the file was understood, gaps, jumps, and noise");
  options.most_used({"cell", "output", "fastest", "columns", "fps"});
  if (!options.parse(arguments)) return kFine;
  if (!options.cell_file)
    throw UsageError(
        "missing --cell CELL.toml: it says how large the cells are; gatewalk sample cell");
  const auto cutting = cut_options(options);
  lattice::CellFile cell =
      lattice::read_cell_file(options.file(options.cell_file.value()).toml(), options.overrides());
  lattice::require_measurable(cell);
  CutResult result{lattice::read_tracks(options.tracks.values(), track_options(options)),
                   std::move(cell)};
  for (const std::string& text : result.file.warnings) options.warn(text);
  result.cut = lattice::cut_tracks(result.file, result.cell, cutting);
  for (const std::string& text : result.cut.doubts) options.warn(text);
  result.made_by = options.provenance();
  result.made_by.scene = lattice::to_toml(result.cell);

  const std::string path = options.output.value();
  options.keep_old(path);
  lattice::write_runs(path, result.cell,
                      lattice::recorded_runs(result.cut, result.file, result.cell));
  if (options.visits)
    options.write(options.visits.value(),
                  lattice::visits_csv(result.cut, result.file, result.cell));
  if (options.transitions)
    options.write(options.transitions.value(), lattice::transitions_csv(result.cut, result.cell));
  options.give_out(result, {answer_text(result), details_text(result),
                            next_of(result, path, options.cell_file.value())});
  options.draw([&] { return figure_of(result.cut, result.cell); });
  return kFine;
}

}  // namespace gatewalk::cli
