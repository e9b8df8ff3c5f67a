// SPDX-License-Identifier: MIT
#pragma once
/// Size of the field of gates, where trials start, and which gates the full dynamics simulates.

#include <array>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
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

/// Size of the field in gates, and the gate that trials start in. Column indices i_x count from the
/// start's column, row indices i_y from the near row.
struct FieldParams {
  int columns = 9;
  int rows = 9;
  int max_gates = 13;  // most gates that a trial visits; 0: no limit
  Fidelity fidelity = Fidelity::active;
  std::optional<int> own_start_column{};  // from 0 at the left; nullopt: the middle column
  int start_row = 0;                      // from 0, the near row

  [[nodiscard]] int middle_column() const { return columns / 2; }
  [[nodiscard]] int start_column() const { return own_start_column.value_or(middle_column()); }
  [[nodiscard]] bool contains(int column, int row) const {
    return column >= 0 && column < columns && row >= 0 && row < rows;
  }
};

/// The field cut to the rows before `row`, without a limit of gates. Throws std::invalid_argument
/// for a row that is not ahead of the start's row.
[[nodiscard]] inline FieldParams up_to_row(FieldParams field, int row) {
  if (row <= field.start_row)
    throw std::invalid_argument(
        "the row to enter must be " + std::to_string(field.start_row + 1) + " or more" +
        (field.start_row > 0
             ? ": bodies start in field.start_row = " + std::to_string(field.start_row)
             : ""));
  field.rows = row;
  field.max_gates = 0;
  return field;
}

}  // namespace gatewalk::lattice
