// SPDX-License-Identifier: MIT
#pragma once
/// What is asked about, whatever the cells are: which stand where, the field's size, where trials
/// start.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/cells/cell.h"
#include "lattice/field/field_params.h"

namespace gatewalk::lattice {

struct Problem {
  dynamics::CellField cells;
  FieldParams field;
  dynamics::Entry start;             // of trials, into the field's start cell
  double width = 0.0, length = 0.0;  // m, of a cell
  std::vector<std::string> types;    // names, by cells.map.types
  std::string source;                // the file that says so, for messages
  /// Runs a sample of so many trials again by a better method, if there is one, and puts into
  /// `health` what that changes.
  std::function<void(std::int64_t trials, std::uint64_t seed, dynamics::Health& health,
                     const dynamics::Work& work)>
      check;

  [[nodiscard]] const dynamics::CellMap& map() const { return cells.map; }
  /// Runs were recorded: no new ones can be made.
  [[nodiscard]] bool is_recorded() const { return cells.cells.empty(); }
  [[nodiscard]] int start_type() const { return map().type_of(field.start_column(), 0); }
};

}  // namespace gatewalk::lattice
