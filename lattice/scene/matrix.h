// SPDX-License-Identifier: MIT
#pragma once
/// Matrices with the scene they belong to: building one, taking one from a file.

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

/// The section of matrices of scenes: a disc in its gate.
[[nodiscard]] const dynamics::Section& scene_section();

/// Throws std::runtime_error when a run of the matrix broke.
void require_unbroken(const dynamics::Transitions& t);

/// A matrix of these states for each of gates_of(scene).types(), these trials of each row: runs
/// (dynamics::runs_per_trial as many for a single entry's). A sample is run again by a better
/// method (check_outcomes): the first one has the health of all. Throws std::runtime_error when a
/// run broke.
[[nodiscard]] std::vector<dynamics::Transitions> build_matrices(const Scene& scene,
                                                                const States& states,
                                                                dynamics::TrialRange trials,
                                                                std::uint64_t seed,
                                                                const dynamics::Work& work = {});

/// The matrices in a file, one for each of gates_of(scene).types(). Throws std::invalid_argument
/// when it has none of a type of the scene's terrain.
[[nodiscard]] std::vector<dynamics::Transitions> matrices_of(const MatrixFile& file,
                                                             const Scene& scene);
/// Puts them there.
void put_matrices(MatrixFile& file, const Scene& scene,
                  std::vector<dynamics::Transitions> matrices);

/// A matrix and the scene to use it with.
struct SceneMatrix {
  std::shared_ptr<const MatrixFile> file;
  Scene scene;
};
/// The scene stored in a file read from there. Throws markov::BadFile.
[[nodiscard]] Scene own_scene(const MatrixFile& file, const std::string& path);
/// The matrix of a file with another scene, or (null) its `own`. Throws SceneError, and
/// std::invalid_argument when the other scene's physics are not those the matrix was built with.
[[nodiscard]] SceneMatrix scene_matrix(std::shared_ptr<const MatrixFile> file, const Scene& own,
                                       const std::string& matrix_path, const TomlFile* other,
                                       const std::vector<std::string>& overrides);
/// Of a matrix of trees: makes each of these starts a state of its own, by new trials from those
/// that it does not know. What these predict; none where it knows all. Other matrices stay as they
/// are.
[[nodiscard]] std::optional<PooledPrediction> add_starts(SceneMatrix& m, const std::string& path,
                                                         const std::vector<dynamics::Entry>& starts,
                                                         std::uint64_t seed,
                                                         const dynamics::Work& work = {});

/// As chain_start; `name` ("the start") begins the message. Throws std::invalid_argument when the
/// start lies outside the chain's bins.
[[nodiscard]] ChainStart start_in_bins(const dynamics::StateSpace& space, const FieldParams& field,
                                       const dynamics::Entry& entry, const std::string& name);
/// The bins of entries by a face: "EN d [-5, 5] m, vx [-5, 5] m/s, vy [10, 20] m/s".
[[nodiscard]] std::string entry_bins(const dynamics::StateSpace& space, int face);

/// Rows i_y = first to last whose gates are those of another matrix.
struct RowMatrix {
  int first = 0, last = 0;
  std::string path;
  SceneMatrix matrix;
};

/// What the cells of base's field draw from: the matrices of its types of gates, or of these rows'
/// own. Throws std::invalid_argument, whose message begins
/// "--row FIRST-LAST=PATH", when rows lie outside the field or are given twice, or when a matrix
/// has another body, gates of another size or other states than `base`, which is called
/// `base_path`; and when there are rows and the base has a terrain.
[[nodiscard]] CountedField field_of(const SceneMatrix& base, const std::string& base_path,
                                    const std::vector<RowMatrix>& others);

}  // namespace gatewalk::lattice
