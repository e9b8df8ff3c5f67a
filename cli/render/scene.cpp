// SPDX-License-Identifier: MIT
#include "cli/render/scene.h"

#include <algorithm>
#include <cmath>

#include "cli/render/json.h"
#include "cli/render/quantity.h"
#include "cli/render/text.h"
#include "lattice/scene/scene_bins.h"
#include "lattice/text/digits.h"

namespace gatewalk::cli {

namespace {

/// A number of a scene with seven digits at most, unless it is a whole one.
std::string shortened(const std::string& number) {
  if (number.find_first_of(".en") == number.npos) return number;
  const double x = lattice::number_of(number);
  const std::string text = digits(x);
  return lattice::number_of(text) == x ? number : text;
}

/// A key's value: a number, or text in quotation marks.
std::string shown_value(const lattice::KeyInfo& k) {
  return k.value.starts_with('"') ? k.value : shortened(k.value);
}

/// "[low, high]", each end shortened.
std::string shown_range(const lattice::KeyInfo& k) {
  const std::size_t comma = k.range.find(", ");
  if (comma == k.range.npos) return k.range;
  const std::size_t high = comma + 2, end = k.range.size() - 1;
  return k.range.front() + shortened(k.range.substr(1, comma - 1)) + ", " +
         shortened(k.range.substr(high, end - high)) + k.range.back();
}

}  // namespace

std::string limits_text(const ShownField& shown) {
  std::string text = std::isnan(shown.time_limit)
                         ? "(trapped: as the runs say"
                         : "(trapped: still in the same gate " + quantity(shown.time_limit, "s") +
                               " after entering it";
  if (shown.field.max_gates > 0)
    text += "; cut off: would go on from gate number " + std::to_string(shown.field.max_gates) +
            ", the limit field.max_gates, 0 for none";
  return text + ")\n";
}

std::string too_few_gates(const ShownField& shown) {
  const lattice::FieldParams& field = shown.field;
  int longest = 1;  // rows in one move
  for (const dynamics::Face& face : shown.map.section.faces) longest = std::max(longest, face.di_y);
  if (field.max_gates == 0 || field.max_gates >= (field.rows + longest - 1) / longest) return "";
  return "nobody can cross: field.max_gates = " + std::to_string(field.max_gates) +
         " is less than field.rows = " + std::to_string(field.rows);
}

std::string scene_line(const lattice::Scene& scene, const std::vector<std::string>& actions) {
  const auto& gate = scene.gate;
  const auto& start = scene.start;
  const auto number = [](double x) { return digits(x, 6); };
  // Two numbers with one unit, that of the larger.
  const Sized place = readable_unit("m", std::max(std::abs(start.x), std::abs(start.y)));
  const Sized speed = readable_unit("m/s", std::max(std::abs(start.vx), std::abs(start.vy)));
  const std::string text = scene.source + ": start x " + number(start.x / place.size) + ", y " +
                           number(start.y / place.size) + " " + place.name + ", v (" +
                           number(start.vx / speed.size) + ", " + number(start.vy / speed.size) +
                           ") " + speed.name + "; disc " + quantity(gate.body.mass, "kg", 6) +
                           ", R " + quantity(gate.body.radius, "m", 6) + "; ";
  if (!actions.empty()) {
    std::string all;
    for (const std::string& action : actions) all += (all.empty() ? "" : ", ") + action;
    return text + "actions " + all + "\n";
  }
  return text + "F " + quantity(gate.forces.propulsion, "N", 6) + ", Rm " +
         quantity(gate.forces.random, "N", 6) + "; beams k " + number(gate.beams.stiffness_left) +
         " / " + number(gate.beams.stiffness_right) + ", d " + number(gate.beams.damping) + "; " +
         gate.run.method + " " +
         (gate.run.method == "event" ? quantity(gate.run.event_tolerance, "m", 6)
                                     : quantity(gate.run.step, "s", 6)) +
         "\n";
}

Json to_json(const std::vector<lattice::KeyInfo>& keys) {
  Json json;
  for (const lattice::KeyInfo& k : keys)
    json.push_back({{"key", k.key},
                    {"value", k.value},
                    {"unit", k.unit},
                    {"range", k.range},
                    {"meaning", k.meaning},
                    {"source", k.source}});
  return json;
}

std::string table_of(const std::vector<lattice::KeyInfo>& keys) {
  std::size_t key_width = 0, value_width = 0, unit_width = 0, source_width = 0;
  for (const lattice::KeyInfo& k : keys) {
    key_width = std::max(key_width, k.key.size());
    value_width = std::max(value_width, shown_value(k).size());
    unit_width = std::max(unit_width, k.unit.size());
    source_width = std::max(source_width, k.source.size());
  }
  const auto column = [](const std::string& text, std::size_t width) {
    return padded(text, -static_cast<int>(width + 2));
  };
  std::string table = column("key", key_width) + column("value", value_width) +
                      column("unit", unit_width) + column("from", source_width) +
                      "meaning; range\n";
  for (const lattice::KeyInfo& k : keys)
    table += column(k.key, key_width) + column(shown_value(k), value_width) +
             column(k.unit, unit_width) + column(k.source, source_width) + k.meaning +
             (k.range.empty() ? "" : "; " + shown_range(k)) + "\n";
  return table;
}

std::string commented(const lattice::Scene& scene) {
  std::vector<lattice::KeyInfo> keys = lattice::describe(scene);
  std::string text =
      "# A scene for gatewalk: one body, one gate with two beams, a field of such gates. Units are "
      "in the keys.\n"
      "# A key that is left out, as behind #, follows from the others by the paper's proportions: "
      "from body.radius_m,\n"
      "# body.mass_kg and forces.propulsion_N. gatewalk scene FILE shows every value and its "
      "source.\n";
  std::string table;
  std::size_t width = 0;
  const auto leaf = [](const lattice::KeyInfo& k) { return k.key.substr(k.key.find('.') + 1); };
  const auto of_terrain = [](const lattice::KeyInfo& k) {
    return k.key.starts_with("terrain.") || k.key.starts_with("actions.");
  };
  for (lattice::KeyInfo& k : keys) {
    if (k.source == "derived")
      k.value = digits(lattice::number_of(k.value));  // nobody reads them back
    if (!of_terrain(k)) width = std::max(width, leaf(k).size() + k.value.size() + 5);
  }
  for (const lattice::KeyInfo& k : keys) {
    if (of_terrain(k)) break;  // as a table below
    if (const std::string own = k.key.substr(0, k.key.find('.')); own != table)
      text += "\n[" + (table = own) + "]\n";
    const bool follows = k.source == "derived";
    text += padded((follows ? "# " : "") + leaf(k) + " = " + k.value, -static_cast<int>(width)) +
            "  # " + k.meaning;
    if (!k.range.empty()) text += ", in " + shown_range(k) + (k.unit.empty() ? "" : " " + k.unit);
    if (follows || k.source == "paper") text += "; " + k.source;
    text += "\n";
  }
  if (scene.bins) text += "\n" + lattice::bins_toml(*scene.bins);
  if (scene.terrain) text += "\n" + lattice::terrain_toml(*scene.terrain, scene.field);
  text += lattice::gates_toml("actions", scene.actions);
  if (!scene.sweep.empty()) text += "\n[sweep]\n";
  for (const lattice::Variation& v : scene.sweep)
    text += "\"" + v.key + "\" = \"" + v.values + "\"\n";
  return text;
}

}  // namespace gatewalk::cli
