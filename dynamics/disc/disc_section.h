// SPDX-License-Identifier: MIT
#pragma once
/// How a disc enters a gate: the boundaries and the coordinates there, as a section; a crossing out
/// of one gate is an entry into the next. And Table III's states of it.

#include <cstddef>

#include "dynamics/cells/section.h"
#include "dynamics/cells/state_space.h"
#include "dynamics/disc/gate.h"

namespace gatewalk::dynamics {

/// The faces of a gate. `right_*`: through the right side, coming from the right neighbour.
enum Boundary : int {
  enter,           // EN, from below; d = x
  right_deflect,   // RD, right side below the joint; d = joint_y - y
  left_deflect,    // LD
  right_traverse,  // RT, right side above the joint; d = y - joint_y
  left_traverse,   // LT
};
inline constexpr int kBoundaries = 5;
/// The coordinates of an entry: distance d along the boundary (m), velocity (m/s).
inline constexpr std::size_t kEntryD = 0, kEntryVx = 1, kEntryVy = 2;

/// That of any gate: on scales of 1, and without usual ranges.
[[nodiscard]] const Section& disc_section();
/// That of this gate: scales are its own units (Scale), usual are Table III's ranges. Throws
/// InvalidParameter as table3_space.
[[nodiscard]] Section disc_section(const GateParams& p);

/// A gate's left half is the mirror image of its right half.
[[nodiscard]] bool symmetric(const GateParams& p);

/// The entry into the next gate that ends a run. Only for runs that left the gate.
[[nodiscard]] Entry crossing_of(const GateParams& p, Outcome outcome, const BodyState& exit);

/// That of a body on the lower edge of its gate, y = 0.
[[nodiscard]] inline Entry entry_of(const BodyState& b) {
  return {Boundary::enter, {b.x, b.vx, b.vy}};
}

/// Body on the boundary of its new gate, in that gate's frame.
[[nodiscard]] BodyState entry_state(const GateParams& p, const Entry& entry);

/// The same body in the frame of the gate it has moved into: nothing is rounded to the boundary.
[[nodiscard]] BodyState shifted_into_next(const GateParams& p, Outcome outcome, BodyState exit);

/// Table III: 25 EN, 30 RD, 30 LD, 1 RT, 1 LT. Distances follow the gate's size, velocities the
/// scene's own unit of speed: the table's in the paper's scenes. RT and LT are one state each;
/// their bin is what "Departures" in README.md says: y from joint + R up, velocities of RD and
/// LD. Throws InvalidParameter when no disc can be ahead of the beams inside the gate.
[[nodiscard]] StateSpace table3_space(const GateParams& p);

}  // namespace gatewalk::dynamics
