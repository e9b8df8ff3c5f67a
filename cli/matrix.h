#pragma once
/// Matrices as the commands use them: building one in batches, taking one from a file with the
/// scene it belongs to.

#include "cli/bins.h"
#include "lattice/gate_chain.h"

namespace gatewalk::cli {

/// Throws std::runtime_error when a run of the matrix broke.
void require_unbroken(const dynamics::Transitions& t);

/// A matrix of these states, `trials` runs per row (dynamics::runs_per_trial as many for a single
/// entry's). Throws std::runtime_error when a run broke.
[[nodiscard]] dynamics::Transitions build_matrix(const lattice::Scene& scene, const States& states,
                                                 std::int64_t trials, std::uint64_t seed,
                                                 bool show_progress);

/// A matrix file and the scene to use it with: the one given, or the one stored in the file.
struct MatrixAndScene {
  lattice::MatrixFile file;
  lattice::Scene scene;
  Json status;  // the health of the runs that made the matrix
};
/// The faults of the runs behind a stored status, in one sentence; empty when none were seen.
[[nodiscard]] std::string faults_recorded(const Json& status);
/// Warns when the matrix was made by runs that showed faults. Throws UsageError when the given
/// scene's physics are not those the matrix was built with.
[[nodiscard]] MatrixAndScene read_matrix_and_scene(const std::string& matrix_path,
                                                   const std::string& scene_path,
                                                   const std::vector<std::string>& overrides);

/// Throws UsageError when a start lies outside the chain's bins; warns when it lies beyond every
/// entry that open bins were made from. `name`: "the start".
lattice::ChainStart start_in_bins(const dynamics::StateSpace& space,
                                  const lattice::FieldParams& field,
                                  const dynamics::BodyState& body, const std::string& name);

/// Where the chain starts for a body, as start_in_bins. Remarks when it lies on an edge of its bin:
/// then another bin would serve it as well.
struct ReadyStart {
  lattice::ChainStart start;
  std::string text;  // its bin: "EN d [-5, 5] m, vx [-5, 5] m/s, vy [10, 20] m/s"
};
[[nodiscard]] ReadyStart ready_start(const Options& options, const MatrixAndScene& m,
                                     const dynamics::BodyState& body, const std::string& name);

/// Chain and start for that scene.
struct ReadyChain {
  markov::Chain chain;
  lattice::ChainStart start;
  std::string start_text;
};
[[nodiscard]] ReadyChain ready_chain(const Options& options, const MatrixAndScene& m);

}  // namespace gatewalk::cli
