// SPDX-License-Identifier: MIT
#pragma once
/// Sparse matrices as other programs write and read them.

#include <Eigen/SparseCore>
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "cli/exchange/npz.h"

namespace gatewalk::cli {

/// Entries in the order of rows, within each of columns; no two at one place.
struct SparseTable {
  /// How finely numbers are written, at most: digits from the first that is not 0, and behind the
  /// point. Of doubles and floats in binary the digits that tell any two apart.
  struct Precision {
    int digits = 0, decimals = 0;
  };
  struct Entry {
    std::int64_t row = 0, column = 0;  // from 0
    double value = 0.0;
  };
  std::int64_t rows = 0, columns = 0;
  std::vector<Entry> entries;
  bool whole = false;          // written as whole numbers
  bool probabilities = false;  // its file calls them so
  Precision precision{};
  std::vector<std::string> understood{};  // what its reader decided, a sentence each
};

template <class Value>
[[nodiscard]] SparseTable table_of(const Eigen::SparseMatrix<Value, Eigen::RowMajor>& matrix) {
  SparseTable table{matrix.rows(), matrix.cols(), {}, std::is_integral_v<Value>};
  for (Eigen::Index row = 0; row < matrix.rows(); ++row)
    for (typename Eigen::SparseMatrix<Value, Eigen::RowMajor>::InnerIterator it(matrix, row); it;
         ++it)
      table.entries.push_back({row, it.col(), static_cast<double>(it.value())});
  return table;
}

/// The same with another order of its states, (n x n + 1): row k is that of states[k], and so are
/// the columns but the last.
template <class Matrix>
[[nodiscard]] Matrix in_order(const Matrix& matrix, const std::vector<int>& states) {
  if (std::is_sorted(states.begin(), states.end())) return matrix;
  std::vector<int> place(states.size() + 1, static_cast<int>(states.size()));
  for (std::size_t k = 0; k < states.size(); ++k)
    place[static_cast<std::size_t>(states[k])] = static_cast<int>(k);
  std::vector<Eigen::Triplet<typename Matrix::Scalar>> entries;
  for (Eigen::Index row = 0; row < matrix.rows(); ++row)
    for (typename Matrix::InnerIterator it(matrix, row); it; ++it)
      entries.emplace_back(place[static_cast<std::size_t>(row)],
                           place[static_cast<std::size_t>(it.col())], it.value());
  Matrix ordered(matrix.rows(), matrix.cols());
  ordered.setFromTriplets(entries.begin(), entries.end());
  return ordered;
}

/// Matrix Market's coordinate format, which counts from 1; `comment` on a line of its own.
[[nodiscard]] std::string matrix_market_of(const SparseTable& table, std::string comment);
/// from,to,VALUE with the names of rows and columns.
[[nodiscard]] std::string csv_of(const SparseTable& table, const std::vector<std::string>& rows,
                                 const std::vector<std::string>& columns, const std::string& value);
/// As scipy.sparse.load_npz reads it: compressed rows.
[[nodiscard]] std::string npz_of(const SparseTable& table);

/// "coordinate" or "array"; "real", "integer" or "unsigned-integer"; "general" or "symmetric".
/// Entries of one place are added up, as scipy does. These throw std::runtime_error naming file,
/// line and what is allowed.
[[nodiscard]] SparseTable read_matrix_market(const std::string& path);
/// Columns from, to and count or probability, in any order; states by these names, or by their
/// numbers from 0. `columns`: names of outputs, the first `rows` of which are those of the rows.
[[nodiscard]] SparseTable read_csv(const std::string& path, std::int64_t rows,
                                   const std::vector<std::string>& columns);
/// Of an .npz: compressed rows or columns, or coordinates, as scipy.sparse.save_npz writes them.
/// Entries of one place are added up.
[[nodiscard]] SparseTable table_of(const std::string& path, const std::vector<NumpyArray>& arrays);

/// Sequences of states from 0: a line each, numbers between blanks or commas; or an array each of
/// an .npz. -1 is a gap: where no state is known.
using Trajectories = std::vector<std::vector<std::int64_t>>;
[[nodiscard]] std::string text_of(const Trajectories& all);
[[nodiscard]] std::string npz_of(const Trajectories& all);
[[nodiscard]] Trajectories read_trajectories(const std::string& path);
/// Of an .npz; and whether it holds such sequences, and no sparse matrix.
[[nodiscard]] Trajectories trajectories_of(const std::string& path, std::vector<NumpyArray> arrays);
[[nodiscard]] bool hold_trajectories(const std::vector<NumpyArray>& arrays);

}  // namespace gatewalk::cli
