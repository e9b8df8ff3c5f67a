// SPDX-License-Identifier: MIT
#pragma once
/// Sparse matrices in the formats of other programs.

#include <Eigen/SparseCore>
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "cli/exchange/npz.h"

namespace gatewalk::cli {

/// A sparse matrix. Entries are sorted by row, then by column, without two at one place.
struct SparseTable {
  /// The largest precision of the numbers in a file: significant digits, and digits after the
  /// point. For binary doubles and floats, the digits that distinguish any two numbers.
  struct Precision {
    int digits = 0, decimals = 0;
  };
  struct Entry {
    std::int64_t row = 0, column = 0;  // from 0
    double value = 0.0;
  };
  std::int64_t rows = 0, columns = 0;
  std::vector<Entry> entries;
  bool whole = false;          // written as integers
  bool probabilities = false;  // called probabilities in the file
  Precision precision{};
  std::vector<std::string> understood{};  // what the reader decided, a sentence each
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

/// The matrix with its states in another order, (n x n + 1). Row k becomes the row of states[k];
/// the columns are reordered in the same way, except the last.
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

/// The matrix in Matrix Market's coordinate format, which counts from 1; `comment` stands on its
/// own line.
[[nodiscard]] std::string matrix_market_of(const SparseTable& table, std::string comment);
/// A CSV table from,to,VALUE with the names of rows and columns.
[[nodiscard]] std::string csv_of(const SparseTable& table, const std::vector<std::string>& rows,
                                 const std::vector<std::string>& columns, const std::string& value);
/// The matrix as compressed rows, as scipy.sparse.load_npz reads it.
[[nodiscard]] std::string npz_of(const SparseTable& table);

/// Reads a Matrix Market file: "coordinate" or "array"; "real", "integer" or "unsigned-integer";
/// "general" or "symmetric". Entries at the same place are added, as in scipy. Throws
/// std::runtime_error naming file, line and what is allowed.
[[nodiscard]] SparseTable read_matrix_market(const std::string& path);
/// Reads a CSV table with the columns from, to and count or probability, in any order. States are
/// given by name or by number from 0. `columns` are the names of all columns of the matrix; its
/// first `rows` names are those of the rows. Throws as read_matrix_market().
[[nodiscard]] SparseTable read_csv(const std::string& path, std::int64_t rows,
                                   const std::vector<std::string>& columns);
/// Reads a sparse matrix from the arrays of an .npz file: compressed rows or columns, or
/// coordinates, as scipy.sparse.save_npz writes them. Entries at the same place are added. Throws
/// as read_matrix_market().
[[nodiscard]] SparseTable table_of(const std::string& path, const std::vector<NumpyArray>& arrays);

/// Sequences of states, numbered from 0; -1 is a gap, where the state is unknown. In a text file
/// each line is a sequence of numbers between blanks or commas; in an .npz file each array is one.
using Trajectories = std::vector<std::vector<std::int64_t>>;
[[nodiscard]] std::string text_of(const Trajectories& all);
[[nodiscard]] std::string npz_of(const Trajectories& all);
[[nodiscard]] Trajectories read_trajectories(const std::string& path);
/// The sequences in the arrays of an .npz file, and whether the arrays hold sequences rather than a
/// sparse matrix.
[[nodiscard]] Trajectories trajectories_of(const std::string& path, std::vector<NumpyArray> arrays);
[[nodiscard]] bool hold_trajectories(const std::vector<NumpyArray>& arrays);

}  // namespace gatewalk::cli
