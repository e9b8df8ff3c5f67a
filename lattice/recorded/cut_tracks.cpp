// SPDX-License-Identifier: MIT
#include "lattice/recorded/cut_tracks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "lattice/recorded/crossings.h"
#include "lattice/text/digits.h"
#include "lattice/text/toml_text.h"

namespace gatewalk::lattice {
namespace {

using dynamics::Entry;

/// A quantity measured where a border is crossed, with its units.
struct Measured {
  std::string_view name;
  std::array<std::string_view, 3> units;
  bool is_odd_upwards, is_odd_sideways;  // sign change in the mirror, for moves up or sideways
};
constexpr std::array<Measured, 5> kMeasured{{
    {"s", {"m"}, true, false},
    {"vx", {"m/s", "m s-1", "m s^-1"}, true, true},
    {"vy", {"m/s", "m s-1", "m s^-1"}, false, false},
    {"speed", {"m/s", "m s-1", "m s^-1"}, false, false},
    {"heading", {"rad"}, true, true},
}};

const Measured& measured(const dynamics::Coordinate& coordinate) {
  for (const Measured& m : kMeasured)
    if (m.name == coordinate.name) return m;
  throw std::invalid_argument("coordinate " + printable(coordinate.name) +
                              " cannot be measured of tracks: these can, s (m, along the face from "
                              "its middle), vx, vy, speed (m/s), heading (rad)");
}

/// The number of places in all pieces of tracks.
std::int64_t places_of(const CutTracks& cut) {
  std::int64_t places = 0;
  for (const TrackPiece& p : cut.pieces) places += static_cast<std::int64_t>(p.size());
  return places;
}

/// Limits in cells: distance from the origin, and distance from frame to frame.
constexpr double kMostCells = 1e9, kMostCellsAtOnce = 1000.0;

/// Standard deviations of a place beyond which noise hardly ever carries it; the most frames in a
/// row that may be bridged without a remark.
constexpr double kSure = 5.0, kMostBridged = 100.0;

class Cutter {
 public:
  Cutter(const TrackFile& file, const CellFile& cell, const CutOptions& options)
      : file_(file), cell_(cell), options_(options) {
    require_measurable(cell);
    for (const auto& coordinate : cell.map.section.coordinates)
      measured_.push_back(&measured(coordinate) - kMeasured.data());
    set_lattice();
  }

  CutTracks cut() {
    if (!(std::isfinite(options_.fastest) && options_.fastest > 0.0))
      throw std::invalid_argument("--fastest " + rounded(options_.fastest) +
                                  ": must be above 0 m/s");
    if (options_.bridge < 0) throw std::invalid_argument("--bridge: must be 0 or more frames");
    cut_at_gaps_and_jumps();
    try {
      cut_.noise = noise_of(cut_.pieces);
    } catch (const std::invalid_argument& e) {
      const std::string words = words_of_steps();
      throw std::invalid_argument(file_.source + ": " + e.what() +
                                  (words.empty() ? "" : ": " + words));
    }
    for (const TrackPiece& piece : cut_.pieces) require_near(piece);
    trials_.assign(file_.tracks.size(), 0);
    for (std::size_t i = 0; i < cut_.pieces.size(); ++i) cut_piece(cut_.pieces[i], ends_[i]);
    count_outside();
    cut_.path_noise = std::sqrt(place_variances_ / static_cast<double>(places_of(cut_)));
    if (kSure * cut_.path_noise > 0.25 * std::min(cell_.width, cell_.length))
      throw std::invalid_argument(
          file_.source + ": cells of " + rounded(cell_.width) + " m x " + rounded(cell_.length) +
          " m are too small for tracks with a noise of " + rounded(cut_.noise.place) +
          " m: a body is only sure to have crossed a border where it is seen " +
          rounded(kSure * cut_.path_noise) + " m beyond it (is --metres-per-unit right?)");
    if (cut_.crossings == 0) refuse_nothing();
    cut_.velocity_noise = std::sqrt(velocity_variances_ / static_cast<double>(cut_.crossings));
    add_doubts();
    return std::move(cut_);
  }

