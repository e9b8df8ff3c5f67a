// SPDX-License-Identifier: MIT
#include "lattice/scene/scene_problem.h"

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "lattice/gates/gates.h"
#include "lattice/scene/table4.h"
#include "lattice/scene/terrain.h"

namespace gatewalk::lattice {

namespace {

FieldGates gates_of(const Scene& scene, RunsFrom from) {
  return from == RunsFrom::all_types ? all_gates_of(scene) : gates_of(scene);
}

std::vector<std::string> names_of_types(const Scene& scene, RunsFrom from) {
  std::vector<std::string> names{std::string(kOwnGate)};
  const std::vector<int> types = gate_types(scene);
  for (std::size_t i = 0; scene.terrain && i < scene.terrain->types.size(); ++i)
    if (from == RunsFrom::all_types || types[i] >= std::ssize(names))
      names.push_back(scene.terrain->types[i].name);
  return names;
}

Problem complete_problem(const Scene& scene, RunsFrom from) {
  Problem problem = problem_without_cells(scene, from);
  put_cells(problem, scene, from);
  return problem;
}

}  // namespace

Problem problem_without_cells(const Scene& scene, RunsFrom from) {
  // Outside the braces: if one of several initialisers throws there, g++ 12 frees twice.
  dynamics::CellMap map = gates_of(scene, from).map();
  const dynamics::Entry start = own_start(scene);
  Problem problem{.cells = {std::move(map), {}},
                  .field = scene.field,
                  .start = start,
                  .width = scene.gate.gate_width(),
                  .length = scene.gate.gate_length(),
                  .types = names_of_types(scene, from),
                  .source = scene.source,
                  .check = {}};
  problem.field.fidelity = Fidelity::active;
  return problem;
}

void put_cells(Problem& problem, const Scene& scene, RunsFrom from) {
  problem.cells = gates_of(scene, from).cells();
  problem.check = [scene, from](std::int64_t trials, std::uint64_t seed, dynamics::Health& health,
                                const dynamics::Work& work) {
    check_outcomes(scene, from, seed, trials, health, work);
  };
}

Problem problem_of(const Scene& scene) { return complete_problem(scene, RunsFrom::everywhere); }

Problem problem_with_all_types(const Scene& scene) {
  return complete_problem(scene, RunsFrom::all_types);
}

Scene up_to_row(const Scene& scene, int row) {
  Scene deep = scene;
  deep.field = up_to_row(scene.field, row);
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
