#pragma once
/// Matrices as the commands use them: building one in batches, taking one from a file with the scene
/// it belongs to.

#include "cli/command.h"
#include "lattice/gate_chain.h"

namespace gatewalk::cli {

/// Fills `trials` runs per row of Table III's states. Throws std::runtime_error when a run broke.
[[nodiscard]] dynamics::Transitions build_matrix(const Scene& scene, std::int64_t trials,
                                                 std::uint64_t seed, bool show_progress);

/// A matrix file and the scene to use it with: the one given, or the one stored in the file.
struct MatrixAndScene {
  lattice::MatrixFile file;
  Scene scene;
};
/// Throws UsageError when the given scene's physics are not those the matrix was built with.
[[nodiscard]] MatrixAndScene read_matrix_and_scene(const std::string& matrix_path,
                                                   const std::string& scene_path,
                                                   const std::vector<std::string>& overrides);

/// Chain and start for that scene; remarks when the start lay outside the bins.
struct ReadyChain {
  markov::Chain chain;
  lattice::ChainStart start;
};
[[nodiscard]] ReadyChain ready_chain(const Options& options, const MatrixAndScene& m);

}  // namespace gatewalk::cli
