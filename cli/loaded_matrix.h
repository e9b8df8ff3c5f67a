// SPDX-License-Identifier: MIT
#pragma once
/// Matrix files that stay in memory from one command to the next.

#include <memory>
#include <optional>
#include <string>

#include "lattice/gate_chain.h"
#include "lattice/pool/run_pool.h"
#include "lattice/scene/scene.h"

namespace gatewalk::cli {

/// What is read from a matrix file, whatever the command.
struct LoadedMatrix {
  std::string path;
  std::shared_ptr<const lattice::MatrixFile> file;
  std::optional<lattice::Scene> scene{};   // its own; none of cells that are not ours
  std::optional<lattice::RunPool> pool{};  // its runs in the field of its own scene, if it has any
};

/// Throws markov::BadFile and lattice::SceneError.
[[nodiscard]] LoadedMatrix load_matrix(const std::string& path);

}  // namespace gatewalk::cli
