// SPDX-License-Identifier: MIT
#pragma once
/// How walks end, told by everything at once: after each first draw, and after visits to each cell.

#include <Eigen/Core>
#include <array>
#include <vector>

#include "markov/chain.h"

namespace gatewalk::markov {

/// Columns: the endings, by Ending, then the final cells (row * columns + column).
using EndTable = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct Outcomes {
  /// (outputs x kEndings + cells) Of walks whose first draw, in the start's cell, gave this output.
  EndTable by_output;
  /// (cells x kEndings + cells) Of walks from the start: visits to this cell times how likely the
  /// walk then ends so; their sum over the endings is the expected visits.
  EndTable by_cell;
  /// (cells x exits' moves + 1) Of the visits to a cell, how many go on by each of `moves`; the
  /// last column: are trapped there.
  EndTable next;
  std::vector<std::array<int, 2>> moves;  // di_x, di_y, those of the exits, each once
};

/// By the backward recursion, for all endings and final cells; exact with a limit of cells, without
/// (max_cells 0) until nothing changes by more than 1e-13. Takes as long as a prediction for each
/// eight cells or so. On all threads of the current TBB arena; the same bits for any number of
/// them. Throws as validate(), std::invalid_argument for what would take more than 4 GiB, and
/// std::runtime_error where walks can circle (almost) for ever.
[[nodiscard]] Outcomes outcomes(const FieldChain& chain, const Field& field, const Start& start,
                                int max_cells);

}  // namespace gatewalk::markov
