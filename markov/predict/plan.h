// SPDX-License-Identifier: MIT
#pragma once
/// What the solvers by steps (by_steps.cpp) and by rows (by_rows.cpp) share: prepared chains, and
/// what has ended of the walks from one start.

#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "markov/predict.h"
#include "markov/predict/end_sums.h"
#include "markov/predict/layout.h"
#include "markov/predict/row_elimination.h"

namespace gatewalk::markov {

/// A mass that is nothing: products with it must not become denormal numbers, which are slow.
inline constexpr double kNothing = 1e-280;

/// Planes of a tally: all mass; then what ends in a cell: trapped, in a state never sampled, gone
/// by the first move, by the second, ...
enum Tally : int { kTallyTotal, kTallyTrapped, kTallyUnsampled, kTallyMoved };

/// staying_per_move() of a chain, found when it is first asked for. Thread-safe.
class LazyStay {
 public:
  /// `sideways`: the moves within a row, of so many inputs.
  [[nodiscard]] double get(const Stencil& sideways, int inputs) const {
    std::call_once(made_, [&] { per_move_ = per_move(sideways, inputs); });
    return per_move_;
  }

 private:
  [[nodiscard]] static double per_move(const Stencil& sideways, int inputs);
  mutable std::once_flag made_;
  mutable double per_move_ = 1.0;
};

/// A chain as stencils.
struct PreparedChain {
  std::vector<int> walking_inputs, unsampled;  // of the inputs that are entered
  Stencil moves;                               // all of them
  Stencil first_sideways;                      // within a row: of inputs entered from below
  Stencil sideways;                            // within a row: of inputs entered sideways
  std::vector<Stencil> upwards;                // by 1 row, 2 rows, ...
  Stencil ends;                                // to the planes of a Tally but the first
  Stencil walking;                             // to kTallyTotal: all that walks on
  std::unique_ptr<const LazyRowElimination> elimination;          // none where it cannot be used
  std::unique_ptr<LazyStay> stay = std::make_unique<LazyStay>();  // of `sideways`
};

struct PredictionPlan {
  FieldChain field_chain;
  bool has_uniform_rows = true;       // all cells of a row have one type
  int inputs = 0, outputs = 0;        // outputs: of the chain with most
  int most_terms = 0;                 // of a sum over moves
  std::vector<Move> moves;            // that some exit makes
  int widest = 0;                     // largest |di_x|
  int lowest = 0, highest = 0;        // di_y
  bool is_chequered = true;           // every move leads to the other colour of a chessboard
  std::vector<int> from_below;        // inputs entered from a row below
  std::vector<int> sideways;          // inputs entered within a row
  Stencil arriving, staying;          // to kTallyTotal: all mass in from_below, sideways
  std::vector<PreparedChain> chains;  // by type of cell

  explicit PredictionPlan(FieldChain chain) : field_chain(std::move(chain)) {}
  [[nodiscard]] const PreparedChain& at(std::int64_t column, std::int64_t row) const {
    return chains[static_cast<std::size_t>(field_chain.type_of(column, row))];
  }
};

/// Foresees how many steps a sum takes, from what is left after 512, 1024, 2048, ... of them.
class Pace {
 public:
  /// Whether more than `most`, until no more than `enough` is left. (Of a sum of which nothing has
  /// ended yet nothing is foreseen.)
  [[nodiscard]] bool is_too_slow(int steps, double left, double enough, int most) {
    constexpr int kFirst = 512;
    if (steps >= most) return true;
    if (steps < kFirst || (steps & (steps - 1)) != 0) return false;
    const double before = std::exchange(before_, left);
    if (steps == kFirst || !(left < before)) return false;
    return steps + 0.5 * steps * std::log(left / enough) / std::log(before / left) > most;
  }

 private:
  double before_ = 0.0;
};

/// What has ended of the walks from a start, and what is left.
struct StartTally {
  Start start;
  EndSums ends;
  Pace pace;
  CompensatedSum draws, remainder;
  int steps = 0;
  bool over = false;
  bool stopped = false;  // before it was done

  StartTally(const Field& field, const Start& from) : start(from), ends(field) {}

