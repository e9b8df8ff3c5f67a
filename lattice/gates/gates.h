// SPDX-License-Identifier: MIT
#pragma once
/// The gates of a field, of one type or several, as cells.

#include <vector>

#include "dynamics/cells/cell.h"
#include "dynamics/disc/params.h"
#include "lattice/field/field_params.h"

namespace gatewalk::lattice {

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
  /// A DiscCell for each type. Throws InvalidParameter as that.
  [[nodiscard]] dynamics::CellField cells() const;

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
