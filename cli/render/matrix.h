#pragma once
/// A matrix file with its scene as commands take it: what is wrong with it is said.

#include "cli/command.h"
#include "lattice/scene/matrix.h"
#include "lattice/scene/table4.h"

namespace gatewalk::cli {

/// A matrix, the scene to use it with, and the health of the runs that made it.
struct MatrixAndScene {
  lattice::MatrixFile file;
  lattice::Scene scene;
  Json status;
};
/// The faults of the runs behind a stored status, in one sentence; empty when none were seen.
[[nodiscard]] std::string faults_recorded(const Json& status);
/// lattice::read_scene_matrix; warns when the matrix was made by runs that showed faults.
[[nodiscard]] MatrixAndScene read_matrix_and_scene(const std::string& matrix_path,
                                                   const std::string& scene_path,
                                                   const std::vector<std::string>& overrides);

/// lattice::start_in_bins; warns when the start lies beyond every entry that open bins were made
/// from.
lattice::ChainStart checked_start(const dynamics::StateSpace& space,
                                  const lattice::FieldParams& field,
                                  const dynamics::BodyState& body, const std::string& name);
/// The same for each of them.
void require_inside_bins(const std::vector<lattice::PaperStart>& starts,
                         const lattice::Scene& scene, const dynamics::StateSpace& space);

/// Where the chain starts for a body, as checked_start. Remarks when it lies on an edge of its bin:
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
