// SPDX-License-Identifier: MIT
#pragma once
/// What stands where in a field, as data: enough for pools, chains and predictions.

#include <cstddef>
#include <vector>

#include "dynamics/cells/section.h"

namespace gatewalk::dynamics {

struct CellMap {
  struct Type {
    bool symmetric = false;  // mirror images of its passages are passages through it
  };
  Section section;
  std::vector<Type> types;
  int columns = 0;                // 0: the first type everywhere
  std::vector<int> type_of_cell;  // (rows x columns) of types

  [[nodiscard]] int type_of(int column, int row) const {
    return type_of_cell.empty() ? 0
                                : type_of_cell[static_cast<std::size_t>(row * columns + column)];
  }
  /// Throws std::invalid_argument unless types are given for a field of this size, or one for all.
  void require_fits(int field_columns, int field_rows) const;
};

}  // namespace gatewalk::dynamics
