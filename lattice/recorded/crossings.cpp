// SPDX-License-Identifier: MIT
#include "lattice/recorded/crossings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace gatewalk::lattice {
namespace {

/// The path between frames i - 1 and i: places by the cubic through the places and velocities of
/// both frames, velocities by linear interpolation.
class Between {
 public:
  Between(const SmoothPath& path, std::size_t i)
      : path_(path), i_(i), step_(path.time[i] - path.time[i - 1]) {}

  [[nodiscard]] double place(const std::vector<double>& x, const std::vector<double>& v,
                             double u) const {
    const double a = x[i_ - 1], b = x[i_], at_a = step_ * v[i_ - 1], at_b = step_ * v[i_];
    return a +
           u * (at_a + u * (3.0 * (b - a) - 2.0 * at_a - at_b + u * (2.0 * (a - b) + at_a + at_b)));
  }
  /// Where the border is crossed, in [0, 1]; the two frames are on opposite sides of the border, or
  /// on it.
  [[nodiscard]] double reaches(const std::vector<double>& x, const std::vector<double>& v,
                               double border) const {
    double low = 0.0, high = 1.0;
    const bool is_below = x[i_ - 1] < border;
    for (int halved = 0; halved < 52; ++halved) {
      const double u = 0.5 * (low + high);
      ((place(x, v, u) < border) == is_below ? low : high) = u;
    }
    return high;
  }
  [[nodiscard]] Crossing at(double u, int di_x, int di_y) const {
    const auto mixed = [&](const std::vector<double>& v) {
      return (1.0 - u) * v[i_ - 1] + u * v[i_];
    };
    return {path_.time[i_ - 1] + u * step_,
            place(path_.x, path_.vx, u),
            place(path_.y, path_.vy, u),
            mixed(path_.vx),
            mixed(path_.vy),
            mixed(path_.velocity_variance),
            di_x,
            di_y,
            0,
            0};
  }

 private:
  const SmoothPath& path_;
  std::size_t i_;
  double step_;
};

/// Calls found(frame, border, way) for each border k size along one axis that the path crosses
/// between a frame and the one before; `way`: +1 or -1.
template <class Found>
void for_crossings(const std::vector<double>& place, double size, Found found) {
  int cell = cell_at(place[0], size);
  for (std::size_t i = 1; i < place.size(); ++i) {
    const auto step = [&](int way) {
      const double border = size * (way > 0 ? cell + 1 : cell);
      std::size_t j = i;  // after frames on the border itself, it was crossed before them
      while (j > 1 && (place[j - 1] < border) == (way < 0)) --j;
      found(j, border, way);
      cell += way;
    };
    while (place[i] > size * (cell + 1)) step(+1);
    while (place[i] < size * cell) step(-1);
  }
}

/// The crossings of all borders, as if there were no walls.
WayThroughCells own_way(const SmoothPath& path, const Grid& grid) {
  WayThroughCells way{cell_at(path.x[0], grid.width), cell_at(path.y[0], grid.length), {}};
  const auto add = [&](bool is_x) {
    const auto &place = is_x ? path.x : path.y, &speed = is_x ? path.vx : path.vy;
    for_crossings(
        place, is_x ? grid.width : grid.length, [&](std::size_t frame, double border, int step) {
          const Between between(path, frame);
          way.crossings.push_back(
              between.at(between.reaches(place, speed, border), is_x ? step : 0, is_x ? 0 : step));
        });
  };
  add(true);
  add(false);
  std::stable_sort(way.crossings.begin(), way.crossings.end(),
                   [](const Crossing& a, const Crossing& b) { return a.time < b.time; });
  int column = way.column, row = way.row;
  for (Crossing& c : way.crossings) {
    c.column = column += c.di_x;
    c.row = row += c.di_y;
  }
  return way;
}

/// The nearest way through open borders, by dynamic programming over the instants of a path: its
/// frames, and its own crossings of borders, which have little weight. At each instant a body may
/// cross one border.
class OpenWay {
 public:
  OpenWay(const SmoothPath& path, const Grid& grid)
      : path_(path), grid_(grid), own_(own_way(path, grid)) {}

