// SPDX-License-Identifier: MIT
#pragma once
/// A field with known answers: cells that let a body through with a probability by type.

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/cells/cell.h"
#include "lattice/field/problem.h"

namespace gatewalk::test {

/// One column of cells of these types, each with its probability; bodies enter the next cell
/// anywhere.
inline lattice::Problem lane(const std::vector<double>& chances, std::vector<int> type_of_cell) {
  using namespace dynamics;
  Section section;
  section.faces = {{"S", 0, 1, 0, 1, "from below", {}}};
  section.coordinates = {{"x", "x", "1", "place", 1.0}};
  lattice::Problem problem;
  problem.cells.map.section = section;
  for (const double chance : chances) {
    problem.cells.cells.push_back(std::make_shared<FunctionCell>(section, [chance](Body& body) {
      const Fate fate = body.random.uniform() < chance ? Fate::left : Fate::trapped;
      body.entry = {0, {2.0 * body.random.uniform() - 1.0}};
      return Passage{fate, body.entry};
    }));
    problem.cells.map.types.push_back({});
    problem.types.push_back("type " + std::to_string(problem.types.size()));
  }
  problem.cells.map.columns = 1;
  problem.cells.map.type_of_cell = std::move(type_of_cell);
  problem.field = {1, static_cast<int>(problem.cells.map.type_of_cell.size()), 0};
  problem.start = {0, {0.5}};
  return problem;
}

}  // namespace gatewalk::test
