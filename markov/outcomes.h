// SPDX-License-Identifier: MIT
#pragma once
/// How walks end, after each possible first draw and after visits to each cell.

#include <Eigen/Core>
#include <array>
#include <vector>

#include "markov/chain.h"

namespace gatewalk::markov {

/// A table of ends. Columns: the endings, by Ending, then the final cells (row * columns + column).
using EndTable = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct Outcomes {
  /// (outputs x kEndings + cells) Distribution of the ends of walks whose first draw, in the
  /// start's cell, gives this output.
  EndTable by_output;
  /// (cells x kEndings + cells) Of walks from the start: expected visits to the cell times the
  /// probability that the walk then ends so. The sum over the endings is the expected visits.
  EndTable by_cell;
  /// (cells x moves + 1) Expected number of visits to a cell that continue by each of `moves`; last
  /// column: that end trapped there.
  EndTable next;
  std::vector<std::array<int, 2>> moves;  // {di_x, di_y} of all exits, each once
};

/// Computes the outcomes by backward recursion for all endings and final cells: exact with a limit
/// of cells; without one (max_cells 0) until nothing changes by more than 1e-13. Takes about as
/// long as one prediction for each eight cells. Runs on all threads of the current TBB arena; the
/// bits are the same for any number of them. Throws as validate(), std::invalid_argument if more
/// than 4 GiB are needed, std::runtime_error if walks can circle (almost) for ever.
[[nodiscard]] Outcomes outcomes(const FieldChain& chain, const Field& field, const Start& start,
                                int max_cells);

}  // namespace gatewalk::markov
