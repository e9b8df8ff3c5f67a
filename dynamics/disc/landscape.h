// SPDX-License-Identifier: MIT
#pragma once
/// The potential energy landscape of Sec. II-C: what it costs to stand somewhere in the gate with
/// both beams deflected forward and in contact, Eqs. (14) and (15). It knows no motion; a body that
/// is slower than the beams, or beside a beam that swings free, is above or below it.

#include <Eigen/Core>
#include <array>
#include <vector>

#include "dynamics/disc/params.h"

namespace gatewalk::dynamics {

/// Which beams resist; without one of them it is the paper's Fig. 6C.
using BeamsThatPush = std::array<bool, 2>;
inline constexpr BeamsThatPush kBothBeams{true, true};

/// Angle (rad) at which the beam, deflected forward, just touches a disc behind it with its centre
/// at (x, y): on the beam's side, or with the tip. 0 where a beam at rest is not reached. Infinite
/// where the disc covers the joint: no angle is out of its way.
[[nodiscard]] double forward_deflection(const GateParams& p, Side side, double x, double y);

/// Elastic energy of the beams (J), Eq. (14).
[[nodiscard]] double beam_energy(const GateParams& p, double x, double y,
                                 BeamsThatPush beams = kBothBeams);

/// Energy of the propulsion (J), Eq. (15): zero at the far boundary y = traverse_y.
[[nodiscard]] double propulsion_energy(const GateParams& p, double y);

/// Eqs. (14) and (15) on a grid over the gate, side to side and from `y_low` to traverse_y.
struct Landscape {
  std::vector<double> x, y;  // m
  Eigen::ArrayXXd elastic;   // (y x x) J, Eq. (14)
  Eigen::ArrayXXd total;     // (y x x) J, Eq. (15)
};
/// `spacing` in m, the paper's is 0.5; both ends are on the grid, so it is shortened to fit. Throws
/// std::invalid_argument unless 0 < spacing and y_low < traverse_y, or for more than 10^8 points.
[[nodiscard]] Landscape landscape(const GateParams& p, double y_low, double spacing,
                                  BeamsThatPush beams = kBothBeams);

/// The way through the gate whose highest point is lowest, step by step over the grid.
struct Pass {
  double x = 0.0,
         y = 0.0;       // m, its highest point: the lowest saddle, or the start if all is downhill
  double energy = 0.0;  // J, there
  double start_energy = 0.0;               // J, at the grid point nearest to the start
  std::vector<std::array<double, 2>> way;  // m, from the start to traverse_y
  [[nodiscard]] double barrier() const { return energy - start_energy; }
};
/// Where steepest descent over `total` from (x, y) ends (m): in a basin, or on the far boundary if
/// there is none on the way. Throws as lowest_pass does.
[[nodiscard]] std::array<double, 2> basin_below(const Landscape& l, double x, double y);

/// From (x, y) to the far boundary, inside the gate, over `total`. Throws std::invalid_argument for
/// a start off the grid, std::runtime_error when there is no way (joints covered from side to
/// side).
[[nodiscard]] Pass lowest_pass(const Landscape& l, double x, double y);

// ---- The way through, on two grids ----

/// Spacings (m) for a grid over the gate and down to the start.
struct Spacings {
  double least;  // 2000 of them along the longer side
  double usual;  // the paper's, half a unit of length (Scale), but neither below `least` nor above
                 // `most`
  double most;   // two from side to side
};
[[nodiscard]] Spacings spacings_for(const GateParams& p, const BodyState& start);

/// What one grid shows.
struct GridPasses {
  double spacing = 0.0;  // m, at most
  Landscape landscape;
  Pass from_start, from_basin;  // of the basin below the start

  /// From the start to the pass out of the basin (J); below zero where the start lies higher.
  [[nodiscard]] double above_start() const { return from_basin.energy - from_start.start_energy; }
  /// There is no basin on the way to the far boundary.
  [[nodiscard]] bool downhill() const { return from_basin.way.size() == 1; }
};

/// The lowest way through on a grid and on a finer one: the pass may lie between grid points.
struct Passes {
  BeamsThatPush beams = kBothBeams;
  double kinetic_energy = 0.0;  // J, of the start
  GridPasses coarse;            // of the spacing asked for
  GridPasses fine;              // ten times finer, or of the least spacing
};
/// The grids begin at y = 0, or at the start if that lies lower. Throws std::invalid_argument for a
/// spacing outside spacings_for, and as landscape and lowest_pass do.
[[nodiscard]] Passes passes(const GateParams& p, const BodyState& start, double spacing,
                            BeamsThatPush beams = kBothBeams);

}  // namespace gatewalk::dynamics
