// SPDX-License-Identifier: MIT
#pragma once
/// A matrix file as results, as tables and as a figure, with what it holds besides its counts.

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

/// The records "state_space", "method" and "status" of a matrix file; nullopt if the file has none.
/// Throws markov::BadFile naming `path` for a damaged record; a damaged status counts as none.
[[nodiscard]] std::optional<StateRecord> recorded_states(const lattice::MatrixFile& file,
                                                         const std::string& path);
[[nodiscard]] std::optional<lattice::Settled> recorded_method(const lattice::MatrixFile& file,
                                                              const std::string& path);
[[nodiscard]] std::optional<dynamics::Health> recorded_health(const lattice::MatrixFile& file);
/// A sentence on the faults in a recorded status; empty if there were none.
[[nodiscard]] std::string faults_recorded(const std::optional<dynamics::Health>& status);
/// A line of the first screen if faults_recorded() is not empty; else empty.
[[nodiscard]] std::string beware_of_recorded(const std::optional<dynamics::Health>& status);

/// "87 states"; "192 states and 1 start" for trees, whose starts have rows of their own.
[[nodiscard]] std::string states_words(const dynamics::StateSpace& space);

/// Throws std::invalid_argument if a scene is too large for a matrix file.
void require_keepable(const lattice::Scene& scene);

/// The result of `build` for gates: a matrix, shown without its counts.
struct MadeMatrix {
  std::string path{};
  lattice::MatrixFile file;
  StateRecord states;
  std::optional<lattice::Settled> method{};
  std::optional<std::int64_t> trials_per_row{};  // for bins
  Provenance made_by{};
};
void describe(Fields& out, const MadeMatrix& made);
/// The texts that the matrix file holds besides its counts, by key; `health` is that of its runs.
[[nodiscard]] std::map<std::string, std::string> texts_of(const MadeMatrix& made,
                                                          const lattice::Scene& scene,
                                                          const dynamics::Health& health);
/// Size, runs and types of gates of a written matrix, a line each.
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
  std::vector<std::string> understood;  // how ambiguous parts of the file were read
  Provenance made_by;
};
void describe(Fields& out, const ImportedMatrix& imported);
/// The result of `build` for recorded runs and for cells of a program.
struct CellMatrixResult {
  ShownMatrix matrix;
  RecordedCounts recorded;
  Provenance made_by;
};
void describe(Fields& out, const CellMatrixResult& built);

/// What to show besides the summary: a line for each row, or all outputs of one row. Rows count
/// from 0 in the order of lattice::shown_order.
struct ShownRows {
  bool all = false;
  std::optional<int> one;
};
[[nodiscard]] std::string answer_text(const ShownMatrix& matrix, const ShownRows& shown);
/// How the matrix was made, and its scene.
[[nodiscard]] std::string details_text(const ShownMatrix& matrix);

/// A figure of the matrix, with states grouped by boundary, and in blocks if there are many.
[[nodiscard]] Figure figure_of(const dynamics::Transitions& t);

}  // namespace gatewalk::cli