 private:
  /// Why pieces are short, as text: most steps, or some, are longer than a frame, or too fast.
  /// Empty if none of these applies.
  [[nodiscard]] std::string words_of_steps() const {
    std::vector<double> frames, speeds;
    for (const Track& t : file_.tracks)
      for (std::size_t i = 1; i < t.time.size(); ++i) {
        const double step = t.time[i] - t.time[i - 1];
        frames.push_back(std::round(step / file_.interval));
        speeds.push_back(std::hypot(t.x[i] - t.x[i - 1], t.y[i] - t.y[i - 1]) / step);
      }
    if (frames.empty()) return "no body was seen twice";
    std::sort(frames.begin(), frames.end());
    std::sort(speeds.begin(), speeds.end());
    const double usual = frames[frames.size() / 2];
    const auto gaps = std::upper_bound(frames.begin(), frames.end(), options_.bridge + 1.0);
    std::string words;
    const auto add = [&](const std::string& text) { words += (words.empty() ? "" : "; ") + text; };
    const auto bridge = [](double n) { return "--bridge " + rounded(n - 1.0); };
    if (usual >= 2.0 && usual > options_.bridge + 1.0) {
      add("frames go up by " + rounded(usual) +
          " from one place of a body to its next (a frame is " + rounded(file_.interval) +
          " s): " + bridge(usual) + " bridges them, unless --fps is wrong");
    } else if (gaps != frames.end()) {
      double missing = 0.0, all = 0.0;
      for (const double n : frames) {
        all += n;
        missing += n - 1.0;
      }
      const auto most = gaps + (frames.end() - gaps) * 9 / 10;  // nine of ten gaps are no longer
      add(rounded(std::round(1000.0 * missing / all) / 10.0) + " % of the frames are missing, " +
          (*gaps == *most ? rounded(*most - 1.0)
                          : rounded(*gaps - 1.0) + " to " + rounded(*most - 1.0)) +
          " at a time: " +
          (*most > kMostBridged
               ? "too long to be bridged"
               : bridge(*most) + " bridges " + (*most == frames.back() ? "them" : "most of them")));
    }
    if (const double middle = speeds[speeds.size() / 2]; middle > options_.fastest)
      add("most steps are faster than --fastest " + rounded(options_.fastest) + " m/s (median " +
          rounded(middle) + " m/s): are --fps and --metres-per-unit right?");
    return words;
  }

  [[nodiscard]] std::string and_words_of_steps() const {
    const std::string words = words_of_steps();
    return words.empty() ? words : "; " + words;
  }

  void add_doubts() {
    const auto all = std::ssize(cut_.passages);
    if (const auto lost = cut_.lost(LostBy::gap) + cut_.lost(LostBy::jump); 2 * lost > all)
      if (const std::string words = words_of_steps(); !words.empty())
        cut_.doubts.push_back(std::to_string(lost) + " of " + std::to_string(all) +
                              " passages are lost in gaps and jumps: " + words);
    if (cut_.is_mostly_outside())
      cut_.doubts.push_back(std::to_string(cut_.places_outside) + " of " +
                            std::to_string(places_of(cut_)) +
                            " places lie outside the cells: check --origin, " +
                            (file_.y_down ? "which with --y-down is 0,HEIGHT of the picture"
                                          : "the lower left corner of the first row, --y-down") +
                            ", and --metres-per-unit");
    const auto percent = [](std::int64_t part, std::int64_t whole) {
      return rounded(std::round(1000.0 * static_cast<double>(part) / static_cast<double>(whole)) /
                     10.0) +
             " %";
    };
    if (10 * cut_.places_put_back > places_of(cut_))
      cut_.doubts.push_back(percent(cut_.places_put_back, places_of(cut_)) +
                            " of the places lie beyond walls: do the map and --origin fit?");
    if (10 * cut_.unsure_crossings > cut_.crossings)
      cut_.doubts.push_back(
          "the cells are small for these tracks: " +
          percent(cut_.unsure_crossings, cut_.crossings) + " of the crossings turn back within " +
          rounded(kSure * cut_.path_noise) +
          " m of the border, where noise hides some; counts of bodies that turn back may be too "
          "small");
    std::int64_t ahead = 0, back = 0;
    for (const CutPassage& p : cut_.passages) {
      const int way = cell_.map.section.faces[static_cast<std::size_t>(p.in.face)].di_y;
      ahead += way > 0;
      back += way < 0;
    }
    if (back > 9 * ahead)
      cut_.doubts.push_back(
          (ahead == 0 ? "all" : "nearly all") +
          std::string(" passages go backwards, down the rows: ") +
          std::string(file_.y_down ? "leave --y-down out if y grows upwards in the file"
                                   : "give --y-down and --origin 0,HEIGHT if y grows downwards "
                                     "in the file, as in pictures"));
  }

