// SPDX-License-Identifier: MIT
#include "lattice/scene/scene_trials.h"

#include "lattice/gates/disc_field.h"
#include "lattice/scene/bins.h"
#include "lattice/scene/settle.h"
#include "lattice/scene/terrain.h"

namespace gatewalk::lattice {

FieldTally field_trials(const Scene& scene, dynamics::TrialRange trials, std::uint64_t seed,
                        const dynamics::Work& work, const TakeTrials& take) {
  const dynamics::StateSpace space = fixed_space(scene);
  const FieldGates gates = gates_of(scene);
  FieldTally tally = field_trials(
      scene.field, trials,
      [&](dynamics::TrialRange range, FieldTrials& each) {
        return run_field(gates, scene.field, scene.start, seed, range, &each, &space);
      },
      work, take);
  check_outcomes(scene, RunsFrom::everywhere, seed, trials.count, tally.health, work);
  return tally;
}

}  // namespace gatewalk::lattice
