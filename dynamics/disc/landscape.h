// SPDX-License-Identifier: MIT
#pragma once
/// The potential energy landscape of Sec. II-C: the energy of a body at rest in the gate with both
/// beams deflected forward and in contact, Eqs. (14) and (15). The landscape ignores motion. A body
/// slower than the beams, or beside a beam that swings freely, has another energy.

#include <Eigen/Core>
#include <array>
#include <vector>

#include "dynamics/disc/params.h"

namespace gatewalk::dynamics {

/// Which beams are present; with only one of them, the landscape is the paper's Fig. 6C.
using BeamsThatPush = std::array<bool, 2>;
inline constexpr BeamsThatPush kBothBeams{true, true};

/// Angle (rad) at which a beam, deflected forward, just touches a disc centred at (x, y) behind it,
/// with its side or its tip. 0 if the disc does not reach the beam at rest. Infinite if the disc
/// covers the joint, because no angle then clears the disc.
[[nodiscard]] double forward_deflection(const GateParams& p, Side side, double x, double y);

/// Elastic energy of the beams (J), Eq. (14).
[[nodiscard]] double beam_energy(const GateParams& p, double x, double y,
                                 BeamsThatPush beams = kBothBeams);

/// Energy of the propulsion (J), Eq. (15): zero at the far boundary y = traverse_y.
[[nodiscard]] double propulsion_energy(const GateParams& p, double y);

/// Eqs. (14) and (15) on a grid over the gate, from side to side and from `y_low` to traverse_y.
struct Landscape {
  std::vector<double> x, y;  // m
  Eigen::ArrayXXd elastic;   // (y x x) J, Eq. (14)
  Eigen::ArrayXXd total;     // (y x x) J, Eq. (15)
};
/// Computes the landscape. `spacing` is in m (the paper's is 0.5); it is shortened so that both
/// ends are on the grid. Throws std::invalid_argument unless 0 < spacing and y_low < traverse_y, or
/// for more than 10^8 points.
[[nodiscard]] Landscape landscape(const GateParams& p, double y_low, double spacing,
                                  BeamsThatPush beams = kBothBeams);

/// The minimax path through the gate: the path over the grid whose highest point is lowest.
struct Pass {
  /// The highest point of the path (m): the lowest saddle, or the start if the path only descends.
  double x = 0.0, y = 0.0;
  double energy = 0.0;                     // J, at the highest point
  double start_energy = 0.0;               // J, at the grid point nearest to the start
  std::vector<std::array<double, 2>> way;  // m, from the start to traverse_y
  [[nodiscard]] double barrier() const { return energy - start_energy; }
};
/// The end (m) of steepest descent over `total` from (x, y): in a basin, or on the far boundary if
/// no basin is on the way. Throws as lowest_pass does.
[[nodiscard]] std::array<double, 2> basin_below(const Landscape& l, double x, double y);

/// Finds the minimax path over `total` from (x, y) to the far boundary, inside the gate. Throws
/// std::invalid_argument for a start off the grid, std::runtime_error if there is no path (joints
/// covered from side to side).
[[nodiscard]] Pass lowest_pass(const Landscape& l, double x, double y);

// ---- The pass on two grids ----

/// Permitted spacings (m) of a grid over the gate that extends down to the start.
struct Spacings {
  double least;  // 2000 intervals along the longer side
  double usual;  // half a unit of length (Scale) as in the paper, between `least` and `most`
  double most;   // two steps from side to side
};
[[nodiscard]] Spacings spacings_for(const GateParams& p, const BodyState& start);

/// The landscape and the passes on one grid.
struct GridPasses {
  double spacing = 0.0;  // m, upper bound
  Landscape landscape;
  Pass from_start, from_basin;  // from_basin starts in the basin below the start

  /// Energy (J) from the start up to the pass out of the basin; negative if the start is higher
  /// than the pass.
  [[nodiscard]] double above_start() const { return from_basin.energy - from_start.start_energy; }
  /// Whether no basin is on the way to the far boundary.
  [[nodiscard]] bool downhill() const { return from_basin.way.size() == 1; }
};

/// The passes on a coarse and on a finer grid, because the pass may lie between grid points.
struct Passes {
  BeamsThatPush beams = kBothBeams;
  double kinetic_energy = 0.0;  // J, of the start
  GridPasses coarse;            // on the requested spacing
  GridPasses fine;              // ten times finer, or the least spacing
};
/// Finds the passes on both grids, which begin at y = 0, or at the start if it is lower. Throws
/// std::invalid_argument for a spacing outside spacings_for, and as landscape and lowest_pass do.
[[nodiscard]] Passes passes(const GateParams& p, const BodyState& start, double spacing,
                            BeamsThatPush beams = kBothBeams);

}  // namespace gatewalk::dynamics
