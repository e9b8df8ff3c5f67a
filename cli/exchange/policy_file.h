// SPDX-License-Identifier: MIT
#pragma once
/// What a body does in each gate, as a file (JSON): made by `gatewalk plan`, run by `gatewalk
/// lattice`.

#include <string>

#include "lattice/scene/scene.h"
#include "lattice/study/plan.h"

namespace gatewalk::cli {

/// Throws std::runtime_error for a scene of more actions, or more gates, than a file can hold.
void require_file_for(const lattice::Scene& scene);
/// Text of the file: the scene with its actions, the trees of ways to enter, a letter for the
/// action in each state (gates by row and column, with a limit of gates also by how many were
/// passed). Throws std::runtime_error for more than a file can hold.
[[nodiscard]] std::string policy_text(const lattice::Policy& policy, const lattice::Scene& scene);

/// Reads it for a scene. Throws markov::BadFile for a file that is damaged, and for a scene that
/// differs from its own in anything but the start.
[[nodiscard]] lattice::Policy read_policy(const std::string& path, const lattice::Scene& scene);

}  // namespace gatewalk::cli
