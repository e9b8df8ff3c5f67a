// SPDX-License-Identifier: MIT
#pragma once
/// Matrix files of cells that are not ours: the chain of their runs, the runs, and the cell file;
/// or a chain that was made elsewhere, without runs.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lattice/field/matrix_file.h"
#include "lattice/recorded/recorded_pool.h"

namespace gatewalk::lattice {

/// The key of a matrix file's text that has the cell file.
inline constexpr const char* kCellText = "cell";

/// What such a file holds. The field and start are the cell file's, with overrides.
struct CellMatrix {
  std::shared_ptr<const MatrixFile> file;
  CellFile cells;
  std::optional<RunPool> pool;  // none of a chain that was made elsewhere
  Problem problem;
};
/// Of a matrix of such cells that was read from there. Throws markov::BadFile, and SceneError for
/// an override that is not permitted.
[[nodiscard]] CellMatrix cell_matrix(std::shared_ptr<const MatrixFile> file,
                                     const std::string& path,
                                     const std::vector<std::string>& overrides = {});

/// The matrices of a pool, by type, without starts of their own.
[[nodiscard]] std::vector<dynamics::Transitions> cell_matrices(const Problem& problem,
                                                               const RunPool& pool, int per_leaf);
/// A file of these, with `text` beside the cell file: scales are kept as they are.
[[nodiscard]] MatrixFile cell_matrix_file(std::vector<dynamics::Transitions> matrices,
                                          CellFile cells, const RunPool& pool,
                                          std::map<std::string, std::string> text);

/// One matrix for each type of `cells`, of its file.
[[nodiscard]] std::vector<dynamics::Transitions> matrices_of(const MatrixFile& file,
                                                             const CellFile& cells);

/// A matrix file of any cells, whose section is that of its cell file, or of a disc in its gate.
[[nodiscard]] MatrixFile read_matrix(const std::string& path);

}  // namespace gatewalk::lattice
