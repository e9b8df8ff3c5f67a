// SPDX-License-Identifier: MIT
#pragma once
/// A Markov chain over the states in which a walker enters a cell of a lattice. The matrix has one
/// row per input state and one column per output. Each output has an `Exit`, which says where the
/// output leads, so this module does not know what states mean.

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace gatewalk::markov {

using Counts = Eigen::SparseMatrix<std::int64_t, Eigen::RowMajor>;   // (n_in x n_out)
using Probabilities = Eigen::SparseMatrix<double, Eigen::RowMajor>;  // (n_in x n_out)

/// Where one output leads: to an input state of the cell that is (di_x, di_y) away, or nowhere
/// (trapped).
struct Exit {
  static constexpr int kTrapped = -1;
  int next_input = kTrapped;
  int di_x = 0;
  int di_y = 0;
  friend bool operator==(const Exit&, const Exit&) = default;
};

/// Throws std::invalid_argument naming the output (counted from 0) unless there is one exit per
/// output, each next_input is in [0, inputs) or kTrapped, and trapped exits do not move.
void validate(const std::vector<Exit>& exits, std::int64_t inputs, std::int64_t outputs);

/// A sparse, row-stochastic matrix with its exits; a Chain never changes. A row without samples is
/// marked "unsampled": a walk that enters it ends as Ending::unsampled and is never absorbed by
/// accident.
class Chain {
 public:
  /// Makes a chain from counts: each row is divided by its sum, and an all-zero row becomes
  /// "unsampled". `start_rows` are appended behind the other rows; exits need not lead to them.
  /// Throws std::invalid_argument naming the row (counted from 0, as in all messages) for a
  /// negative count or an overflowing sum, and for exits that do not fit.
  static Chain from_counts(const Counts& counts, std::vector<Exit> exits,
                           const Counts& start_rows = {});

  /// Makes a chain from probabilities. Rows must be finite, non-negative and sum to 1 within 1e-12;
  /// nothing is normalised. An empty row is "unsampled". Throws std::invalid_argument naming the
  /// row and its sum.
  static Chain from_probabilities(Probabilities matrix, std::vector<Exit> exits);

  [[nodiscard]] int inputs() const { return static_cast<int>(p_.rows()); }
  [[nodiscard]] int outputs() const { return static_cast<int>(p_.cols()); }
  [[nodiscard]] const Probabilities& matrix() const { return p_; }
  [[nodiscard]] const std::vector<Exit>& exits() const { return exits_; }
  [[nodiscard]] bool is_sampled(int row) const {
    return p_.outerIndexPtr()[row + 1] > p_.outerIndexPtr()[row];
  }
  [[nodiscard]] int unsampled_rows() const;

 private:
  Chain(Probabilities p, std::vector<Exit> exits);
  Probabilities p_;  // compressed, no stored zeros
  std::vector<Exit> exits_;
};

/// The chains of a field: one chain per type of cell, and the type of each cell.
class FieldChain {
 public:
  /// One chain in all cells, for fields of any size.
  FieldChain(Chain everywhere);  // NOLINT(google-explicit-constructor): a Chain is the uniform case
  /// Cells of row r draw from chains[type_of_row[r]]; for fields with that many rows. Throws
  /// std::invalid_argument unless there is a chain, all chains have the same number of inputs, and
  /// each row has one of the chains.
  [[nodiscard]] static FieldChain by_row(std::vector<Chain> chains, std::vector<int> type_of_row);
  /// Cell (column, row) draws from chains[type_of_cell[row * columns + column]]; for fields of that
  /// size. Throws std::invalid_argument as by_row does, and unless the cells fill whole rows.
  [[nodiscard]] static FieldChain by_cell(std::vector<Chain> chains, int columns,
                                          std::vector<int> type_of_cell);

  /// The same layout of cell types with other chains. Throws std::invalid_argument unless there are
  /// as many chains as before, with as many inputs.
  [[nodiscard]] FieldChain with(std::vector<Chain> chains) const;

  [[nodiscard]] const std::vector<Chain>& chains() const { return chains_; }  // by type
  [[nodiscard]] int inputs() const { return chains_.front().inputs(); }
  [[nodiscard]] int type_of(std::int64_t column, std::int64_t row) const {
    return types_[static_cast<std::size_t>(row * row_stride_ + column * column_stride_)];
  }
  [[nodiscard]] const Chain& at(std::int64_t column, std::int64_t row) const {
    return chains_[static_cast<std::size_t>(type_of(column, row))];
  }
  /// Whether all cells of a row have the same type, in every row.
  [[nodiscard]] bool has_uniform_rows() const;
  /// The size of the fields that this chain is made for; 0: any size.
  [[nodiscard]] std::int64_t columns() const;
  [[nodiscard]] std::int64_t rows() const;

 private:
  FieldChain(std::vector<Chain> chains, std::vector<int> types, std::int64_t row_stride,
             std::int64_t column_stride);
  std::vector<Chain> chains_;
  std::vector<int> types_;  // (rows x columns), (rows) or (1): see the strides
  std::int64_t row_stride_ = 0, column_stride_ = 0;
};

/// A rectangular field of cells. A walk that moves outside has left the field.
struct Field {
  int columns = 9;
  int rows = 9;
};

/// How a walk ends: in a trapped output; by a move over an edge of the field (`far_edge`: beyond
/// the last row, `near_edge`: before the first row, also over a corner); cut off at the limit of
/// cells; or in an unsampled state.
enum class Ending : std::uint8_t {
  trapped,
  far_edge,
  left_edge,
  right_edge,
  near_edge,
  cut_off,
  unsampled
};
inline constexpr std::size_t kEndings = 7;
inline constexpr std::array<Ending, 4> kEdges{Ending::far_edge, Ending::left_edge,
                                              Ending::right_edge, Ending::near_edge};

/// The edge of the field over which a move left whose target (column, row) is outside.
[[nodiscard]] constexpr Ending edge_before(const Field& field, std::int64_t column,
                                           std::int64_t row) {
  if (row >= field.rows) return Ending::far_edge;
  if (row < 0) return Ending::near_edge;
  return column < 0 ? Ending::left_edge : Ending::right_edge;
}

/// Moves a walk that has drawn `exit` in cell (column, row). Returns the ending if the walk ends;
/// otherwise column and row become the next cell. If `last_draw`, a walk that would go on is cut
/// off.
[[nodiscard]] constexpr std::optional<Ending> follow(const Field& field, const Exit& exit,
                                                     bool last_draw, std::int64_t& column,
                                                     std::int64_t& row) {
  if (exit.next_input == Exit::kTrapped) return Ending::trapped;
  const std::int64_t to_column = column + exit.di_x, to_row = row + exit.di_y;
  if (to_column < 0 || to_column >= field.columns || to_row < 0 || to_row >= field.rows)
    return edge_before(field, to_column, to_row);
  if (last_draw) return Ending::cut_off;
  column = to_column;
  row = to_row;
  return {};
}

/// The start of a walk: cell (column, row), both from 0, and the input state there.
struct Start {
  int column = 0;
  int row = 0;
  int input = 0;
};

/// Throws std::invalid_argument if chain, field, start and max_cells (0: no limit) do not fit
/// together.
void validate(const Chain& chain, const Field& field, const Start& start, int max_cells);
/// Throws std::invalid_argument if chain, field, start and max_cells do not fit together, or if the
/// field does not have the size for which the cell types are given.
void validate(const FieldChain& chain, const Field& field, const Start& start, int max_cells);

}  // namespace gatewalk::markov
