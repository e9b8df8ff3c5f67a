// SPDX-License-Identifier: MIT
#pragma once
/// What the rest of the program asks about a scene file and its keys.

#include <string>
#include <string_view>
#include <vector>

#include "lattice/scene/scene.h"

namespace gatewalk::lattice {

class TomlFile;

/// As read_scene(path, overrides), of a file that is open already.
[[nodiscard]] Scene read_scene(const TomlFile& file, const std::vector<std::string>& overrides);

/// The keys that the override `given` sets, however it is spelled. Throws SceneError.
[[nodiscard]] std::vector<std::string> keys_set_by(const std::string& given);

/// Throws SceneError unless `key` is one of a scene; `origin` begins the message.
void require_key(const std::string& key, const std::string& origin);

/// Whether the scene's method looks at the key: "auto" chooses a step, "event" has none.
[[nodiscard]] bool has_effect(const Scene& scene, std::string_view key);
/// to_toml without keys that have no effect and that nobody gave: a file to go on with, whose
/// reader need not warn of what no user wrote.
[[nodiscard]] std::string scene_file(const Scene& scene);

/// What differs between two scenes among the keys that shape a transition matrix (all of
/// GateParams, [bins] and the types of [terrain]; neither field nor map nor start):
/// "forces.random_N: 40 here, 20 there", empty if nothing.
[[nodiscard]] std::vector<std::string> physics_differences(const Scene& here, const Scene& there);

}  // namespace gatewalk::lattice
