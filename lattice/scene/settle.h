// SPDX-License-Identifier: MIT
#pragma once
/// run.method = "auto": the method and setting that a scene can do with; and a check of a scene's
/// method by a better one.

#include <optional>
#include <string>
#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/disc/study/choice.h"
#include "lattice/scene/scene.h"

namespace gatewalk::lattice {

/// Where gate runs begin: at the scene's start, or in states all over the state space too; there of
/// all types of gates, whether they stand in the field or not.
enum class RunsFrom { start, everywhere, all_types };

/// What "auto" became.
struct Settled {
  dynamics::Choice choice;
  double tolerance = 0.0;  // run.tolerance, that was asked for
  std::size_t pilot_starts = 0;
};

/// Replaces "auto" in the scene by the method and setting that a pilot chooses; none when the scene
/// names its method.
[[nodiscard]] std::optional<Settled> settle_method(Scene& scene, RunsFrom from, std::uint64_t seed,
                                                   const dynamics::Work& work = {});

/// Keys that the scene gives and its method, or runs from there, do not look at, a sentence each.
[[nodiscard]] std::vector<std::string> keys_without_effect(const Scene& scene, RunsFrom from);
/// That the scene's terrain has none where one gate is run; empty without one.
[[nodiscard]] std::string terrain_without_effect(const Scene& scene);
/// What the scene leaves out and has been given by its own proportions; empty if nothing.
[[nodiscard]] std::string derived_keys(const Scene& scene);
/// To be said where pushes are compared, or the file gives one: which of the beams, the random
/// force and the drag the scene leaves out so that they follow forces.propulsion_N, and what to
/// write to fix them. Empty where none does.
[[nodiscard]] std::string push_is_followed(const Scene& scene);

/// Runs a sample of `trials` again by a better method, and puts into `health` what that changes:
/// see dynamics::check_outcomes.
void check_outcomes(const Scene& scene, RunsFrom from, std::uint64_t seed, std::int64_t trials,
                    dynamics::Health& health, const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
