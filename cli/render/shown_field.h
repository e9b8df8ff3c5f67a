// SPDX-License-Identifier: MIT
#pragma once
/// What results are shown of: the field, its cells' size and types, how entries are told.

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
  double time_limit = 0.0;           // s, until a body is trapped; NaN: somebody said so
  std::optional<double> mass;        // kg, of a disc; other bodies' are not known
  std::vector<std::string> types;    // names by type, "s/t" where two are alike; none where all are
  dynamics::CellMap map;             // section, which type stands where

  ShownField(const lattice::Scene& scene);  // NOLINT(google-explicit-constructor)
  explicit ShownField(const lattice::CellFile& cells);
  explicit ShownField(const lattice::Source& source)
      : ShownField(source.scene ? ShownField(*source.scene) : ShownField(*source.cells)) {}
};

}  // namespace gatewalk::cli
