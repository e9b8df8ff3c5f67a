// SPDX-License-Identifier: MIT
#include "cli/cells/hello.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <stdexcept>
#include <string>

#include "cli/cells/process.h"
#include "cli/fields/json.h"
#include "cli/fields/json_value.h"

namespace gatewalk::cli {
namespace {

using Keys = std::initializer_list<std::string_view>;

[[noreturn]] void refuse_hello(const std::string& what) { throw std::invalid_argument(what); }

/// Whether a text is not empty and has no blanks, so that it can be a word of a line.
bool is_word(std::string_view text) {
  return !text.empty() && std::none_of(text.begin(), text.end(),
                                       [](unsigned char c) { return c <= ' ' || c == 127; });
}

/// An object in the first line, or in one of its lists: checks the keys and reads their values.
class HelloTable {
 public:
  HelloTable(const Json& json, std::string where, Keys keys)
      : json_(json), where_(std::move(where)) {
    if (!json.is_object()) refuse_hello(where_ + " must be an object { }");
    for (const auto& [key, value] : json.items()) {
      if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
      refuse_hello(fmt::format("{} has no key '{}'; it has {}", where_, excerpt(key, 60),
                               fmt::join(keys, ", ")));
    }
  }
  [[nodiscard]] const Json* find(std::string_view key) const {
    const auto at = json_.find(key);
    return at == json_.end() ? nullptr : &*at;
  }
  [[nodiscard]] const Json& at(std::string_view key) const {
    const Json* const value = find(key);
    if (value == nullptr) refuse_hello(fmt::format("{}: '{}' is missing", where_, key));
    return *value;
  }
  [[noreturn]] void refuse_value(std::string_view key, const std::string& must_be) const {
    refuse_hello(fmt::format("{}: '{}' must be {}", where_, key, must_be));
  }

  [[nodiscard]] std::string word(std::string_view key) const {
    const Json& value = at(key);
    const std::string text = value.is_string() ? value.get<std::string>() : "";
    if (!is_word(text)) refuse_value(key, "a word without blanks");
    return text;
  }
  [[nodiscard]] std::string text(std::string_view key, const std::string& otherwise) const {
    const Json* const value = find(key);
    if (value == nullptr) return otherwise;
    if (!value->is_string()) refuse_value(key, "a text");
    return value->get<std::string>();
  }
  [[nodiscard]] int whole(std::string_view key, int low, int high, int otherwise) const {
    const Json* const value = find(key);
    if (value == nullptr) return otherwise;
    if (!value->is_number_integer() || value->get<double>() < low || value->get<double>() > high)
      refuse_value(key, fmt::format("a whole number from {} to {}", low, high));
    return value->get<int>();
  }
  [[nodiscard]] bool flag(std::string_view key) const {
    const Json* const value = find(key);
    if (value == nullptr) return false;
    if (!value->is_boolean()) refuse_value(key, "true or false");
    return value->get<bool>();
  }
  [[nodiscard]] const Json& list(std::string_view key) const {
    const Json& value = at(key);
    if (!value.is_array()) refuse_value(key, "a list [ ]");
    return value;
  }

