// SPDX-License-Identifier: MIT
#pragma once
/// The same gate in general physics engines, each programmed as its manual says: a disc, two rods
/// with mass on hinges with springs and dampers, no gravity, no friction, beams that do not collide
/// with each other. The restitution is the scene's; where the disc touches a tip, the tip's.

#include <memory>

#include "dynamics/disc/params.h"

namespace gatewalk::bench {

class Engine {
 public:
  virtual ~Engine() = default;
  /// Does a step of p.run.step under the lateral force `force_x` (N). Returns the disc's state (m,
  /// m/s).
  virtual dynamics::BodyState step(double force_x) = 0;
};

[[nodiscard]] std::unique_ptr<Engine> make_chipmunk(const dynamics::GateParams& p);
[[nodiscard]] std::unique_ptr<Engine> make_box2d(const dynamics::GateParams& p);
[[nodiscard]] std::unique_ptr<Engine> make_ode(const dynamics::GateParams& p);

/// The restitution of a disc at (x, y) from the joint of a beam along the unit vector (c, s).
[[nodiscard]] inline double restitution(const dynamics::GateParams& p, double x, double y, double c,
                                        double s) {
  return x * c + y * s >= p.beams.length ? p.contact.tip_restitution : p.contact.restitution;
}

}  // namespace gatewalk::bench
