// SPDX-License-Identifier: MIT
#pragma once
/// Runs many trials through a scene's field, for any start and fidelity.

#include <cstdint>

#include "dynamics/base/work.h"
#include "lattice/scene/scene.h"
#include "lattice/study/trials.h"

namespace gatewalk::lattice {

/// Runs trials through the field from the scene's start; clamped entries refer to
/// fixed_space(scene). A sample is run again by a better method (check_outcomes). `take`: see
/// study/trials.h. Throws as run_field.
[[nodiscard]] FieldTally field_trials(const Scene& scene, dynamics::TrialRange trials,
                                      std::uint64_t seed, const dynamics::Work& work = {},
                                      const TakeTrials& take = {});

/// Resolution of the durations of gate runs, s: a thousandth of the gate's time limit.
[[nodiscard]] inline double bin_of_durations(const dynamics::GateParams& p) {
  return p.run.time_limit / 1000.0;
}

}  // namespace gatewalk::lattice
