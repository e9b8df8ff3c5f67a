// SPDX-License-Identifier: MIT
#include "cli/render/shown_field.h"

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

}  // namespace gatewalk::cli
