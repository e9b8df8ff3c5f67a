// SPDX-License-Identifier: MIT
#pragma once
/// Where a path crosses the borders of rectangular cells, some of which may be walls.

#include <cstdint>
#include <functional>
#include <vector>

#include "lattice/recorded/smooth_path.h"

namespace gatewalk::lattice {

/// The column or row of a place, in cells of this size.
[[nodiscard]] int cell_at(double place, double size);

/// A crossing of a border.
struct Crossing {
  double time;               // s
  double x, y, vx, vy;       // m, m/s
  double velocity_variance;  // m^2/s^2
  int di_x, di_y;            // the move; (0, 0): the body is beyond walls, lost to this cell
  int column, row;           // of the cell that the body is in afterwards
  [[nodiscard]] bool is_loss() const { return di_x == 0 && di_y == 0; }
};

/// Cells side by side; column and row 0 begin at the origin.
struct Grid {
  double width, length;  // of a cell, m
  /// Whether a body can cross the border of a cell by a move; empty: all borders.
  std::function<bool(int column, int row, int di_x, int di_y)> is_open{};
};

/// The way of a path through cells.
struct WayThroughCells {
  int column, row;                   // where it begins
  std::vector<Crossing> crossings;   // by time
  std::int64_t places_put_back = 0;  // frames at which the path is beyond a wall of its cell
};
/// The way of a path: where it crosses borders; with walls, the nearest way that crosses no wall.
/// That is the one with the least sum, over all frames, of the squared distance from the place to
/// the cell that the body is in. A body whose path stays beyond walls for long is lost.
[[nodiscard]] WayThroughCells way_through(const SmoothPath& path, const Grid& grid);

}  // namespace gatewalk::lattice
