// SPDX-License-Identifier: MIT
#include "cli/render/cut_tracks.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cli/fields/text.h"
#include "cli/fields/text_table.h"
#include "cli/render/panel.h"
#include "cli/render/quantity.h"

namespace gatewalk::cli {
namespace {

using lattice::CutEnd;
using lattice::CutPassage;
using lattice::CutTracks;

std::int64_t never_seen(const lattice::TrackFile& file) {
  return std::count_if(file.tracks.begin(), file.tracks.end(),
                       [](const lattice::Track& t) { return t.time.empty(); });
}

/// The number of passages that left through each face.
std::vector<std::int64_t> left_by(const CutTracks& cut, const lattice::CellFile& cell) {
  std::vector<std::int64_t> counts(cell.map.section.faces.size(), 0);
  for (const CutPassage& p : cut.passages)
    if (p.end == CutEnd::left) ++counts[static_cast<std::size_t>(p.out.face)];
  return counts;
}

/// Lines on how the files of tracks were read.
std::string lines_of_file(const lattice::TrackFile& file) {
  std::string text =
      wrapped(fmt::format("{} ({}): {}, {} places, a frame every {}", file.source, file.kind,
                          counted(std::ssize(file.tracks), "body", "bodies"), file.places,
                          quantity(file.interval, "s")),
              "  ");
  const auto add = [&](std::int64_t n, const std::string& what) {
    if (n > 0) text += fmt::format("  {} {}\n", n, what);
  };
  const auto places = [](std::int64_t n) { return std::string(n == 1 ? "place" : "places"); };
  add(file.no_place, places(file.no_place) + " without a number");
  add(file.unsure, places(file.unsure) + " with less confidence than --confidence");
  add(file.repeated, places(file.repeated) + " repeated exactly, taken as not seen");
  add(file.at_zero, places(file.at_zero) + " at (0, 0), taken as not seen");
  add(file.no_body,
      std::string(file.no_body == 1 ? "line" : "lines") + " without a body, left out");
  add(never_seen(file), "of the bodies never seen");
  for (const std::string& remark : file.remarks) text += wrapped("  " + remark, "    ");
  return text;
}

/// Lines on how tracks were completed between recorded places, and how the cells lie.
std::string lines_of_cut(const CutResult& result) {
  const auto& [file, cell, cut, made_by] = result;
  std::string text =
      wrapped(fmt::format("{} between {} and {}; the fastest step is {}",
                          counted(std::ssize(cut.pieces), "piece of track", "pieces of track"),
                          counted(cut.gaps, "gap", "gaps"), counted(cut.jumps, "jump", "jumps"),
                          quantity(cut.fastest_step, "m/s")));
  if (cut.short_pieces > 0)
    text += fmt::format("  {} of {} left out: too short for a fit\n",
                        counted(cut.short_pieces, "more piece", "more pieces"),
                        counted(cut.short_frames, "frame", "frames"));
  text += fmt::format(
      "cells of {} x {}, {}\n", quantity(cell.width, "m"), quantity(cell.length, "m"),
      cut.columns > 0
          ? fmt::format("{} columns and {} rows from the origin on", cut.columns, cut.rows)
          : "wherever there are tracks");
  if (cut.places_outside > 0)
    text += wrapped(
        fmt::format("  {} outside the cells, {} never seen in a cell; {} where a body comes back",
                    counted(cut.places_outside, "place lies", "places lie"),
                    counted(cut.bodies_outside, "body is", "bodies are"),
                    counted(cut.came_back, "trial begins", "trials begin")),
        "    ");
  if (cell.has_walls())
    text += fmt::format("  {} beyond walls, put back\n",
                        counted(cut.places_put_back, "place lies", "places lie"));
  return text + fmt::format(
                    "noise: {} in places; the path is known to {}, its velocity at borders to {}\n"
                    "{} of {} turned back within the noise, and may be none.\n",
                    quantity(cut.noise.place, "m", 3), quantity(cut.path_noise, "m", 3),
                    quantity(cut.velocity_noise, "m/s", 3), cut.unsure_crossings,
                    counted(cut.crossings, "crossing", "crossings"));
}

void describe(Fields& out, const lattice::TrackFile& file) {
  out.text({"file", "name of the file, or of the files"}, file.source);
  out.text(Label("kind", "format of the file").one_of({"a table", "DeepLabCut", "movement"}),
           file.kind);
  out.count({"bodies", "1", "number of bodies in the file"}, file.tracks.size());
  out.count({"bodies_never_seen", "1", "number of bodies without any place that was seen"},
            never_seen(file));
  out.number({"frame_interval_s", "s", "time from frame to frame"}, file.interval);
  out.count({"places", "1",
             "number of lines, or frames, of all bodies, whether the body was seen there or not"},
            file.places);
  out.count({"places_without_number", "1", "places without a number"}, file.no_place);
  out.count({"places_unsure", "1", "places with less confidence than was asked for"}, file.unsure);
  out.count(Field("places_repeated", "1",
                  "places taken as not seen: exact repeats of the place before, for more frames "
                  "than noise allows")
                .at_least(0),
            file.repeated);
  out.count(Field("places_at_zero", "1",
                  "places taken as not seen: exactly (0, 0) in the file, far from other places or "
                  "for too many frames")
                .at_least(0),
            file.at_zero);
  out.count({"lines_of_no_body", "1", "lines without a body, left out"}, file.no_body);
  out.count({"unit_rows_left_out", "1", "rows of descriptions or units, left out"}, file.unit_rows);
  out.texts({"remarks", "how the file was understood, a sentence each"}, file.remarks);
}

}  // namespace

void describe(Fields& out, const CutResult& result) {
  const auto& [file, cell, cut, made_by] = result;
  out.count({"passages", "1", "number of passages, each of a body through one cell"},
            cut.passages.size());
  out.count({"trials", "1", "number of trials, each the way of a body through the lattice"},
            cut.trials);
  out.object({"endings", "number of passages by how they end"}, [&](Fields& f) {
    f.count({"left", "1", "the body left the cell, into the next one or out of the lattice"},
            cut.count(CutEnd::left));
    f.count({"trapped", "1", "the body stayed in the cell for cell.trapped_after_s or longer"},
            cut.count(CutEnd::trapped));
    f.count({"lost", "1", "the body was lost from sight in the cell"}, cut.count(CutEnd::lost));
  });
  out.object(
      {"left_by",
       "number of passages that left, by the face through which the body enters the next cell"},
      [&](Fields& f) {
        const auto counts = left_by(cut, cell);
        for (std::size_t i = 0; i < counts.size(); ++i)
          f.count(Field(cell.map.section.faces[i].name, "1", "passages that left through this face")
                      .varying("<face>"),
                  counts[i]);
      });
  out.number({"lost_share", "1", "share of the passages in which the body was lost from sight"},
             cut.passages.empty() ? 0.0
                                  : static_cast<double>(cut.count(CutEnd::lost)) /
                                        static_cast<double>(cut.passages.size()));
  out.object({"lost_by", "number of passages in which the body was lost from sight, by the reason"},
             [&](Fields& f) {
               f.count({"gap", "1", "a gap in the track"}, cut.lost(lattice::LostBy::gap));
               f.count({"jump", "1", "a jump in the track"}, cut.lost(lattice::LostBy::jump));
               f.count(Field("wall", "1", "a track that stays beyond walls").at_least(0),
                       cut.lost(lattice::LostBy::wall));
               f.count({"end", "1", "the end of the track"}, cut.lost(lattice::LostBy::end));
             });
  out.object({"tracks", "what was read from the file of tracks"},
             [&](Fields& f) { describe(f, file); });
  out.count({"pieces", "1", "pieces of tracks without a gap or jump, long enough to be fitted"},
            cut.pieces.size());
  out.count(
      {"gaps", "1", "gaps in tracks: more frames in a row without a place than --bridge allows"},
      cut.gaps);
  out.count({"jumps", "1", "jumps in tracks: steps faster than --fastest"}, cut.jumps);
  out.number({"fastest_step_m_per_s", "m/s", "fastest step that is not a jump"}, cut.fastest_step);
  out.count({"short_pieces", "1", "pieces too short to be fitted, left out"}, cut.short_pieces);
  out.count({"short_frames", "1", "frames in pieces that are too short to be fitted"},
            cut.short_frames);
  out.count(
      {"first_stays_left_out", "1", "stays left out because nobody saw the body enter the cell"},
      cut.first_stays);
  struct Size {
    int columns = 0, rows = 0;
  };
  out.maybe({"lattice", "size of the lattice, from its origin on; null: without end"},
            cut.columns > 0 ? std::optional(Size{cut.columns, cut.rows}) : std::nullopt,
            [](Fields& f, const Size& size) {
              f.count({"columns", "1", "number of columns, from left to right"}, size.columns);
              f.count({"rows", "1", "number of rows, from the near row on"}, size.rows);
            });
  out.count({"places_outside", "1", "places of tracks outside the lattice, where there is no cell"},
            cut.places_outside);
  out.count({"bodies_outside", "1", "bodies that were never seen in the lattice"},
            cut.bodies_outside);
  out.count({"trials_that_came_back", "1",
             "trials that begin where a body comes back into the lattice that it had left"},
            cut.came_back);
  out.number({"noise_m", "m", "standard deviation of each coordinate of a measured place"},
             cut.noise.place);
  out.number({"path_noise_m", "m",
              "standard deviation of each coordinate of the path, given all measured places"},
             cut.path_noise);
  out.number({"velocity_noise_m_per_s", "m/s",
              "standard deviation of each velocity at crossings, given all measured places"},
             cut.velocity_noise);
  out.count({"crossings", "1", "crossings of borders"}, cut.crossings);
  out.count(
      {"crossings_unsure", "1",
       "crossings after which the path turns back within 5 path_noise_m of the border: each is "
       "drawn by its probability"},
      cut.unsure_crossings);
  out.count(
      Field("places_put_back", "1", "places beyond walls, put back into the cell").at_least(0),
      cut.places_put_back);
  out.count(
      {"places_moved_to_face_end", "1", "entries beyond the end of their face, moved to that end"},
      cut.moved_ends);
  describe_made_by(out, made_by);
}

namespace {

/// What lost passages mean, and what to do.
std::string losses_text(const CutTracks& cut, const lattice::CellFile& cell, double interval) {
  constexpr double kFew = 0.01;
  const std::int64_t lost = cut.count(CutEnd::lost);
  if (cut.is_off())
    return fmt::format(
        "Beware: the options do not fit the tracks. Check {}\nthe unit (--metres-per-unit) and "
        "--fastest before you build a chain.\n",
        "--origin (with --y-down: 0,HEIGHT of the picture),");
  if (static_cast<double>(lost) <= kFew * static_cast<double>(cut.passages.size())) return "";
  std::string text = "Beware: lost passages bias a chain if losses depend on the motion.\n";
  if (cut.lost(lattice::LostBy::gap) > 0) text += "--bridge N bridges gaps of up to N frames.\n";
  const std::int64_t ends = cut.lost(lattice::LostBy::end),
                     at_border = cut.ended_at_outer_border(cell, cut.fastest_step * interval);
  if (2 * at_border >= ends && at_border > 0)
    text += wrapped(fmt::format(
        "{} of {} ended within one step of the outer border: film beyond the cells, or give a "
        "smaller --lattice.",
        at_border, counted(ends, "lost track", "lost tracks")));
  return text;
}

}  // namespace

std::string answer_text(const CutResult& result) {
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
  table.row({"passages", all, "", fmt::format("in {}", counted(cut.trials, "trial", "trials"))});
  const auto line = [&](const char* name, CutEnd end, const std::string& of_what) {
    const std::int64_t n = cut.count(end);
    table.row({name, n, percent(static_cast<double>(n), static_cast<double>(all)), of_what});
  };
  line("left", CutEnd::left, fmt::format("into the next cell by {}", fmt::join(faces, ", ")));
  line("trapped", CutEnd::trapped,
       cell.trapped_after ? "for more than " + quantity(*cell.trapped_after, "s")
                          : "cell.trapped_after_s is not given");
  line("lost", CutEnd::lost, fmt::format("{}", fmt::join(losses, ", ")));
  std::string text =
      table.text() +
      wrapped(fmt::format(
          "From {}, {} places.{}", counted(std::ssize(file.tracks), "body", "bodies"), file.places,
          cut.first_stays > 0
              ? fmt::format(" {} left out: the track begins inside the cell.",
                            counted(cut.first_stays, "first cell is", "first cells are"))
              : ""));
  return text + losses_text(cut, cell, file.interval);
}

std::string details_text(const CutResult& result) {
  return "\n" + lines_of_file(result.file) + lines_of_cut(result);
}

namespace {

constexpr std::size_t kMostPlaces = 40'000, kMostMarks = 3'000;  // of a figure
constexpr long kMostBorders = 100;                               // along an axis

/// A range of cells by columns and rows, without the last ones.
struct Span {
  long left, right, bottom, top;

