// SPDX-License-Identifier: MIT
#include "lattice/scene/scene_terrain.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "lattice/scene/grey_picture.h"
#include "lattice/scene/scene.h"
#include "lattice/scene/units.h"
#include "lattice/text/csv.h"
#include "lattice/text/lines.h"
#include "lattice/text/toml_text.h"

namespace gatewalk::lattice {
namespace {

constexpr std::size_t kMostTypes = 100;
constexpr const char* kKeys = "map, map_file, grey, random, seed and types";

const toml::table& table_at(const toml::node& node, const std::string& name, const Origin& origin) {
  if (const auto* table = node.as_table()) return *table;
  throw SceneError(origin(node.source().begin.line) + ": " + name + shown_value(node) +
                   " is not permitted: must be a table");
}

/// One row of a map, and the beginning of messages about it.
struct MapRow {
  std::string text, where;
};

std::vector<MapRow> rows_given(const TerrainSetting& map) {
  const auto refuse = [&](const toml::node& node) {
    throw SceneError(map.origin(node.source().begin.line) + ": terrain.map" + shown_value(node) +
                     " is not permitted: must be an array of texts, a row of gates each, the far "
                     "side first, such as [\".s.\", \"...\"]");
  };
  std::vector<MapRow> rows;
  if (!map.value->is_array()) refuse(*map.value);
  for (const toml::node& row : *map.value->as_array()) {
    if (!row.is_string()) refuse(row);
    rows.push_back({row.as_string()->get(), map.origin(row.source().begin.line) + ": terrain.map"});
  }
  return rows;
}

std::string path_of(const TerrainSetting& given) {
  const auto* name = given.value->as_string();
  if (!name)
    throw SceneError(given.where() + ": terrain.map_file" + shown_value(*given.value) +
                     " is not permitted: must be the name of a file, such as \"terrain.csv\"");
  return (std::filesystem::path(given.folder) / name->get()).string();
}

std::vector<MapRow> rows_of_file(const TerrainSetting& given, const std::string& path) {
  std::error_code none;
  if (std::filesystem::is_character_file(path, none) || std::filesystem::is_block_file(path, none))
    throw SceneError(given.where() + ": terrain.map_file: " + path +
                     " is a device: must be a file, whose end can be read");
  std::vector<MapRow> rows;
  try {
    std::size_t line = 0;
    for (const std::string& text : lines_of(path)) {
      ++line;
      if (!text.starts_with("# "))  // a comment
        rows.push_back({text, path + ":" + std::to_string(line)});
    }
  } catch (const std::invalid_argument& e) {
    throw SceneError(given.where() + ": terrain.map_file: " + e.what());
  }
  const auto is_blank = [](const MapRow& row) {
    return row.text.find_first_not_of(" ,;\t") == row.text.npos;
  };
  while (!rows.empty() && is_blank(rows.back())) rows.pop_back();
  return rows;
}

/// The names in a row: separated by commas, semicolons or tabs, or one letter each.
std::vector<std::string> names_in(const std::string& row, int columns) {
  const char separator = separator_in(row);
  if (columns > 1 && row.find(separator) == row.npos) {
    std::vector<std::string> names;
    for (const char c : row) names.emplace_back(1, c);
    return names;
  }
  std::vector<std::string> names = csv_fields(row, separator).value_or(std::vector{row});
  if (std::ssize(names) == columns + 1 && names.back().empty()) names.pop_back();
  return names;
}

std::string all_names(const Terrain& terrain) {
  std::string names = terrain.own;
  for (const Terrain::Type& type : terrain.types) names += ", " + type.name;
  return names;
}

/// Index of a type in the terrain, from 1; 0: its own gate; -1: unknown.
int type_named(const Terrain& terrain, std::string_view name) {
  if (name == terrain.own) return 0;
  for (std::size_t i = 0; i < terrain.types.size(); ++i)
    if (terrain.types[i].name == name) return static_cast<int>(i) + 1;
  return -1;
}

std::vector<int> cells_of(const std::vector<MapRow>& rows, const std::string& where,
                          const Terrain& terrain, const FieldParams& field) {
  if (std::ssize(rows) != field.rows)
    throw SceneError(where + ": the map has " + std::to_string(rows.size()) +
                     " rows, field.rows = " + std::to_string(field.rows));
  std::vector<int> types(rows.size() * static_cast<std::size_t>(field.columns));
  for (int r = 0; r < field.rows; ++r) {
    const MapRow& row = rows[static_cast<std::size_t>(r)];
    const std::string begin = row.where + ": row " + std::to_string(r + 1) + " of the map";
    const std::vector<std::string> names = names_in(row.text, field.columns);
    if (std::ssize(names) != field.columns)
      throw SceneError(begin + " has " + std::to_string(names.size()) +
                       " gates, field.columns = " + std::to_string(field.columns));
    for (int c = 0; c < field.columns; ++c) {
      const std::string& name = names[static_cast<std::size_t>(c)];
      const int type = type_named(terrain, name);
      if (type < 0)
        throw SceneError(begin + ", column " + std::to_string(c + 1) + ": \"" + printable(name) +
                         "\" is no type of gate: there are " + all_names(terrain));
      types[static_cast<std::size_t>((field.rows - 1 - r) * field.columns + c)] = type;
    }
  }
  return types;
}

/// The types by grey value, from terrain.grey.
std::map<int, int> types_by_grey(const TerrainSettings& settings, const Terrain& terrain) {
  std::map<int, int> types;
  for (const auto& [key, given] : settings) {
    if (!key.starts_with("grey.")) continue;
    const std::string name = key.substr(key.find('.') + 1);
    const std::string begin = given.where() + ": terrain.grey." +
                              (name == kOwnGate ? "\".\"" : name) + shown_value(*given.value);
    const int type = type_named(terrain, name);
    if (type < 0)
      throw SceneError(begin + ": " + printable(name) + " is no type of gate: there are " +
                       all_names(terrain));
    const auto* grey = given.value->as_integer();
    if (!grey || grey->get() < 0 || grey->get() > 255)
      throw SceneError(begin +
                       " is not permitted: must be a whole number from 0 (black) to 255 "
                       "(white)");
    if (!types.emplace(static_cast<int>(grey->get()), type).second)
      throw SceneError(begin + " is not permitted: another type has it");
  }
  return types;
}

std::vector<int> cells_of_picture(const TerrainSetting& given, const std::string& path,
                                  const std::map<int, int>& types, const FieldParams& field) {
  const std::string begin = given.where() + ": terrain.map_file: " + path + ": ";
  std::string greys;
  for (const auto& [grey, type] : types)
    greys += (greys.empty() ? "" : ", ") + std::to_string(grey);
  if (types.empty())
    throw SceneError(begin +
                     "a picture needs the grey value of each type: terrain.grey = { s = 0, "
                     "\".\" = 255 }");
  GreyPicture picture;
  try {
    picture = read_grey_png(path, field.columns, field.rows);
  } catch (const std::runtime_error& e) {
    throw SceneError(begin + e.what());
  }
  std::vector<int> cells(picture.grey.size());
  for (int r = 0; r < field.rows; ++r)
    for (int c = 0; c < field.columns; ++c) {
      const int grey = picture.grey[static_cast<std::size_t>(r * field.columns + c)];
      const auto type = types.find(grey);
      if (type == types.end())
        throw SceneError(begin + "row " + std::to_string(r + 1) + ", column " +
                         std::to_string(c + 1) + " has the grey value " + std::to_string(grey) +
                         ": terrain.grey has " + greys);
      cells[static_cast<std::size_t>((field.rows - 1 - r) * field.columns + c)] = type->second;
    }
  return cells;
}

std::map<std::string, double> type_shares(const TerrainSettings& settings, const Terrain& terrain) {
  std::map<std::string, double> shares;
  double sum = 0.0;
  for (const auto& [key, given] : settings) {
    if (!key.starts_with("random.")) continue;
    const std::string name = key.substr(key.find('.') + 1);
    const std::string begin = given.where() + ": terrain." + key + shown_value(*given.value);
    if (type_named(terrain, name) < 1)
      throw SceneError(begin + ": " + printable(name) + " is no type of gate: there are " +
                       all_names(terrain) + "; what the shares leave is \"" + terrain.own + "\"");
    const auto share = given.value->value<double>();
    if (!given.value->is_number() || !(*share >= 0.0 && *share <= 1.0))
      throw SceneError(begin + " is not permitted: must be a share in [0, 1]");
    sum += shares[name] = *share;
    if (sum > 1.0 + 1e-9)
      throw SceneError(begin + ": the shares of terrain.random sum up to " + shortest(sum) +
                       ", more than 1");
  }
  return shares;
}

/// A group of named gates, each with some keys different from the scene.
struct Group {
  std::string key, table;  // "types", "terrain.types"
  std::string one, other;  // for messages
  bool (*may_have)(std::string_view key);
  std::string (*known)(const std::string& given, const std::string& where) = known_key;
};
const Group kTypes{
    "types.", "terrain.types", "a type's",
    "all gates of a field have it in common; a type has beams (but their joints), forces and "
    "contact of its own",
    may_differ};
const Group kActions{
    "actions.", std::string(kActionsTable), "an action's",
    "a body cannot choose it; an action has forces and beams (but their joints) of its own",
    [](std::string_view key) { return may_differ(key) && !key.starts_with("contact."); }};

/// True for the name of a program's number: parameters. and a word without blanks and '='.
bool is_parameter(std::string_view key) {
  constexpr unsigned char kDelete = 127;
  return key.starts_with(kParameters) && key.size() > kParameters.size() &&
         std::none_of(key.begin(), key.end(),
                      [](unsigned char c) { return c <= ' ' || c == '=' || c == kDelete; });
}
const Group kProgramActions{
    "actions.",
    std::string(kActionsTable),
    "an action's",
    "an action of cells has numbers of the program that carries bodies through, parameters.KEY",
    is_parameter,
    [](const std::string& given, const std::string&) { return given; }};

void add_gate(TerrainSettings& settings, const Group& group, const std::string& name,
              const toml::node& node, const Origin& origin, const std::string& folder) {
  const std::string shown = group.table + "." + printable(name);
  if (!is_name(name))
    throw SceneError(origin(node.source().begin.line) + ": " + shown + ": " + group.one +
                     " name must be letters, digits and _, and begin with a letter");
  const auto add = [&](const std::string& key, const toml::node& value,
                       const std::string& spelled) {
    settings.insert_or_assign(key, TerrainSetting{&value, origin, folder, spelled});
  };
  const std::string gate = group.key + name;
  add(gate, node, "");
  std::map<std::string, std::pair<const toml::node*, std::string>> seen;  // in this document
  const auto add_key = [&](const std::string& key, const toml::node& value) {
    const std::string where = origin(value.source().begin.line) + ": " + shown;
    const std::string known = group.known(key, where);
    if (!group.may_have(known))
      throw SceneError(where + "." + printable(key) + " is not permitted: " + group.other);
    if (const auto [other, is_new] = seen.try_emplace(known, &value, key); !is_new)
      throw SceneError(given_twice(*other->second.first, shown + "." + other->second.second, value,
                                   shown + "." + key, origin));
    add(gate + "." + known, value, key);
  };
  for (const auto& [table, keys] : table_at(node, shown, origin)) {
    const std::string of_table(table.str());
    if (!keys.is_table())
      add_key(of_table, keys);  // a whole key in quotation marks, or no key
    else
      for (const auto& [key, value] : *keys.as_table())
        add_key(of_table + "." + std::string(key.str()), value);
  }
}

void add_gates(TerrainSettings& settings, const Group& group, const toml::node& table,
               const Origin& origin, const std::string& folder) {
  for (const auto& [name, keys] : table_at(table, group.table, origin))
    add_gate(settings, group, std::string(name.str()), keys, origin, folder);
}

std::vector<Terrain::Type> gates_in(const TerrainSettings& settings, const Group& group,
                                    const TypeValue& value) {
  std::vector<Terrain::Type> gates;
  for (const auto& [key, given] : settings) {  // a gate stands before its keys
    if (!key.starts_with(group.key)) continue;
    const std::size_t dot = key.find('.', group.key.size());
    if (dot == key.npos) {
      gates.push_back({key.substr(group.key.size()), {}});
      continue;
    }
    const std::string name = key.substr(dot + 1);
    const double x =
        value(name, given, group.table + "." + gates.back().name + "." + given.spelled);
    std::string where = given.where();
    if (given.spelled != name && !where.starts_with("--set "))
      where += " (" + given.spelled + shown_value(*given.value) + ")";
    gates.back().keys.push_back({name, x, where});
  }
  if (gates.size() > kMostTypes)
    throw SceneError(settings.begin()->second.where() + ": more than " +
                     std::to_string(kMostTypes) + " tables " + group.table + ".NAME");
  return gates;
}

}  // namespace

void add_actions(TerrainSettings& settings, const toml::table& document, const Origin& origin) {
  if (const toml::node* const actions = document.get(kActionsTable))
    add_gates(settings, kActions, *actions, origin, "");
}

void add_program_actions(TerrainSettings& settings, const toml::table& document,
                         const Origin& origin) {
  if (const toml::node* const actions = document.get(kActionsTable))
    add_gates(settings, kProgramActions, *actions, origin, "");
}

std::vector<Terrain::Type> actions_in(const TerrainSettings& settings, const TypeValue& value) {
  return gates_in(settings, kActions, value);
}

void add_terrain(TerrainSettings& settings, const toml::table& document, const Origin& origin,
                 const std::string& folder) {
  const toml::node* const terrain = document.get(kTerrainTable);
  if (!terrain) return;
  const auto add = [&](const std::string& key, const toml::node& node) {
    settings.insert_or_assign(key, TerrainSetting{&node, origin, folder, ""});
  };
  for (const auto& [key, node] : table_at(*terrain, "terrain", origin)) {
    const std::string name(key.str());
    if (name == "map" || name == "map_file" || name == "seed") {
      add(name, node);
    } else if (name == "random" || name == "grey") {
      for (const auto& [type, number] : table_at(node, "terrain." + name, origin))
        add(name + "." + std::string(type.str()), number);
    } else if (name == "types") {
      add_gates(settings, kTypes, node, origin, folder);
    } else {
      throw SceneError(origin(node.source().begin.line) + ": unknown key terrain." +
                       printable(name) + "; [terrain] has " + kKeys);
    }
  }
  if (settings.empty())
    throw SceneError(origin(terrain->source().begin.line) + ": [terrain] is empty; it has " +
                     kKeys);
}

std::optional<Terrain> terrain_of(const TerrainSettings& settings, const FieldParams& field,
                                  const TypeValue& value) {
  if (settings.empty()) return std::nullopt;
  Terrain terrain;
  terrain.types = gates_in(settings, kTypes, value);
  read_map(terrain, settings, field);
  return terrain;
}

void read_map(Terrain& terrain, const TerrainSettings& settings, const FieldParams& field) {
  const std::string where = settings.begin()->second.where();
  const auto map = settings.find("map"), file = settings.find("map_file"),
             seed = settings.find("seed");
  const auto random = settings.lower_bound("random.");
  const bool is_random = random != settings.end() && random->first.starts_with("random.");
  if ((map != settings.end()) + (file != settings.end()) + (is_random ? 1 : 0) != 1)
    throw SceneError(where + ": [terrain] must have one of map, map_file and random");
  if (seed != settings.end()) {
    const auto* whole = seed->second.value->as_integer();
    const std::string begin =
        seed->second.where() + ": terrain.seed" + shown_value(*seed->second.value);
    if (!whole || whole->get() < 0)
      throw SceneError(begin + " is not permitted: must be a whole number from 0");
    if (!is_random) throw SceneError(begin + " has no meaning without terrain.random");
    terrain.seed = static_cast<std::uint64_t>(whole->get());
  }
  const auto greys = types_by_grey(settings, terrain);
  const std::string path = file != settings.end() ? path_of(file->second) : "";
  if (!greys.empty() && !has_ending(path, ".png")) {
    const auto grey = settings.lower_bound("grey.");
    throw SceneError(
        grey->second.where() +
        ": terrain.grey has no meaning without a picture: terrain.map_file = \"NAME.png\"");
  }
  if (is_random) {
    terrain.shares = type_shares(settings, terrain);
    terrain.type_of_cell = drawn_map(terrain, field);
  } else if (map != settings.end()) {
    terrain.type_of_cell =
        cells_of(rows_given(map->second), map->second.where() + ": terrain.map", terrain, field);
  } else if (has_ending(path, ".png")) {
    terrain.type_of_cell = cells_of_picture(file->second, path, greys, field);
  } else {
    terrain.type_of_cell = cells_of(rows_of_file(file->second, path),
                                    file->second.where() + ": terrain.map_file", terrain, field);
  }
}

}  // namespace gatewalk::lattice
