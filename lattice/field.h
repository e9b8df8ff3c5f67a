#pragma once
/// The field's size, where a trial starts in it, and how much of it the full dynamics follows.

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "dynamics/cells/cell_map.h"
#include "dynamics/disc/params.h"

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

/// The gates of a field: one type everywhere, or a type per cell. All have the same body, width,
/// length and joints.
class FieldGates {
 public:
  FieldGates(
      dynamics::GateParams everywhere);  // NOLINT(google-explicit-constructor): the usual case
  /// The gate in (column, row) is types[type_of_cell[row * columns + column]]. Throws
  /// std::invalid_argument unless there is a type (256 at most), all are of one size and for one
  /// body, and each cell is given one of them.
  [[nodiscard]] static FieldGates by_cell(std::vector<dynamics::GateParams> types, int columns,
                                          std::vector<int> type_of_cell);

  [[nodiscard]] const std::vector<dynamics::GateParams>& types() const { return types_; }
  [[nodiscard]] int type_of(int column, int row) const {
    return type_of_cell_.empty() ? 0
                                 : type_of_cell_[static_cast<std::size_t>(row * columns_ + column)];
  }
  [[nodiscard]] const dynamics::GateParams& at(int column, int row) const {
    return types_[static_cast<std::size_t>(type_of(column, row))];
  }
  /// (rows x columns) of types(); empty: all are the first.
  [[nodiscard]] const std::vector<int>& type_of_cell() const { return type_of_cell_; }
  /// What a chain knows of them. Throws InvalidParameter as dynamics::disc_section.
  [[nodiscard]] dynamics::CellMap map() const;
  /// Throws std::invalid_argument unless types are given for a field of this size, or one for all.
  void require_fits(const FieldParams& field) const;

 private:
  std::vector<dynamics::GateParams> types_;
  int columns_ = 0;
  std::vector<int> type_of_cell_;  // (rows x columns); empty: all are the first
};

/// Throws dynamics::InvalidParameter when this fidelity cannot be run in these gates: `remember`
/// and `all` have a stepper of their own (field_stepper.h), which is that of method moreau; `all`
/// looks at a few neighbours only, so beams must not reach over many gates.
void validate(const dynamics::GateParams& p, const FieldParams& field);

}  // namespace gatewalk::lattice
