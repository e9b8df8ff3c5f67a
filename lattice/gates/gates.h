// SPDX-License-Identifier: MIT
#pragma once
/// The gates of a field, of one type or several, as cells.

#include <vector>

#include "dynamics/cells/cell.h"
#include "dynamics/disc/params.h"
#include "lattice/field/field_params.h"

namespace gatewalk::lattice {

/// The gates of a field: one type everywhere, or a type per cell. All types have the same body,
/// width, length and joints.
class FieldGates {
 public:
  FieldGates(
      dynamics::GateParams everywhere);  // NOLINT(google-explicit-constructor): the usual case
  /// A field whose gate in (column, row) is types[type_of_cell[row * columns + column]]. Throws
  /// std::invalid_argument unless there are 1 to 256 types, all of one size and for one body, and
  /// each cell has one of them.
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
  /// (rows x columns), indices into types(); empty: all are the first
  [[nodiscard]] const std::vector<int>& type_of_cell() const { return type_of_cell_; }
  /// The gates as a chain sees them. Throws InvalidParameter, as dynamics::disc_section.
  [[nodiscard]] dynamics::CellMap map() const;
  /// One DiscCell per type. Throws InvalidParameter, as DiscCell.
  [[nodiscard]] dynamics::CellField cells() const;

 private:
  std::vector<dynamics::GateParams> types_;
  int columns_ = 0;
  /// (rows x columns), indices into types_; empty: all are the first
  std::vector<int> type_of_cell_;
};

/// Throws dynamics::InvalidParameter if these gates cannot run with this fidelity. `remember` and
/// `all` have their own stepper (field_stepper.h), which needs method moreau; `all` considers only
/// a few neighbours, so beams must not reach over many gates.
void validate(const dynamics::GateParams& p, const FieldParams& field);

}  // namespace gatewalk::lattice