  void set_lattice() {
    const auto& map = cell_.map;
    const bool is_given = options_.columns > 0 || options_.endless;
    if (!map.type_of_cell.empty()) {
      cut_.columns = map.columns;
      cut_.rows = static_cast<int>(map.type_of_cell.size()) / map.columns;
      if (is_given && (options_.columns != cut_.columns || options_.rows != cut_.rows))
        throw std::invalid_argument("--lattice: the map of " + cell_.source + " has " +
                                    std::to_string(cut_.columns) + " columns and " +
                                    std::to_string(cut_.rows) + " rows");
    } else if (is_given) {
      cut_.columns = options_.columns;
      cut_.rows = options_.rows;
    } else if (cell_.has_field) {
      cut_.columns = cell_.field.columns;
      cut_.rows = cell_.field.rows;
    } else {
      throw std::invalid_argument(
          cell_.source +
          " does not say how many cells there are: give columns and rows of [field], or --lattice "
          "COLUMNS,ROWS (all: without end, to all sides of the origin)");
    }
  }

  void cut_at_gaps_and_jumps() {
    for (const Track& track : file_.tracks) {
      std::size_t begin = 0;
      for (std::size_t i = 1; i <= track.time.size(); ++i) {
        std::optional<LostBy> ends;
        if (i == track.time.size()) {
          ends = LostBy::end;
        } else {
          const double step = track.time[i] - track.time[i - 1];
          const double speed =
              std::hypot(track.x[i] - track.x[i - 1], track.y[i] - track.y[i - 1]) / step;
          if (step > (options_.bridge + 1.5) * file_.interval) {
            ends = LostBy::gap;
            ++cut_.gaps;
          } else if (speed > options_.fastest) {
            ends = LostBy::jump;
            ++cut_.jumps;
          } else {
            cut_.fastest_step = std::max(cut_.fastest_step, speed);
          }
        }
        if (!ends) continue;
        if (i - begin >= kLeastFrames) {
          cut_.pieces.push_back({&track, begin, i});
          ends_.push_back(*ends);
        } else {
          ++cut_.short_pieces;
          cut_.short_frames += static_cast<std::int64_t>(i - begin);
        }
        begin = i;
      }
    }
  }

  /// Throws std::invalid_argument for a body that is, or jumps, too far away to be among cells.
  void require_near(const TrackPiece& piece) const {
    const Track& track = *piece.track;
    const auto cells = [&](std::size_t i) {
      return std::array{track.x[i] / cell_.width, track.y[i] / cell_.length};
    };
    for (std::size_t i = piece.begin; i < piece.end; ++i)
      for (std::size_t axis = 0; axis < 2; ++axis) {
        const double at = cells(i)[axis], before = cells(std::max(i, piece.begin + 1) - 1)[axis];
        if (std::abs(at) <= kMostCells && std::abs(at - before) <= kMostCellsAtOnce) continue;
        throw std::invalid_argument(
            file_.source + ": body " + printable(track.body) + " is at (" + rounded(track.x[i]) +
            ", " + rounded(track.y[i]) + ") m at " + rounded(track.time[i]) + " s, over " +
            (std::abs(at) <= kMostCells
                 ? rounded(kMostCellsAtOnce) + " cells from where it was a frame before"
                 : rounded(kMostCells) + " cells from the origin") +
            " (are --metres-per-unit, --origin, --fps and --fastest right?)");
      }
  }

  [[nodiscard]] bool is_inside(int column, int row) const {
    return cut_.columns == 0 ||
           (column >= 0 && column < cut_.columns && row >= 0 && row < cut_.rows);
  }