  /// The first draw; `enter(column, row, input, p)` for what walks on.
  template <class Enter>
  void draw_first(const Chain& chain, const Field& field, bool is_last, Enter enter) {
    const std::int64_t cell = std::int64_t{start.row} * field.columns + start.column;
    over = is_last;
    if (!chain.is_sampled(start.input)) {
      ends.add(Ending::unsampled, cell, 1.0);
      over = true;
      return;
    }
    draws += 1.0;
    for (Probabilities::InnerIterator it(chain.matrix(), start.input); it; ++it) {
      const Exit& exit = chain.exits()[static_cast<std::size_t>(it.col())];
      if (exit.next_input == Exit::kTrapped) {
        ends.add(Ending::trapped, cell, it.value());
      } else if (neighbour_cell(field, start.column, start.row, exit.di_x, exit.di_y) < 0) {
        ends.depart(cell, std::int64_t{start.column} + exit.di_x,
                    std::int64_t{start.row} + exit.di_y, it.value());
      } else if (is_last) {
        ends.add(Ending::cut_off, cell, it.value());
      } else {
        enter(std::int64_t{start.column} + exit.di_x, std::int64_t{start.row} + exit.di_y,
              exit.next_input, it.value());
      }
    }
  }

  /// What visitors of a cell draw: one number per plane of ends at `tally`. `is_last`: whoever
  /// would go on is cut off.
  void count(const Field& field, const std::vector<Move>& moves, std::int64_t column,
             std::int64_t row, bool is_last, const double* tally, std::ptrdiff_t stride) {
    const std::int64_t cell = row * field.columns + column;
    const double trapped = tally[kTallyTrapped * stride],
                 unsampled = tally[kTallyUnsampled * stride];
    if (trapped != 0.0) ends.add(Ending::trapped, cell, trapped);
    if (unsampled != 0.0) ends.add(Ending::unsampled, cell, unsampled);
    double drawn = trapped;
    for (std::size_t m = 0; m < moves.size(); ++m) {
      const double moved = tally[(kTallyMoved + static_cast<std::ptrdiff_t>(m)) * stride];
      if (moved == 0.0) continue;
      drawn += moved;
      if (neighbour_cell(field, column, row, moves[m].di_x, moves[m].di_y) < 0) {
        ends.depart(cell, column + moves[m].di_x, row + moves[m].di_y, moved);
      } else if (is_last) {
        ends.add(Ending::cut_off, cell, moved);
      }
    }
    draws += drawn;
  }

  /// Roundings that a move and an ending go through: see rounding_bound().
  [[nodiscard]] FinalDistribution result(double per_move, double ending) const {
    FinalDistribution d = ends.result();
    d.remainder = remainder.value();
    d.mean_steps = draws.value();
    d.rounding = rounding_bound(d.mean_steps, per_move, ending);
    d.steps = steps;
    return d;
  }
};

/// After so many sums a direct solve takes over, where it may.
inline constexpr int kMostSums = 10'000;

/// Predictor::predict_all by Solver::steps and Solver::rows, arguments checked. With `may_stop`,
/// without limit of cells: none for starts of which it would take more than kMostSums sums, or keep
/// fewer than 6 digits.
using MaybePredicted = std::vector<std::optional<FinalDistribution>>;
[[nodiscard]] MaybePredicted predict_by_steps(const PredictionPlan& plan, const Field& field,
                                              const std::vector<Start>& starts,
                                              const PredictOptions& options, bool may_stop);
[[nodiscard]] MaybePredicted predict_by_rows(const PredictionPlan& plan, const Field& field,
                                             const std::vector<Start>& starts,
                                             const PredictOptions& options, bool may_stop);

/// solve_absorption() whose factors have at most `most_numbers` numbers; throws std::runtime_error
/// for more.
[[nodiscard]] FinalDistribution solve_by_klu(const FieldChain& chain, const Field& field,
                                             const Start& start, double most_numbers);

/// Where walks circle too long for sums, and there is no limit of cells: by the elimination without
/// subtraction, which keeps all digits, in at most so many products; where it would take more, by
/// KLU's LU, if that has at most 2e8 numbers and keeps 6 digits. None where neither does, and for
/// fields of too many pairs of a cell and an input: the choice depends on the chain and the field
/// alone. Throws std::bad_alloc.
[[nodiscard]] std::optional<FinalDistribution> solve_circles(const FieldChain& chain,
                                                             const Field& field, const Start& start,
                                                             double most_operations = 2e9);

}  // namespace gatewalk::markov
