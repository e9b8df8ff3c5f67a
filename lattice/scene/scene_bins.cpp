// SPDX-License-Identifier: MIT
#include "lattice/scene/scene_bins.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "dynamics/disc/disc_section.h"
#include "lattice/scene/units.h"
#include "lattice/text/digits.h"
#include "lattice/text/toml_text.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

std::string key_of(int boundary, std::size_t axis) {
  return disc_section().faces[boundary].name + "_" + disc_section().coordinates[axis].key;
}

std::string all_keys() {
  std::string names;
  for (int b = 0; b < kBoundaries; ++b)
    for (std::size_t axis = 0; axis < disc_section().coordinates.size(); ++axis)
      names += (names.empty() ? "" : ", ") + key_of(b, axis);
  return names;
}

/// Edges as TOML, with the shortest digits that read back the same, never as whole numbers.
std::string text(const std::vector<double>& edges) {
  std::string list;
  for (const double e : edges) list += (list.empty() ? "[" : ", ") + toml_float(e);
  return list + "]";
}

std::vector<double> numbers_in(const toml::node& node, const std::string& begin,
                               const KeyUnit& unit) {
  const auto refuse = [&] {
    throw SceneError(begin +
                     " is not permitted: must be two or more numbers, finite and ascending, such "
                     "as [-0.2, 0, 0.2]");
  };
  const toml::array* const array = node.as_array();
  if (!array) refuse();
  std::vector<double> edges;
  for (const toml::node& item : *array) {
    if (const auto* whole = item.as_integer())
      edges.push_back(in_own_unit(static_cast<double>(whole->get()), unit));
    else if (const auto* number = item.as_floating_point())
      edges.push_back(in_own_unit(number->get(), unit));
    else
      refuse();
    if (!std::isfinite(edges.back()) ||
        (edges.size() > 1 && !(edges[edges.size() - 2] < edges.back())))
      refuse();
  }
  if (edges.size() < 2) refuse();
  return edges;
}

}  // namespace

std::vector<GivenEdges> edges_in(const toml::table& document,
                                 const std::function<std::string(std::size_t)>& origin) {
  const toml::node* const node = document.get(kBinsTable);
  if (!node) return {};
  if (!node->is_table())
    throw SceneError(origin(node->source().begin.line) +
                     ": bins is not permitted: must be a table, written [bins]");
  std::vector<GivenEdges> all;
  std::map<std::string, std::pair<const toml::node*, std::string>> seen;
  for (const auto& [key, value] : *node->as_table()) {
    const std::string at = origin(value.source().begin.line), name(key.str());
    bool known = false;
    for (int b = 0; b < kBoundaries; ++b)
      for (std::size_t axis = 0; axis < disc_section().coordinates.size(); ++axis) {
        const std::string own = key_of(b, axis);
        const auto unit = unit_of(name, own);
        if (!unit) continue;
        known = true;
        if (const auto [other, is_new] = seen.try_emplace(own, &value, name); !is_new)
          throw SceneError(given_twice(*other->second.first, "bins." + other->second.second, value,
                                       "bins." + name, origin));
        all.push_back({b, axis, "bins." + own, at + (name == own ? "" : " (" + name + ")"),
                       numbers_in(value, at + ": bins." + name, *unit)});
      }
    if (!known) throw SceneError(at + ": unknown key in [bins]; its keys are " + all_keys());
  }
  return all;
}

std::optional<SceneBins> bins_of(const GateParams& gate, const std::vector<GivenEdges>& given) {
  if (given.empty()) return std::nullopt;
  SceneBins bins = table3_space(gate).bins();
  const double side = gate.beams.joint_x, joint = gate.beams.joint_y;
  const double above = gate.run.traverse_y - joint;
  for (const GivenEdges& g : given) {
    const int b = g.boundary;
    const double low = b == Boundary::enter ? -side : 0.0;
    const double high = b == Boundary::enter                                          ? side
                        : b == Boundary::right_deflect || b == Boundary::left_deflect ? joint
                                                                                      : above;
    if (g.axis == kEntryD && !(g.edges.front() >= low && g.edges.back() <= high))
      throw SceneError(g.origin + ": " + g.name + " = " + text(g.edges) +
                       " is not permitted: must lie in [" + toml_float(low) + ", " +
                       toml_float(high) + "] m");
    bins[b].edges[g.axis] = g.edges;
  }
  double states = 0.0;
  for (const Bins& b : bins) {
    double here = 1.0;
    for (std::size_t axis = 0; axis < disc_section().coordinates.size(); ++axis)
      here *= static_cast<double>(b.edges[axis].size() - 1);
    states += here;
  }
  if (states > kMostStates)
    throw SceneError(given.back().origin + ": the table [bins] makes more than " +
                     std::to_string(kMostStates) + " states");
  return bins;
}

std::string bins_toml(const SceneBins& bins) {
  std::string lines = "[bins]\n";
  for (int b = 0; b < kBoundaries; ++b)
    for (std::size_t axis = 0; axis < disc_section().coordinates.size(); ++axis)
      lines += key_of(b, axis) + " = " + text(bins[b].edges[axis]) + "\n";
  return lines;
}

}  // namespace gatewalk::lattice
