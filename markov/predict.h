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
  /// direct: without limit, by sparse elimination of all reachable (cell, input) pairs. Nothing is
  ///   subtracted: digits hold however seldom a walk ends.
  /// klu: without limit, by one sparse LU solve over these pairs; faster, with fewer digits.
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

struct PredictionPlan;

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

}  // namespace gatewalk::markov
