// SPDX-License-Identifier: MIT
#include "dynamics/cells/cell_map.h"

#include <cstdint>
#include <stdexcept>
#include <string>

namespace gatewalk::dynamics {

void CellMap::require_fits(int field_columns, int field_rows) const {
  if (type_of_cell.empty()) return;
  if (columns != field_columns || std::ssize(type_of_cell) != std::int64_t{columns} * field_rows)
    throw std::invalid_argument("field: types for " + std::to_string(columns) + " columns and " +
                                std::to_string(std::ssize(type_of_cell) / columns) +
                                " rows, the field has " + std::to_string(field_columns) + " and " +
                                std::to_string(field_rows));
}

}  // namespace gatewalk::dynamics
