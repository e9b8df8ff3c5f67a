// SPDX-License-Identifier: MIT
#pragma once
/// run.method = "auto": chooses a sufficient numerical method and setting for a scene; and checks a
/// scene's method against a better one.

#include <optional>
#include <string>
#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/disc/study/choice.h"
#include "lattice/scene/scene.h"

namespace gatewalk::lattice {

/// Where gate runs begin: at the scene's start only; also in states all over the state space; or
/// there with all types of gates, whether they stand in the field or not.
enum class RunsFrom { start, everywhere, all_types };

/// The method that "auto" became.
struct Settled {
  dynamics::Choice choice;
  double tolerance = 0.0;  // run.tolerance, as asked for
  std::size_t pilot_starts = 0;
};

/// Replaces "auto" in the scene by the method and setting that a pilot chooses; nullopt if the
/// scene names its method.
[[nodiscard]] std::optional<Settled> settle_method(Scene& scene, RunsFrom from, std::uint64_t seed,
                                                   const dynamics::Work& work = {});

/// A sentence for each key that the scene gives, but that its method or runs from there do not use.
[[nodiscard]] std::vector<std::string> keys_without_effect(const Scene& scene, RunsFrom from);
/// A sentence that the scene's terrain has no effect where a single gate is run; empty without a
/// terrain.
[[nodiscard]] std::string terrain_without_effect(const Scene& scene);
/// A sentence on the keys that the scene leaves out and that get scaled values of the paper; empty
/// if there are none.
[[nodiscard]] std::string derived_keys(const Scene& scene);
/// The keys of the scene that gatewalk computed from forces.propulsion_N:
/// "beams.damping_Nms_per_rad and forces.random_N". Empty if there are none.
[[nodiscard]] std::string numbers_from_the_push(const Scene& scene);

/// Runs a sample of `trials` again by a better method, and adds to `health` by how much the results
/// change (dynamics::check_outcomes).
void check_outcomes(const Scene& scene, RunsFrom from, std::uint64_t seed, std::int64_t trials,
                    dynamics::Health& health, const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
