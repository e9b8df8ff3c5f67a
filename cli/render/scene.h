// SPDX-License-Identifier: MIT
#pragma once
/// What a scene says, in words.

#include <string>
#include <vector>

#include "cli/render/figure.h"
#include "cli/render/shown_field.h"
#include "lattice/scene/scene.h"

namespace gatewalk::cli {

/// What is run, in four lines: start, body and forces, beams and method.
[[nodiscard]] std::string scene_line(const lattice::Scene& scene,
                                     const std::vector<std::string>& actions = {});
/// What two of the endings mean in this scene, below them.
[[nodiscard]] std::string limits_text(const ShownField& shown);
/// That no body can cross the field within the gates it may visit; empty if one can.
[[nodiscard]] std::string too_few_gates(const ShownField& shown);

/// Every key with its value, unit, range, meaning and source.
[[nodiscard]] std::string table_of(const std::vector<lattice::KeyInfo>& keys);
/// The scene as a file to edit: every key with its value, unit, range and meaning.
[[nodiscard]] std::string commented(const lattice::Scene& scene);

/// One gate to scale: the disc at its start, the beams at rest, each length and force at its place,
/// and the keys that give them.
[[nodiscard]] Figure figure_of(const lattice::Scene& scene);

}  // namespace gatewalk::cli
