// SPDX-License-Identifier: MIT
#pragma once
/// The exact distribution of final cells and endings: the result of infinitely many walks.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "markov/ends.h"

namespace gatewalk::markov {

/// The predicted shares of all walks. final_cells.sum() + remainder and the sum of all endings +
/// remainder are both 1 within 1e-12, as long as mean_steps times the error of a row's sum (some
/// 1e-16 for counts) is smaller than 1e-12. Nothing is normalised.
struct FinalDistribution : Ends<double> {
  /// The share of walks that are not accounted for: walks still going on when the sum was stopped,
  /// or what a linear solve leaves over; `endless` included. Each of these walks would end at most
  /// once, so `remainder` bounds the error of each number above and of all cells together.
  double remainder = 0.0;
  /// The part of `remainder` that can never end: walks in states from which no way leads to an end.
  /// Only Solver::direct computes this number.
  double endless = 0.0;
  /// Bound on the error by rounding, to first order in 1e-16, including the rounding of counts into
  /// probabilities.
  double rounding = 0.0;
  double mean_steps = 0.0;  // draws per walk, as WalkTally::steps / walks; excludes the remainder
  int steps = 0;            // propagation steps; 0 for a linear solve
  double operations = 0.0;  // multiplications of Solver::direct; else 0
};

/// Options of a prediction: the limit of cells, the solver, and when the solver stops.
struct PredictOptions {
  /// Largest number of cells that a walk may visit before it is cut off; 0: no limit.
  int max_cells = 0;

  /// The solver.
  /// - automatic: `steps` with a limit of cells or if an exit leads to a row below, else `rows`.
  ///   Without a limit, `direct` replaces a solver that would need more than 10^4 sums or keep
  ///   fewer than 6 digits; `klu` replaces `direct` in fields too large for `direct`, if `klu`
  ///   keeps 6 digits.
  /// - steps: forward propagation of the whole field, step by step. Memory per start: 4 n_in
  ///   numbers for each reachable cell; half of that if every move changes the colour of a
  ///   chessboard. With a limit, `steps` stops early once at most 1e-30 of all walks are left in
  ///   any state of a cell.
  /// - rows: without a limit, row by row. Walks that enter a row are followed until they leave it,
  ///   then the next row is entered. Memory: a few rows x n_in numbers for any number of rows, plus
  ///   up to 512 MiB for elimination.
  /// - direct: without a limit, sparse elimination of all reachable (cell, input) pairs. Nothing is
  ///   subtracted, so digits hold however seldom a walk ends.
  /// - klu: without a limit, one sparse LU solve over the same pairs; faster than `direct`, with
  ///   fewer digits.
  enum class Solver { automatic, steps, rows, direct, klu };
  Solver solver = Solver::automatic;

  /// How `rows` computes the expected visits within a row.
  /// - elimination: eliminates the row's columns. Its time does not grow with the number of moves.
  ///   It needs cells of one type, and moves within the row only to the next column.
  /// - sweeps: sweeps to both sides that pass each state's visits on to the next states. They need
  ///   cells of one type, and walks that soon leave the row.
  /// - sums: sums over more and more moves. They suit any row, and replace a method that does not
  ///   suit.
  /// - cheapest: the method with the least estimated time.
  enum class RowMethod { cheapest, elimination, sweeps, sums };
  RowMethod row_method = RowMethod::cheapest;

  /// Without a limit: the share of all walks that may be left unfinished (`remainder`); elimination
  /// may leave more where rounding prevents better. Default: 1e-12 for `rows`, else 1e-13.
  std::optional<double> tolerance = std::nullopt;
  /// Without a limit: the number of steps after which `steps` stops (check `remainder`), and the
  /// number of moves within one row after which sums of `rows` give up.
  int max_steps = 1'000'000;

  [[nodiscard]] double tolerance_of(Solver used) const {
    return tolerance.value_or(used == Solver::rows ? 1e-12 : 1e-13);
  }
};

struct PredictionPlan;

/// A field's chain, prepared for predictions from any start in any field that fits the chain.
/// Several threads may use one Predictor at a time.
class Predictor {
 public:
  /// Prepares the chain. Throws std::invalid_argument for moves of more than 10^4 cells.
  explicit Predictor(FieldChain chain);
  ~Predictor();
  Predictor(const Predictor&) = delete;
  Predictor& operator=(const Predictor&) = delete;

  /// Predicts where and how walks from one start end. Throws std::invalid_argument if chain, field,
  /// start and options do not fit together (`rows`, `direct` and `klu` with a limit of cells;
  /// `rows` unless can_go_by_rows()). Throws std::runtime_error if walks can circle (almost) for
  /// ever: `rows` needs more than max_steps sums in a row, or `rows` or `klu` keeps fewer than 6
  /// digits, and `automatic` cannot use `direct` instead; also for a field that is too large for
  /// `direct`.
  [[nodiscard]] FinalDistribution predict(const Field& field, const Start& start,
                                          const PredictOptions& options = {}) const;
  /// Predicts from several starts at once, on all threads of the current TBB arena. The bits are
  /// those of separate predictions, in less time.
  [[nodiscard]] std::vector<FinalDistribution> predict_all(
      const Field& field, const std::vector<Start>& starts,
      const PredictOptions& options = {}) const;

  /// Whether Solver::rows can be used: true if no exit leads to a row below.
  [[nodiscard]] bool can_go_by_rows() const;

 private:
  std::unique_ptr<const PredictionPlan> plan_;
};

/// Makes one prediction per start: Predictor(chain).predict_all(field, starts, options).
[[nodiscard]] std::vector<FinalDistribution> predict(const FieldChain& chain, const Field& field,
                                                     const std::vector<Start>& starts,
                                                     const PredictOptions& options = {});

}  // namespace gatewalk::markov
