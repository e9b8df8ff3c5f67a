// SPDX-License-Identifier: MIT
#pragma once
/// An example of a cell of your own: the periodic Lorentz gas. A point of speed 1 flies among hard
/// discs of radius 1 on a triangular lattice, with gaps between neighbours. A cell is a rhombus
/// with a disc in each corner; its faces are the four gaps between them.
///
/// A class derived from dynamics::Cell says what an entry is (section) and moves a body from an
/// entry to the next (pass). Lengths here are in radii, times in radii by speed.

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <stdexcept>

#include "dynamics/cells/cell.h"

namespace lorentz {

using namespace gatewalk;
using Point = Eigen::Vector2d;

/// Moves a point from one side of a polygon with discs in its corners (counter-clockwise) to where
/// it leaves, and returns the time that this takes; NaN for non-finite numbers. The entry's numbers
/// are the place along the side, from the middle, and the velocity along it: the sine of the angle
/// of entry.
template <std::size_t n>
double cross(const std::array<Point, n>& corners, dynamics::Entry& at) {
  const auto middle = [&](int i) -> Point { return (corners[i] + corners[(i + 1) % n]) / 2.0; };
  const auto along = [&](int i) -> Point { return (middle(i) - corners[i]).normalized(); };
  const auto inward = [&](int i) { return Point(-along(i).y(), along(i).x()); };
  const double s = at.at[0], v = at.at[1];
  Point x = middle(at.face) + s * along(at.face);
  Point u = v * along(at.face) + std::sqrt(std::fmax(0.0, 1.0 - v * v)) * inward(at.face);
  for (double time = 0.0, soonest = INFINITY;; soonest = INFINITY) {
    int side = -1, disc = -1;  // hit next
    for (int i = 0; i < static_cast<int>(n); ++i) {
      const Point from = x - corners[i];
      const double b = from.dot(u), root = b * b - from.squaredNorm() + 1.0;
      if (const double t = -b - std::sqrt(root); b < 0.0 && root > 0.0 && t < soonest)
        soonest = t, disc = i, side = -1;
      const double out = -u.dot(inward(i));
      if (const double t = from.dot(inward(i)) / out; out > 0.0 && t < soonest)
        soonest = t, disc = -1, side = i;
    }
    if (side < 0 && disc < 0) return NAN;
    x += soonest * u;
    time += soonest;
    if (side >= 0) {
      at = {side, {(x - middle(side)).dot(along(side)), u.dot(along(side))}};
      return time;
    }
    const Point normal = (x - corners[disc]).normalized();
    u -= 2.0 * u.dot(normal) * normal;
  }
}

struct LorentzCell : dynamics::Cell {
  explicit LorentzCell(double gap) : gap_(gap) {
    if (!(gap > 0.0 && gap < 4.0 / std::sqrt(3.0) - 2.0))
      throw std::invalid_argument(
          "the gap must be > 0, else nobody gets through, and < 4 / sqrt(3) - 2 = 0.3094, else "
          "some fly on for ever between rows of discs: there is no diffusion coefficient");
    lattice << 2.0 + gap, 1.0 + gap / 2.0, 0.0, std::sqrt(3.0) * (1.0 + gap / 2.0);
    corners_ = {Point(0, 0), lattice.col(0), lattice.rowwise().sum(), lattice.col(1)};
    // Name, the move that enters there, its mirror image, what is odd in that, in words.
    section_.faces = {{"S", 0, 1, 0, 0, "from below", {}},
                      {"E", -1, 0, 3, 0, "from the right", {}},
                      {"N", 0, -1, 2, 0, "from above", {}},
                      {"W", 1, 0, 1, 0, "from the left", {}}};
    for (dynamics::Face& face : section_.faces)
      face.usual = {{{-gap / 2.0, gap / 2.0}, {-1.0, 1.0}}};
    section_.coordinates = {{"s", "s", "1", "place in the gap", gap},
                            {"v", "v", "1", "velocity along it", 2.0}};
    section_.costs = {{"time", "1", "time of flight"}};
  }
  const dynamics::Section& section() const override { return section_; }
  dynamics::Passage pass(dynamics::Body& body) const override {
    dynamics::Entry& at = body.entry;
    const double time = cross(corners_, at);
    if (std::isnan(time)) return {};                   // broken
    at = {(at.face + 2) % 4, {-at.at[0], -at.at[1]}};  // seen from the neighbour
    return {dynamics::Fate::left, at, {time}};
  }
  /// An entry drawn as in the long run: any gap, any place in it, any velocity along it.
  dynamics::Entry anywhere(dynamics::Random& r) const {
    return {static_cast<int>(r.below(4)), {gap_ * (r.uniform() - 0.5), 2.0 * r.uniform() - 1.0}};
  }
  Eigen::Matrix2d lattice;  // columns: where the moves (1, 0) and (0, 1) lead

 private:
  double gap_;
  std::array<Point, 4> corners_;
  dynamics::Section section_;
};

}  // namespace lorentz
