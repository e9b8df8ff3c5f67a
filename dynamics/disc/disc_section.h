// SPDX-License-Identifier: MIT
#pragma once
/// The section of a gate: its boundaries, the coordinates of an entry, and the states of Table III.
/// A crossing out of one gate is an entry into the next.

#include <cstddef>

#include "dynamics/cells/section.h"
#include "dynamics/cells/state_space.h"
#include "dynamics/disc/gate.h"

namespace gatewalk::dynamics {

/// The faces of a gate. `right_*`: through the right side, from the right neighbour.
enum Boundary : int {
  enter,           // EN, from below; d = x
  right_deflect,   // RD, right side below the joint; d = joint_y - y
  left_deflect,    // LD
  right_traverse,  // RT, right side above the joint; d = y - joint_y
  left_traverse,   // LT
};
inline constexpr int kBoundaries = 5;
/// The coordinates of an entry: the distance d along the boundary (m) and the velocity (m/s).
inline constexpr std::size_t kEntryD = 0, kEntryVx = 1, kEntryVy = 2;

/// The section of any gate, with scales of 1 and without usual ranges.
[[nodiscard]] const Section& disc_section();
/// The section of this gate: scales are its own units (Scale), usual ranges those of Table III.
/// Throws InvalidParameter as table3_space does.
[[nodiscard]] Section disc_section(const GateParams& p);

/// Whether the gate's left half is the mirror image of its right half.
[[nodiscard]] bool symmetric(const GateParams& p);

/// The entry into the next gate at the end of a run that left its gate.
[[nodiscard]] Entry crossing_of(const GateParams& p, Outcome outcome, const BodyState& exit);

/// The entry of a body on the lower edge of its gate, y = 0.
[[nodiscard]] inline Entry entry_of(const BodyState& b) {
  return {Boundary::enter, {b.x, b.vx, b.vy}};
}

/// True if a body stands on a boundary that it can enter by: the lower edge, or a side of the gate.
[[nodiscard]] bool on_boundary(const GateParams& p, const BodyState& b);
/// The entry of a body on a boundary of its gate; inside the gate, that of a body below it on the
/// lower edge.
[[nodiscard]] Entry entry_of(const GateParams& p, const BodyState& b);

/// The state of a body on the boundary of its new gate, in that gate's frame.
[[nodiscard]] BodyState entry_state(const GateParams& p, const Entry& entry);

/// The exit state in the frame of the gate that the body enters, not rounded to the boundary.
[[nodiscard]] BodyState shifted_into_next(const GateParams& p, Outcome outcome, BodyState exit);

/// The states of Table III: 25 EN, 30 RD, 30 LD, 1 RT, 1 LT. Distances follow the gate's size,
/// velocities the scene's own unit of speed; in the paper's scenes both are those of the table. RT
/// and LT are one state each, with y from joint + R up and the velocities of RD and LD (see
/// "Departures from the paper"). Throws InvalidParameter if no disc can be ahead of the beams
/// inside the gate.
[[nodiscard]] StateSpace table3_space(const GateParams& p);

}  // namespace gatewalk::dynamics
