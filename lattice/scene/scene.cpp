// SPDX-License-Identifier: MIT
#include "lattice/scene/scene.h"

#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <utility>
#include <variant>

#include "dynamics/disc/methods/method.h"
#include "lattice/gates/gates.h"
#include "lattice/scene/scene_bins.h"
#include "lattice/scene/scene_keys.h"
#include "lattice/scene/scene_terrain.h"
#include "lattice/scene/toml_settings.h"
#include "lattice/scene/units.h"
#include "lattice/text/digits.h"
#include "lattice/text/edit_distance.h"
#include "lattice/text/toml_text.h"

namespace gatewalk::lattice {
namespace {

constexpr std::size_t kLongestCompared = 100;  // bytes of an unknown key

// ---- The table of keys

constexpr std::string_view kMethodKey = "run.method";
constexpr const char* kFidelityKey = "field.fidelity";
constexpr std::string_view kStartColumnKey = "field.start_column", kStartRowKey = "field.start_row";
constexpr std::string_view kSweepTable = "sweep";

using Slot = std::variant<double*, int*, std::optional<int>*, std::string*, Fidelity*>;

struct SceneKey {
  std::string_view key;
  std::function<Slot(Scene&)> slot;
  std::function<Interval(const Scene&)> permitted;  // may depend on keys before this one
  std::string_view meaning;
};

/// Every key of a scene in canonical order: keys of GateParams, then field and start.
const std::vector<SceneKey>& scene_keys() {
  static const std::vector<SceneKey> keys = [] {
    const auto fixed = [](Interval interval) {
      return [interval](const Scene&) { return interval; };
    };
    std::vector<SceneKey> all;
    for (const dynamics::ParamInfo& info : dynamics::gate_param_table()) {
      if (info.key == "run.step_s") {
        all.push_back({kMethodKey,
                       [](Scene& s) { return Slot(&s.gate.run.method); },
                       {},
                       "method of time stepping: auto, stable, moreau, event, penalty, paper"});
      }
      all.push_back({info.key, [&info](Scene& s) { return Slot(&info.ref(s.gate)); },
                     [&info](const Scene&) {
                       return Interval{info.low, info.high, info.low_open};
                     },
                     info.meaning});
    }
    // In the scene's own units: far enough for any study, near enough to compute with.
    constexpr double kFar = 1e12;
    const auto speeds = [](const Scene& s) {
      const double most = kFar * dynamics::scale_of(s.gate).speed();
      return Interval{-most, most};
    };
    const auto add = [&](std::string_view key, auto slot,
                         std::function<Interval(const Scene&)> permitted,
                         std::string_view meaning) {
      all.push_back(
          {key, [slot](Scene& s) { return Slot(slot(s)); }, std::move(permitted), meaning});
    };
    add(
        "field.columns", [](Scene& s) { return &s.field.columns; }, fixed(kFieldSizes),
        "columns of gates, side by side");
    add(
        "field.rows", [](Scene& s) { return &s.field.rows; }, fixed(kFieldSizes),
        "rows of gates, one behind the other");
    add(
        "field.max_gates", [](Scene& s) { return &s.field.max_gates; }, fixed(kGateLimits),
        "gates that a body may visit before it is cut off; 0: no limit");
    add(
        kStartColumnKey, [](Scene& s) { return &s.field.own_start_column; },
        [](const Scene& s) { return below(s.field.columns); },
        "column that bodies start in, from 0 at the left; default: the middle one");
    add(
        kStartRowKey, [](Scene& s) { return &s.field.start_row; },
        [](const Scene& s) { return below(s.field.rows); },
        "row that bodies start in, from 0, the near one");
    add(
        kFidelityKey, [](Scene& s) { return &s.field.fidelity; }, {},
        "beams that act: active (the body's gate), remember (also the last), all");
    add(
        "start.x_m", [](Scene& s) { return &s.start.x; },
        [](const Scene& s) {
          return Interval{-s.gate.beams.joint_x, s.gate.beams.joint_x};
        },
        "x of the start, from the gate's middle line; at a side: the body enters by the side");
    add(
        "start.y_m", [](Scene& s) { return &s.start.y; },
        [](const Scene& s) {
          return Interval{-kFar * dynamics::scale_of(s.gate).length, s.gate.run.traverse_y, false,
                          true};
        },
        "y of the start, from the gate's entrance");
    add(
        "start.vx_m_per_s", [](Scene& s) { return &s.start.vx; }, speeds,
        "lateral velocity at the start");
    add(
        "start.vy_m_per_s", [](Scene& s) { return &s.start.vy; }, speeds,
        "forward velocity at the start");
    return all;
  }();
  return keys;
}

const SceneKey* find_key(std::string_view name) {
  const auto& keys = scene_keys();
  const auto it =
      std::find_if(keys.begin(), keys.end(), [&](const SceneKey& k) { return k.key == name; });
  return it == keys.end() ? nullptr : &*it;
}

std::string_view table_of(std::string_view key) { return key.substr(0, key.find('.')); }
std::string_view leaf_of(std::string_view key) { return key.substr(key.find('.') + 1); }

bool is_table(std::string_view name) {
  const auto& keys = scene_keys();
  return std::any_of(keys.begin(), keys.end(),
                     [&](const SceneKey& k) { return table_of(k.key) == name; });
}

// ---- Texts

/// The table whose name is nearest to `name`.
std::string_view closest_table(std::string_view name) {
  name = name.substr(0, kLongestCompared);
  std::vector<std::string_view> tables;
  for (const SceneKey& key : scene_keys()) tables.push_back(table_of(key.key));
  tables.insert(tables.end(), {kSweepTable, kBinsTable, kTerrainTable, kActionsTable});
  return *std::min_element(tables.begin(), tables.end(),
                           [&](std::string_view a, std::string_view b) {
                             return edit_distance(name, a) < edit_distance(name, b);
                           });
}

/// The key nearest to `name`, by its whole length or by the part after the table's name.
std::string_view closest_key(std::string_view name) {
  name = name.substr(0, kLongestCompared);
  // Compares without case.
  const auto small = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
  for (const SceneKey& k : scene_keys())
    if (std::ranges::equal(name, k.key, {}, small, small)) return k.key;
  // Users often forget the unit.
  for (const SceneKey& k : scene_keys())
    if (!leaf_of(name).empty() && table_of(k.key) == table_of(name) &&
        leaf_of(k.key).starts_with(leaf_of(name)))
      return k.key;
  // An unknown word is meant for the table that it stands in; a known key of another table keeps
  // its spelling.
  const auto is_elsewhere = [&](const SceneKey& k) { return leaf_of(k.key) == leaf_of(name); };
  const bool in_table = is_table(table_of(name)) && name.find('.') != name.npos &&
                        std::none_of(scene_keys().begin(), scene_keys().end(), is_elsewhere);
  std::string_view closest;
  std::size_t least = name.npos;
  for (const SceneKey& k : scene_keys()) {
    if (in_table && table_of(k.key) != table_of(name)) continue;
    const std::size_t distance =
        std::min(edit_distance(name, k.key), 1 + edit_distance(leaf_of(name), leaf_of(k.key)));
    if (distance < least) {
      least = distance;
      closest = k.key;
    }
  }
  return closest;
}

/// "the closest known key is body.mass_kg"; names both beams' keys if `name` does not say which.
std::string closest_keys(std::string_view name) {
  const std::string key(closest_key(name));
  const auto other_side = [&](const std::string& side, const std::string& other) {
    const std::size_t at = key.find(side);
    return at == key.npos ? "" : key.substr(0, at) + other + key.substr(at + side.size());
  };
  if (name.find("left") == name.npos && name.find("right") == name.npos) {
    if (const std::string right = other_side("_left", "_right"); !right.empty())
      return "the closest known keys are " + key + " and " + right;
    if (const std::string left = other_side("_right", "_left"); !left.empty())
      return "the closest known keys are " + left + " and " + key;
  }
  return "the closest known key is " + key;
}

// ---- From TOML to settings

/// All keys that `document` sets. Throws SceneError for a key that no scene has.
Settings settings_of(const toml::table& document, const Origin& origin) {
  Settings settings;
  for (const auto& [table_key, table_node] : document) {
    const std::string table_name(table_key.str());
    const std::string table_origin = origin(table_node.source().begin.line);
    const toml::table* table = table_node.as_table();
    if (table_name == kSweepTable || table_name == kBinsTable || table_name == kTerrainTable ||
        table_name == kActionsTable)
      continue;  // read separately
    if (!is_table(table_name)) {
      throw SceneError(table_origin + ": unknown " +
                       (table ? "table " + printable(table_name) + "; the closest known table is " +
                                    std::string(closest_table(table_name))
                              : "key " + printable(table_name) + "; " + closest_keys(table_name)));
    }
    if (!table) {
      throw SceneError(table_origin + ": " + table_name + shown_value(table_node) +
                       " is not permitted: must be a table, written [" + table_name + "]");
    }
    for (const auto& [key, node] : *table) {
      const std::string name = table_name + "." + std::string(key.str());
      const std::string key_origin = origin(node.source().begin.line);
      const std::string known = known_key(name, key_origin);
      if (const auto other = settings.find(known); other != settings.end())
        throw SceneError(
            given_twice(*other->second.value, other->second.spelled, node, name, origin));
      settings[known] = {&node, key_origin, name};
    }
  }
  return settings;
}

/// Table [sweep]: keys of the scene, each with text "4:1:9" or "1,2", or an array of numbers or
/// texts.
std::vector<Variation> variations_of(const toml::table& document, const Origin& origin) {
  struct Found {
    toml::source_position place;
    Variation variation;
  };
  std::vector<Found> found;
  const auto item = [&](const toml::node& node, const std::string& begin) {
    if (const auto* text = node.as_string()) return text->get();
    if (const auto* whole = node.as_integer()) return std::to_string(whole->get());
    if (const auto* number = node.as_floating_point()) return shortest(number->get());
    throw SceneError(
        begin + shown_value(node) +
        " is not permitted: must be \"from:step:to\", or a number or text, or an array of these");
  };
  const auto take = [&](const std::string& name, const toml::node& node) {
    const std::string at = origin(node.source().begin.line);
    require_key(name, at);
    const std::string begin = at + ": sweep." + name;
    std::string values;
    if (const auto* array = node.as_array()) {
      for (const toml::node& n : *array) values += (values.empty() ? "" : ",") + item(n, begin);
    } else {
      values = item(node, begin);
    }
    found.push_back({node.source().begin, {name, values, begin}});
  };
  const toml::node* sweep = document.get(kSweepTable);
  if (!sweep) return {};
  if (!sweep->is_table())
    throw SceneError(origin(sweep->source().begin.line) + ": sweep" + shown_value(*sweep) +
                     " is not permitted: must be a table, written [sweep]");
  for (const auto& [table, node] : *sweep->as_table()) {
    const std::string name(table.str());
    if (!node.is_table()) {
      take(name, node);  // a whole key in quotation marks
      continue;
    }
    for (const auto& [key, value] : *node.as_table())
      take(name + "." + std::string(key.str()), value);
  }
  std::sort(found.begin(), found.end(),
            [](const Found& a, const Found& b) { return a.place < b.place; });
  std::vector<Variation> variations;
  for (Found& f : found) {
    for (const Variation& v : variations)
      if (known_key(v.key, v.origin) == known_key(f.variation.key, f.variation.origin))
        throw SceneError(f.variation.origin + " is there twice" +
                         (v.key == f.variation.key ? "" : ", as " + v.key + " before"));
    variations.push_back(std::move(f.variation));
  }
  return variations;
}

/// Adds "key=value" to `settings`; `documents` keeps the parsed values alive.
void apply_override(const std::string& given, std::deque<toml::table>& documents,
                    Settings& settings) {
  Override read = parse_override(
      given, [](std::string_view key) { return key == kMethodKey || key == kFidelityKey; });
  documents.push_back(std::move(read.document));
  const Settings added = settings_of(documents.back(), [&read](std::size_t) { return read.begin; });
  if (added.empty() && !documents.back().contains(kBinsTable) &&
      !documents.back().contains(kTerrainTable) && !documents.back().contains(kActionsTable))
    throw SceneError(read.begin + ": sets no key");
  for (const auto& [key, setting] : added) settings[key] = setting;
}

// ---- From settings to a scene

/// Assigns a setting to its key. `shown` names the key in messages; a number may be in another
/// unit.
void assign(const SceneKey& key, const Setting& setting, Scene& scene, std::string_view shown) {
  const auto refusal = [&](const std::string& allowed) {
    return SceneError(refusal_of(setting, shown, allowed));
  };
  const Slot slot = key.slot(scene);
  if (auto* const* text = std::get_if<std::string*>(&slot)) {
    const auto* string = setting.value->as_string();
    if (!string) throw refusal("be text, such as \"" + **text + "\"");
    **text = string->get();
  } else if (auto* const* fidelity = std::get_if<Fidelity*>(&slot)) {
    const auto* string = setting.value->as_string();
    const auto& names = kFidelityNames;
    const auto name = string ? std::find(names.begin(), names.end(), string->get()) : names.end();
    if (name == names.end()) {
      std::string known;
      for (const std::string_view n : names)
        known += (known.empty() ? "\"" : ", \"") + std::string(n) + "\"";
      throw refusal("be one of " + known);
    }
    **fidelity = static_cast<Fidelity>(name - names.begin());
  } else if (auto* const* integer = std::get_if<int*>(&slot)) {
    **integer = whole_number_of(setting, key.permitted(scene), shown);
  } else if (auto* const* own = std::get_if<std::optional<int>*>(&slot)) {
    **own = whole_number_of(setting, key.permitted(scene), shown);
  } else {
    *std::get<double*>(slot) = number_of(setting, key.key, key.permitted(scene), shown);
  }
}

void assign(const SceneKey& key, const Setting& setting, Scene& scene) {
  assign(key, setting, scene, setting.spelled);
}

/// Distance from the start to the nearest point of the two beams at rest (both on y = joint_y), m.
double distance_to_beams(const Scene& scene) {
  const dynamics::Beams beams =
      gates_of(scene).at(scene.field.start_column(), scene.field.start_row).beams;
  const auto to_beam = [&](double joint_x, double tip_x) {
    const double nearest_x =
        std::clamp(scene.start.x, std::min(joint_x, tip_x), std::max(joint_x, tip_x));
    return std::hypot(scene.start.x - nearest_x, scene.start.y - beams.joint_y);
  };
  return std::min(to_beam(-beams.joint_x, beams.length - beams.joint_x),
                  to_beam(beams.joint_x, beams.joint_x - beams.length));
}

/// Runs a check, and reports its refusal at the line of the refused key, else at that of another
/// key that the message names.
template <class Check>
void check(const Scene& scene, const Settings& settings, Check checked) {
  try {
    checked();
  } catch (const dynamics::InvalidParameter& error) {
    std::string origin = scene.source;
    if (const auto own = settings.find(error.key()); own != settings.end()) {
      origin = own->second.where(own->first);
    } else {
      for (const auto& [key, setting] : settings) {
        if (std::strstr(error.what(), key.c_str())) origin = setting.where(key);
      }
    }
    throw SceneError(origin + ": " + error.what());
  }
}

/// True for settings of the methods, which follow from all other keys unless they are given.
bool is_methods_own(std::string_view key) {
  return key == "run.step_s" || key == "run.event_tolerance_m" ||
         key == "contact.impulse_threshold_Ns";
}

/// Throws InvalidParameter for a gate that no method, or not its own method, can run.
void require_runnable(const dynamics::GateParams& gate) {
  if (gate.run.method == "auto")
    dynamics::validate(gate);
  else
    // validates, and asks the method whether it can run the gate
    (void)dynamics::make_method(gate);
}

/// Checks that involve several keys of the gate.
void check_gate(const Scene& scene, const Settings& settings) {
  check(scene, settings, [&] { require_runnable(scene.gate); });
}

/// Checks the types of the terrain, or the actions, in table `table`.
void check_types(const Scene& scene, const std::vector<Terrain::Type>& types,
                 const std::string& table) {
  for (const Terrain::Type& type : types) try {
      require_runnable(gate_of(scene, type));
    } catch (const dynamics::InvalidParameter& error) {
      std::string origin = scene.source;
      for (const Terrain::Key& key : type.keys)
        if (std::strstr(error.what(), key.name.c_str())) origin = key.origin;
      throw SceneError(origin + ": " + table + "." + type.name + ": " + error.what());
    }
}

/// Reads tables [terrain] and [actions] of the file and of the overrides.
void read_terrain(Scene& scene, const toml::table& document, const Origin& origin,
                  const std::deque<toml::table>& override_documents,
                  const std::vector<std::string>& overrides) {
  TerrainSettings terrain, actions;
  add_terrain(terrain, document, origin,
              std::filesystem::path(scene.source).parent_path().string());
  add_actions(actions, document, origin);
  for (std::size_t i = 0; i < overrides.size(); ++i) {
    const Origin of_override = [given = printable(overrides[i])](std::size_t) {
      return "--set " + given;
    };
    add_terrain(terrain, override_documents[i], of_override, "");
    add_actions(actions, override_documents[i], of_override);
  }
  const TypeValue value = [&](std::string_view name, const TerrainSetting& given,
                              const std::string& shown) {
    Scene other = scene;
    const SceneKey& key = *find_key(name);
    assign(key, {given.value, given.where(), given.spelled}, other, shown);
    return *std::get<double*>(key.slot(other));
  };
  scene.terrain = terrain_of(terrain, scene.field, value);
  scene.actions = actions_in(actions, value);
  if (scene.terrain) check_types(scene, scene.terrain->types, "terrain.types");
  for (const Terrain::Type& action : scene.actions) {
    const Scene taken = with_action(scene, action);
    check_types(taken, {action}, std::string(kActionsTable));
    if (taken.terrain)
      check_types(taken, taken.terrain->types,
                  std::string(kActionsTable) + "." + action.name + " with terrain.types");
  }
}

/// Checks that involve gate, field and start.
void check_start(const Scene& scene, const Settings& settings) {
  check(scene, settings, [&] {
    validate(scene.gate, scene.field);
    if (scene.terrain && scene.field.fidelity != Fidelity::active)
      throw dynamics::InvalidParameter(
          kFidelityKey, std::string(kFidelityKey) + " = \"" +
                            std::string(name_of(scene.field.fidelity)) +
                            "\" is not permitted with [terrain]: gates of several types are only "
                            "run with \"active\"");
    const auto& [x, y, vx, vy] = scene.start;
    if (std::abs(x) == scene.gate.beams.joint_x) {
      const std::string at_a_side =
          ": start.x_m = " + shortest(x) + " is a side of the gate, which bodies enter by with ";
      if (y < 0.0)
        throw dynamics::InvalidParameter(
            "start.y_m",
            "start.y_m = " + shortest(y) + " is not permitted" + at_a_side + "start.y_m >= 0");
      if (!(x * vx < 0.0))
        throw dynamics::InvalidParameter(
            "start.vx_m_per_s", "start.vx_m_per_s = " + shortest(vx) + " is not permitted" +
                                    at_a_side + "start.vx_m_per_s " + (x < 0.0 ? "> 0" : "< 0"));
    }
    if (const double distance = distance_to_beams(scene); distance < scene.gate.body.radius) {
      throw dynamics::InvalidParameter(
          "start.y_m", "start.y_m = " + shortest(scene.start.y) +
                           " is not permitted: the disc (body.radius_m = " +
                           shortest(scene.gate.body.radius) + ") would overlap a beam at rest, " +
                           shortest(distance) + " m from start.x_m = " + shortest(scene.start.x));
    }
  });
}

}  // namespace

std::vector<std::string> keys_set_by(const std::string& given) {
  std::deque<toml::table> documents;
  Settings settings;
  apply_override(given, documents, settings);
  std::vector<std::string> keys;
  for (const auto& [key, setting] : settings) keys.push_back(key);
  return keys;
}

void require_key(const std::string& key, const std::string& origin) {
  (void)known_key(key, origin);
}

std::string known_key(const std::string& given, const std::string& origin) {
  for (const SceneKey& key : scene_keys())
    if (unit_of(given, key.key)) return std::string(key.key);
  for (const SceneKey& key : scene_keys()) {
    const std::string units = units_instead(given, key.key);
    if (units.empty()) continue;
    // The key itself with a wrong unit; else another key may be nearer: forces.random_rate_hz.
    const std::string_view closest = closest_key(given);
    if (closest == key.key || (!closest.starts_with(given) &&
                               edit_distance(given.substr(0, kLongestCompared), closest) > 1))
      throw SceneError(origin + ": unknown key " + printable(given) + ": " + std::string(key.key) +
                       " may end in " + units + " instead");
  }
  throw SceneError(origin + ": unknown key " + printable(given) + "; " + closest_keys(given));
}

Scene read_scene(const std::string& path, const std::vector<std::string>& overrides) {
  return read_scene(TomlFile::read(path), overrides);
}

Scene parse_scene(std::string_view text, std::string name,
                  const std::vector<std::string>& overrides) {
  return read_scene(TomlFile(std::string(text), std::move(name)), overrides);
}

Scene read_scene(const TomlFile& file, const std::vector<std::string>& overrides) {
  const std::string& name = file.name();
  const Origin origin = [&name](std::size_t line) { return name + ":" + std::to_string(line); };
  if (has_ending(name, ".csv"))
    throw SceneError(name +
                     ": is a table, and no scene: of recorded runs gatewalk build TABLE --cell "
                     "CELL.toml -o MATRIX.nc makes a chain");
  const toml::table& document = document_of(file, "a scene");
  if (document["cell"].is_table())
    throw SceneError(name +
                     ": has cells of another kind, [cell]: --cell-program COMMAND says who "
                     "simulates them, gatewalk build TABLE --cell " +
                     name + " makes a chain of recorded runs");
  const Settings of_file = settings_of(document, origin);
  Settings settings = of_file;
  std::deque<toml::table> override_documents;
  for (const std::string& given : overrides) apply_override(given, override_documents, settings);

  Scene scene;
  scene.source = name;
  scene.sweep = variations_of(document, origin);
  for (const auto& [key, setting] : settings) scene.named.emplace(key, setting.where(key));
  const auto of_gate = [](const SceneKey& key) {
    return table_of(key.key) != "field" && table_of(key.key) != "start";
  };
  // Keys that the file leaves out follow from the file. An override changes only its own key and
  // the settings of the method, and may correct a value that the file must not have.
  for (const SceneKey& key : scene_keys()) {
    const auto it = of_file.find(key.key);
    if (!of_gate(key) || it == of_file.end()) continue;
    try {
      assign(key, it->second, scene);
    } catch (const SceneError&) {
      if (settings.at(std::string(key.key)).origin == it->second.origin) throw;
    }
  }
  const auto derive = [&](auto known) {
    for (const std::string_view key : dynamics::fill_in(scene.gate, scene.start, known))
      scene.derived.emplace(key);
  };
  check(scene, settings,
        [&] { derive([&](std::string_view key) { return of_file.contains(key); }); });
  for (const SceneKey& key : scene_keys())
    if (const auto it = settings.find(key.key); of_gate(key) && it != settings.end())
      assign(key, it->second, scene);
  check(scene, settings, [&] {
    derive([&](std::string_view key) { return scene.named.contains(key) || !is_methods_own(key); });
  });
  std::erase_if(scene.derived, [&](const std::string& key) { return scene.named.contains(key); });
  check_gate(scene, settings);  // the permitted starts depend on the gate
  for (const SceneKey& key : scene_keys())
    if (const auto it = settings.find(key.key); !of_gate(key) && it != settings.end())
      assign(key, it->second, scene);
  read_terrain(scene, document, origin, override_documents, overrides);
  check_start(scene, settings);
  auto edges = edges_in(document, origin);
  for (std::size_t i = 0; i < overrides.size(); ++i)
    for (GivenEdges& given : edges_in(override_documents[i], [&](std::size_t) {
           return "--set " + printable(overrides[i]);
         }))
      edges.push_back(std::move(given));
  try {
    scene.bins = bins_of(scene.gate, edges);
  } catch (const dynamics::InvalidParameter& error) {
    throw SceneError(scene.source + ": " + error.what());
  }
  return scene;
}

namespace {

/// The value of a key as TOML writes it.
std::string value_text(const SceneKey& key, Scene& scene) {
  const Slot slot = key.slot(scene);
  if (auto* const* string = std::get_if<std::string*>(&slot)) return "\"" + **string + "\"";
  if (auto* const* integer = std::get_if<int*>(&slot)) return std::to_string(**integer);
  if (auto* const* own = std::get_if<std::optional<int>*>(&slot))
    return std::to_string((*own)->value_or(scene.field.middle_column()));
  if (auto* const* fidelity = std::get_if<Fidelity*>(&slot))
    return "\"" + std::string(name_of(**fidelity)) + "\"";
  return toml_float(*std::get<double*>(slot));
}

}  // namespace

namespace {

/// True for the start's cell where it is the usual one, which the text of a scene leaves out.
bool is_usual_cell(const FieldParams& field, std::string_view key) {
  return (key == kStartColumnKey && !field.own_start_column) ||
         (key == kStartRowKey && field.start_row == 0);
}

/// The keys of the scene for which is_written(key) is true, as TOML.
template <class IsWritten>
std::string toml_of(const Scene& scene, IsWritten is_written) {
  Scene copy = scene;  // slots point into a mutable scene
  std::string text;
  std::string_view table;
  for (const SceneKey& key : scene_keys()) {
    if (table_of(key.key) != table) {
      table = table_of(key.key);
      text += (text.empty() ? "[" : "\n[") + std::string(table) + "]\n";
    }
    if (is_written(key.key) && !is_usual_cell(scene.field, key.key))
      text += std::string(leaf_of(key.key)) + " = " + value_text(key, copy) + "\n";
  }
  if (scene.bins) text += "\n" + bins_toml(*scene.bins);
  if (scene.terrain) text += "\n" + terrain_toml(*scene.terrain, scene.field);
  return text + gates_toml(kActionsTable, scene.actions);
}

}  // namespace

std::string to_toml(const Scene& scene) {
  return toml_of(scene, [](std::string_view) { return true; });
}

bool has_effect(const Scene& scene, std::string_view key) {
  const std::string& method = scene.gate.run.method;
  if (key == "run.step_s") return method != "auto" && method != "event";
  return key != "run.event_tolerance_m" || method == "event";
}

std::string scene_file(const Scene& scene) {
  return toml_of(scene, [&](std::string_view key) {
    return has_effect(scene, key) || scene.named.contains(key);
  });
}

std::vector<KeyInfo> describe(const Scene& scene) {
  Scene copy = scene;
  std::vector<KeyInfo> all;
  for (const SceneKey& key : scene_keys()) {
    KeyInfo info{std::string(key.key),
                 value_text(key, copy),
                 unit_of(key.key, key.key)->shown,
                 {},
                 std::string(key.meaning),
                 "paper"};
    if (key.permitted) info.range = key.permitted(scene).text();
    if (const auto given = scene.named.find(key.key); given != scene.named.end())
      info.source = given->second;
    if (scene.derived.contains(key.key)) info.source = "derived";
    all.push_back(std::move(info));
  }
  const auto add = [&](const std::string& table, const std::vector<Terrain::Type>& types) {
    for (const Terrain::Type& type : types)
      for (const Terrain::Key& own : type.keys) {
        KeyInfo info = *std::find_if(all.begin(), all.end(),
                                     [&](const KeyInfo& k) { return k.key == own.name; });
        info.key = table + "." + type.name + "." + own.name;
        info.value = toml_float(own.value);
        info.source = own.origin;
        all.push_back(std::move(info));
      }
  };
  if (scene.terrain) add("terrain.types", scene.terrain->types);
  add(std::string(kActionsTable), scene.actions);
  return all;
}

namespace {

/// The differences between the types of two terrains, by name.
std::vector<std::string> type_differences(const Scene& here, const Scene& there) {
  const auto types_of = [](const Scene& s) {
    std::map<std::string, dynamics::GateParams> types;
    if (s.terrain)
      for (const Terrain::Type& type : s.terrain->types) types.emplace(type.name, gate_of(s, type));
    return types;
  };
  const auto ours = types_of(here), theirs = types_of(there);
  std::vector<std::string> lines;
  for (const auto& [name, gate] : theirs)
    if (!ours.contains(name)) lines.push_back("terrain.types." + name + ": none here");
  for (const auto& [name, gate] : ours) {
    const auto other = theirs.find(name);
    if (other == theirs.end()) lines.push_back("terrain.types." + name + ": none there");
    for (const dynamics::ParamInfo& info : dynamics::gate_param_table())
      if (other != theirs.end() && may_differ(info.key) &&
          info.get(gate) != info.get(other->second))
        lines.push_back("terrain.types." + name + "." + std::string(info.key) + ": " +
                        shortest(info.get(gate)) + " here, " + shortest(info.get(other->second)) +
                        " there");
  }
  return lines;
}

}  // namespace

std::vector<std::string> physics_differences(const Scene& here, const Scene& there) {
  std::vector<std::string> lines;
  const auto add = [&](std::string_view key, const std::string& a, const std::string& b) {
    lines.push_back(std::string(key) + ": " + a + " here, " + b + " there");
  };
  for (const dynamics::ParamInfo& info : dynamics::gate_param_table()) {
    const double a = info.get(here.gate), b = info.get(there.gate);
    // "auto" agrees with any method that was chosen.
    const bool chosen = info.key == "run.step_s" || info.key == "run.event_tolerance_m";
    if (here.gate.run.method == "auto" && chosen) continue;
    // Keys without effect here: the tolerance once "auto" has chosen, and the setting of another
    // method.
    if (info.key == "run.tolerance" && here.gate.run.method != "auto") continue;
    if (info.key == "run.event_tolerance_m" && there.gate.run.method != "event") continue;
    if (a != b) add(info.key, shortest(a), shortest(b));
  }
  if (here.gate.run.method != there.gate.run.method && here.gate.run.method != "auto") {
    add(kMethodKey, here.gate.run.method, there.gate.run.method);
  }
  if (here.bins != there.bins) {
    const auto told = [](const Scene& s) { return s.bins ? "edges of its own" : "none"; };
    if (here.bins && there.bins)
      lines.push_back("[bins]: other edges here than there");
    else
      add("[bins]", told(here), told(there));
  }
  const auto types = type_differences(here, there);
  lines.insert(lines.end(), types.begin(), types.end());
  return lines;
}

}  // namespace gatewalk::lattice