  void count_outside() {
    std::vector<bool> has_pieces(file_.tracks.size(), false), is_in(file_.tracks.size(), false);
    for (const TrackPiece& p : cut_.pieces) {
      const std::size_t track = static_cast<std::size_t>(p.track - file_.tracks.data());
      has_pieces[track] = true;
      for (std::size_t i = p.begin; i < p.end; ++i)
        if (is_inside(cell_at(p.track->x[i], cell_.width), cell_at(p.track->y[i], cell_.length)))
          is_in[track] = true;
        else
          ++cut_.places_outside;
    }
    for (std::size_t i = 0; i < is_in.size(); ++i)
      cut_.bodies_outside += has_pieces[i] && !is_in[i];
  }

  /// Whether bodies cross a border of a cell: neither of the two cells has a wall there.
  [[nodiscard]] bool is_open(int column, int row, int di_x, int di_y) const {
    const auto has_wall = [&](int at_column, int at_row, int move_x, int move_y) {
      if (!is_inside(at_column, at_row)) return false;
      const auto& faces = cell_.map.section.faces;
      const std::uint64_t walls =
          cell_.walls[static_cast<std::size_t>(cell_.map.type_of(at_column, at_row))];
      for (std::size_t f = 0; f < faces.size(); ++f)
        if ((walls >> f & 1) != 0 && faces[f].di_x == move_x && faces[f].di_y == move_y)
          return true;
      return false;
    };
    return !has_wall(column + di_x, row + di_y, di_x, di_y) && !has_wall(column, row, -di_x, -di_y);
  }

  /// A path by its probability given the places; the same in each call, and whatever other bodies
  /// stand before it in the file.
  SmoothPath path_of(const TrackPiece& piece) {
    const SmoothPath expected = smoothed(piece, cut_.noise);
    double variances = 0.0;
    for (const double v : expected.place_variance) variances += v;
    place_variances_ += variances;
    dynamics::Random random(dynamics::Purpose::track,
                            {1, number_of_name(piece.track->body), piece.begin});
    const SmoothPath path = drawn_path(piece, cut_.noise, expected, random);
    for (std::size_t i = 0; i < path.time.size(); ++i)
      if (!std::isfinite(path.x[i] + path.y[i] + path.vx[i] + path.vy[i]))
        throw std::invalid_argument(file_.source + ": body " + printable(piece.track->body) +
                                    " has no finite path at " + rounded(path.time[i]) +
                                    " s: are its times and places right?");
    return path;
  }

  /// By crossing: true if the path turns back before it is surely beyond the border, or has just
  /// come back so.
  static std::vector<bool> unsure_crossings(const SmoothPath& path, const WayThroughCells& way) {
    std::vector<bool> is_unsure(way.crossings.size(), false);
    for (std::size_t k = 1; k < way.crossings.size(); ++k) {
      const Crossing &there = way.crossings[k - 1], &back = way.crossings[k];
      if (there.is_loss() || back.is_loss() || there.di_x != -back.di_x || there.di_y != -back.di_y)
        continue;
      const auto& places = there.di_x != 0 ? path.x : path.y;
      const double border = there.di_x != 0 ? there.x : there.y;
      bool is_sure = false;
      for (auto i = static_cast<std::size_t>(
               std::upper_bound(path.time.begin(), path.time.end(), there.time) -
               path.time.begin());
           i < path.time.size() && path.time[i] < back.time; ++i)
        is_sure =
            is_sure || std::abs(places[i] - border) > kSure * std::sqrt(path.place_variance[i]);
      if (!is_sure) is_unsure[k - 1] = is_unsure[k] = true;
    }
    return is_unsure;
  }