  WayThroughCells find() {
    begin();
    for (std::size_t i = 1; i < path_.time.size(); ++i) {
      while (next_ < own_.crossings.size() && own_.crossings[next_].time <= path_.time[i])
        advance(own_.crossings[next_], static_cast<std::ptrdiff_t>(next_)), ++next_;
      advance(at_frame(i), -1);
    }
    return traced();
  }

 private:
  /// A cell that the body may be in at an instant, and the least sum of squares until then, in
  /// squares of a cell's smaller side. `before`: of the states of the instant before.
  struct State {
    int column, row, before;
    double sum;
  };
  struct Instant {
    Crossing at;
    std::ptrdiff_t own;  // number of the path's own crossing; -1: a frame
    std::size_t begin;   // of states_
  };
  /// A body is lost, to come back in the cell that its path is in, rather than follow it by a way
  /// that is further off than this many frames at the distance of a cell.
  static constexpr double kLoss = 200.0;
  /// The column of a body that is lost while its path is in a cell that is closed to all sides.
  static constexpr int kNowhere = std::numeric_limits<int>::min();
  /// Decides between ways that are equally near: the one with fewer crossings.
  static constexpr double kCrossing = 1e-9;
  /// A crossing of a border that the path is not at counts as this many frames at the same
  /// distance: a body that leans over a wall is not sent round through other cells.
  static constexpr double kFarCrossing = 1000.0;
  /// The weight of a place on a border beside that of a frame: enough to tell which border it is.
  static constexpr double kOnBorder = 1e-3;

  [[nodiscard]] Crossing at_frame(std::size_t i) const {
    return {path_.time[i],
            path_.x[i],
            path_.y[i],
            path_.vx[i],
            path_.vy[i],
            path_.velocity_variance[i],
            0,
            0,
            cell_at(path_.x[i], grid_.width),
            cell_at(path_.y[i], grid_.length)};
  }
  [[nodiscard]] double square_to(const Crossing& at, int column, int row) const {
    const auto off = [](double place, int cell, double size) {
      return std::max({cell * size - place, 0.0, place - (cell + 1) * size});
    };
    const double side = std::min(grid_.width, grid_.length);
    const double x = off(at.x, column, grid_.width) / side, y = off(at.y, row, grid_.length) / side;
    return x * x + y * y;
  }
  /// The square of the distance from the path to the border of a cell that a move crosses.
  [[nodiscard]] double square_to_border(const Crossing& at, const State& from, int di_x,
                                        int di_y) const {
    Crossing border = at;
    if (di_x != 0) border.x = grid_.width * (from.column + (di_x > 0 ? 1 : 0));
    if (di_y != 0) border.y = grid_.length * (from.row + (di_y > 0 ? 1 : 0));
    const double side = std::min(grid_.width, grid_.length);
    const double away = ((at.x - border.x) + (at.y - border.y)) / side;  // one of them is 0
    return away * away + square_to(border, from.column, from.row);
  }
  [[nodiscard]] bool has_opening(int column, int row) const {
    return std::any_of(kMoves.begin(), kMoves.end(), [&](const auto& move) {
      return grid_.is_open(column, row, move[0], move[1]);
    });
  }

  void begin() {
    const Crossing first = at_frame(0);
    instants_.push_back({first, -1, 0});
    for (int column = first.column - 1; column <= first.column + 1; ++column)
      for (int row = first.row - 1; row <= first.row + 1; ++row)
        if (has_opening(column, row))
          states_.push_back({column, row, -1, square_to(first, column, row)});
    if (states_.empty()) states_.push_back({first.column, first.row, -1, 0.0});
  }

