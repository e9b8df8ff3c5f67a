#pragma once
/// A scene as a problem: its gates as cells, its start as an entry.

#include "lattice/problem.h"
#include "lattice/scene/scene.h"

namespace gatewalk::lattice {

/// Of chains: field.fidelity is "active". Throws InvalidParameter as FieldGates::cells, and
/// std::invalid_argument as PaperStart::entry.
[[nodiscard]] Problem problem_of(const Scene& scene);

}  // namespace gatewalk::lattice
