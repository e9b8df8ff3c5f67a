// SPDX-License-Identifier: MIT
#pragma once
/// Many trials through a scene's field, whatever its start and fidelity.

#include <cstdint>

#include "dynamics/base/work.h"
#include "lattice/scene/scene.h"
#include "lattice/study/trials.h"

namespace gatewalk::lattice {

/// Trials through the field from the scene's start; entries are counted by fixed_space(scene). A
/// sample is run again by a better method (check_outcomes). `take` as in study/trials.h. Throws as
/// run_field.
[[nodiscard]] FieldTally field_trials(const Scene& scene, dynamics::TrialRange trials,
                                      std::uint64_t seed, const dynamics::Work& work = {},
                                      const TakeTrials& take = {});

/// Durations of a gate's runs are kept to a thousandth of its time limit (s).
[[nodiscard]] inline double bin_of_durations(const dynamics::GateParams& p) {
  return p.run.time_limit / 1000.0;
}

}  // namespace gatewalk::lattice