 private:
  const Json& json_;
  std::string where_;
};

double number_of(const Json& value, const std::string& where) {
  if (!value.is_number() || !std::isfinite(value.get<double>()))
    refuse_hello(where + " must be a finite number");
  return value.get<double>();
}

/// The unit as part of a key: "m s-1" becomes "_m_per_s".
std::string unit_in_key(const std::string& unit) {
  std::string key;
  for (std::size_t at = 0; at < unit.size();) {
    const std::size_t end = std::min(unit.find(' ', at), unit.size());
    const std::string factor = unit.substr(at, end - at);
    const std::size_t power = factor.find('-');
    if (factor != "1" && !factor.empty()) {
      key += power == factor.npos ? "_" + factor : "_per_" + factor.substr(0, power);
      if (power != factor.npos && factor.substr(power) != "-1") key += factor.substr(power + 1);
    }
    at = end + 1;
  }
  return key;
}

std::string origin_of(int di_x, int di_y) {
  if (di_x == 0) return di_y > 0 ? "from below" : "from above";
  if (di_y == 0) return di_x > 0 ? "from the left" : "from the right";
  return fmt::format("from {}, {}", -di_x, -di_y);
}

std::size_t coordinate_of(const dynamics::Section& section, const Json& name,
                          const std::string& where) {
  for (std::size_t k = 0; k < section.coordinates.size(); ++k)
    if (name == section.coordinates[k].name) return k;
  refuse_hello(where + ": 'odd' must name coordinates: " + dynamics::names_of(section.coordinates));
}

void read_coordinates(const Json& list, dynamics::Section& section) {
  for (const Json& one : list) {
    const std::string where = fmt::format("coordinate {}", section.coordinates.size() + 1);
    const HelloTable table(one, where, {"name", "key", "unit", "words", "scale"});
    dynamics::Coordinate c{.name = table.word("name"),
                           .key = "",
                           .unit = table.text("unit", "1"),
                           .words = "",
                           .scale = number_of(table.at("scale"), where + ": 'scale'")};
    c.key = table.text("key", c.name + unit_in_key(c.unit));
    c.words = table.text("words", c.name);
    section.coordinates.push_back(std::move(c));
  }
}

/// `symmetric`: whether the cells are symmetric.
void read_faces(const Json& list, dynamics::Section& section, bool symmetric) {
  std::vector<std::string> mirrors;
  for (const Json& one : list) {
    const std::string where = fmt::format("face {}", section.faces.size() + 1);
    const HelloTable table(one, where, {"name", "move", "mirror", "odd", "origin"});
    dynamics::Face face{.name = table.word("name"), .origin = ""};
    const Json& move = table.list("move");
    const auto is_step = [](const Json& step) {
      return step.is_number_integer() && std::abs(step.get<double>()) <= 1.0;
    };
    if (move.size() != 2 || !is_step(move[0]) || !is_step(move[1]))
      table.refuse_value("move", "two of -1, 0, 1: by which move in the lattice it is entered");
    face.di_x = move[0].get<int>();
    face.di_y = move[1].get<int>();
    face.origin = table.text("origin", origin_of(face.di_x, face.di_y));
    if (table.find("odd") != nullptr)
      for (const Json& name : table.list("odd"))
        face.odd |= static_cast<std::uint8_t>(1U << coordinate_of(section, name, where));
    mirrors.push_back(table.find("mirror") == nullptr ? "" : table.word("mirror"));
    section.faces.push_back(std::move(face));
  }
  const std::string allowed = "'mirror' must name a face: " + dynamics::names_of(section.faces);
  std::vector<int> images(section.faces.size(), dynamics::kNoMirror);
  for (std::size_t f = 0; f < section.faces.size(); ++f) {
    if (mirrors[f].empty()) continue;
    const auto image = std::find_if(section.faces.begin(), section.faces.end(),
                                    [&](const dynamics::Face& o) { return o.name == mirrors[f]; });
    if (image == section.faces.end()) refuse_hello(fmt::format("face {}: {}", f + 1, allowed));
    images[f] = static_cast<int>(image - section.faces.begin());
  }
  dynamics::set_mirrors(section.faces, images, symmetric);
  for (const dynamics::Face& face : section.faces)
    if (symmetric && face.mirror == dynamics::kNoMirror)
      refuse_hello(
          fmt::format("face {} of symmetric cells needs 'mirror': {}", face.name, allowed));
}

void read_costs(const Json& list, dynamics::Section& section) {
  for (const Json& one : list) {
    const HelloTable table(one, fmt::format("cost {}", section.costs.size() + 1),
                           {"key", "unit", "words"});
    dynamics::CostInfo cost{table.word("key"), table.text("unit", "1"), ""};
    cost.words = table.text("words", cost.key);
    section.costs.push_back(std::move(cost));
  }
  if (section.costs.empty())
    refuse_hello("'costs' must name at least one; the first one is a time");
}

std::vector<dynamics::Cell::Remembered> read_remembered(const Json& list,
                                                        const dynamics::Section& section) {
  std::vector<dynamics::Cell::Remembered> remembered;
  std::vector<std::string> names;
  for (const dynamics::Coordinate& c : section.coordinates)
    names.insert(names.end(), {c.name, c.key});
  for (const Json& one : list) {
    const std::string where = fmt::format("remembered number {}", remembered.size() + 1);
    const HelloTable table(one, where, {"key", "odd"});
    const std::string key = table.word("key");
    if (key.find(',') != key.npos) table.refuse_value("key", "a word without commas");
    if (std::find(names.begin(), names.end(), key) != names.end())
      refuse_hello(fmt::format("{}: '{}' is the name of another number", where, excerpt(key, 60)));
    remembered.push_back({.key = key, .odd = table.flag("odd")});
    names.push_back(key);
  }
  if (remembered.size() > dynamics::Cell::kMostRemembered ||
      section.coordinates.size() + remembered.size() > dynamics::kMostCoordinates)
    refuse_hello(
        fmt::format("'remembered' must be at most {} numbers, and {} together with 'coordinates'",
                    dynamics::Cell::kMostRemembered, dynamics::kMostCoordinates));
  return remembered;
}

Hello::Parameter read_parameter(const std::string& key, const Json& value) {
  const std::string where = fmt::format("parameter '{}'", excerpt(key, 60));
  if (!is_word(key) || key.find('=') != key.npos)
    refuse_hello(where + " must be a word without blanks and '='");
  constexpr double kAny = std::numeric_limits<double>::max();
  if (!value.is_array()) return {{key, number_of(value, where)}, -kAny, kAny};
  if (value.size() != 3) refuse_hello(where + " must be a number or [number, least, most]");
  const Hello::Parameter p{
      {key, number_of(value[0], where)}, number_of(value[1], where), number_of(value[2], where)};
  if (!p.permits(p.number.value)) refuse_hello(where + " must be " + p.range());
  return p;
}

}  // namespace

std::string Hello::Parameter::range() const {
  return fmt::format("a number from {} to {}", json_number(low), json_number(high));
}

Hello read_hello(std::string_view line) {
  const Json json = parsed_json(line);
  if (json.is_discarded()) refuse_hello("it is not JSON");
  const HelloTable table(json, "it",
                         {"gatewalk", "faces", "coordinates", "costs", "symmetric", "normals",
                          "uniforms", "parameters", "remembered"});
  if (const Json& version = table.at("gatewalk"); version != kProgramProtocol)
    refuse_hello(fmt::format("'gatewalk' is the protocol, which must be {}", kProgramProtocol));
  Hello hello;
  read_coordinates(table.list("coordinates"), hello.section);
  if (hello.section.coordinates.size() > dynamics::kMostCoordinates)
    refuse_hello(fmt::format("'coordinates' must be at most {}", dynamics::kMostCoordinates));
  hello.symmetric = table.flag("symmetric");
  read_faces(table.list("faces"), hello.section, hello.symmetric);
  read_costs(table.list("costs"), hello.section);
  hello.section.validate();
  hello.normals = table.whole("normals", 0, kMostNoise, 0);
  hello.uniforms = table.whole("uniforms", 0, kMostNoise, 0);
  if (hello.normals > 0 && hello.uniforms > 0)
    refuse_hello("it has 'normals' and 'uniforms'; use one");
  if (const Json* const parameters = table.find("parameters")) {
    if (!parameters->is_object()) table.refuse_value("parameters", "an object { }");
    for (const auto& [key, value] : parameters->items())
      hello.parameters.push_back(read_parameter(key, value));
  }
  if (table.find("remembered") != nullptr)
    hello.remembered = read_remembered(table.list("remembered"), hello.section);
  return hello;
}

}  // namespace gatewalk::cli
