// SPDX-License-Identifier: MIT
#pragma once
/// Questions about a scene file and its keys.

#include <string>
#include <string_view>
#include <vector>

#include "lattice/scene/scene.h"

namespace gatewalk::lattice {

class TomlFile;

/// Reads a scene from a file that is already open, as read_scene(path, overrides).
[[nodiscard]] Scene read_scene(const TomlFile& file, const std::vector<std::string>& overrides);

/// The keys that the override `given` sets, in any spelling. Throws SceneError.
[[nodiscard]] std::vector<std::string> keys_set_by(const std::string& given);

/// Throws SceneError unless `key` is a key of a scene; `origin` begins the message.
void require_key(const std::string& key, const std::string& origin);

/// True if the scene's method uses the key: "auto" chooses a step, "event" has none.
[[nodiscard]] bool has_effect(const Scene& scene, std::string_view key);
/// The scene as TOML, as to_toml, without keys that have no effect and that the user did not give:
/// a reader of the file then need not warn of them.
[[nodiscard]] std::string scene_file(const Scene& scene);

/// The differences between two scenes in keys that shape a transition matrix (all of GateParams,
/// [bins] and the types of [terrain]; not field, map and start), one text each: "forces.random_N:
/// 40 here, 20 there".
[[nodiscard]] std::vector<std::string> physics_differences(const Scene& here, const Scene& there);

}  // namespace gatewalk::lattice
