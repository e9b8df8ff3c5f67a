// SPDX-License-Identifier: MIT
#pragma once
/// A drawing of a scene.

#include "cli/render/figure.h"
#include "lattice/scene/scene.h"

namespace gatewalk::cli {

/// One gate to scale: the disc at its start, the beams at rest, each length and force at its place,
/// and the keys that give them.
[[nodiscard]] Figure figure_of(const lattice::Scene& scene);

}  // namespace gatewalk::cli
