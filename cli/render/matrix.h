// SPDX-License-Identifier: MIT
#pragma once
/// A matrix file: what it keeps beside its counts, and all of it as results, as tables
/// and as a picture.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cli/render/figure.h"
#include "cli/render/provenance.h"
#include "cli/render/recorded.h"
#include "cli/render/states.h"
#include "lattice/field/matrix_file.h"
#include "lattice/scene/settle.h"

namespace gatewalk::cli {

/// Its record "state_space", "method" or "status"; none where it has none. Throws markov::BadFile
/// naming `path` when one is damaged; a damaged status is none.
[[nodiscard]] std::optional<StateRecord> recorded_states(const lattice::MatrixFile& file,
                                                         const std::string& path);
[[nodiscard]] std::optional<lattice::Settled> recorded_method(const lattice::MatrixFile& file,
                                                              const std::string& path);
[[nodiscard]] std::optional<dynamics::Health> recorded_health(const lattice::MatrixFile& file);
/// The faults of the runs behind a recorded status, in one sentence; empty when none were seen.
[[nodiscard]] std::string faults_recorded(const std::optional<dynamics::Health>& status);

/// Throws std::invalid_argument where a scene is larger than what a matrix file keeps of it.
void require_keepable(const lattice::Scene& scene);

/// The result of `build` for gates: a matrix without its counts.
struct MadeMatrix {
  std::string path{};
  lattice::MatrixFile file;
  StateRecord states;
  std::optional<lattice::Settled> method{};
  std::optional<std::int64_t> trials_per_row{};  // of bins
  Provenance made_by{};
};
void describe(Fields& out, const MadeMatrix& made);
/// All that the file of such a matrix keeps beside its counts, by key; `health` of its runs.
[[nodiscard]] std::map<std::string, std::string> texts_of(const MadeMatrix& made,
                                                          const lattice::Scene& scene,
                                                          const dynamics::Health& health);
/// Size, runs and types of gates of a matrix that was written, a line each.
[[nodiscard]] std::string summary_table(const lattice::MatrixFile& file, const std::string& path);

/// The result of `show`: all that a file holds.
struct ShownMatrix {
  std::string path;
  lattice::MatrixFile file;
};
void describe(Fields& out, const ShownMatrix& shown);
/// The result of `import`.
struct ImportedMatrix {
  ShownMatrix matrix;
  std::vector<std::string> understood;  // where a file may be read in more than one way
  Provenance made_by;
};
void describe(Fields& out, const ImportedMatrix& imported);
/// The result of `build` for cells that are not ours.
struct CellMatrixResult {
  ShownMatrix matrix;
  RecordedCounts recorded;
  Provenance made_by;
};
void describe(Fields& out, const CellMatrixResult& built);

/// What is shown besides the summary: a line per row, all outputs of one row (from 0, in the order
/// of lattice::shown_order, as all of them).
struct ShownRows {
  bool all = false;
  std::optional<int> one;
};
[[nodiscard]] std::string answer_text(const ShownMatrix& matrix, const ShownRows& shown);
/// How the matrix was made, and its scene.
[[nodiscard]] std::string details_text(const ShownMatrix& matrix);

/// The matrix as a picture: states grouped by boundary, in blocks if they are many.
[[nodiscard]] Figure figure_of(const dynamics::Transitions& t);

}  // namespace gatewalk::cli
