// SPDX-License-Identifier: MIT
#include "lattice/scene/scene_problem.h"

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "lattice/scene/settle.h"
#include "lattice/scene/table4.h"

namespace gatewalk::lattice {

namespace {

/// Of gates with these names.
Problem problem_of(const Scene& scene, const FieldGates& gates, std::vector<std::string> names,
                   RunsFrom from) {
  Problem problem{.cells = gates.cells(),
                  .field = scene.field,
                  .start = own_start(scene).entry(),
                  .width = scene.gate.gate_width(),
                  .length = scene.gate.gate_length(),
                  .types = std::move(names),
                  .source = scene.source,
                  .check = {}};
  problem.field.fidelity = Fidelity::active;
  problem.check = [scene, from](std::int64_t trials, std::uint64_t seed, dynamics::Health& health,
                                const dynamics::Work& work) {
    check_outcomes(scene, from, seed, trials, health, work);
  };
  return problem;
}

}  // namespace

Problem problem_of(const Scene& scene) {
  std::vector<std::string> names{std::string(kOwnGate)};
  const std::vector<int> types = gate_types(scene);
  for (std::size_t i = 0; i < types.size(); ++i)
    if (types[i] >= std::ssize(names)) names.push_back(scene.terrain->types[i].name);
  return problem_of(scene, gates_of(scene), std::move(names), RunsFrom::everywhere);
}

Problem problem_with_all_types(const Scene& scene) {
  std::vector<std::string> names{std::string(kOwnGate)};
  if (scene.terrain)
    for (const Terrain::Type& type : scene.terrain->types) names.push_back(type.name);
  return problem_of(scene, all_gates_of(scene), std::move(names), RunsFrom::all_types);
}

Scene up_to_row(const Scene& scene, int row) {
  if (row < 1) throw std::invalid_argument("the row to enter must be 1 or more");
  Scene deep = scene;
  deep.field.rows = row;
  deep.field.max_gates = 0;
  if (!scene.terrain) return deep;
  if (row > scene.field.rows)
    throw std::invalid_argument(
        scene.source + ": the terrain has " + std::to_string(scene.field.rows) +
        " rows; the row to enter (--row) must be at most " + std::to_string(scene.field.rows) +
        (scene.terrain->shares.empty() ? "" : ", or field.rows larger: as many are drawn"));
  deep.terrain->type_of_cell.resize(static_cast<std::size_t>(deep.field.columns) *
                                    static_cast<std::size_t>(row));  // the near rows
  return deep;
}

}  // namespace gatewalk::lattice
