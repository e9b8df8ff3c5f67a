// SPDX-License-Identifier: MIT
#include "cli/render/cut_tracks.h"

#include <algorithm>

#include "cli/render/json.h"
#include "cli/render/quantity.h"
#include "cli/render/text.h"

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

std::string line_of(const char* name, std::int64_t count, std::size_t all,
                    const std::string& of_what) {
  return padded(name, -10) + padded(std::to_string(count), 8) +
         padded(percent(static_cast<double>(count), static_cast<double>(all)), 10) + "   " +
         of_what + "\n";
}

std::string lines_of_file(const lattice::TrackFile& file) {
  std::string text = file.source + " (" + file.kind +
                     "): " + counted(std::ssize(file.tracks), "body, ", "bodies, ") +
                     std::to_string(file.places) + " places, a frame every " +
                     quantity(file.interval, "s") + "\n";
  const auto add = [&](std::int64_t n, const std::string& what) {
    if (n > 0) text += "  " + std::to_string(n) + " " + what + "\n";
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

}  // namespace

std::string table_of(const CutTracks& cut, const lattice::TrackFile& file,
                     const lattice::CellFile& cell) {
  const lattice::TrackNoise& noise = cut.noise;
  std::string text = lines_of_file(file);
  text += counted(std::ssize(cut.pieces), "piece", "pieces") + " between " +
          counted(cut.gaps, "gap and ", "gaps and ") + counted(cut.jumps, "jump", "jumps") +
          "; fastest step " + quantity(cut.fastest_step, "m/s") + "\n";
  if (cut.short_pieces > 0)
    text += "  " + counted(cut.short_pieces, "more piece", "more pieces") + " of " +
            counted(cut.short_frames, "frame", "frames") + " too short to be fitted, left out\n";
  text += "cells " + quantity(cell.width, "m") + " x " + quantity(cell.length, "m") +
          (cut.columns > 0 ? ", " + std::to_string(cut.columns) + " columns and " +
                                 std::to_string(cut.rows) + " rows from the origin on"
                           : std::string(", as many as there is room for")) +
          "\n";
  if (cut.places_outside > 0)
    text += "  " + counted(cut.places_outside, "place lies", "places lie") + " outside them, " +
            counted(cut.bodies_outside, "body is", "bodies are") +
            " never seen in them: no passages; " +
            counted(cut.came_back, "trial begins", "trials begin") + " where a body comes back\n";
  text += "fits of " + std::to_string(noise.window) + " frames (" +
          quantity(noise.window * file.interval, "s", 3) + "); noise of places " +
          quantity(noise.place, "m", 3) + ", of velocities " +
          quantity(cut.crossing_velocity_noise, "m/s", 3) + " at borders; smoothed away " +
          quantity(noise.velocity_bias, "m/s", 3) + "\na border is crossed by who gets " +
          quantity(cut.hysteresis, "m", 3) +
          " over it: " + counted(cut.uncounted, "crossing", "crossings") +
          " to and fro not counted\n\n";

  std::string faces, losses;
  const auto counts = left_by(cut, cell);
  for (std::size_t i = 0; i < counts.size(); ++i)
    faces += (i > 0 ? ", " : "") + cell.map.section.faces[i].name + " " + std::to_string(counts[i]);
  for (std::size_t i = 0; i < lattice::kLostNames.size(); ++i)
    losses += (i > 0 ? ", " : "") + std::string(lattice::kLostNames[i]) + " " +
              std::to_string(cut.lost(static_cast<lattice::LostBy>(i)));
  const std::size_t all = cut.passages.size();
  text += padded("passages", -10) + padded(std::to_string(all), 8) + padded("", 13) + "in " +
          counted(cut.trials, "trial", "trials") + "; " +
          counted(cut.first_stays, "stay", "stays") + " that began unseen left out\n";
  text += line_of("left", cut.count(CutEnd::left), all, "into the next cell by " + faces);
  text += line_of("trapped", cut.count(CutEnd::trapped), all,
                  cell.trapped_after ? "for more than " + quantity(*cell.trapped_after, "s")
                                     : "cell.trapped_after_s is not given");
  text += line_of("lost", cut.count(CutEnd::lost), all, losses);
  return text;
}

Json to_json(const CutTracks& cut, const lattice::TrackFile& file, const lattice::CellFile& cell) {
  Json json;
  json["passages"] = cut.passages.size();
  json["trials"] = cut.trials;
  json["endings"] = {{"left", cut.count(CutEnd::left)},
                     {"trapped", cut.count(CutEnd::trapped)},
                     {"lost", cut.count(CutEnd::lost)}};
  const auto counts = left_by(cut, cell);
  for (std::size_t i = 0; i < counts.size(); ++i)
    json["left_by"][cell.map.section.faces[i].name] = counts[i];
  json["lost_share"] = cut.passages.empty() ? 0.0
                                            : static_cast<double>(cut.count(CutEnd::lost)) /
                                                  static_cast<double>(cut.passages.size());
  json["lost_by"] = {{"gap", cut.lost(lattice::LostBy::gap)},
                     {"jump", cut.lost(lattice::LostBy::jump)},
                     {"end", cut.lost(lattice::LostBy::end)}};
  json["tracks"] = {{"file", file.source},
                    {"kind", file.kind},
                    {"bodies", file.tracks.size()},
                    {"bodies_never_seen", never_seen(file)},
                    {"frame_interval_s", file.interval},
                    {"places", file.places},
                    {"places_without_number", file.no_place},
                    {"places_unsure", file.unsure},
                    {"places_repeated", file.repeated},
                    {"places_at_zero", file.at_zero},
                    {"lines_of_no_body", file.no_body},
                    {"unit_rows_left_out", file.unit_rows},
                    {"remarks", file.remarks}};
  json["pieces"] = cut.pieces.size();
  json["gaps"] = cut.gaps;
  json["jumps"] = cut.jumps;
  json["fastest_step_m_per_s"] = cut.fastest_step;
  json["short_pieces"] = cut.short_pieces;
  json["short_frames"] = cut.short_frames;
  json["first_stays_left_out"] = cut.first_stays;
  json["lattice"] = cut.columns > 0 ? Json{{"columns", cut.columns}, {"rows", cut.rows}} : Json();
  json["places_outside"] = cut.places_outside;
  json["bodies_outside"] = cut.bodies_outside;
  json["trials_that_came_back"] = cut.came_back;
  json["window_frames"] = cut.noise.window;
  json["window_s"] = cut.noise.window * file.interval;
  json["noise_m"] = cut.noise.place;
  json["velocity_noise_m_per_s"] = cut.crossing_velocity_noise;
  json["velocity_bias_m_per_s"] = cut.noise.velocity_bias;
  json["hysteresis_m"] = cut.hysteresis;
  json["crossings"] = cut.crossings;
  json["crossings_not_counted"] = cut.uncounted;
  json["places_moved_to_face_end"] = cut.moved_ends;
  return json;
}

}  // namespace gatewalk::cli
