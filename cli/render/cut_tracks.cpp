// SPDX-License-Identifier: MIT
#include "cli/render/cut_tracks.h"

#include <fmt/format.h>

#include <algorithm>

#include "cli/render/quantity.h"
#include "cli/render/text.h"
#include "cli/render/text_table.h"

namespace gatewalk::cli {
namespace {

using lattice::CutEnd;
using lattice::CutPassage;
using lattice::CutTracks;

std::int64_t never_seen(const lattice::TrackFile& file) {
  return std::count_if(file.tracks.begin(), file.tracks.end(),
                       [](const lattice::Track& t) { return t.time.empty(); });
}

/// How many passages left through each face.
std::vector<std::int64_t> left_by(const CutTracks& cut, const lattice::CellFile& cell) {
  std::vector<std::int64_t> counts(cell.map.section.faces.size(), 0);
  for (const CutPassage& p : cut.passages)
    if (p.end == CutEnd::left) ++counts[static_cast<std::size_t>(p.out.face)];
  return counts;
}

std::string lines_of_file(const lattice::TrackFile& file) {
  std::string text = fmt::format("{} ({}): {}, {} places, a frame every {}\n", file.source,
                                 file.kind, counted(std::ssize(file.tracks), "body", "bodies"),
                                 file.places, quantity(file.interval, "s"));
  const auto add = [&](std::int64_t n, const std::string& what) {
    if (n > 0) text += fmt::format("  {} {}\n", n, what);
  };
  const auto places = [](std::int64_t n) { return std::string(n == 1 ? "place" : "places"); };
  add(file.no_place, places(file.no_place) + " without a number");
  add(file.unsure, places(file.unsure) + " with less confidence than asked for");
  add(file.repeated, places(file.repeated) + " written again and again, taken as not seen");
  add(file.at_zero, places(file.at_zero) + " at (0, 0), taken as not seen");
  add(file.no_body, std::string(file.no_body == 1 ? "line" : "lines") + " of no body, left out");
  add(never_seen(file), "of the bodies never seen");
  for (const std::string& remark : file.remarks) text += "  " + remark + "\n";
  return text;
}

/// What happened between the places that were seen, and how the cells lie among them.
std::string lines_of_cut(const CutResult& result) {
  const auto& [file, cell, cut, made_by] = result;
  std::string text = fmt::format(
      "{} between {} and {}; fastest step {}\n", counted(std::ssize(cut.pieces), "piece", "pieces"),
      counted(cut.gaps, "gap", "gaps"), counted(cut.jumps, "jump", "jumps"),
      quantity(cut.fastest_step, "m/s"));
  if (cut.short_pieces > 0)
    text += fmt::format("  {} of {} too short to be fitted, left out\n",
                        counted(cut.short_pieces, "more piece", "more pieces"),
                        counted(cut.short_frames, "frame", "frames"));
  text += fmt::format("cells {} x {}, {}\n", quantity(cell.width, "m"), quantity(cell.length, "m"),
                      cut.columns > 0 ? fmt::format("{} columns and {} rows from the origin on",
                                                    cut.columns, cut.rows)
                                      : "as many as there is room for");
  if (cut.places_outside > 0)
    text += fmt::format(
        "  {} outside them, {} never seen in them: no passages; {} where a body comes back\n",
        counted(cut.places_outside, "place lies", "places lie"),
        counted(cut.bodies_outside, "body is", "bodies are"),
        counted(cut.came_back, "trial begins", "trials begin"));
  const lattice::TrackNoise& noise = cut.noise;
  return text +
         fmt::format(
             "fits of {} frames ({}); noise of places {}, of velocities {} at borders; smoothed "
             "away {}\na border is crossed by who gets {} over it: {} to and fro not counted\n\n",
             noise.window, quantity(noise.window * file.interval, "s", 3),
             quantity(noise.place, "m", 3), quantity(cut.crossing_velocity_noise, "m/s", 3),
             quantity(noise.velocity_bias, "m/s", 3), quantity(cut.hysteresis, "m", 3),
             counted(cut.uncounted, "crossing", "crossings"));
}

void describe(Fields& out, const lattice::TrackFile& file) {
  out.text({"file", "the file, or the files"}, file.source);
  out.text({"kind", "what it is: a table, DeepLabCut's, movement's"}, file.kind);
  out.count({"bodies", "1", "bodies in the file"}, file.tracks.size());
  out.count({"bodies_never_seen", "1", "bodies without a place that was seen"}, never_seen(file));
  out.number({"frame_interval_s", "s", "time from frame to frame"}, file.interval);
  out.count({"places", "1", "lines, or frames, of all bodies, seen there or not"}, file.places);
  out.count({"places_without_number", "1", "places without a number"}, file.no_place);
  out.count({"places_unsure", "1", "places with less confidence than was asked for"}, file.unsure);
  out.count(Field("places_repeated", "1",
                  "places that stand still exactly for more frames than their noise allows, but "
                  "for the first: taken as not seen")
                .at_least(0),
            file.repeated);
  out.count(Field("places_at_zero", "1",
                  "places that are exactly (0, 0) of the file, far from those before and behind or "
                  "for more frames than their noise allows: taken as not seen")
                .at_least(0),
            file.at_zero);
  out.count({"lines_of_no_body", "1", "lines of no body, left out"}, file.no_body);
  out.count({"unit_rows_left_out", "1", "rows of descriptions and units, left out"},
            file.unit_rows);
  out.texts({"remarks", "what was taken for what in the file, a sentence each"}, file.remarks);
}

}  // namespace

void describe(Fields& out, const CutResult& result) {
  const auto& [file, cell, cut, made_by] = result;
  out.count({"passages", "1", "passages of a body through one cell"}, cut.passages.size());
  out.count({"trials", "1", "trials: ways of a body through the lattice"}, cut.trials);
  out.object({"endings", "the passages by what became of the body"}, [&](Fields& f) {
    f.count({"left", "1", "it went into the next cell"}, cut.count(CutEnd::left));
    f.count({"trapped", "1", "it stayed longer than cell.trapped_after_s"},
            cut.count(CutEnd::trapped));
    f.count({"lost", "1", "it was lost from sight"}, cut.count(CutEnd::lost));
  });
  out.object({"left_by", "the passages that left, by the face of the next cell"}, [&](Fields& f) {
    const auto counts = left_by(cut, cell);
    for (std::size_t i = 0; i < counts.size(); ++i)
      f.count(
          Field(cell.map.section.faces[i].name, "1", "passages that left by it").varying("<face>"),
          counts[i]);
  });
  out.number({"lost_share", "1", "share of the passages in which the body was lost from sight"},
             cut.passages.empty() ? 0.0
                                  : static_cast<double>(cut.count(CutEnd::lost)) /
                                        static_cast<double>(cut.passages.size()));
  out.object({"lost_by", "the passages that were lost, by what lost the body"}, [&](Fields& f) {
    f.count({"gap", "1", "frames without a place"}, cut.lost(lattice::LostBy::gap));
    f.count({"jump", "1", "a step faster than bodies are"}, cut.lost(lattice::LostBy::jump));
    f.count({"end", "1", "the end of its track"}, cut.lost(lattice::LostBy::end));
  });
  out.object({"tracks", "what was read"}, [&](Fields& f) { describe(f, file); });
  out.count({"pieces", "1", "pieces of tracks without a gap or jump"}, cut.pieces.size());
  out.count({"gaps", "1", "gaps: frames in which a body was not seen"}, cut.gaps);
  out.count({"jumps", "1", "steps faster than --fastest"}, cut.jumps);
  out.number({"fastest_step_m_per_s", "m/s", "fastest step that is no jump"}, cut.fastest_step);
  out.count({"short_pieces", "1", "pieces too short to be fitted, left out"}, cut.short_pieces);
  out.count({"short_frames", "1", "frames of these pieces"}, cut.short_frames);
  out.count({"first_stays_left_out", "1", "stays in cells that nobody saw entered, left out"},
            cut.first_stays);
  struct Size {
    int columns = 0, rows = 0;
  };
  out.maybe({"lattice", "the cells that there are, from the origin on; null: without end"},
            cut.columns > 0 ? std::optional(Size{cut.columns, cut.rows}) : std::nullopt,
            [](Fields& f, const Size& size) {
              f.count({"columns", "1", "cells from left to right"}, size.columns);
              f.count({"rows", "1", "cells from the start's side on"}, size.rows);
            });
  out.count({"places_outside", "1", "places of tracks outside the lattice, where no cell is"},
            cut.places_outside);
  out.count({"bodies_outside", "1", "bodies never seen in the lattice"}, cut.bodies_outside);
  out.count({"trials_that_came_back", "1",
             "trials that begin where a body that was in the lattice before comes into it again"},
            cut.came_back);
  out.count({"window_frames", "1", "frames of a local fit"}, cut.noise.window);
  out.number({"window_s", "s", "duration of a local fit"}, cut.noise.window * file.interval);
  out.number({"noise_m", "m", "standard deviation of a place, from the residuals of the fits"},
             cut.noise.place);
  out.number({"velocity_noise_m_per_s", "m/s",
              "root mean square of what the noise makes of velocities at the borders"},
             cut.crossing_velocity_noise);
  out.number({"velocity_bias_m_per_s", "m/s",
              "root mean square of what the fits smooth away of a velocity"},
             cut.noise.velocity_bias);
  out.number({"hysteresis_m", "m", "how far over a border a body must get to have crossed it"},
             cut.hysteresis);
  out.count({"crossings", "1", "crossings of borders"}, cut.crossings);
  out.count({"crossings_not_counted", "1", "crossings to and fro within the hysteresis"},
            cut.uncounted);
  out.count({"places_moved_to_face_end", "1",
             "entries beyond their face's end by no more than the hysteresis, moved to it"},
            cut.moved_ends);
  describe_made_by(out, made_by);
}

std::string table_of(const CutResult& result) {
  const auto& [file, cell, cut, made_by] = result;
  std::vector<std::string> faces, losses;
  const auto counts = left_by(cut, cell);
  for (std::size_t i = 0; i < counts.size(); ++i)
    faces.push_back(fmt::format("{} {}", cell.map.section.faces[i].name, counts[i]));
  for (std::size_t i = 0; i < lattice::kLostNames.size(); ++i)
    losses.push_back(
        fmt::format("{} {}", lattice::kLostNames[i], cut.lost(static_cast<lattice::LostBy>(i))));
  const std::size_t all = cut.passages.size();
  TextTable table({{"", -10}, {"", 8}, {"", 10}, {"", 0, 0, "", "   "}});
  table.row(
      {"passages", all, "",
       fmt::format("in {}; {} that began unseen left out", counted(cut.trials, "trial", "trials"),
                   counted(cut.first_stays, "stay", "stays"))});
  const auto line = [&](const char* name, CutEnd end, const std::string& of_what) {
    const std::int64_t n = cut.count(end);
    table.row({name, n, percent(static_cast<double>(n), static_cast<double>(all)), of_what});
  };
  line("left", CutEnd::left, fmt::format("into the next cell by {}", fmt::join(faces, ", ")));
  line("trapped", CutEnd::trapped,
       cell.trapped_after ? "for more than " + quantity(*cell.trapped_after, "s")
                          : "cell.trapped_after_s is not given");
  line("lost", CutEnd::lost, fmt::format("{}", fmt::join(losses, ", ")));
  return lines_of_file(file) + lines_of_cut(result) + table.text();
}

}  // namespace gatewalk::cli
