#pragma once
/// The exact distribution of the final cell: what infinitely many walks would give.

#include <array>
#include <vector>

#include "markov/chain.h"

namespace gatewalk::markov {

using CellProbabilities = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Rows of the field that differ: who is in row r draws from chains[chain_of_row[r]].
struct RowChains {
  std::vector<Chain> chains;      // distinct ones
  std::vector<int> chain_of_row;  // (rows)

  /// Throws std::invalid_argument unless there is a chain, all have the same number of inputs, and
  /// each row is given one of them.
  RowChains(std::vector<Chain> distinct, std::vector<int> of_row);

  [[nodiscard]] const Chain& at(std::int64_t row) const {
    return chains[static_cast<std::size_t>(chain_of_row[static_cast<std::size_t>(row)])];
  }
};

/// As validate() of chain.h; there must be as many rows as the field has.
void validate(const RowChains& rows, const Field& field, const Start& start, int max_cells);

/// What ended in one cell.
struct CellEndings {
  std::int64_t cell = 0;                     // row * columns + column
  std::array<double, kEndings> by_ending{};  // by Ending
};

/// final_cells.sum() + remainder == 1 and trapped + left_field + cut_off + unsampled + remainder
/// == 1, both within 1e-12 as long as mean_steps times what a row's sum lacks from 1 (counts: some
/// 1e-16) stays below that: nothing is normalised.
struct FinalDistribution {
  CellProbabilities final_cells;  // (rows x columns)
  double trapped = 0.0;
  double left_field = 0.0;
  double cut_off = 0.0;    // visited max_cells cells and would have gone on
  double unsampled = 0.0;  // entered a state whose row was never sampled
  /// The same by Ending; its four edges together are left_field.
  std::array<double, kEndings> endings{};
  /// Cells in which walks ended otherwise than trapped, in ascending order. In all others, all of
  /// final_cells was trapped.
  std::vector<CellEndings> mixed_cells;
  /// Still walking when the sum was stopped; of a solve, what its solution leaves unaccounted for.
  /// As that would end at most once, it bounds the errors of all cells together, and of each number
  /// above.
  double remainder = 0.0;
  /// What rounding adds to these errors at most, to first order in 1e-16 (that of counts into
  /// probabilities included).
  double rounding = 0.0;
  double mean_steps = 0.0;  // draws per walk, as WalkTally::steps / walks; without the remainder's
  int steps = 0;            // propagation steps done (0 for a solve)
};

/// Shares of all walks that were trapped in each cell; that left the field from it (rows x
/// columns).
[[nodiscard]] CellProbabilities trapped_cells(const FinalDistribution& d);
[[nodiscard]] CellProbabilities departed_cells(const FinalDistribution& d);

/// Forward propagation, Eq. (16) applied once per cell. With a limit: exact after `max_cells`
/// steps, fewer if nobody walks any more. Without (0): steps until at most `tolerance` still walks
/// (`remainder`), or `max_steps_without_limit` are done; the caller reads `remainder`. Memory:
/// 2 cells x n_in numbers.
[[nodiscard]] FinalDistribution propagate(const Chain& chain, const Field& field,
                                          const Start& start, int max_cells,
                                          double tolerance = 1e-13,
                                          int max_steps_without_limit = 1'000'000);
[[nodiscard]] FinalDistribution propagate(const RowChains& rows, const Field& field,
                                          const Start& start, int max_cells,
                                          double tolerance = 1e-13,
                                          int max_steps_without_limit = 1'000'000);

/// Without limit, by one sparse LU solve of (I - Q)^T visits = start over the reachable transient
/// (cell, input) pairs (SuiteSparse KLU). Throws std::runtime_error when the matrix is singular (a
/// walk can circle for ever) or its estimated condition leaves fewer than 6 digits.
/// A second route to check the first by, not a faster one: 9 x 9 cells of 87 states take some 0.3
/// s. The fast routes are Sweeper's (sweep.h).
[[nodiscard]] FinalDistribution solve_absorption(const Chain& chain, const Field& field,
                                                 const Start& start);
[[nodiscard]] FinalDistribution solve_absorption(const RowChains& rows, const Field& field,
                                                 const Start& start);

}  // namespace gatewalk::markov
