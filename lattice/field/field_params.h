// SPDX-License-Identifier: MIT
#pragma once
/// The field's size, where a trial starts in it, and how much of it the full dynamics follows.

#include <array>
#include <cstdint>
#include <string_view>

namespace gatewalk::lattice {

/// Which beams a body meets, and what becomes of those it does not meet.
enum class Fidelity : std::uint8_t {
  active,    // the paper: only the gate the body is in, its beams at rest on entry
  remember,  // beams keep moving behind the body; the gate it came from still pushes within reach
  all,       // every gate whose beams are within reach pushes, all beams keep moving
};
inline constexpr std::array<std::string_view, 3> kFidelityNames{"active", "remember", "all"};

[[nodiscard]] inline std::string_view name_of(Fidelity f) {
  return kFidelityNames[static_cast<std::size_t>(f)];
}

/// i_x runs from -columns/2 (whole division), i_y from 0; a trial starts in gate (0, 0).
struct FieldParams {
  int columns = 9;
  int rows = 9;
  int max_gates = 13;  // gates a trial may visit, 0: no limit
  Fidelity fidelity = Fidelity::active;

  [[nodiscard]] int start_column() const { return columns / 2; }
  [[nodiscard]] bool contains(int column, int row) const {
    return column >= 0 && column < columns && row >= 0 && row < rows;
  }
};

}  // namespace gatewalk::lattice
