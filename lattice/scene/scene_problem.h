// SPDX-License-Identifier: MIT
#pragma once
/// A scene as a problem: its gates as cells, its start as an entry.

#include "lattice/field/problem.h"
#include "lattice/scene/scene.h"
#include "lattice/scene/settle.h"

namespace gatewalk::lattice {

/// Of chains: field.fidelity is "active". Throws InvalidParameter as FieldGates::cells, and
/// std::invalid_argument as own_start.
[[nodiscard]] Problem problem_of(const Scene& scene);
/// The same of a scene that leaves its method to a pilot: what does not depend on the method, and
/// what put_cells adds when the method is chosen. `from`: everywhere or all_types, as below.
[[nodiscard]] Problem problem_without_cells(const Scene& scene,
                                            RunsFrom from = RunsFrom::everywhere);
void put_cells(Problem& problem, const Scene& scene, RunsFrom from = RunsFrom::everywhere);

/// The same with a type of cell for each of the terrain, also those that are alike: scenes that
/// differ in gates alone have the same map.
[[nodiscard]] Problem problem_with_all_types(const Scene& scene);

/// The scene with as many rows of gates as there are before `row`, and no limit of gates. Throws
/// std::invalid_argument where its terrain has fewer, and for a row below 1.
[[nodiscard]] Scene up_to_row(const Scene& scene, int row);

}  // namespace gatewalk::lattice
