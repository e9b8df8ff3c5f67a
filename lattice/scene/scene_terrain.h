// SPDX-License-Identifier: MIT
#pragma once
/// Reads tables [terrain] and [actions] of a scene, and [actions] of a file of cells.

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

/// One key of the table, as a file or an override gives it; the node must outlive it.
struct TerrainSetting {
  const toml::node* value;
  Origin origin;
  std::string folder;   // that a path in it starts from
  std::string spelled;  // a key of a type as it is written, perhaps in another unit

  [[nodiscard]] std::string where() const { return origin(value->source().begin.line); }
};
/// "map", "random.s", "types.s", "types.s.forces.propulsion_N", "actions.push", ...
using TerrainSettings = std::map<std::string, TerrainSetting, std::less<>>;

/// Adds the keys of the table [terrain] of `document`, if it has one: they replace those that are
/// there. Throws SceneError for what is no key of it, naming the closest one of a type's.
void add_terrain(TerrainSettings& settings, const toml::table& document, const Origin& origin,
                 const std::string& folder);

/// The value of the key `name` of a scene, for a type. Throws SceneError when it is not permitted.
using TypeValue =
    std::function<double(std::string_view name, const TerrainSetting& given, const std::string&)>;

/// Reads the map (map, map_file and grey, random and seed) of a terrain whose types are known.
/// Throws SceneError as terrain_of.
void read_map(Terrain& terrain, const TerrainSettings& settings, const FieldParams& field);

/// None without settings. Throws SceneError naming the line, row and column for a map that does not
/// fill the field or has a type that there is not, and for shares that are none.
[[nodiscard]] std::optional<Terrain> terrain_of(const TerrainSettings& settings,
                                                const FieldParams& field, const TypeValue& value);

/// The same for the table [actions] of `document`: settings of their own. Throws SceneError for
/// what a body cannot choose.
void add_actions(TerrainSettings& settings, const toml::table& document, const Origin& origin);
/// The same of a file of cells, whose actions have keys parameters.KEY: numbers of a program.
void add_program_actions(TerrainSettings& settings, const toml::table& document,
                         const Origin& origin);
/// By name. Throws SceneError for more than a hundred.
[[nodiscard]] std::vector<Terrain::Type> actions_in(const TerrainSettings& settings,
                                                    const TypeValue& value);

}  // namespace gatewalk::lattice