  void advance(const Crossing& at, std::ptrdiff_t own) {
    const std::size_t old_begin = instants_.back().begin, old_end = states_.size();
    instants_.push_back({at, own, old_end});
    double least = std::numeric_limits<double>::infinity();
    std::size_t best = old_begin;
    for (std::size_t s = old_begin; s < old_end; ++s)
      if (states_[s].sum < least) least = states_[s].sum, best = s;
    const double weight = own < 0 ? 1.0 : kOnBorder;
    const bool is_closed = own >= 0 || !has_opening(at.column, at.row);
    const auto offer = [&](int column, int row, std::size_t before, double sum) {
      if (column != kNowhere) sum += weight * square_to(at, column, row);
      for (std::size_t s = old_end; s < states_.size(); ++s) {
        if (states_[s].column != column || states_[s].row != row) continue;
        if (sum < states_[s].sum)
          states_[s] = {column, row, static_cast<int>(before - old_begin), sum};
        return;
      }
      states_.push_back({column, row, static_cast<int>(before - old_begin), sum});
    };
    // Who crosses as early as it can comes first, so that an equal way does not replace it.
    for (std::size_t s = old_begin; s < old_end; ++s)
      if (const State from = states_[s];
          from.sum <= least + kLoss && (is_closed || from.column != kNowhere))
        offer(from.column, from.row, s, from.sum);
    for (std::size_t s = old_begin; s < old_end; ++s) {
      const State from = states_[s];
      if (from.sum > least + kLoss || from.column == kNowhere) continue;
      for (const auto& [di_x, di_y] : kMoves)
        if (grid_.is_open(from.column, from.row, di_x, di_y))
          offer(from.column + di_x, from.row + di_y, s,
                from.sum + kCrossing + kFarCrossing * square_to_border(at, from, di_x, di_y));
    }
    if (own >= 0) return;
    if (is_closed) {
      offer(kNowhere, 0, best, least + kLoss);
      return;
    }
    offer(at.column, at.row, best, least + kLoss);
    for (std::size_t s = old_begin; s < old_end; ++s)
      if (states_[s].column == kNowhere) offer(at.column, at.row, s, states_[s].sum);
  }

  [[nodiscard]] WayThroughCells traced() const {
    // By instant: the number of the state.
    std::vector<std::size_t> chosen(instants_.size());
    const auto end = states_.end();
    auto state =
        std::min_element(states_.begin() + static_cast<std::ptrdiff_t>(instants_.back().begin), end,
                         [](const State& a, const State& b) { return a.sum < b.sum; });
    chosen.back() = static_cast<std::size_t>(state - states_.begin());
    for (std::size_t i = instants_.size() - 1; i > 0; --i)
      chosen[i - 1] = instants_[i - 1].begin + static_cast<std::size_t>(states_[chosen[i]].before);
    const State& first = states_[chosen[0]];
    WayThroughCells way{first.column, first.row, {}};
    for (std::size_t i = 0; i < instants_.size(); ++i) {
      const State& now = states_[chosen[i]];
      const Instant& instant = instants_[i];
      if (instant.own < 0 &&
          (now.column == kNowhere || square_to(instant.at, now.column, now.row) > 0.0))
        ++way.places_put_back;
      if (i > 0) add_crossing(states_[chosen[i - 1]], now, instant, way);
    }
    return way;
  }

  /// Adds the crossing from one state to the next, if there is any: the path's own, or one where
  /// the path is nearest to the border.
  void add_crossing(const State& before, const State& now, const Instant& instant,
                    WayThroughCells& way) const {
    if (now.column == before.column && now.row == before.row) return;
    if (before.column == kNowhere) {  // where the body that was lost comes back
      way.crossings.back().column = now.column;
      way.crossings.back().row = now.row;
      return;
    }
    Crossing c = instant.at;
    c.di_x = c.di_y = 0;
    const int di_x = now.column - before.column, di_y = now.row - before.row;
    if (now.column == kNowhere || std::abs(di_x) + std::abs(di_y) != 1 ||
        !grid_.is_open(before.column, before.row, di_x, di_y)) {
      way.crossings.push_back(c);
      return;
    }
    c.di_x = di_x;
    c.di_y = di_y;
    c.column = now.column;
    c.row = now.row;
    if (di_x != 0) c.x = grid_.width * std::max(now.column, before.column);
    if (di_y != 0) c.y = grid_.length * std::max(now.row, before.row);
    way.crossings.push_back(c);
  }

  static constexpr std::array<std::array<int, 2>, 4> kMoves{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
  const SmoothPath& path_;
  const Grid& grid_;
  WayThroughCells own_;
  std::size_t next_ = 0;  // of own_.crossings
  std::vector<Instant> instants_;
  std::vector<State> states_;
};

}  // namespace

int cell_at(double place, double size) { return static_cast<int>(std::floor(place / size)); }

WayThroughCells way_through(const SmoothPath& path, const Grid& grid) {
  return grid.is_open ? OpenWay(path, grid).find() : own_way(path, grid);
}

}  // namespace gatewalk::lattice
