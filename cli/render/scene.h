// SPDX-License-Identifier: MIT
#pragma once
/// A scene in words, as a table and as a figure.

#include <string>
#include <vector>

#include "cli/render/figure.h"
#include "cli/render/shown_field.h"
#include "lattice/scene/scene.h"
#include "markov/chain.h"

namespace gatewalk::cli {

/// The scene in four lines: start, body and forces, beams and method.
[[nodiscard]] std::string scene_line(const lattice::Scene& scene,
                                     const std::vector<std::string>& actions = {});
/// The meaning of two endings, trapped and cut off, in this scene.
[[nodiscard]] std::string limits_text(const ShownField& shown);
/// The endings that no sequence of moves from the start can reach. `trapped` is never among them,
/// as it is no move. Empty for fields that are too large to search.
[[nodiscard]] std::vector<markov::Ending> impossible_endings(const ShownField& shown);
/// A warning that no body can cross the field within its limit of gates; empty otherwise.
[[nodiscard]] std::string too_few_gates(const ShownField& shown);

/// Every key with its value, unit, range, meaning and source.
[[nodiscard]] std::string table_of(const std::vector<lattice::KeyInfo>& keys);
/// The scene as a file to edit: every key with its value, unit, range and meaning.
[[nodiscard]] std::string commented(const lattice::Scene& scene);

/// A gate to scale: the disc at its start, the beams at rest, each length and force at its place,
/// and the keys that give them.
[[nodiscard]] Figure figure_of(const lattice::Scene& scene);

}  // namespace gatewalk::cli
