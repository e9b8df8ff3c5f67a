// SPDX-License-Identifier: MIT
#pragma once
/// The exact distribution of the final cell: what infinitely many walks would give.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "markov/ends.h"

namespace gatewalk::markov {

/// Shares of all walks. final_cells.sum() + remainder == 1 and the sum of all endings + remainder
/// == 1, both within 1e-12 as long as mean_steps times what a row's sum lacks from 1 (counts: some
/// 1e-16) stays below that: nothing is normalised.
struct FinalDistribution : Ends<double> {
  /// Still walking when the sum was stopped; of a solve, what its solution leaves unaccounted for;
  /// and `endless`. As that would end at most once, it bounds the errors of all cells together, and
  /// of each number above.
  double remainder = 0.0;
  /// The part of it that can never end: walks in states from which no way leads to an end. Only
  /// Solver::direct tells it.
  double endless = 0.0;
  /// What rounding adds to these errors at most, to first order in 1e-16 (that of counts into
  /// probabilities included).
  double rounding = 0.0;
  double mean_steps = 0.0;  // draws per walk, as WalkTally::steps / walks; without the remainder's
  int steps = 0;            // propagation steps done (0 for a solve)
  double operations = 0.0;  // products that Solver::direct took; 0 for any other
};

/// How a prediction is made: the limit of cells, the route to the answer, and when it stops. All
/// defaults stand here.
struct PredictOptions {
  /// Cells a walk may visit before it is cut off; 0: no limit.
  int max_cells = 0;

  /// automatic: `rows` if there is no limit of cells and no exit leads to a row below; else
  ///   `steps`. Without limit `direct` instead where these would take more than 10^4 sums, or keep
  ///   fewer than 6 digits; `klu` where the field is too large for `direct`, if it keeps 6.
  /// steps: forward propagation of all planes of the field, step by step. Memory per start: 4 n_in
  ///   numbers per cell that can be reached, half of that when every move leads to the other colour
  ///   of a chessboard. With a limit it stops once next to nobody walks (1e-30 of all walks in any
  ///   state of a cell).
  /// rows: without limit, row by row: what enters a row walks in it until it has left it, then the
  ///   next row is entered. Memory: a few rows x n_in numbers, whatever the number of rows, and for
  ///   elimination up to 512 MiB.
  /// direct: solve_directly().
  /// klu: solve_absorption().
  enum class Solver { automatic, steps, rows, direct, klu };
  Solver solver = Solver::automatic;

  /// How `rows` finds the visits of a row. `elimination` of its columns takes as long whatever the
  /// number of moves; it needs cells of one type, and no move within the row to any but the next
  /// column. `sweeps` to both sides bring on what each state gives to the next ones; they need
  /// cells of one type, and walks that soon leave the row. `sums` over more and more moves take any
  /// row, and stand in where the method asked for does not suit. `cheapest`: what takes least time
  /// by estimate.
  enum class RowMethod { cheapest, elimination, sweeps, sums };
  RowMethod row_method = RowMethod::cheapest;

  /// Without limit: the share of all walks that may be left walking (`remainder`; elimination may
  /// leave more where rounding lets it not do better). None: 1e-12 for `rows`, else 1e-13.
  std::optional<double> tolerance = std::nullopt;
  /// Without limit: steps after which `steps` stops (the caller reads `remainder`), and moves
  /// within one row after which `rows` by sums gives up.
  int max_steps = 1'000'000;

  [[nodiscard]] double tolerance_of(Solver used) const {
    return tolerance.value_or(used == Solver::rows ? 1e-12 : 1e-13);
  }
};

struct PredictionPlan;  // predict/plan.h

/// A field's chain, prepared for any starts and any field it fits. May be used from several threads
/// at a time.
class Predictor {
 public:
  /// Throws std::invalid_argument for moves of more than 10^4 cells.
  explicit Predictor(FieldChain chain);
  ~Predictor();
  Predictor(const Predictor&) = delete;
  Predictor& operator=(const Predictor&) = delete;

  /// Throws std::invalid_argument when chain, field, start and options cannot belong together
  /// (`rows`, `direct` and `klu` with a limit of cells, `rows` unless can_go_by_rows());
  /// std::runtime_error when walks can circle (almost) for ever: `rows` takes more than max_steps
  /// sums in a row, or it or `klu` is left with fewer than 6 digits, and `automatic` cannot take
  /// `direct` instead.
  [[nodiscard]] FinalDistribution predict(const Field& field, const Start& start,
                                          const PredictOptions& options = {}) const;
  /// From several starts side by side, on all threads of the current TBB arena: the same bits as
  /// one by one, in less time.
  [[nodiscard]] std::vector<FinalDistribution> predict_all(
      const Field& field, const std::vector<Start>& starts,
      const PredictOptions& options = {}) const;

  /// Whether Solver::rows can be used: no exit leads to a row below.
  [[nodiscard]] bool can_go_by_rows() const;

 private:
  std::unique_ptr<const PredictionPlan> plan_;
};

/// One prediction per start: Predictor(chain).predict_all(field, starts, options).
[[nodiscard]] std::vector<FinalDistribution> predict(const FieldChain& chain, const Field& field,
                                                     const std::vector<Start>& starts,
                                                     const PredictOptions& options = {});

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
