// SPDX-License-Identifier: MIT
#pragma once
/// The problem that trials and predictions are about, whatever kind its cells are.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/cells/cell.h"
#include "lattice/field/field_params.h"

namespace gatewalk::lattice {

/// A field of cells: which cell stands where, the field's size, and where trials start.
struct Problem {
  dynamics::CellField cells;
  FieldParams field;
  dynamics::Entry start;             // of trials, into the field's start cell
  double width = 0.0, length = 0.0;  // of a cell, m
  std::vector<std::string> types;    // names, by cells.map.types
  std::string source;                // the file that describes the problem, for messages
  /// Runs a sample of `trials` again by a better numerical method, where there is one, and adds to
  /// `health` by how much the results change.
  std::function<void(std::int64_t trials, std::uint64_t seed, dynamics::Health& health,
                     const dynamics::Work& work)>
      check;

  [[nodiscard]] const dynamics::CellMap& map() const { return cells.map; }
  /// True if the runs were recorded, so that no new ones can be made.
  [[nodiscard]] bool is_recorded() const { return cells.cells.empty(); }
  [[nodiscard]] int start_type() const {
    return map().type_of(field.start_column(), field.start_row);
  }
};

}  // namespace gatewalk::lattice
