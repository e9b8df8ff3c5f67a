#pragma once
/// Many trials through a scene's field, whatever its start and fidelity.

#include <cstdint>

#include "dynamics/base/work.h"
#include "lattice/exits.h"
#include "lattice/field_costs.h"
#include "lattice/scene/scene.h"

namespace gatewalk::lattice {

/// Trials 0, 1, ... through the field from the scene's start; entries are counted by
/// fixed_space(scene). A sample is run again by a better method (check_outcomes). What they took is
/// added to `costs`, and where they left the field to `exits`, if given. Throws as run_field.
[[nodiscard]] FieldTally field_trials(const Scene& scene, std::int64_t trials, std::uint64_t seed,
                                      const dynamics::Work& work = {}, FieldCosts* costs = nullptr,
                                      ExitCounts* exits = nullptr);

/// Durations of a gate's runs are kept to a thousandth of its time limit (s).
[[nodiscard]] inline double bin_of_durations(const dynamics::GateParams& p) {
  return p.run.time_limit / 1000.0;
}

}  // namespace gatewalk::lattice
