// SPDX-License-Identifier: MIT
#pragma once
/// What results show of a field: its size, the size and types of its cells, and how entries are
/// described.

#include <optional>
#include <string>
#include <vector>

#include "dynamics/cells/section.h"
#include "lattice/field/field_params.h"
#include "lattice/scene/cell_file.h"
#include "lattice/scene/scene.h"
#include "lattice/source/source.h"

namespace gatewalk::cli {

struct ShownField {
  lattice::FieldParams field;
  double width = 0.0, length = 0.0;  // m, of a cell
  double time_limit = 0.0;           // s, until a body is trapped; NaN: not known
  bool is_simulated = true;          // no recorded runs or counts
  std::optional<double> mass;        // kg, of a disc; not known for other bodies
  std::vector<std::string> types;    // by type, "s/t" for equal types; empty if all gates are alike
  dynamics::CellMap map;             // section, and the type of each cell

  ShownField(const lattice::Scene& scene);  // NOLINT(google-explicit-constructor)
  explicit ShownField(const lattice::CellFile& cells);
  explicit ShownField(const lattice::Source& source)
      : ShownField(source.scene ? ShownField(*source.scene) : ShownField(*source.cells)) {
    is_simulated = !source.is_recorded();
  }
};

/// A line of the first screen where the start has more columns on one side than on the other, as in
/// every field with an even number of columns; empty otherwise.
[[nodiscard]] std::string unequal_sides(const ShownField& shown);

}  // namespace gatewalk::cli