  void cut_piece(const TrackPiece& piece, LostBy ends) {
    const std::size_t track = static_cast<std::size_t>(piece.track - file_.tracks.data());
    const SmoothPath path = path_of(piece);
    Grid grid{cell_.width, cell_.length};
    if (cell_.has_walls())
      grid.is_open = [this](int column, int row, int di_x, int di_y) {
        return is_open(column, row, di_x, di_y);
      };
    const WayThroughCells way = way_through(path, grid);
    const std::vector<bool> is_unsure = unsure_crossings(path, way);
    cut_.places_put_back += way.places_put_back;
    int column = way.column, row = way.row;
    cut_.first_stays += is_inside(column, row) ? 1 : 0;
    std::optional<CutPassage> now;  // the passage under way
    bool was_inside = false;
    for (std::size_t i = 0; i < way.crossings.size(); ++i) {
      const Crossing& c = way.crossings[i];
      const bool is_in = is_inside(column, row);
      column = c.column;
      row = c.row;
      const bool goes_on = is_inside(column, row);
      if (c.is_loss()) {
        if (now) {
          now->lost_by = LostBy::wall;
          (void)finish(*now, c.time - now->entered, CutEnd::lost, {c.x, c.y}, {});
        }
        now.reset();
        cut_.first_stays += goes_on ? 1 : 0;
        continue;
      }
      cut_.came_back += !is_in && goes_on && (was_inside || trials_[track] > 0) ? 1 : 0;
      was_inside = was_inside || is_in;
      if (!now && !goes_on) continue;
      const Entry entry = entry_of(c, column, row, *piece.track);
      cut_.unsure_crossings += is_unsure[i];
      bool is_new = !now;
      if (now) {
        is_new = finish(*now, c.time - now->entered, CutEnd::left, {c.x, c.y}, entry);
        if (!goes_on) now.reset();
      }
      if (!goes_on) continue;
      if (is_new) {
        ++trials_[track];
        ++cut_.trials;
      }
      now = CutPassage{.track = track,
                       .trial = trials_[track],
                       .in = entry,
                       .column = column,
                       .row = row,
                       .entered = c.time,
                       .from = {c.x, c.y}};
      if (!cell_.map.type_of_cell.empty()) now->type = cell_.map.type_of(column, row);
    }
    if (!now) return;
    now->lost_by = ends;
    (void)finish(*now, path.time.back() - now->entered, CutEnd::lost,
                 {path.x.back(), path.y.back()}, {});
  }

  /// Ends a passage; it counts as trapped if it took as long as trapped_after. Returns true if
  /// trapped, which ends the trial.
  bool finish(CutPassage& passage, double time, CutEnd end, std::array<double, 2> to, Entry out) {
    const bool trapped = cell_.trapped_after && time >= *cell_.trapped_after;
    passage.end = trapped ? CutEnd::trapped : end;
    // A way through a corner takes no time, but the format needs a positive time.
    const double some =
        1e-6 * std::min(file_.interval, cell_.trapped_after.value_or(file_.interval));
    passage.time = trapped ? *cell_.trapped_after : std::max(time, some);
    passage.to = to;
    if (passage.end == CutEnd::left) passage.out = out;
    cut_.passages.push_back(passage);
    return trapped;
  }

  /// The entry into a cell by a crossing.
  Entry entry_of(const Crossing& c, int column, int row, const Track& track) {
    ++cut_.crossings;
    velocity_variances_ += c.velocity_variance;
    const auto& faces = cell_.map.section.faces;
    const auto face = std::find_if(faces.begin(), faces.end(), [&](const dynamics::Face& f) {
      return f.di_x == c.di_x && f.di_y == c.di_y;
    });
    if (face == faces.end())
      throw std::invalid_argument(file_.source + ": body " + printable(track.body) +
                                  " crosses a border at " + rounded(c.time) + " s by a move of (" +
                                  std::to_string(c.di_x) + ", " + std::to_string(c.di_y) +
                                  "), at (" + rounded(c.x) + ", " + rounded(c.y) +
                                  ") m: no face of " + cell_.source + " has that move");
    const double half = 0.5 * (c.di_y != 0 ? cell_.width : cell_.length);
    const double along =
        c.di_y != 0 ? c.x - (column + 0.5) * cell_.width : c.y - (row + 0.5) * cell_.length;
    cut_.moved_ends += std::abs(along) > half ? 1 : 0;
    const std::array<double, kMeasured.size()> values{
        std::clamp(along, -half, half), c.vx, c.vy, std::hypot(c.vx, c.vy), std::atan2(c.vx, c.vy)};
    Entry entry{.face = static_cast<int>(face - faces.begin())};
    for (std::size_t k = 0; k < measured_.size(); ++k)
      entry.at[k] = values[static_cast<std::size_t>(measured_[k])];
    return entry;
  }

