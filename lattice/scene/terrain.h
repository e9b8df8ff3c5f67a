// SPDX-License-Identifier: MIT
#pragma once
/// Gates of several types in one field: table [terrain] of a scene.

#include <string>
#include <string_view>
#include <vector>

#include "lattice/scene/scene.h"

namespace gatewalk::lattice {

class FieldGates;

/// How keys of a cell program's own numbers begin, in actions and in --set.
inline constexpr std::string_view kParameters = "parameters.";

/// Beams, forces and contacts, but not the joints: all gates of a field have body, size, method and
/// time limit in common.
[[nodiscard]] bool may_differ(std::string_view key);

/// The gate of a type: the scene's with the type's keys.
[[nodiscard]] dynamics::GateParams gate_of(const Scene& scene, const Terrain::Type& type);
/// The scene while a body takes this action: gates of all types have the keys of the action.
[[nodiscard]] Scene with_action(const Scene& scene, const Terrain::Type& action);
/// "\n[terrain.types.s]\n..." for each of them.
[[nodiscard]] std::string gates_toml(std::string_view table,
                                     const std::vector<Terrain::Type>& gates);
/// The gates of the scene's field: its own, then each type that is not like one before.
[[nodiscard]] FieldGates gates_of(const Scene& scene);
/// The same with every type of the terrain, in its order, also those that are alike.
[[nodiscard]] FieldGates all_gates_of(const Scene& scene);
/// By type of the terrain: which of gates_of(scene).types() it is.
[[nodiscard]] std::vector<int> gate_types(const Scene& scene);

/// Throws std::invalid_argument when the scene has a terrain; `what` cannot use it.
void require_no_terrain(const Scene& scene, const std::string& what);

/// A type for each cell of the field, drawn by the terrain's shares; the rest is the scene's own
/// gate. A cell's draw is that of its place from the start, whatever the size of the field.
[[nodiscard]] std::vector<int> drawn_map(const Terrain& terrain, const FieldParams& field);

/// The map, a row of gates each, the far side first: ".s.t", or ".,soft,.,stiff" where a name is
/// longer than a letter.
[[nodiscard]] std::vector<std::string> map_rows(const Terrain& terrain, const FieldParams& field);

/// "[terrain]\nmap = [...]\n\n[terrain.types.s]\n...": what reads back the same.
[[nodiscard]] std::string terrain_toml(const Terrain& terrain, const FieldParams& field);

}  // namespace gatewalk::lattice
