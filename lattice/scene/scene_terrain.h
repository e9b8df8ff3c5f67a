// SPDX-License-Identifier: MIT
#pragma once
/// Reads tables [terrain] and [actions] of a scene, and [actions] of a cell file.

#include <toml++/toml.h>

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lattice/scene/terrain.h"
#include "lattice/scene/toml_settings.h"

namespace gatewalk::lattice {

inline constexpr std::string_view kTerrainTable = "terrain", kActionsTable = "actions";

/// One key of the table, as a file or an override gives it. The node must outlive it.
struct TerrainSetting {
  const toml::node* value;
  Origin origin;
  std::string folder;   // folder that relative paths start from
  std::string spelled;  // a type's key as the user wrote it, perhaps in another unit

  [[nodiscard]] std::string where() const { return origin(value->source().begin.line); }
};
/// By key: "map", "random.s", "types.s", "types.s.forces.propulsion_N", "actions.push", ...
using TerrainSettings = std::map<std::string, TerrainSetting, std::less<>>;

/// Adds the keys of the table [terrain] of `document`, if there is one; they replace keys already
/// in `settings`. Throws SceneError for an unknown key, naming the closest key of a type.
void add_terrain(TerrainSettings& settings, const toml::table& document, const Origin& origin,
                 const std::string& folder);

/// Returns the value of the key `name` for a type of gate. Throws SceneError if the value is not
/// permitted.
using TypeValue =
    std::function<double(std::string_view name, const TerrainSetting& given, const std::string&)>;

/// Reads the map of a terrain with known types (keys map, map_file and grey, random and seed).
/// Throws SceneError as terrain_of.
void read_map(Terrain& terrain, const TerrainSettings& settings, const FieldParams& field);

/// The terrain; nullopt without settings. Throws SceneError, naming line, row and column, for a map
/// that does not fill the field or has an unknown type, and for invalid shares.
[[nodiscard]] std::optional<Terrain> terrain_of(const TerrainSettings& settings,
                                                const FieldParams& field, const TypeValue& value);

/// Adds the keys of the table [actions] of `document`. Throws SceneError for keys that an action
/// cannot change.
void add_actions(TerrainSettings& settings, const toml::table& document, const Origin& origin);
/// Adds the keys of [actions] of a cell file, which are parameters.KEY: numbers of a program.
void add_program_actions(TerrainSettings& settings, const toml::table& document,
                         const Origin& origin);
/// The actions, in the order of their names. Throws SceneError for more than a hundred.
[[nodiscard]] std::vector<Terrain::Type> actions_in(const TerrainSettings& settings,
                                                    const TypeValue& value);

}  // namespace gatewalk::lattice
