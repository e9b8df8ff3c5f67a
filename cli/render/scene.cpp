// SPDX-License-Identifier: MIT
#include "cli/render/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/render/quantity.h"
#include "cli/render/text.h"
#include "cli/render/text_table.h"
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
  return fmt::format("{}{}, {}{}", k.range.front(), shortened(k.range.substr(1, comma - 1)),
                     shortened(k.range.substr(high, end - high)), k.range.back());
}

}  // namespace

std::string limits_text(const ShownField& shown) {
  std::string text = std::isnan(shown.time_limit)
                         ? "(trapped: as the runs say"
                         : fmt::format("(trapped: still in the same gate {} after entering it",
                                       quantity(shown.time_limit, "s"));
  if (shown.field.max_gates > 0)
    text += fmt::format(
        "; cut off: would go on from gate number {}, the limit field.max_gates, 0 for none",
        shown.field.max_gates);
  return text + ")\n";
}

std::string too_few_gates(const ShownField& shown) {
  const lattice::FieldParams& field = shown.field;
  int longest = 1;  // rows in one move
  for (const dynamics::Face& face : shown.map.section.faces) longest = std::max(longest, face.di_y);
  if (field.max_gates == 0 || field.max_gates >= (field.rows + longest - 1) / longest) return "";
  return fmt::format("nobody can cross: field.max_gates = {} is less than field.rows = {}",
                     field.max_gates, field.rows);
}

std::string scene_line(const lattice::Scene& scene, const std::vector<std::string>& actions) {
  const auto& gate = scene.gate;
  const auto& start = scene.start;
  const auto number = [](double x) { return digits(x, 6); };
  // Two numbers with one unit, that of the larger.
  const Sized place = readable_unit("m", std::max(std::abs(start.x), std::abs(start.y)));
  const Sized speed = readable_unit("m/s", std::max(std::abs(start.vx), std::abs(start.vy)));
  const std::string text =
      fmt::format("{}: start x {}, y {} {}, v ({}, {}) {}; disc {}, R {}; ", scene.source,
                  number(start.x / place.size), number(start.y / place.size), place.name,
                  number(start.vx / speed.size), number(start.vy / speed.size), speed.name,
                  quantity(gate.body.mass, "kg", 6), quantity(gate.body.radius, "m", 6));
  if (!actions.empty()) return fmt::format("{}actions {}\n", text, fmt::join(actions, ", "));
  return fmt::format("{}F {}, Rm {}; beams k {} / {}, d {}; {} {}\n", text,
                     quantity(gate.forces.propulsion, "N", 6), quantity(gate.forces.random, "N", 6),
                     number(gate.beams.stiffness_left), number(gate.beams.stiffness_right),
                     number(gate.beams.damping), gate.run.method,
                     gate.run.method == "event" ? quantity(gate.run.event_tolerance, "m", 6)
                                                : quantity(gate.run.step, "s", 6));
}

std::string table_of(const std::vector<lattice::KeyInfo>& keys) {
  TextTable table({{"key", -kFit},
                   {"value", -kFit, 0, "", "  "},
                   {"unit", -kFit, 0, "", "  "},
                   {"from", -kFit, 0, "", "  "},
                   {"meaning; range", 0, 0, "", "  "}});
  for (const lattice::KeyInfo& k : keys)
    table.row({k.key, shown_value(k), k.unit, k.source,
               k.meaning + (k.range.empty() ? "" : "; " + shown_range(k))});
  return table.text();
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
    text +=
        fmt::format("{:<{}}  # {}", fmt::format("{}{} = {}", follows ? "# " : "", leaf(k), k.value),
                    width, k.meaning);
    if (!k.range.empty()) text += ", in " + shown_range(k) + (k.unit.empty() ? "" : " " + k.unit);
    if (follows || k.source == "paper") text += "; " + k.source;
    text += "\n";
  }
  if (scene.bins) text += "\n" + lattice::bins_toml(*scene.bins);
  if (scene.terrain) text += "\n" + lattice::terrain_toml(*scene.terrain, scene.field);
  text += lattice::gates_toml("actions", scene.actions);
  if (!scene.sweep.empty()) text += "\n[sweep]\n";
  for (const lattice::Variation& v : scene.sweep)
    text += fmt::format("\"{}\" = \"{}\"\n", v.key, v.values);
  return text;
}

}  // namespace gatewalk::cli
