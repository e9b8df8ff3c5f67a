// SPDX-License-Identifier: MIT
#include "lattice/scene/terrain.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "dynamics/base/random.h"
#include "lattice/gates/gates.h"
#include "lattice/scene/scene.h"
#include "lattice/text/digits.h"

namespace gatewalk::lattice {
namespace {

using dynamics::GateParams;

bool alike(const GateParams& a, const GateParams& b) {
  const auto table = dynamics::gate_param_table();
  return std::all_of(table.begin(), table.end(),
                     [&](const dynamics::ParamInfo& info) { return info.get(a) == info.get(b); });
}

/// The different gates, and which of them each type of the terrain is.
std::pair<std::vector<GateParams>, std::vector<int>> sorted_out(const Scene& scene) {
  std::vector<GateParams> gates{scene.gate};
  std::vector<int> types;
  for (const Terrain::Type& type : scene.terrain->types) {
    const GateParams gate = gate_of(scene, type);
    const auto known = std::find_if(gates.begin(), gates.end(),
                                    [&](const GateParams& other) { return alike(gate, other); });
    types.push_back(static_cast<int>(known - gates.begin()));
    if (known == gates.end()) gates.push_back(gate);
  }
  return {std::move(gates), std::move(types)};
}

/// A key as TOML writes it, in quotation marks if a part has more than letters, digits, _ and -.
std::string key_toml(const std::string& key) {
  constexpr std::string_view kBare =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-";
  const std::size_t dot = key.find_first_not_of(kBare);
  if (dot == key.npos || (key[dot] == '.' && key.find_first_not_of(kBare, dot + 1) == key.npos))
    return key;
  std::string quoted = "\"";
  for (const char c : key) quoted += c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
  return quoted + "\"";
}

}  // namespace

bool may_differ(std::string_view key) {
  return (key.starts_with("beams.") && !key.starts_with("beams.joint_")) ||
         key.starts_with("forces.") || key.starts_with("contact.");
}

GateParams gate_of(const Scene& scene, const Terrain::Type& type) {
  GateParams gate = scene.gate;
  for (const Terrain::Key& key : type.keys)
    for (const dynamics::ParamInfo& info : dynamics::gate_param_table())
      if (info.key == key.name) info.ref(gate) = key.value;
  return gate;
}

Scene with_action(const Scene& scene, const Terrain::Type& action) {
  Scene taken = scene;
  taken.gate = gate_of(scene, action);
  taken.actions.clear();
  for (const Terrain::Key& key : action.keys) {
    taken.named[key.name] = key.origin;
    taken.derived.erase(key.name);
  }
  if (taken.terrain)
    for (Terrain::Type& type : taken.terrain->types)
      for (const Terrain::Key& key : action.keys) {
        std::erase_if(type.keys, [&](const Terrain::Key& k) { return k.name == key.name; });
        type.keys.push_back(key);
      }
  return taken;
}

std::string gates_toml(std::string_view table, const std::vector<Terrain::Type>& gates) {
  std::string text;
  for (const Terrain::Type& gate : gates) {
    text += "\n[" + std::string(table) + "." + gate.name + "]\n";
    for (const Terrain::Key& key : gate.keys)
      text += key_toml(key.name) + " = " + toml_float(key.value) + "\n";
  }
  return text;
}

FieldGates gates_of(const Scene& scene) {
  if (!scene.terrain) return scene.gate;
  auto [gates, types] = sorted_out(scene);
  if (gates.size() == 1) return scene.gate;
  std::vector<int> type_of_cell = scene.terrain->type_of_cell;
  for (int& type : type_of_cell)
    if (type > 0) type = types[static_cast<std::size_t>(type - 1)];
  return FieldGates::by_cell(std::move(gates), scene.field.columns, std::move(type_of_cell));
}

FieldGates all_gates_of(const Scene& scene) {
  if (!scene.terrain) return scene.gate;
  std::vector<GateParams> gates{scene.gate};
  for (const Terrain::Type& type : scene.terrain->types) gates.push_back(gate_of(scene, type));
  return FieldGates::by_cell(std::move(gates), scene.field.columns, scene.terrain->type_of_cell);
}

std::vector<int> gate_types(const Scene& scene) {
  return scene.terrain ? sorted_out(scene).second : std::vector<int>{};
}

void require_no_terrain(const Scene& scene, const std::string& what) {
  if (scene.terrain)
    throw std::invalid_argument(scene.source + ": its table [terrain] is not permitted for " +
                                what + ", which has gates of one type");
}

std::vector<int> drawn_map(const Terrain& terrain, const FieldParams& field) {
  std::vector<int> types;
  for (int row = 0; row < field.rows; ++row)
    for (int column = 0; column < field.columns; ++column) {
      // Two's complement counts columns from the middle one in both directions.
      const auto i_x =
          static_cast<std::uint64_t>(std::int64_t{column} - std::int64_t{field.middle_column()});
      dynamics::Random random(dynamics::Purpose::terrain,
                              {terrain.seed, static_cast<std::uint64_t>(row), i_x});
      double left = random.uniform();
      int drawn = 0;
      for (std::size_t type = 0; type < terrain.types.size() && drawn == 0; ++type) {
        const auto share = terrain.shares.find(terrain.types[type].name);
        if (share == terrain.shares.end()) continue;
        if (left < share->second) drawn = static_cast<int>(type) + 1;
        left -= share->second;
      }
      types.push_back(drawn);
    }
  return types;
}

std::vector<std::string> map_rows(const Terrain& terrain, const FieldParams& field) {
  std::vector<std::string> names{terrain.own};
  for (const Terrain::Type& type : terrain.types) names.push_back(type.name);
  const bool letters = std::all_of(names.begin(), names.end(),
                                   [](const std::string& name) { return name.size() == 1; });
  std::vector<std::string> rows;
  for (int row = field.rows; row-- > 0;) {
    std::string& text = rows.emplace_back();
    for (int column = 0; column < field.columns; ++column) {
      if (column > 0 && !letters) text += ",";
      text += names[static_cast<std::size_t>(
          terrain.type_of_cell[static_cast<std::size_t>(row * field.columns + column)])];
    }
  }
  return rows;
}

std::string terrain_toml(const Terrain& terrain, const FieldParams& field) {
  std::string text = "[terrain]\n";
  if (terrain.shares.empty()) {
    text += "map = [\n";
    for (const std::string& row : map_rows(terrain, field)) text += "  \"" + row + "\",\n";
    text += "]\n";
  } else {
    std::string shares;
    for (const auto& [name, share] : terrain.shares)
      shares += (shares.empty() ? "" : ", ") + name + " = " + toml_float(share);
    text += "random = { " + shares + " }\nseed = " + std::to_string(terrain.seed) + "\n";
  }
  return text + gates_toml("terrain.types", terrain.types);
}

}  // namespace gatewalk::lattice
