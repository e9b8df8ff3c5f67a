// SPDX-License-Identifier: MIT
#pragma once
/// Size of the field of gates, where trials start, and which gates the full dynamics simulates.

#include <array>
#include <cstdint>
#include <string_view>

namespace gatewalk::lattice {

/// Which gates the full dynamics simulates around a body.
enum class Fidelity : std::uint8_t {
  active,    // the paper's: only the gate that the body is in; its beams are at rest on entry
  remember,  // beams keep moving behind the body; the gate it came from still pushes within reach
  all,       // every gate whose beams are within reach pushes; all beams keep moving
};
inline constexpr std::array<std::string_view, 3> kFidelityNames{"active", "remember", "all"};

[[nodiscard]] inline std::string_view name_of(Fidelity f) {
  return kFidelityNames[static_cast<std::size_t>(f)];
}

/// Size of the field in gates. Column indices i_x run from -columns/2 (integer division), row
/// indices i_y from 0; a trial starts in gate (0, 0).
struct FieldParams {
  int columns = 9;
  int rows = 9;
  int max_gates = 13;  // most gates that a trial visits; 0: no limit
  Fidelity fidelity = Fidelity::active;

  [[nodiscard]] int start_column() const { return columns / 2; }
  [[nodiscard]] bool contains(int column, int row) const {
    return column >= 0 && column < columns && row >= 0 && row < rows;
  }
};

}  // namespace gatewalk::lattice
