// SPDX-License-Identifier: MIT
#pragma once
/// Shared parts of the solvers by steps (by_steps.cpp) and by rows (by_rows.cpp): prepared chains,
/// and the sums of ended walks from one start.

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

/// A negligible mass. Smaller masses are dropped, because products with them would become denormal
/// numbers, which are slow.
inline constexpr double kNothing = 1e-280;

/// The planes of a tally: all mass; then the mass that ends in a cell: trapped, unsampled, moved by
/// the first move, by the second, ...
enum Tally : int { kTallyTotal, kTallyTrapped, kTallyUnsampled, kTallyMoved };

struct PredictionPlan;

/// A chain's moves for predictions by rows, of chains without moves to a row below.
struct RowStencils {
  Stencil first_sideways;        // moves within a row, of inputs entered from below
  Stencil sideways;              // moves within a row, of inputs entered sideways
  std::vector<Stencil> upwards;  // moves by 1 row, 2 rows, ...
  double stay;                   // staying_per_move() of `sideways`
};

/// The RowStencils of a chain, made on first use: predictions by steps do without. Thread-safe.
class LazyRowStencils {
 public:
  /// `plan` and `chain` must outlive this object.
  LazyRowStencils(const PredictionPlan& plan, const Chain& chain) : plan_(plan), chain_(chain) {}
  [[nodiscard]] const RowStencils& get() const {
    std::call_once(made_, [this] { stencils_ = made(); });
    return stencils_;
  }

 private:
  [[nodiscard]] RowStencils made() const;

  const PredictionPlan& plan_;
  const Chain& chain_;
  mutable std::once_flag made_;
  mutable RowStencils stencils_{};
};

/// A chain as stencils.
struct PreparedChain {
  std::vector<int> walking_inputs, unsampled;  // among inputs that some exit leads to
  Stencil moves;                               // all moves
  Stencil ends;                                // to all planes of a Tally but the first
  Stencil walking;                             // to kTallyTotal: all mass that goes on
  std::unique_ptr<const LazyRowStencils> by_row;
  std::unique_ptr<const LazyRowElimination> elimination;  // null if the chain does not suit
};

struct PredictionPlan {
  FieldChain field_chain;
  bool has_uniform_rows = true;       // all cells of a row have one type
  int inputs = 0, outputs = 0;        // outputs: the largest number of any chain
  int most_terms = 0;                 // of a sum over moves
  std::vector<Move> moves;            // moves of all exits
  int widest = 0;                     // largest |di_x|
  int lowest = 0, highest = 0;        // di_y
  bool is_chequered = true;           // every move changes the colour of a chessboard
  std::vector<int> from_below;        // inputs entered from a row below
  std::vector<int> sideways;          // inputs entered within a row
  Stencil arriving, staying;          // to kTallyTotal: all mass in from_below, sideways
  std::vector<PreparedChain> chains;  // by type of cell

  explicit PredictionPlan(FieldChain chain) : field_chain(std::move(chain)) {}
  [[nodiscard]] const PreparedChain& at(std::int64_t column, std::int64_t row) const {
    return chains[static_cast<std::size_t>(field_chain.type_of(column, row))];
  }
};

/// By output of the chain: the number of its exit's move among `moves`; one more than the last if
/// it is none of them.
[[nodiscard]] std::vector<int> moves_of_exits(const std::vector<Move>& moves, const Chain& chain);

/// Predicts how many steps a sum takes, from the remainder after 512, 1024, 2048, ... steps.
class Pace {
 public:
  /// Whether the sum takes more than `most` steps until at most `enough` is left. While nothing has
  /// ended yet, nothing is predicted.
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

/// The sums of ended walks from one start, and the remainder.
struct StartTally {
  Start start;
  EndSums ends;
  Pace pace;
  CompensatedSum draws, remainder;
  int steps = 0;
  bool over = false;
  bool stopped = false;  // stopped before it was done

  StartTally(const Field& field, const Start& from) : start(from), ends(field) {}

  /// Makes the first draw. `enter(column, row, input, p)` receives the mass that goes on.
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

  /// Counts the draws of the mass in a cell: one number for each plane of ends at `tally`.
  /// `is_last`: mass that would go on is cut off.
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

  /// The result; `per_move` and `ending` count the roundings of a move and of an ending, see
  /// rounding_bound().
  [[nodiscard]] FinalDistribution result(double per_move, double ending) const {
    FinalDistribution d = ends.result();
    d.remainder = remainder.value();
    d.mean_steps = draws.value();
    d.rounding = rounding_bound(d.mean_steps, per_move, ending);
    d.steps = steps;
    return d;
  }
};

/// The number of sums after which a direct solve takes over, where permitted.
inline constexpr int kMostSums = 10'000;

/// Predictor::predict_all by Solver::steps and Solver::rows, with checked arguments. With
/// `may_stop` and without a limit of cells, a start has no result if it would take more than
/// kMostSums sums or keep fewer than 6 digits.
using MaybePredicted = std::vector<std::optional<FinalDistribution>>;
[[nodiscard]] MaybePredicted predict_by_steps(const PredictionPlan& plan, const Field& field,
                                              const std::vector<Start>& starts,
                                              const PredictOptions& options, bool may_stop);
[[nodiscard]] MaybePredicted predict_by_rows(const PredictionPlan& plan, const Field& field,
                                             const std::vector<Start>& starts,
                                             const PredictOptions& options, bool may_stop);

/// solve_absorption() with factors of at most `most_numbers` numbers; throws std::runtime_error for
/// more.
[[nodiscard]] FinalDistribution solve_by_klu(const FieldChain& chain, const Field& field,
                                             const Start& start, double most_numbers);

/// Solves fields without a limit of cells in which walks circle too long for sums: by elimination
/// without subtraction, which keeps all digits, within `most_operations` products; else by KLU's LU
/// if it has at most 2e8 numbers and keeps 6 digits. Returns nullopt if neither does, or if the
/// field has too many (cell, input) pairs. The choice depends only on the chain and the field.
/// Throws std::bad_alloc.
[[nodiscard]] std::optional<FinalDistribution> solve_circles(const FieldChain& chain,
                                                             const Field& field, const Start& start,
                                                             double most_operations = 2e9);

}  // namespace gatewalk::markov
