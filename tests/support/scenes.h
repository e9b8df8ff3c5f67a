// SPDX-License-Identifier: MIT
#pragma once
/// Scenes that several tests share.

#include <utility>

#include "dynamics/disc/params.h"

namespace gatewalk::test {

/// The study of Sec. III-B: F = 7, Rm = 10, kL = 300, kR = 500, no drag; the body starts at rest at
/// the origin. Its converged figures are in results/table4/README.md.
inline dynamics::GateParams study(double damping) {
  dynamics::GateParams p;
  p.forces = {.propulsion = 7.0, .random = 10.0, .random_rate = 50.0, .drag = 0.0};
  p.beams.stiffness_left = 300.0;
  p.beams.stiffness_right = 500.0;
  p.beams.damping = damping;
  p.run.traverse_y = 65.0;
  return p;
}

/// The default gate without forces, springs, damping and drag: a disc and two free rods.
inline dynamics::GateParams free_rods() {
  dynamics::GateParams p;
  p.forces = {.propulsion = 0.0, .random = 0.0, .random_rate = 50.0, .drag = 0.0};
  p.beams.stiffness_left = p.beams.stiffness_right = p.beams.damping = 0.0;
  return p;
}

/// `p` with left and right exchanged.
inline dynamics::GateParams mirrored(dynamics::GateParams p) {
  std::swap(p.beams.stiffness_left, p.beams.stiffness_right);
  return p;
}
inline dynamics::BodyState mirrored(const dynamics::BodyState& b) {
  return {-b.x, b.y, -b.vx, b.vy};
}

}  // namespace gatewalk::test
