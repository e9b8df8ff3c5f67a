// SPDX-License-Identifier: MIT
#include "cli/render/shown_field.h"

#include <fmt/core.h>

#include <cmath>

#include "cli/render/type_marks.h"
#include "lattice/gates/gates.h"
#include "lattice/scene/cell_file.h"
#include "lattice/scene/terrain.h"

namespace gatewalk::cli {

ShownField::ShownField(const lattice::Scene& scene)
    : field(scene.field),
      width(scene.gate.gate_width()),
      length(scene.gate.gate_length()),
      time_limit(scene.gate.run.time_limit),
      mass(scene.gate.body.mass),
      types(type_names(scene)),
      map(lattice::gates_of(scene).map()) {}

ShownField::ShownField(const lattice::CellFile& cells)
    : field(cells.field),
      width(cells.width),
      length(cells.length),
      time_limit(cells.trapped_after.value_or(std::nan(""))),
      types(cells.types.size() > 1 ? cells.types : std::vector<std::string>{}),
      map(cells.map) {}

std::string unequal_sides(const ShownField& shown) {
  const int left = shown.field.start_column(), right = shown.field.columns - 1 - left;
  if (left == right) return "";
  return fmt::format(
      "{} columns: {} to the left of the start and {} to its right. This alone makes the sides "
      "differ.\n",
      shown.field.columns, left, right);
}

}  // namespace gatewalk::cli
