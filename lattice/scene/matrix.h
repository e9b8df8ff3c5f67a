// SPDX-License-Identifier: MIT
#pragma once
/// Matrices with their scenes: builds a matrix, or takes one from a file.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/base/work.h"
#include "lattice/field/gate_chain.h"
#include "lattice/field/matrix_file.h"
#include "lattice/pool/pooled_prediction.h"
#include "lattice/scene/bins.h"
#include "lattice/statistics/matrix_noise.h"

namespace gatewalk::lattice {

class TomlFile;

/// The section of a scene's matrices: a disc in its gate.
[[nodiscard]] const dynamics::Section& scene_section();

/// Throws std::runtime_error if a run of the matrix broke.
void require_unbroken(const dynamics::Transitions& t);

/// Builds one matrix of these states for each of gates_of(scene).types(). `trials`: runs per row
/// (dynamics::runs_per_trial times as many for a row of a single entry). A sample is run again by a
/// better method (check_outcomes); the first matrix has the health of all. Throws
/// std::runtime_error if a run broke.
[[nodiscard]] std::vector<dynamics::Transitions> build_matrices(const Scene& scene,
                                                                const States& states,
                                                                dynamics::TrialRange trials,
                                                                std::uint64_t seed,
                                                                const dynamics::Work& work = {});

/// The matrices in a file, one for each of gates_of(scene).types(). Throws std::invalid_argument if
/// the file has no matrix for a type of the scene's terrain.
[[nodiscard]] std::vector<dynamics::Transitions> matrices_of(const MatrixFile& file,
                                                             const Scene& scene);
/// Stores matrices, one for each of gates_of(scene).types(), in a file.
void put_matrices(MatrixFile& file, const Scene& scene,
                  std::vector<dynamics::Transitions> matrices);

/// A matrix file, and the scene to use it with.
struct SceneMatrix {
  std::shared_ptr<const MatrixFile> file;
  Scene scene;
};
/// The scene stored in a matrix file; `path` names the file in messages. Throws markov::BadFile.
[[nodiscard]] Scene own_scene(const MatrixFile& file, const std::string& path);
/// The matrix of a file, with the scene `other`, or (null) its `own`. Throws SceneError, and
/// std::invalid_argument if the physics of `other` are not those the matrix was built with.
[[nodiscard]] SceneMatrix scene_matrix(std::shared_ptr<const MatrixFile> file, const Scene& own,
                                       const std::string& matrix_path, const TomlFile* other,
                                       const std::vector<std::string>& overrides);
/// For a matrix of trees: makes each of these starts a state of its own, with new trials from
/// starts that the matrix does not know. Returns the prediction from these trials; nullopt if the
/// matrix knows all starts. Other matrices stay unchanged.
[[nodiscard]] std::optional<PooledPrediction> add_starts(SceneMatrix& m, const std::string& path,
                                                         const std::vector<dynamics::Entry>& starts,
                                                         std::uint64_t seed,
                                                         const dynamics::Work& work = {});

/// As chain_start, but throws std::invalid_argument if the start lies outside the chain's bins;
/// `name` ("the start") begins the message.
[[nodiscard]] ChainStart start_in_bins(const dynamics::StateSpace& space, const FieldParams& field,
                                       const dynamics::Entry& entry, const std::string& name);
/// The bins of entries by one face: "EN d [-5, 5] m, vx [-5, 5] m/s, vy [10, 20] m/s".
[[nodiscard]] std::string entry_bins(const dynamics::StateSpace& space, int face);

/// Rows i_y = first to last of a field whose gates use another matrix.
struct RowMatrix {
  int first = 0, last = 0;
  std::string path;
  SceneMatrix matrix;
};

/// The chain and counts of a field: the matrices of base's gate types, or the matrices of `others`
/// in their rows. Throws std::invalid_argument, with a message that begins "--row FIRST-LAST=PATH",
/// for rows outside the field or given twice. Also throws for a matrix with another body, gate size
/// or states than `base` (called `base_path`), and for rows in a base with a terrain.
[[nodiscard]] CountedField field_of(const SceneMatrix& base, const std::string& base_path,
                                    const std::vector<RowMatrix>& others);

}  // namespace gatewalk::lattice