  /// The cells of this range that are in the lattice.
  [[nodiscard]] Span within(long columns, long rows) const {
    if (columns == 0) return *this;
    return {std::clamp(left, 0L, columns), std::clamp(right, 0L, columns),
            std::clamp(bottom, 0L, rows), std::clamp(top, 0L, rows)};
  }
};
/// The range of cells that holds all pieces of tracks.
Span span_of(const CutTracks& cut, const lattice::CellFile& cell) {
  double left = HUGE_VAL, right = -HUGE_VAL, bottom = HUGE_VAL, top = -HUGE_VAL;
  for (const lattice::TrackPiece& p : cut.pieces)
    for (std::size_t i = p.begin; i < p.end; ++i) {
      left = std::min(left, p.track->x[i]);
      right = std::max(right, p.track->x[i]);
      bottom = std::min(bottom, p.track->y[i]);
      top = std::max(top, p.track->y[i]);
    }
  const auto cells = [](double low, double high, double size) {
    const long first = std::lround(std::floor(low / size));
    return std::array{first, std::max(first + 1, std::lround(std::ceil(high / size)))};
  };
  const auto across = cells(left, right, cell.width), along = cells(bottom, top, cell.length);
  return {across[0], across[1], along[0], along[1]};
}

/// Adds the tracks, with a gap between two of them.
void add_ways(Rows& rows, const CutTracks& cut, const Sized& metre) {
  std::size_t all = 0;
  for (const lattice::TrackPiece& p : cut.pieces) all += p.size();
  const std::size_t stride = all / kMostPlaces + 1;
  for (const lattice::TrackPiece& p : cut.pieces) {
    const auto add = [&](std::size_t i) {
      rows.add(p.track->x[i] / metre.size, p.track->y[i] / metre.size);
    };
    for (std::size_t i = p.begin; i < p.end; i += stride) add(i);
    add(p.end - 1);
    rows.gap();
  }
}

/// Adds the borders of the cells: "x y dx dy".
void add_borders(Rows& rows, const Span& span, const lattice::CellFile& cell, const Sized& metre) {
  const double w = cell.width / metre.size, l = cell.length / metre.size;
  const double wide = w * static_cast<double>(span.right - span.left),
               tall = l * static_cast<double>(span.top - span.bottom);
  for (long i = span.left; i <= span.right; ++i)
    rows.add(w * static_cast<double>(i), l * static_cast<double>(span.bottom), 0, tall);
  for (long i = span.bottom; i <= span.top; ++i)
    rows.add(w * static_cast<double>(span.left), l * static_cast<double>(i), wide, 0);
}

/// Adds the walls of the cells in `span`, which lie inside the map: "x y dx dy".
void add_walls(Rows& rows, const Span& span, const lattice::CellFile& cell, const Sized& metre) {
  const double w = cell.width / metre.size, l = cell.length / metre.size;
  const std::vector<dynamics::Face>& faces = cell.map.section.faces;
  for (long row = span.bottom; row < span.top; ++row)
    for (long column = span.left; column < span.right; ++column) {
      const auto type = static_cast<std::size_t>(
          cell.map.type_of(static_cast<int>(column), static_cast<int>(row)));
      for (std::size_t f = 0; f < faces.size(); ++f)
        if ((cell.walls[type] >> f & 1) != 0) {  // a body by this face comes from the other side
          const double x = w * static_cast<double>(column + (faces[f].di_x < 0 ? 1 : 0)),
                       y = l * static_cast<double>(row + (faces[f].di_y < 0 ? 1 : 0));
          rows.add(x, y, faces[f].di_x == 0 ? w : 0.0, faces[f].di_y == 0 ? l : 0.0);
        }
    }
}

}  // namespace

Figure figure_of(const CutTracks& cut, const lattice::CellFile& cell) {
  const Span span = span_of(cut, cell);
  const double left = cell.width * static_cast<double>(span.left),
               right = cell.width * static_cast<double>(span.right),
               bottom = cell.length * static_cast<double>(span.bottom),
               top = cell.length * static_cast<double>(span.top);
  const Sized metre = readable_unit("m", std::max({-left, right, -bottom, top}));
  std::vector<std::array<double, 2>> crossed, lost, trapped;
  for (std::size_t i = 0; i < cut.passages.size(); ++i) {
    const CutPassage& p = cut.passages[i];
    const bool goes_on =
        i > 0 && cut.passages[i - 1].track == p.track && cut.passages[i - 1].trial == p.trial;
    if (!goes_on) crossed.push_back(p.from);
    (p.end == CutEnd::left ? crossed : p.end == CutEnd::lost ? lost : trapped).push_back(p.to);
  }
  const double scale = std::min(414.0 / (right - left), 520.0 / (top - bottom));
  const Box box{78, 78 + scale * (right - left), 44, 44 + scale * (top - bottom)};
  const bool with_borders =
      span.right - span.left <= kMostBorders && span.top - span.bottom <= kMostBorders;
  const std::size_t most = std::max({crossed.size(), lost.size(), trapped.size()});
  Panels out;
  Rows& ways = out.data("$ways");
  add_ways(ways, cut, metre);
  Panel& panel = out.add(box);
  panel.say(fmt::format("{} passages of {} pieces of track{}{}", cut.passages.size(),
                        cut.pieces.size(), most > kMostMarks ? "; not all marks are drawn" : "",
                        with_borders ? "" : "; too many borders to be drawn"),
            8, 18);
  panel.border = 15;
  panel.x = {fmt::format("x ({})", metre.name), left / metre.size, right / metre.size,
             digits(tic_step((right - left) / metre.size, std::max(1.0, box.width() / 70.0)))};
  panel.y = {fmt::format("y ({})", metre.name), bottom / metre.size, top / metre.size};
  if (with_borders) {
    Rows& borders = out.data("$borders");
    add_borders(borders, span.within(cut.columns, cut.rows), cell, metre);
    panel.draw(borders, "1:2:3:4", "vectors nohead", {"#999999", 0.6});
  }
  if (with_borders && cell.has_walls()) {
    Rows& walls = out.data("$walls");
    add_walls(walls, span.within(cut.columns, cut.rows), cell, metre);
    panel.draw(walls, "1:2:3:4", "vectors nohead", {kInk, 1.6});
  }
  panel.draw(ways, "1:2", "lines", {kFirstColour, 0.7});
  double at = 8.0;
  const auto add = [&](const char* name, const std::vector<std::array<double, 2>>& marks,
                       const Pen& pen, const std::string& word) {
    if (marks.empty()) return;
    Rows& rows = out.data(name);  // no more than can be distinguished
    for (std::size_t i = 0; i < marks.size(); i += marks.size() / kMostMarks + 1)
      rows.add(marks[i][0] / metre.size, marks[i][1] / metre.size);
    panel.draw(rows, "1:2", "points", pen);
    out.add_key(at, box.bottom + 62,
                {entry("points", pen, fmt::format("{} {}", word, marks.size()))});
    at += 166.0;
  };
  add("$crossed", crossed, {.colour = "#000000", .mark = 7, .size = 0.3}, "border crossed");
  add("$trapped", trapped, {.colour = kThirdColour, .mark = 5, .size = 0.6}, "trapped");
  add("$lost", lost, {kSecondColour, 1.5, 2, 0.8}, "lost");
  return out.figure(static_cast<int>(box.bottom + 88));
}

}  // namespace gatewalk::cli
