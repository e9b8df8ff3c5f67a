// SPDX-License-Identifier: MIT
#include <cmath>

#include "cli/command.h"
#include "cli/render/cut_tracks.h"
#include "lattice/recorded/cut_tracks.h"
#include "lattice/source/source.h"
#include "lattice/text/digits.h"

namespace gatewalk::cli {
namespace {

void declare_all(Options& options) {
  options.positional_list(
      "tracks",
      "tables with a line a place (CSV), DeepLabCut's CSV, or movement's NetCDF; "
      "several recordings make one RUNS.csv");
  options.input_file("cell", "the cells and what is measured of an entry (cell.toml)");
  options.main_output_file("RUNS.csv", "the passages, a line each", Options::Content::binary);
  options.add_number(
      "fastest", "M/S",
      "what is faster from frame to frame, noise included, is a jump (must be given)");
  options.add_text("columns", "MEANING=NAME,...",
                   "of a table: body=..., frame=... or time=..., x=..., y=..., confidence=...; "
                   "x=x*,y=y* where columns are of a body each");
  options.add_number("fps", "N", "frames per second");
  options.add_number("metres-per-unit", "X", "of the file's x and y, unless it says so; 1: metres");
  options.add_text("key-point", "NAME", "the key point that is the body's place");
  options.add_number("confidence", "X", "places with less are not seen");
  options.add_text("origin", "X,Y", "lower left corner of column 0 and row 0, in the file's unit",
                   "0,0");
  options.add_flag("y-down", "y grows downwards in the file, as in pictures; upwards without it");
  options.add_text("lattice", "COLUMNS,ROWS",
                   "cells that there are, from the origin on; all: no end (default: the field's)");
  options.add_text("window", "N|Xs", "of local fits, frames or seconds (default: least error)");
  options.add_count("bridge", "N", "frames that may be missing without a gap", "0");
  options.add_figure("all tracks over the cells, and where they were cut");
}

/// Two numbers with a comma between.
std::array<double, 2> pair_of(const Options& options, const std::string& name) {
  const std::string text = options.text(name);
  std::string_view rest = text;
  const auto first = lattice::take_number(rest);
  const bool has_comma = rest.starts_with(',');
  if (has_comma) rest.remove_prefix(1);
  const auto second = lattice::take_number(rest);
  if (!first || !has_comma || !second || !rest.empty() || !std::isfinite(*first) ||
      !std::isfinite(*second))
    throw UsageError("--" + name + " " + text + ": must be two numbers with a comma between");
  return {*first, *second};
}

lattice::TrackOptions track_options(const Options& options) {
  const auto number = [&](const char* name) {
    return options.has(name) ? std::optional(options.number(name)) : std::nullopt;
  };
  const auto origin = pair_of(options, "origin");
  return {.columns = options.text("columns"),
          .fps = number("fps"),
          .metres_per_unit = number("metres-per-unit"),
          .confidence = number("confidence"),
          .key_point = options.text("key-point"),
          .origin_x = origin[0],
          .origin_y = origin[1],
          .y_down = options.has("y-down")};
}

lattice::CutOptions cut_options(const Options& options) {
  if (!options.has("fastest"))
    throw UsageError("how fast bodies can be is not said: --fastest M/S; what is faster is a jump");
  lattice::CutOptions cut{.fastest = options.number("fastest"),
                          .window = options.text("window"),
                          .bridge = static_cast<int>(options.count("bridge", 0, 1000))};
  const std::string text = options.text("lattice");
  cut.endless = text == "all";
  if (text.empty() || cut.endless) return cut;
  const auto [columns, rows] = pair_of(options, "lattice");
  const auto is_size = [](double x) { return x >= 1.0 && x <= 1e6 && x == std::floor(x); };
  if (!is_size(columns) || !is_size(rows))
    throw UsageError("--lattice " + text + ": must be two whole numbers from 1, or all");
  cut.columns = static_cast<int>(columns);
  cut.rows = static_cast<int>(rows);
  return cut;
}

}  // namespace

int run_passages(const Arguments& arguments) {
  Options options("passages TRACKS... --cell CELL.toml -o RUNS.csv [options]",
                  "Cuts tracks from a lab at the borders of cells into passages, which gatewalk "
                  "build makes a chain of.\nWhat the file does not say has to be given. Gaps and "
                  "jumps are no passages: who is in a cell then is lost.",
                  "gatewalk passages tracks.csv --cell cell.toml -o runs.csv --fastest 2 --fps 120 "
                  "--metres-per-unit 0.001 --columns body=TRACK_ID,frame=FRAME,x=POSITION_X,"
                  "y=POSITION_Y");
  declare_all(options);
  if (!options.parse(arguments)) return kFine;
  if (!options.has("cell")) throw UsageError("the cells are not said: --cell CELL.toml");
  const auto cutting = cut_options(options);
  lattice::CellFile cell =
      lattice::read_cell_file(options.file(options.text("cell")).toml(), options.overrides());
  lattice::require_measurable(cell);
  CutResult result{lattice::read_tracks(options.texts("tracks"), track_options(options)),
                   std::move(cell)};
  for (const std::string& text : result.file.warnings) options.warn(text);
  result.cut = lattice::cut_tracks(result.file, result.cell, cutting);
  for (const std::string& text : result.cut.doubts) options.warn(text);
  result.made_by = options.provenance();
  result.made_by.scene = lattice::to_toml(result.cell);

  const std::string path = options.text("output");
  options.keep_old(path);
  lattice::write_runs(path, result.cell,
                      lattice::recorded_runs(result.cut, result.file, result.cell));
  options.give_out(result, table_of(result));
  options.draw([&] { return figure_of(result.cut, result.cell); });
  return kFine;
}

}  // namespace gatewalk::cli
