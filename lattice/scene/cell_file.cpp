// SPDX-License-Identifier: MIT
#include "lattice/scene/cell_file.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <utility>

#include "dynamics/cells/words.h"
#include "lattice/scene/scene.h"
#include "lattice/scene/scene_terrain.h"
#include "lattice/scene/toml_settings.h"
#include "lattice/scene/units.h"
#include "lattice/text/edit_distance.h"
#include "lattice/text/text_stream.h"
#include "lattice/text/toml_text.h"

namespace gatewalk::lattice {
namespace {

using dynamics::Coordinate;
using dynamics::CostInfo;
using dynamics::Entry;
using dynamics::Face;
using dynamics::kMostCoordinates;
using Names = std::vector<std::string>;

constexpr std::size_t kMostCellTypes = 100;
constexpr Interval kPositive{0.0, 1e300, true}, kAnyNumber{-1e300, 1e300};
constexpr const char* kNameRule =
    "be letters, digits and _, at most 60, and begin with a letter, such as ";
const Names kTables{"cell", "field", "start", std::string(kTerrainTable),
                    std::string(kActionsTable)};
const Names kFieldKeys{"columns", "rows", "max_gates", "start_column", "start_row"};
const Names kCellKeys{"width_m", "length_m",    "symmetric", "trapped_after_s",
                      "faces",   "coordinates", "costs",     "types"};

/// Names as a list: "width_m, length_m and symmetric"
std::string listed(const Names& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 < names.size() ? ", " : " and ") + names[i];
  return text;
}

/// " (did you mean width_m?)", or empty.
std::string guess(std::string_view given, const Names& names) {
  const std::string meant = meant_name(given, names);
  return meant.empty() ? "" : " (did you mean " + meant + "?)";
}

/// A table of the file. Its members throw a SceneError that names file, line and key.
struct GivenTable {
  const toml::table& table;
  std::string name;  // "cell.faces"
  const Origin& origin;
  bool one_of_many = false;  // an array of tables

  [[nodiscard]] std::string at(const toml::node& node) const {
    return origin(node.source().begin.line) + ": ";
  }
  [[nodiscard]] std::string header() const {
    return one_of_many ? "[[" + name + "]]" : "[" + name + "]";
  }
  [[noreturn]] void refuse(const std::string& key, const std::string& allowed) const {
    const toml::node& node = *table.get(key);
    throw SceneError(at(node) + name + "." + key + shown_value(node) + " is not permitted: must " +
                     allowed);
  }
  [[noreturn]] void refuse_key(const toml::node& node, const std::string& key,
                               const Names& keys) const {
    std::string units;
    for (const std::string& known : keys)
      if (const std::string instead = units_instead(key, known); !instead.empty())
        units = "; " + known + " may end in " + instead + " instead";
    throw SceneError(at(node) + "unknown key " + name + "." + printable(key) + guess(key, keys) +
                     "; " + header() + " has " + listed(keys) + units);
  }
  void require_keys(const Names& keys) const {
    for (const auto& [key, node] : table)
      if (std::find(keys.begin(), keys.end(), key.str()) == keys.end())
        refuse_key(node, std::string(key.str()), keys);
  }
  [[nodiscard]] bool has(std::string_view key) const { return table.contains(key); }
  void require(const std::string& key, const std::string& allowed) const {
    if (!has(key))
      throw SceneError(at(table) + header() + " has no key " + key + ": it must " + allowed);
  }

