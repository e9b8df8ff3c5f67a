// SPDX-License-Identifier: MIT
#pragma once
/// A Markov chain over the states in which a walker enters a cell of a lattice.
/// One row per input state, one column per output. Where an output leads is data (`Exit`), so the
/// module knows nothing about what the states mean.

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

/// Where one output leads: the input state of the neighbouring cell (di_x, di_y) away, or nowhere.
struct Exit {
  static constexpr int kTrapped = -1;
  int next_input = kTrapped;
  int di_x = 0;
  int di_y = 0;
  friend bool operator==(const Exit&, const Exit&) = default;
};

/// Throws std::invalid_argument naming the output (counted from 0) unless there is one exit per
/// output, next_input is in [0, inputs) or kTrapped, and a trapped exit does not move.
void validate(const std::vector<Exit>& exits, std::int64_t inputs, std::int64_t outputs);

/// Immutable, row-stochastic, sparse. A row without samples is kept apart ("unsampled"): whoever
/// walks into it is reported as such, it never absorbs by accident.
class Chain {
 public:
  /// Rows become counts / row sum; an all-zero row becomes "unsampled".
  /// `start_rows` stand behind the others: no exit needs to lead to them.
  /// Throws std::invalid_argument naming the row (counted from 0, as all messages here) on a
  /// negative count or an overflowing sum, and on exits that do not fit.
  static Chain from_counts(const Counts& counts, std::vector<Exit> exits,
                           const Counts& start_rows = {});

  /// Rows must be finite, non-negative and sum to 1 within 1e-12 (nothing is normalised silently);
  /// an empty row is "unsampled". Throws std::invalid_argument naming row and sum.
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

/// What the cells of a field draw from: a chain per type of cell, and the type of each cell.
class FieldChain {
 public:
  /// Uniform: one chain in all cells, of a field of any size.
  FieldChain(Chain everywhere);  // NOLINT(google-explicit-constructor): a Chain is the uniform case
  /// Cells of row r draw from chains[type_of_row[r]]; for fields of that many rows. Throws
  /// std::invalid_argument unless there is a chain, all chains have the same number of inputs, and
  /// each row is given one of them.
  [[nodiscard]] static FieldChain by_row(std::vector<Chain> chains, std::vector<int> type_of_row);
  /// Cell (column, row) draws from chains[type_of_cell[row * columns + column]]; for fields of that
  /// size. Throws as by_row, and unless the cells fill whole rows.
  [[nodiscard]] static FieldChain by_cell(std::vector<Chain> chains, int columns,
                                          std::vector<int> type_of_cell);

  /// The same types of cells with other chains, as many and with as many inputs. Throws
  /// std::invalid_argument otherwise.
  [[nodiscard]] FieldChain with(std::vector<Chain> chains) const;

  [[nodiscard]] const std::vector<Chain>& chains() const { return chains_; }  // one per type
  [[nodiscard]] int inputs() const { return chains_.front().inputs(); }
  [[nodiscard]] int type_of(std::int64_t column, std::int64_t row) const {
    return types_[static_cast<std::size_t>(row * row_stride_ + column * column_stride_)];
  }
  [[nodiscard]] const Chain& at(std::int64_t column, std::int64_t row) const {
    return chains_[static_cast<std::size_t>(type_of(column, row))];
  }
  /// Whether all cells of a row have the same type, in every row.
  [[nodiscard]] bool has_uniform_rows() const;
  /// The size of the fields it is made for; 0: any.
  [[nodiscard]] std::int64_t columns() const;
  [[nodiscard]] std::int64_t rows() const;

 private:
  FieldChain(std::vector<Chain> chains, std::vector<int> types, std::int64_t row_stride,
             std::int64_t column_stride);
  std::vector<Chain> chains_;
  std::vector<int> types_;  // (rows x columns), (rows) or (1): see the strides
  std::int64_t row_stride_ = 0, column_stride_ = 0;
};

/// A rectangle of cells; a move that ends outside has left the field.
struct Field {
  int columns = 9;
  int rows = 9;
};

/// How a walk ends: in a trapped output, by a move over an edge of the field (`far_edge`: beyond
/// the last row, `near_edge`: before the first; a move over a corner counts there), cut off by the
/// limit of cells, or in a state whose row was never sampled.
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

/// Over which edge of the field a move left that would have led to (column, row) outside it.
[[nodiscard]] constexpr Ending edge_before(const Field& field, std::int64_t column,
                                           std::int64_t row) {
  if (row >= field.rows) return Ending::far_edge;
  if (row < 0) return Ending::near_edge;
  return column < 0 ? Ending::left_edge : Ending::right_edge;
}

/// What becomes of a walk that has drawn `exit` in cell (column, row): its ending, or none, and the
/// cell becomes the next one. With its last draw it is cut off where it would go on.
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

/// Where a walk begins: cell (column, row), both from 0, and the input state there.
struct Start {
  int column = 0;
  int row = 0;
  int input = 0;
};

/// Throws std::invalid_argument if field, start or max_cells (0: no limit) cannot belong together.
void validate(const Chain& chain, const Field& field, const Start& start, int max_cells);
/// Also if the field is not of the size the types are given for.
void validate(const FieldChain& chain, const Field& field, const Start& start, int max_cells);

}  // namespace gatewalk::markov
