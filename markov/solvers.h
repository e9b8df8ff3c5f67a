// SPDX-License-Identifier: MIT
#pragma once
/// Predictions by one way alone: for many start rows by the adjoint, and the solves that Predictor
/// chooses from.

#include <cstdint>
#include <optional>
#include <vector>

#include "markov/predict.h"

namespace gatewalk::markov {

/// Predictions for many start rows in one cell of a uniform field, by the adjoint: how walks end is
/// found once for each output that may be drawn first, exactly, and a prediction is a sum over the
/// start row. The preparation takes about as long as a prediction for each of 9 x 9 cells (its
/// time grows with the square of their number), a prediction next to nothing.
class AdjointPredictor {
 public:
  /// On all threads of the current TBB arena; the same bits for any number of them. Throws
  /// std::invalid_argument without a limit of cells, and for a cell that is not in the field.
  AdjointPredictor(const Chain& chain, const Field& field, int column, int row, int max_cells);

  /// From a start whose first draw gave each output so often (outputs); all zero: a row never
  /// sampled. Throws std::invalid_argument for another number of outputs.
  [[nodiscard]] FinalDistribution predict(const std::vector<std::int64_t>& counts) const;

 private:
  struct End {
    std::int64_t cell;
    Ending why;
  };
  Field field_;
  Start start_;
  int max_cells_;
  int most_terms_ = 0;  // of a sum over moves
  std::vector<End> ends_;
  Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>
      answers_;  // (outputs x 1 + ends): draws, then the chance of each end
};

/// Without limit, by sparse elimination of one reachable (cell, input) pair after the other, in the
/// blocks and the order that SuiteSparse KLU finds. Nothing is subtracted
/// (Grassmann, Taksar and Heyman 1985), so digits hold however seldom a walk ends, and walks that
/// can never end are told apart (`endless`). None where it would take more than `most_operations`
/// products, or more than some 10^7 pairs are in the field.
[[nodiscard]] std::optional<FinalDistribution> solve_directly(const FieldChain& chain,
                                                              const Field& field,
                                                              const Start& start,
                                                              double most_operations = 2e9);

/// Without limit, by one sparse LU solve of (I - Q)^T visits = start over the reachable transient
/// (cell, input) pairs (SuiteSparse KLU). Throws std::runtime_error when the matrix is singular (a
/// walk can circle for ever) or its estimated condition leaves fewer than 6 digits.
/// Up to four times faster than solve_directly, with fewer digits the longer walks circle, and for
/// fields too large for it. Sums are a hundred times faster where walks leave the field soon.
[[nodiscard]] FinalDistribution solve_absorption(const FieldChain& chain, const Field& field,
                                                 const Start& start);

}  // namespace gatewalk::markov
