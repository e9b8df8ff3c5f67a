// SPDX-License-Identifier: MIT
#pragma once
/// The scenes that are measured: the paper's single gate in two conditions, and its field.

#include <cstdint>
#include <string_view>

#include "dynamics/disc/params.h"
#include "lattice/field/field_params.h"

namespace gatewalk::bench {

/// scenes/single_gate.toml with other forces and stiffness.
inline dynamics::GateParams single_gate(double propulsion, double k_left, double k_right) {
  dynamics::GateParams p;
  p.forces = {.propulsion = propulsion, .random = 10.0, .random_rate = 50.0, .drag = 0.0};
  p.beams.stiffness_left = k_left;
  p.beams.stiffness_right = k_right;
  p.run.traverse_y = 65.0;
  return p;
}

/// Condition A: equal beams. Condition B: a soft left beam.
inline dynamics::GateParams condition(char name) {
  return name == 'A' ? single_gate(8.0, 400.0, 400.0) : single_gate(7.0, 300.0, 500.0);
}

/// scenes/field.toml; run.sh compares its matrix with the program's.
inline dynamics::GateParams field_gate() {
  dynamics::GateParams p;
  p.forces.propulsion = 7.0;
  p.forces.random = 50.0;
  return p;
}
inline constexpr lattice::FieldParams kField;
inline constexpr dynamics::BodyState kFieldStart{.x = 0.0, .y = 0.0, .vx = 0.0, .vy = 15.0};
inline constexpr std::uint64_t kSeed = 1;
inline constexpr std::int64_t kTrialsPerRow = 100;

/// `p` with this method at its own step.
inline dynamics::GateParams by(dynamics::GateParams p, std::string_view method) {
  p.run.method = method;
  p.run.step = dynamics::default_step(p);
  return p;
}

}  // namespace gatewalk::bench
