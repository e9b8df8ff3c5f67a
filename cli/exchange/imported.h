// SPDX-License-Identifier: MIT
#pragma once
/// Imports matrices from other programs as matrix files of cells, whose states are numbers.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cli/exchange/sparse_table.h"
#include "lattice/field/matrix_file.h"
#include "lattice/scene/cell_file.h"

namespace gatewalk::cli {

/// A state of a chain from another program: how a body enters the cell.
struct ForeignState {
  std::string name;            // name in tables; by default its number
  std::string face;            // states of one face make the same move
  int move_x = 0, move_y = 0;  // columns to the right, rows ahead
  int counts_per_run = 0;      // counts per run in its row of counts; 0: not given, 1
};

/// Reads a CSV table of states: state (0, 1, ... in order), move_x, move_y, and optionally name,
/// face and counts_per_run (2 if each run is counted together with its mirror image). Other columns
/// are ignored. Without a column of faces, states with the same move share a face. Notes on a file
/// that is not plain CSV are added to `understood`. Throws std::runtime_error naming file and line.
[[nodiscard]] std::vector<ForeignState> read_states(const std::string& path,
                                                    std::vector<std::string>* understood = nullptr);
/// Writes the table of states of a matrix file, with the limits of each coordinate, in the order of
/// lattice::shown_order. `counts_per_run`: by state; empty: no such column.
[[nodiscard]] std::string states_csv(const lattice::MatrixFile& file,
                                     const std::vector<std::int64_t>& counts_per_run);

/// A matrix from another program, (states x states + 1); the last column is "trapped".
struct ForeignMatrix {
  SparseTable table;  // counts of runs, or probabilities times a power of 2
  bool probabilities = false;
  bool trajectories = false;  // counted here from trajectories, each run once
};
/// Reads .mtx, .csv, .npz (a matrix, or trajectories) or .dtrajs. In a matrix without a column
/// "trapped", no body is trapped. Whole numbers are counts, also if they are written as reals and
/// any row sums to more than 1. Other numbers are probabilities: each row must sum to 0, or to 1
/// within 1e-9 or the rounding of its numbers (floats, or texts of at least three digits). Each
/// step of a trajectory is a count; its last state may be the number of states (trapped), and -1 is
/// a gap. Throws std::runtime_error naming the file and the place.
[[nodiscard]] ForeignMatrix read_foreign(const std::string& path,
                                         const std::vector<ForeignState>& states);

/// The text of a cell file with these states and this cell size (m), which --set can complete.
[[nodiscard]] std::string cell_text(const std::vector<ForeignState>& states, double width,
                                    double length);
/// The entry that stands for a state.
[[nodiscard]] dynamics::Entry entry_of(const std::vector<ForeignState>& states, std::size_t state,
                                       const dynamics::Section& section);
/// The number of each state in the state space, where states of one face stand together.
[[nodiscard]] std::vector<int> places_of(const std::vector<ForeignState>& states,
                                         const dynamics::StateSpace& space);
/// The matrix over the states of `cells`.
[[nodiscard]] dynamics::Transitions transitions_of(const ForeignMatrix& matrix,
                                                   const std::vector<ForeignState>& states,
                                                   const lattice::CellFile& cells);
/// A matrix file in which the states keep their names, numbers and counts per run.
[[nodiscard]] lattice::MatrixFile matrix_file(dynamics::Transitions t,
                                              const std::vector<ForeignState>& states,
                                              std::map<std::string, std::string> text);

}  // namespace gatewalk::cli
