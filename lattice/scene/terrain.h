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

/// True for keys that may differ between types: beams, forces and contacts, but not the joints. All
/// gates of a field share body, size, method and time limit.
[[nodiscard]] bool may_differ(std::string_view key);

/// The gate of a type: the scene's gate with the type's keys.
[[nodiscard]] dynamics::GateParams gate_of(const Scene& scene, const Terrain::Type& type);
/// The scene during an action of the body: gates of all types get the keys of the action.
[[nodiscard]] Scene with_action(const Scene& scene, const Terrain::Type& action);
/// Gates as TOML tables, "\n[terrain.types.s]\n...".
[[nodiscard]] std::string gates_toml(std::string_view table,
                                     const std::vector<Terrain::Type>& gates);
/// The gates of the scene's field: its own, followed by each type that differs from those before.
[[nodiscard]] FieldGates gates_of(const Scene& scene);
/// The gates of the scene's field with every type of the terrain, in its order, even if types are
/// equal.
[[nodiscard]] FieldGates all_gates_of(const Scene& scene);
/// By type of the terrain: its index in gates_of(scene).types().
[[nodiscard]] std::vector<int> gate_types(const Scene& scene);

/// Throws std::invalid_argument if the scene has a terrain, which `what` cannot use.
void require_no_terrain(const Scene& scene, const std::string& what);

/// The type of each cell of the field, drawn with the terrain's shares; the remaining share is the
/// scene's own gate. The draw of a cell depends on its place relative to the start, not on the size
/// of the field.
[[nodiscard]] std::vector<int> drawn_map(const Terrain& terrain, const FieldParams& field);

/// The map as one text per row of gates, the far side first: ".s.t", or ".,soft,.,stiff" if a name
/// is longer than a letter.
[[nodiscard]] std::vector<std::string> map_rows(const Terrain& terrain, const FieldParams& field);

/// The terrain as TOML that reads back the same: "[terrain]\nmap =
/// [...]\n\n[terrain.types.s]\n...".
[[nodiscard]] std::string terrain_toml(const Terrain& terrain, const FieldParams& field);

}  // namespace gatewalk::lattice
