// SPDX-License-Identifier: MIT
#pragma once
/// A scene as a problem: its gates as cells, its start as an entry.

#include "lattice/field/problem.h"
#include "lattice/scene/scene.h"
#include "lattice/scene/settle.h"

namespace gatewalk::lattice {

/// The problem of a scene, as chains see it: field.fidelity is "active". Throws InvalidParameter as
/// FieldGates::cells, and std::invalid_argument as own_start.
[[nodiscard]] Problem problem_of(const Scene& scene);
/// The parts of a scene's problem that do not depend on its method, for a scene that leaves the
/// method to a pilot; put_cells() adds the cells once the method is chosen. `from`: everywhere or
/// all_types.
[[nodiscard]] Problem problem_without_cells(const Scene& scene,
                                            RunsFrom from = RunsFrom::everywhere);
void put_cells(Problem& problem, const Scene& scene, RunsFrom from = RunsFrom::everywhere);

/// The problem of a scene with one cell type per type of the terrain, even if types are equal, so
/// that scenes that differ only in gates have the same map.
[[nodiscard]] Problem problem_with_all_types(const Scene& scene);

/// The scene cut to the rows of gates before `row`, without a limit of gates. Throws
/// std::invalid_argument if its terrain has fewer rows, and for a row not ahead of the start's.
[[nodiscard]] Scene up_to_row(const Scene& scene, int row);

}  // namespace gatewalk::lattice
