// SPDX-License-Identifier: MIT
#pragma once
/// Single solvers: predictions for many start rows by the adjoint, and the linear solves that
/// Predictor chooses from.

#include <cstdint>
#include <optional>
#include <vector>

#include "markov/outcomes.h"
#include "markov/predict.h"

namespace gatewalk::markov {

/// Predictions for many start rows in one cell of a uniform field, by the adjoint. For each output
/// of the first draw, the distribution of ends is computed exactly once; a prediction is then a sum
/// over the start row. The preparation takes about as long as one prediction for each of 9 x 9
/// cells (its time grows with the square of the number of cells); a prediction takes next to
/// nothing.
class AdjointPredictor {
 public:
  /// Prepares the predictions on all threads of the current TBB arena; the bits are the same for
  /// any number of threads. Throws std::invalid_argument without a limit of cells, and for a cell
  /// outside the field.
  AdjointPredictor(const Chain& chain, const Field& field, int column, int row, int max_cells);

  /// Predicts from the counts of the first draw (outputs). Counts that are all zero mean an
  /// unsampled row. Throws std::invalid_argument for another number of outputs.
  [[nodiscard]] FinalDistribution predict(const std::vector<std::int64_t>& counts) const;

 private:
  struct End {
    std::int64_t cell;
    Ending why;
  };
  Field field_;
  Start start_;
  int max_cells_;
  int most_terms_ = 0;  // largest number of terms of a sum over moves
  std::vector<End> ends_;
  Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>
      answers_;  // (outputs x 1 + ends): mean draws, then the probability of each end
};

/// (outputs x kEndings) The probability of each ending of walks whose first draw, in this cell of a
/// uniform field, gives this output. Takes about as long as one prediction. Throws as
/// AdjointPredictor.
[[nodiscard]] EndTable ending_chances(const Chain& chain, const Field& field, int column, int row,
                                      int max_cells);

/// Predicts without a limit of cells by sparse elimination of one reachable (cell, input) pair
/// after the other, in the blocks and the order of SuiteSparse KLU. Nothing is subtracted
/// (Grassmann, Taksar and Heyman 1985), so digits hold however seldom a walk ends, and walks that
/// can never end are identified (`endless`). Returns nullopt if the elimination would take more
/// than `most_operations` products, or the field has more than about 10^7 pairs.
[[nodiscard]] std::optional<FinalDistribution> solve_directly(const FieldChain& chain,
                                                              const Field& field,
                                                              const Start& start,
                                                              double most_operations = 2e9);

/// Predicts without a limit of cells by one sparse LU solve of (I - Q)^T visits = start over the
/// reachable transient (cell, input) pairs (SuiteSparse KLU). Throws std::runtime_error if the
/// matrix is singular (a walk can circle for ever) or its estimated condition number leaves fewer
/// than 6 digits. The solve is up to four times faster than solve_directly and takes larger fields,
/// but loses digits the longer walks circle. Propagation is a hundred times faster where walks
/// leave the field soon.
[[nodiscard]] FinalDistribution solve_absorption(const FieldChain& chain, const Field& field,
                                                 const Start& start);

}  // namespace gatewalk::markov
