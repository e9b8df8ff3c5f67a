#include "lattice/scene/scene_trials.h"

#include "lattice/scene/bins.h"
#include "lattice/scene/disc_field.h"
#include "lattice/scene/settle.h"

namespace gatewalk::lattice {

FieldTally field_trials(const Scene& scene, std::int64_t trials, std::uint64_t seed,
                        const dynamics::Work& work, FieldCosts* costs, ExitCounts* exits) {
  const dynamics::StateSpace space = fixed_space(scene);
  const FieldGates gates = gates_of(scene);
  FieldTally tally(scene.field);
  work.in_pieces("field trials", trials, [&](dynamics::TrialRange range) {
    FieldTrials each;
    tally += run_field(gates, scene.field, scene.start, seed, range, &each, &space);
    if (costs != nullptr) costs->add(each);
    if (exits != nullptr) exits->add(each);
  });
  check_outcomes(scene, RunsFrom::everywhere, seed, trials, tally.health, work);
  return tally;
}

}  // namespace gatewalk::lattice