  [[nodiscard]] std::string text(const std::string& key, const std::string& otherwise) const {
    if (!has(key)) return otherwise;
    const auto* text = table.get(key)->as_string();
    if (!text) refuse(key, "be text");
    return text->get();
  }
  [[nodiscard]] std::string plain_name(const std::string& key, const std::string& example,
                                       const Names& taken = {}) const {
    const std::string allowed = kNameRule + ("\"" + example + "\"");
    require(key, allowed);
    const auto* text = table.get(key)->as_string();
    if (!text || !is_name(text->get())) refuse(key, allowed);
    if (std::find(taken.begin(), taken.end(), text->get()) != taken.end())
      refuse(key, "be another name than " + listed(taken));
    return text->get();
  }
  [[nodiscard]] bool truth(const std::string& key, bool otherwise) const {
    if (!has(key)) return otherwise;
    const auto* truth = table.get(key)->as_boolean();
    if (!truth) refuse(key, "be true or false");
    return truth->get();
  }
  [[nodiscard]] double number(const std::string& key, const Interval& permitted) const {
    return number_of({table.get(key), origin(table.get(key)->source().begin.line), key}, key,
                     permitted, name + "." + key);
  }
  /// The tables [[name.key]]; may be none.
  [[nodiscard]] std::vector<GivenTable> tables(const std::string& key) const {
    std::vector<GivenTable> all;
    if (!has(key)) return all;
    const std::string allowed =
        "be one or more tables, each written [[" + name + "." + key + "]], its keys below it";
    const toml::array* const array = table.get(key)->as_array();
    if (!array || array->empty()) refuse(key, allowed);
    for (const toml::node& node : *array) {
      if (!node.is_table()) refuse(key, allowed);
      all.push_back({*node.as_table(), name + "." + key, origin, true});
    }
    return all;
  }
};

template <class Named>
Names all_names_of(const std::vector<Named>& all) {
  Names names;
  for (const Named& one : all) names.push_back(one.name);
  return names;
}

int place_in(const Names& names, std::string_view name) {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

// ---- Units

/// A unit as it is written in a key: "m_per_s" for "m s-1" and "m/s", nothing for "1". nullopt if
/// `unit` is no unit.
std::optional<std::string> unit_letters(std::string_view unit) {
  if (unit == "1") return "";
  std::string above, below;
  bool divided = false;
  for (std::size_t at = 0; at < unit.size();) {
    const char c = unit[at];
    if (c == ' ' || c == '*' || c == '/') {
      if (divided && c == '/') return {};
      divided = divided || c == '/';
      ++at;
      continue;
    }
    const auto run_of = [&](auto is) {
      const std::size_t begin = at;
      while (at < unit.size() && is(static_cast<unsigned char>(unit[at]))) ++at;
      return std::string(unit.substr(begin, at - begin));
    };
    if (c == '1' && at == 0) {  // 1/s
      ++at;
      continue;
    }
    const std::string letters = run_of([](unsigned char l) { return l < 0x80 && std::isalpha(l); });
    if (letters.empty()) return {};
    if (at < unit.size() && unit[at] == '^') ++at;
    const bool inverse = at < unit.size() && unit[at] == '-';
    if (inverse) ++at;
    std::string power = run_of([](unsigned char l) { return std::isdigit(l) != 0; });
    if (power.size() > 1 || power == "0" || (inverse && power.empty())) return {};
    if (power == "1") power.clear();
    (inverse != divided ? below : above) += letters + power;
    divided = false;
  }
  if (divided || (above.empty() && below.empty())) return {};
  return above + (below.empty() ? "" : (above.empty() ? "per_" : "_per_") + below);
}

std::string unit_in(const GivenTable& given, std::string& letters) {
  const std::string allowed = "be a unit, such as \"m\", \"m s-1\", \"m/s\", or \"1\" for none";
  given.require("unit", allowed);
  const std::string unit = given.text("unit", "");
  const auto read = unit_letters(unit);
  if (!read) given.refuse("unit", allowed);
  letters = *read;
  return unit;
}

// ---- Table [cell]

/// Adds the name of a coordinate or cost to `taken`. Both are columns of the table of runs and keys
/// of [start], so names must differ.
void require_own_column(const GivenTable& given, const std::string& key, const std::string& name,
                        std::set<std::string>& taken) {
  if (name.starts_with("out_"))
    given.refuse(key, "not begin with out_, as columns of runs do that tell how bodies left");
  if (!taken.insert(name).second)
    given.refuse(key, "be a name that nothing else in a table of runs has");
}

std::vector<Coordinate> coordinates_in(const GivenTable& cell, std::vector<bool>& has_scale,
                                       std::set<std::string>& taken) {
  cell.require("coordinates", "have what is told of every entry, each a [[cell.coordinates]]");
  std::vector<Coordinate> all;
  for (const GivenTable& given : cell.tables("coordinates")) {
    given.require_keys({"name", "unit", "scale", "words"});
    if (all.size() == kMostCoordinates)
      throw SceneError(given.at(given.table) + "[[cell.coordinates]]: more than " +
                       std::to_string(kMostCoordinates) + " are not permitted");
    Coordinate& c = all.emplace_back();
    c.name = given.plain_name("name", "vx");
    require_own_column(given, "name", c.name, taken);
    std::string letters;
    c.unit = unit_in(given, letters);
    c.key = c.name + (letters.empty() ? "" : "_" + letters);
    if (c.key != c.name) require_own_column(given, "name", c.key, taken);
    c.words = given.text("words", c.name);
    has_scale.push_back(given.has("scale"));
    if (has_scale.back()) c.scale = given.number("scale", kPositive);
  }
  return all;
}

std::vector<CostInfo> costs_in(const GivenTable& cell, std::set<std::string>& taken) {
  std::vector<CostInfo> all{{"time_s", "s", "duration"}};
  for (const GivenTable& given : cell.tables("costs")) {
    given.require_keys({"key", "unit", "words"});
    if (all.size() == dynamics::kMostCosts)
      throw SceneError(given.at(given.table) + "[[cell.costs]]: more than " +
                       std::to_string(dynamics::kMostCosts - 1) + " are not permitted");
    CostInfo& cost = all.emplace_back();
    cost.key = given.plain_name("key", "work_J");
    require_own_column(given, "key", cost.key, taken);
    std::string letters;
    cost.unit = unit_in(given, letters);
    if (!letters.empty() && !cost.key.ends_with("_" + letters))
      given.refuse("key", "end in its unit, _" + letters);
    const std::string stem =
        cost.key.substr(0, cost.key.size() - (letters.empty() ? 0 : letters.size() + 1));
    cost.words = given.text("words", stem);
  }
  return all;
}

std::string usual_origin(int di_x, int di_y) {
  if (di_x == 0 && di_y == 1) return "from below";
  if (di_x == 0 && di_y == -1) return "from above";
  if (di_x == 1 && di_y == 0) return "from the left";
  if (di_x == -1 && di_y == 0) return "from the right";
  return "by (" + std::to_string(di_x) + ", " + std::to_string(di_y) + ")";
}

std::array<int, 2> move_in(const GivenTable& given) {
  const std::string allowed =
      "be the move to the neighbour that is entered, two whole numbers from -1000 to 1000, not "
      "both 0: [0, 1] for one row further";
  given.require("move", allowed);
  const toml::array* const array = given.table.get("move")->as_array();
  std::array<int, 2> move{};
  if (!array || array->size() != move.size()) given.refuse("move", allowed);
  for (std::size_t i = 0; i < move.size(); ++i) {
    const auto* whole = array->get(i)->as_integer();
    if (!whole || std::abs(whole->get()) > 1000) given.refuse("move", allowed);
    move[i] = static_cast<int>(whole->get());
  }
  if (move[0] == 0 && move[1] == 0) given.refuse("move", allowed);
  return move;
}

/// The numbers of the names listed under `key`, as bits.
std::uint64_t names_in(const GivenTable& given, const std::string& key, const Names& names,
                       const std::string& what) {
  const std::string allowed = "be an array of " + what + ", of " + listed(names) + "; [] for none";
  const toml::array* const array = given.table.get(key)->as_array();
  if (!array) given.refuse(key, allowed);
  std::uint64_t found = 0;
  for (const toml::node& node : *array) {
    const int place = node.is_string() ? place_in(names, node.as_string()->get()) : -1;
    if (place < 0)
      throw SceneError(given.at(node) + given.name + "." + key + shown_value(node) +
                       " is not permitted: must " + allowed);
    found |= std::uint64_t{1} << place;
  }
  return found;
}

void read_usual(const GivenTable& given, const Names& coordinates, Face& face) {
  if (!given.has("usual")) return;
  if (!given.table.get("usual")->is_table())
    given.refuse("usual", "be given by coordinate, as in usual." + coordinates[0] + " = [-1, 1]");
  const GivenTable usual{*given.table.get("usual")->as_table(), "cell.faces.usual", given.origin};
  usual.require_keys(coordinates);
  for (std::size_t c = 0; c < coordinates.size(); ++c) {
    if (!usual.has(coordinates[c])) continue;
    const toml::array* const array = usual.table.get(coordinates[c])->as_array();
    std::array<double, 2>& range = face.usual[c];
    for (std::size_t i = 0; array && i < array->size() && i < range.size(); ++i)
      if (array->get(i)->is_number()) range[i] = *array->get(i)->value<double>();
    if (!array || array->size() != range.size() || !kAnyNumber.permits(range[0]) ||
        !kAnyNumber.permits(range[1]) || !(range[0] < range[1]))
      usual.refuse(coordinates[c], "be two numbers, from and to, the smaller first");
  }
}

std::string mirror_allowed(const std::vector<Face>& faces) {
  return "be the face by which mirror images enter, one of " + listed(all_names_of(faces));
}

/// The face named by `mirror`; kNoMirror without that key.
int named_mirror(const GivenTable& given, const std::vector<Face>& faces) {
  if (!given.has("mirror")) return dynamics::kNoMirror;
  const int mirror = place_in(all_names_of(faces), given.text("mirror", ""));
  if (mirror < 0) given.refuse("mirror", mirror_allowed(faces));
  return mirror;
}

/// Checks the mirror image of a face of symmetric cells.
void require_images(const GivenTable& given, const std::vector<Face>& faces, std::size_t own) {
  const Face &face = faces[own], &image = faces[static_cast<std::size_t>(face.mirror)];
  const auto refuse = [&](const std::string& why) {
    const toml::node* const key = given.table.get("mirror");
    throw SceneError(given.at(key ? *key : given.table) + "cell.faces.mirror = \"" + image.name +
                     "\" of face " + face.name + " is not permitted: " + why);
  };
  const auto move = [](int x, int y) {
    return "[" + std::to_string(x) + ", " + std::to_string(y) + "]";
  };
  if (image.di_x != -face.di_x || image.di_y != face.di_y)
    refuse("the move of " + image.name + " must be " + move(-face.di_x, face.di_y) + ", it is " +
           move(image.di_x, image.di_y));
  if (image.mirror != static_cast<int>(own))
    refuse("the mirror of " + image.name + " must be " + face.name + ", it is " +
           faces[static_cast<std::size_t>(image.mirror)].name);
  if (image.odd != face.odd) refuse("both must have the same odd coordinates");
}

/// The faces of [cell]; `symmetric`: at least one type of cell is symmetric.
std::vector<Face> faces_in(const GivenTable& cell, const Names& coordinates, bool symmetric) {
  cell.require("faces",
               "have the parts of a cell's border that bodies enter by, each a "
               "[[cell.faces]]");
  const std::vector<GivenTable> tables = cell.tables("faces");
  if (tables.size() > dynamics::kMostFaces)
    throw SceneError(tables.back().at(tables.back().table) + "[[cell.faces]]: more than " +
                     std::to_string(dynamics::kMostFaces) + " are not permitted");
  std::vector<Face> faces;
  for (const GivenTable& given : tables) {
    given.require_keys({"name", "move", "mirror", "odd", "from", "usual"});
    Names taken = all_names_of(faces);
    taken.insert(taken.end(), {"trapped", "lost"});  // what runs have in place of a face
    Face face;
    face.name = given.plain_name("name", "S", taken);
    const auto [di_x, di_y] = move_in(given);
    face.di_x = di_x, face.di_y = di_y;
    face.origin = given.text("from", usual_origin(di_x, di_y));
    if (symmetric)
      given.require("odd",
                    "say which coordinates change their sign in the mirror, [] for none, as a type "
                    "of cell is symmetric");
    if (given.has("odd"))
      face.odd = static_cast<std::uint8_t>(
          names_in(given, "odd", coordinates, "coordinates that change their sign in the mirror"));
    read_usual(given, coordinates, face);
    faces.push_back(std::move(face));
  }
  std::vector<int> mirrors;
  for (const GivenTable& given : tables) mirrors.push_back(named_mirror(given, faces));
  dynamics::set_mirrors(faces, mirrors, symmetric);
  if (!symmetric) return faces;
  for (std::size_t f = 0; f < faces.size(); ++f)
    if (faces[f].mirror == dynamics::kNoMirror) tables[f].require("mirror", mirror_allowed(faces));
  for (std::size_t f = 0; f < faces.size(); ++f) require_images(tables[f], faces, f);
  return faces;
}

void read_types(CellFile& file, const GivenTable& cell, bool symmetric) {
  for (const GivenTable& given : cell.tables("types")) {
    given.require_keys({"name", "symmetric", "walls"});
    if (file.types.size() == kMostCellTypes)
      throw SceneError(given.at(given.table) + "[[cell.types]]: more than " +
                       std::to_string(kMostCellTypes) + " are not permitted");
    // The own gate of a scene.
    const bool is_own = file.types.empty() && given.text("name", "") == kOwnGate;
    file.types.push_back(is_own ? std::string(kOwnGate)
                                : given.plain_name("name", "soft", file.types));
    file.map.types.push_back({given.truth("symmetric", symmetric)});
  }
  if (!file.types.empty()) return;
  file.types = {std::string(kOwnGate)};
  file.map.types = {{symmetric}};
}

/// Reads the walls of each type, when the faces are known.
void read_walls(CellFile& file, const GivenTable& cell) {
  file.walls.assign(file.types.size(), 0);
  const std::vector<Face>& faces = file.map.section.faces;
  const Names names = all_names_of(faces);
  std::size_t type = 0;
  for (const GivenTable& given : cell.tables("types")) {
    std::uint64_t& walls = file.walls[type++];
    if (!given.has("walls")) continue;
    walls = names_in(given, "walls", names, "faces at which nothing crosses the border");
    if (!file.map.types[type - 1].symmetric) continue;
    for (std::size_t f = 0; f < faces.size(); ++f)
      if ((walls >> f & 1) != (walls >> faces[f].mirror & 1))
        given.refuse("walls", "have both " + faces[f].name + " and its mirror image " +
                                  names[static_cast<std::size_t>(faces[f].mirror)] +
                                  ", or none, as the type is symmetric");
  }
}

// ---- Single keys, of the file and of overrides

void require_tables(const toml::table& document, const Origin& origin) {
  for (const auto& [table_name, node] : document) {
    const std::string name(table_name.str()), at = origin(node.source().begin.line);
    if (place_in(kTables, name) < 0)
      throw SceneError(at + ": unknown " + (node.is_table() ? "table " : "key ") + printable(name) +
                       guess(name, kTables) + "; a file of cells has the tables " +
                       listed(kTables));
    if (!node.is_table())
      throw SceneError(at + ": " + name + shown_value(node) +
                       " is not permitted: must be a table, written [" + name + "]");
  }
}

/// Adds the keys of `document` that overrides may have too. `known`: all these keys, in full.
void add_settings(Settings& settings, const toml::table& document, const Origin& origin,
                  const Names& known) {
  require_tables(document, origin);
  for (const auto& [table_name, node] : document) {
    const std::string name(table_name.str());
    if (name == kTerrainTable || name == kActionsTable) continue;  // read separately
    const GivenTable given{*node.as_table(), name, origin};
    Settings added;
    for (const auto& [key, value] : given.table) {
      const std::string spelled = name + "." + std::string(key.str());
      std::string whole;
      Names keys = name == "cell" ? kCellKeys : Names{};
      for (const std::string& k : known) {
        if (!k.starts_with(name + ".")) continue;
        if (unit_of(spelled, k) && whole != spelled) whole = k;
        if (name != "cell") keys.push_back(k.substr(name.size() + 1));
      }
      if (whole.empty() && place_in(keys, key.str()) >= 0) continue;  // a table, read separately
      if (whole.empty()) given.refuse_key(value, std::string(key.str()), keys);
      const Setting setting{&value, origin(value.source().begin.line), spelled};
      if (const auto [other, is_new] = added.try_emplace(whole, setting); !is_new)
        throw SceneError(
            given_twice(*other->second.value, other->second.spelled, value, spelled, origin));
    }
    for (const auto& [key, setting] : added) settings[key] = setting;
  }
}

/// Throws for keys below [cell] that only the file may have.
void refuse_lists(const Override& given) {
  for (const char* key : {"faces", "coordinates", "costs", "types"})
    if (given.document["cell"][key])
      throw SceneError(given.begin + ": cell." + key +
                       " can only be given in the file, not by --set");
}

const Setting* found(const Settings& settings, std::string_view key) {
  const auto it = settings.find(key);
  return it == settings.end() ? nullptr : &it->second;
}

void read_numbers(CellFile& file, const Settings& settings, const std::string& cell_line) {
  const auto number = [&](const std::string& key, double& value) {
    const Setting* const given = found(settings, key);
    if (given) value = number_of(*given, key, kPositive, given->spelled);
    return given != nullptr;
  };
  for (const auto& [key, value] :
       {std::pair("cell.width_m", &file.width), std::pair("cell.length_m", &file.length)})
    if (!number(key, *value))
      throw SceneError(cell_line + ": [cell] has no key " + std::string(key).substr(5) +
                       ": it must be the size of a cell, a number > 0");
  if (double limit = 0.0; number("cell.trapped_after_s", limit)) file.trapped_after = limit;
  const auto whole = [&](const std::string& key, const Interval& permitted, auto& value) {
    if (const Setting* const given = found(settings, key))
      value = whole_number_of(*given, permitted, key);
  };
  whole("field.columns", kFieldSizes, file.field.columns);
  whole("field.rows", kFieldSizes, file.field.rows);
  whole("field.max_gates", kGateLimits, file.field.max_gates);
  whole("field.start_column", below(file.field.columns), file.field.own_start_column);
  whole("field.start_row", below(file.field.rows), file.field.start_row);
  file.has_field = found(settings, "field.columns") && found(settings, "field.rows");
}

void read_start(CellFile& file, const Settings& settings) {
  const auto first = settings.lower_bound("start.");
  if (first == settings.end() || !first->first.starts_with("start.")) return;
  const auto need = [&](const std::string& key, const std::string& what) -> const Setting& {
    if (const Setting* const given = found(settings, "start." + key)) return *given;
    throw SceneError(first->second.origin + ": [start] has no key " + key + ": it must be " + what +
                     "; without any key, all that was seen to enter first starts");
  };
  const Names faces = all_names_of(file.map.section.faces);
  const Setting& face = need("face", "the face that bodies enter by, one of " + listed(faces));
  Entry start;
  const auto* name = face.value->as_string();
  start.face = name ? place_in(faces, name->get()) : -1;
  if (start.face < 0)
    throw SceneError(refusal_of(face, "start.face", "be one of " + listed(faces)));
  for (std::size_t c = 0; c < file.map.section.coordinates.size(); ++c) {
    const Coordinate& coordinate = file.map.section.coordinates[c];
    const Setting& given = need(coordinate.key, "a number");
    start.at[c] = number_of(given, "start." + coordinate.key, kAnyNumber, given.spelled);
  }
  file.start = start;
}

/// Adds the map only: types of a cell file have no keys of their own.
void add_map(TerrainSettings& settings, const toml::table& document, const Origin& origin,
             const std::string& folder) {
  if (const auto types = document[kTerrainTable]["types"])
    throw SceneError(origin(types.node()->source().begin.line) +
                     ": terrain.types is not permitted in a file of cells: its types are "
                     "[[cell.types]]");
  add_terrain(settings, document, origin, folder);
}

Terrain types_as_terrain(const CellFile& file) {
  Terrain terrain;
  terrain.own = file.types.front();
  for (auto type = file.types.begin() + 1; type != file.types.end(); ++type)
    terrain.types.push_back({*type, {}});
  terrain.type_of_cell = file.map.type_of_cell;
  return terrain;
}

std::string quoted_toml(const std::string& text) {
  TextStream out;
  out << toml::value<std::string>(text);
  return out.str();
}

/// The walls of a type; nothing if it has none.
std::string walls_toml(const CellFile& file, std::size_t type) {
  std::string names;
  const std::vector<Face>& faces = file.map.section.faces;
  for (std::size_t f = 0; type < file.walls.size() && f < faces.size(); ++f)
    if ((file.walls[type] >> f & 1) != 0)
      names += (names.empty() ? "\"" : ", \"") + faces[f].name + "\"";
  return names.empty() ? "" : "walls = [" + names + "]\n";
}

CellFile cell_file_of(const TomlFile& toml, const std::vector<std::string>& overrides) {
  const std::string& name = toml.name();
  const Origin origin = [&name](std::size_t line) { return name + ":" + std::to_string(line); };
  const toml::table& document = document_of(toml, "a file of cells");
  const toml::table* const cell_table = document["cell"].as_table();
  if (!cell_table) {
    require_tables(document, origin);
    throw SceneError(name + ": has no table [cell]");
  }
  const GivenTable cell{*cell_table, "cell", origin};

  CellFile file;
  file.source = name;
  std::set<std::string> taken{"body", "trial", "in", "out", "type", "face", "time_s"};
  dynamics::Section& section = file.map.section;
  section.coordinates = coordinates_in(cell, file.has_scale, taken);
  section.costs = costs_in(cell, taken);

  Names known{"cell.width_m", "cell.length_m", "cell.symmetric", "cell.trapped_after_s",
              "start.face"};
  for (const std::string& key : kFieldKeys) known.push_back("field." + key);
  for (const Coordinate& c : section.coordinates) known.push_back("start." + c.key);
  Settings settings;
  add_settings(settings, document, origin, known);
  TerrainSettings map_settings, actions;
  add_program_actions(actions, document, origin);
  add_map(map_settings, document, origin, std::filesystem::path(name).parent_path().string());
  std::vector<Override> read;
  read.reserve(overrides.size());  // settings point into it
  for (const std::string& given : overrides) {
    read.push_back(parse_override(given, [](std::string_view key) { return key == "start.face"; }));
    refuse_lists(read.back());
    const Origin of_override = [begin = read.back().begin](std::size_t) { return begin; };
    add_settings(settings, read.back().document, of_override, known);
    add_map(map_settings, read.back().document, of_override, "");
    add_program_actions(actions, read.back().document, of_override);
  }

  bool symmetric = false;
  if (const Setting* const given = found(settings, "cell.symmetric")) {
    if (!given->value->is_boolean())
      throw SceneError(refusal_of(*given, "cell.symmetric", "be true or false"));
    symmetric = given->value->as_boolean()->get();
  }
  read_types(file, cell, symmetric);
  section.faces = faces_in(cell, all_names_of(section.coordinates),
                           std::any_of(file.map.types.begin(), file.map.types.end(),
                                       [](const auto& type) { return type.symmetric; }));
  read_walls(file, cell);
  read_numbers(file, settings, origin(cell_table->source().begin.line));
  read_start(file, settings);
  if (!map_settings.empty()) {
    Terrain terrain = types_as_terrain(file);
    read_map(terrain, map_settings, file.field);
    file.map.columns = file.field.columns;
    file.map.type_of_cell = std::move(terrain.type_of_cell);
  }
  file.actions = actions_in(
      actions, [](std::string_view key, const TerrainSetting& given, const std::string& shown) {
        return number_of({given.value, given.where(), given.spelled}, key, kAnyNumber, shown);
      });
  try {
    section.validate();
  } catch (const std::invalid_argument& error) {
    throw SceneError(name + ": " + error.what());
  }
  return file;
}

}  // namespace

CellFile read_cell_file(const std::string& path, const std::vector<std::string>& overrides) {
  return read_cell_file(TomlFile::read(path), overrides);
}

CellFile read_cell_file(const TomlFile& file, const std::vector<std::string>& overrides) {
  if (has_ending(file.name(), ".csv"))
    throw SceneError(
        file.name() +
        ": is a table, and no file of cells, which is TOML (cli/site/reference/files.md); "
        "with --cell CELL.toml the table stands before it");
  return cell_file_of(file, overrides);
}

bool CellFile::has_walls() const {
  return std::any_of(walls.begin(), walls.end(), [](std::uint64_t w) { return w != 0; });
}

CellFile parse_cell_file(std::string_view text, const std::string& name,
                         const std::vector<std::string>& overrides) {
  return cell_file_of(TomlFile(std::string(text), name), overrides);
}

std::string to_toml(const CellFile& file) {
  const dynamics::Section section = dynamics::Words::plain(file.map.section);
  const Names coordinates = all_names_of(section.coordinates);
  const bool named_types = file.types != Names{std::string(kOwnGate)};
  const auto truth = [](bool b) { return b ? "true" : "false"; };

  std::string text = "[cell]\nwidth_m = " + toml_float(file.width) +
                     "\nlength_m = " + toml_float(file.length) + "\n";
  if (!named_types)
    text += std::string("symmetric = ") + truth(file.map.types.front().symmetric) + "\n";
  if (file.trapped_after) text += "trapped_after_s = " + toml_float(*file.trapped_after) + "\n";
  for (const Face& face : section.faces) {
    text += "\n[[cell.faces]]\nname = \"" + face.name + "\"\nmove = [" + std::to_string(face.di_x) +
            ", " + std::to_string(face.di_y) + "]\n";
    if (face.mirror != dynamics::kNoMirror)
      text += "mirror = \"" + section.faces[static_cast<std::size_t>(face.mirror)].name + "\"\n";
    text += "odd = [";
    std::string odd;
    for (std::size_t c = 0; c < coordinates.size(); ++c)
      if (face.is_odd(c)) odd += (odd.empty() ? "\"" : ", \"") + coordinates[c] + "\"";
    text += odd + "]\nfrom = " + quoted_toml(face.origin) + "\n";
    for (std::size_t c = 0; c < coordinates.size(); ++c)
      if (face.usual[c][0] < face.usual[c][1])
        text += "usual." + coordinates[c] + " = [" + toml_float(face.usual[c][0]) + ", " +
                toml_float(face.usual[c][1]) + "]\n";
  }
  for (std::size_t c = 0; c < coordinates.size(); ++c) {
    const Coordinate& coordinate = section.coordinates[c];
    text += "\n[[cell.coordinates]]\nname = \"" + coordinate.name +
            "\"\nunit = " + quoted_toml(coordinate.unit) +
            "\nwords = " + quoted_toml(coordinate.words) + "\n";
    if (file.has_scale[c]) text += "scale = " + toml_float(coordinate.scale) + "\n";
  }
  for (std::size_t c = 1; c < section.costs.size(); ++c)
    text += "\n[[cell.costs]]\nkey = \"" + section.costs[c].key +
            "\"\nunit = " + quoted_toml(section.costs[c].unit) +
            "\nwords = " + quoted_toml(section.costs[c].words) + "\n";
  for (std::size_t t = 0; named_types && t < file.types.size(); ++t)
    text += "\n[[cell.types]]\nname = \"" + file.types[t] +
            "\"\nsymmetric = " + truth(file.map.types[t].symmetric) + "\n" + walls_toml(file, t);
  text += "\n[field]\ncolumns = " + std::to_string(file.field.columns) +
          "\nrows = " + std::to_string(file.field.rows) +
          "\nmax_gates = " + std::to_string(file.field.max_gates) + "\n";
  if (file.field.own_start_column)
    text += "start_column = " + std::to_string(*file.field.own_start_column) + "\n";
  if (file.field.start_row > 0)
    text += "start_row = " + std::to_string(file.field.start_row) + "\n";
  if (file.start) {
    text += "\n[start]\nface = \"" +
            section.faces[static_cast<std::size_t>(file.start->face)].name + "\"\n";
    for (std::size_t c = 0; c < coordinates.size(); ++c)
      text += section.coordinates[c].key + " = " + toml_float(file.start->at[c]) + "\n";
  }
  if (!file.map.type_of_cell.empty()) {
    text += "\n[terrain]\nmap = [\n";
    for (const std::string& row : map_rows(types_as_terrain(file), file.field))
      text += "  \"" + row + "\",\n";
    text += "]\n";
  }
  return text + gates_toml(kActionsTable, file.actions);
}

}  // namespace gatewalk::lattice