  /// A sentence if the direction of up may be wrong; `highest`: largest y of all places.
  [[nodiscard]] std::string words_of_ways(double highest) const {
    double up = 0.0;  // sum over all bodies
    for (const Track& t : file_.tracks)
      if (!t.y.empty()) up += t.y.back() - t.y.front();
    const bool is_below = highest < 0.0;
    const std::string below = is_below ? ": all lie below the first row" : "";
    if (is_below && file_.y_down) return below + ": with --y-down, --origin is 0,HEIGHT";
    if (!file_.y_down && (is_below || up < 0.0))
      return below + ": is y measured downwards (--y-down)?";
    return below;
  }

  [[noreturn]] void refuse_nothing() const {
    std::array<double, 4> ends{HUGE_VAL, -HUGE_VAL, HUGE_VAL, -HUGE_VAL};
    for (const TrackPiece& p : cut_.pieces)
      for (std::size_t i = p.begin; i < p.end; ++i) {
        ends[0] = std::min(ends[0], p.track->x[i]);
        ends[1] = std::max(ends[1], p.track->x[i]);
        ends[2] = std::min(ends[2], p.track->y[i]);
        ends[3] = std::max(ends[3], p.track->y[i]);
      }
    throw std::invalid_argument(
        file_.source + ": no body is seen to enter a cell: places are x = " + rounded(ends[0]) +
        " to " + rounded(ends[1]) + " m, y = " + rounded(ends[2]) + " to " + rounded(ends[3]) +
        " m, cells " + rounded(cell_.width) + " m x " + rounded(cell_.length) + " m" +
        (cut_.columns > 0 ? ", " + std::to_string(cut_.columns) + " x " +
                                std::to_string(cut_.rows) + " of them from (0, 0) on"
                          : "") +
        (cell_.has_walls() ? ", and no way leads through the walls of " + cell_.source : "") +
        words_of_ways(ends[3]) + " (are --metres-per-unit, --origin, --fps and --fastest right? " +
        std::to_string(cut_.jumps) + " steps were faster than --fastest, " +
        std::to_string(cut_.gaps) + " went over a gap)" +
        (2 * (cut_.jumps + cut_.gaps) > std::ssize(cut_.pieces) ? and_words_of_steps()
                                                                : std::string()));
  }

