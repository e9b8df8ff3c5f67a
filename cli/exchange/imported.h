// SPDX-License-Identifier: MIT
#pragma once
/// Matrices that were made elsewhere, as matrix files of cells: their states are numbers.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cli/exchange/sparse_table.h"
#include "lattice/field/matrix_file.h"
#include "lattice/scene/cell_file.h"

namespace gatewalk::cli {

/// A state of another program: how the cell that it belongs to is entered.
struct ForeignState {
  std::string name;            // in tables; its number unless given
  std::string face;            // states of one face make the same move
  int move_x = 0, move_y = 0;  // columns to the right, rows ahead
  int counts_per_run = 0;      // of a matrix of counts, in its row; 0: not said, 1
};

/// A table of states, CSV: state (0, 1, ... in order), move_x, move_y, and if wanted name, face and
/// counts_per_run (2 where a run is counted with its mirror image); other columns are left alone.
/// Without faces states with one move are of one. What was understood of a file that is not plain
/// CSV is added to `understood`. Throws std::runtime_error naming file and line.
[[nodiscard]] std::vector<ForeignState> read_states(const std::string& path,
                                                    std::vector<std::string>* understood = nullptr);
/// The other way round: of a matrix file, with the low and high of each coordinate, in the order of
/// lattice::shown_order.
/// `counts_per_run`: by state; none: the column is left out.
[[nodiscard]] std::string states_csv(const lattice::MatrixFile& file,
                                     const std::vector<std::int64_t>& counts_per_run);

/// (states x states + 1), the last column: trapped.
struct ForeignMatrix {
  SparseTable table;  // whole numbers: of runs, or probabilities times a power of 2
  bool probabilities = false;
  bool trajectories = false;  // counted here, each run once
};
/// Reads .mtx, .csv, .npz (a matrix, or trajectories) or .dtrajs. A matrix without a column of
/// "trapped" has nobody trapped. Whole numbers are counts, written as reals too unless no row has
/// more than a single 1; others are probabilities whose rows sum to 1, within 1e-9 or what the
/// rounding of three or more digits, or of floats, allows, or to 0. Of a trajectory each step is a
/// count; its last state may be the number of states: trapped, and -1 is a gap. Throws
/// std::runtime_error naming the file and the place.
[[nodiscard]] ForeignMatrix read_foreign(const std::string& path,
                                         const std::vector<ForeignState>& states);

/// The text of a cell file with these states, of cells of this size (m): to it --set adds.
[[nodiscard]] std::string cell_text(const std::vector<ForeignState>& states, double width,
                                    double length);
/// The place of a state among entries.
[[nodiscard]] dynamics::Entry entry_of(const std::vector<ForeignState>& states, std::size_t state,
                                       const dynamics::Section& section);
/// By state: its number in the state space, in which those of one face stand together.
[[nodiscard]] std::vector<int> places_of(const std::vector<ForeignState>& states,
                                         const dynamics::StateSpace& space);
/// The matrix by states of `cells`.
[[nodiscard]] dynamics::Transitions transitions_of(const ForeignMatrix& matrix,
                                                   const std::vector<ForeignState>& states,
                                                   const lattice::CellFile& cells);
/// A file of it, in which states keep their names and numbers, and their counts per run.
[[nodiscard]] lattice::MatrixFile matrix_file(dynamics::Transitions t,
                                              const std::vector<ForeignState>& states,
                                              std::map<std::string, std::string> text);

}  // namespace gatewalk::cli
