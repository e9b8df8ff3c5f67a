// SPDX-License-Identifier: MIT
#pragma once
/// Matrix files of cells that are not gates: the chain of recorded or simulated runs, the runs, and
/// the cell file; or an imported chain, without runs.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lattice/field/matrix_file.h"
#include "lattice/recorded/recorded_pool.h"

namespace gatewalk::lattice {

/// The key of the cell file in a matrix file's text.
inline constexpr const char* kCellText = "cell";

/// The contents of a matrix file of such cells. Field and start are those of the cell file, with
/// overrides.
struct CellMatrix {
  std::shared_ptr<const MatrixFile> file;
  CellFile cells;
  std::optional<RunPool> pool;  // none for an imported chain
  Problem problem;
};
/// Unpacks a matrix file of such cells; `path` names the file in messages. Throws markov::BadFile,
/// and SceneError for an override that is not permitted.
[[nodiscard]] CellMatrix cell_matrix(std::shared_ptr<const MatrixFile> file,
                                     const std::string& path,
                                     const std::vector<std::string>& overrides = {});

/// The matrices of a pool, by cell type, without states for single starts.
[[nodiscard]] std::vector<dynamics::Transitions> cell_matrices(const Problem& problem,
                                                               const RunPool& pool, int per_leaf);
/// A matrix file of these matrices, with the cell file and `text`. The scales of coordinates are
/// kept.
[[nodiscard]] MatrixFile cell_matrix_file(std::vector<dynamics::Transitions> matrices,
                                          CellFile cells, const RunPool& pool,
                                          std::map<std::string, std::string> text);

/// The matrices of a file, one per type of `cells`.
[[nodiscard]] std::vector<dynamics::Transitions> matrices_of(const MatrixFile& file,
                                                             const CellFile& cells);

/// Reads a matrix file of any cells. Its section comes from the cell file in it, or is that of a
/// disc in its gate.
[[nodiscard]] MatrixFile read_matrix(const std::string& path);

}  // namespace gatewalk::lattice