  const TrackFile& file_;
  const CellFile& cell_;
  const CutOptions& options_;
  std::vector<std::ptrdiff_t> measured_;  // by coordinate: index into kMeasured
  std::vector<LostBy> ends_;              // by piece
  std::vector<int> trials_;               // number of trials, by track
  /// Sums over all frames, and over all crossings.
  double place_variances_ = 0.0, velocity_variances_ = 0.0;
  CutTracks cut_;
};

std::string face_move(const dynamics::Face& face) {
  return "face " + printable(face.name) + " with the move (" + std::to_string(face.di_x) + ", " +
         std::to_string(face.di_y) + ")";
}

/// Tracks show what changes sign in the mirror (x to -x): the file of a symmetric cell must state
/// the same.
void require_odd(const CellFile& cell) {
  const auto& section = cell.map.section;
  for (const dynamics::Face& face : section.faces) {
    for (std::size_t k = 0; k < section.coordinates.size(); ++k) {
      const Measured& m = measured(section.coordinates[k]);
      const bool is_odd = face.di_y != 0 ? m.is_odd_upwards : m.is_odd_sideways;
      if (face.is_odd(k) != is_odd)
        throw std::invalid_argument(cell.source + ": " + std::string(m.name) + " of face " +
                                    printable(face.name) +
                                    (is_odd ? " changes its sign in the mirror (x to -x): it must "
                                              "be among the face's odd"
                                            : " keeps its sign in the mirror (x to -x): it must "
                                              "not be among the face's odd"));
    }
  }
}

}  // namespace

std::int64_t CutTracks::count(CutEnd end) const {
  return std::count_if(passages.begin(), passages.end(),
                       [&](const CutPassage& p) { return p.end == end; });
}

std::int64_t CutTracks::lost(LostBy by) const {
  return std::count_if(passages.begin(), passages.end(), [&](const CutPassage& p) {
    return p.end == CutEnd::lost && p.lost_by == by;
  });
}

bool CutTracks::is_mostly_outside() const { return 10 * places_outside > 9 * places_of(*this); }

bool CutTracks::is_off() const {
  return is_mostly_outside() || 10 * count(CutEnd::lost) > 9 * std::ssize(passages);
}

std::int64_t CutTracks::ended_at_outer_border(const CellFile& cell, double distance) const {
  if (columns == 0) return 0;
  const double right = columns * cell.width, top = rows * cell.length;
  return std::count_if(passages.begin(), passages.end(), [&](const CutPassage& p) {
    if (p.end != CutEnd::lost || p.lost_by != LostBy::end) return false;
    const auto [x, y] = p.to;
    return std::min({x, right - x, y, top - y}) <= distance;
  });
}

void require_measurable(const CellFile& cell) {
  const auto& section = cell.map.section;
  for (std::size_t i = 0; i < section.faces.size(); ++i) {
    const dynamics::Face& face = section.faces[i];
    if (std::abs(face.di_x) + std::abs(face.di_y) != 1)
      throw std::invalid_argument(cell.source + ": " + face_move(face) +
                                  ": tracks are cut into rectangles, whose moves are (0, 1), "
                                  "(0, -1), (1, 0) and (-1, 0)");
    for (std::size_t other = 0; other < i; ++other)
      if (section.faces[other].di_x == face.di_x && section.faces[other].di_y == face.di_y)
        throw std::invalid_argument(cell.source + ": " + face_move(face) + ": face " +
                                    printable(section.faces[other].name) +
                                    " has the same, so tracks do not tell which of them it is");
  }
  for (const dynamics::Coordinate& coordinate : section.coordinates) {
    const auto& units = measured(coordinate).units;
    if (std::find(units.begin(), units.end(), coordinate.unit) == units.end() ||
        coordinate.unit.empty())
      throw std::invalid_argument(cell.source + ": coordinate " + printable(coordinate.name) +
                                  " is in \"" + printable(coordinate.unit) +
                                  "\": of tracks it is measured in " + std::string(units[0]));
  }
  if (std::any_of(cell.map.types.begin(), cell.map.types.end(),
                  [](const auto& type) { return type.symmetric; }))
    require_odd(cell);
}

CutTracks cut_tracks(const TrackFile& file, const CellFile& cell, const CutOptions& options) {
  return Cutter(file, cell, options).cut();
}

RecordedRuns recorded_runs(const CutTracks& cut, const TrackFile& file, const CellFile& cell) {
  const auto& costs = cell.map.section.costs;
  RecordedRuns runs;
  runs.passages.begin(cell.map.section);
  std::vector<std::int32_t> numbers(file.tracks.size(), -1);  // by track: index of the body
  const CutPassage* last = nullptr;
  for (const CutPassage& p : cut.passages) {
    std::int32_t& body = numbers[p.track];
    if (body < 0) {
      body = static_cast<std::int32_t>(runs.bodies.size());
      runs.bodies.push_back(file.tracks[p.track].body);
    }
    if (!last || last->track != p.track || last->trial != p.trial)
      runs.trials.push_back({p.in, body, static_cast<std::int64_t>(runs.passages.size()), 0});
    last = &p;
    ++runs.trials.back().count;
    CellPassage row{.fate = p.end == CutEnd::left      ? dynamics::Fate::left
                            : p.end == CutEnd::trapped ? dynamics::Fate::trapped
                                                       : dynamics::Fate::broken,
                    .type = static_cast<std::uint8_t>(p.type),
                    .entry = p.out};
    for (std::size_t c = 0; c < costs.size(); ++c)
      row.costs[c] = costs[c].key == "time_s" ? p.time : std::numeric_limits<double>::quiet_NaN();
    runs.passages.push_back(row);
    runs.trapped += p.end == CutEnd::trapped ? 1 : 0;
    runs.lost += p.end == CutEnd::lost ? 1 : 0;
    for (std::size_t c = 0; c < costs.size(); ++c)
      runs.unknown[c] += p.end != CutEnd::lost && std::isnan(row.costs[c]) ? 1 : 0;
  }
  return runs;
}

}  // namespace gatewalk::lattice
