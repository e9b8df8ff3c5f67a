#include "lattice/scene/scene_problem.h"

#include <string>

#include "lattice/scene/settle.h"
#include "lattice/scene/table4.h"

namespace gatewalk::lattice {

Problem problem_of(const Scene& scene) {
  Problem problem{.cells = gates_of(scene).cells(),
                  .field = scene.field,
                  .start = own_start(scene).entry(),
                  .width = scene.gate.gate_width(),
                  .length = scene.gate.gate_length(),
                  .types = {std::string(kOwnGate)},
                  .source = scene.source,
                  .check = {}};
  problem.field.fidelity = Fidelity::active;
  const std::vector<int> types = gate_types(scene);
  for (std::size_t i = 0; i < types.size(); ++i)
    if (types[i] >= std::ssize(problem.types))
      problem.types.push_back(scene.terrain->types[i].name);
  problem.check = [scene](std::int64_t trials, std::uint64_t seed, dynamics::Health& health,
                          const dynamics::Work& work) {
    check_outcomes(scene, RunsFrom::everywhere, seed, trials, health, work);
  };
  return problem;
}

}  // namespace gatewalk::lattice
