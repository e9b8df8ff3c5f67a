#pragma once
/// Exact distributions fast: the chain applied to whole rows of the field at a time, in vector
/// registers (planes.h). The plain references are propagate and solve_absorption (exact.h).

#include <memory>
#include <vector>

#include "markov/predict/reference.h"

namespace gatewalk::markov {

struct PredictionPlan;  // sweep.cpp

/// A chain, or one per row, prepared for any field and starts. May be used from several threads at
/// a time. Predictions from several starts are made side by side, each on its own: the same bits as
/// one by one, in less time.
class Sweeper {
 public:
  /// Throws std::invalid_argument for moves of more than 10^4 cells.
  explicit Sweeper(const Chain& chain);
  /// For fields of as many rows as `rows` has; each distinct chain is prepared once.
  explicit Sweeper(const RowChains& rows);
  ~Sweeper();
  Sweeper(const Sweeper&) = delete;
  Sweeper& operator=(const Sweeper&) = delete;

  /// The same as propagate() of exact.h, to rounding; with a limit it stops once next to nobody
  /// walks (1e-30 of all walks in any state of a cell). Memory per start: 4 n_in numbers per cell
  /// that can be reached, half of that when every move leads to the other colour of a chessboard.
  [[nodiscard]] FinalDistribution propagate(const Field& field, const Start& start, int max_cells,
                                            double tolerance = 1e-13,
                                            int max_steps_without_limit = 1'000'000) const;
  [[nodiscard]] std::vector<FinalDistribution> propagate_all(
      const Field& field, const std::vector<Start>& starts, int max_cells, double tolerance = 1e-13,
      int max_steps_without_limit = 1'000'000) const;

  /// Whether march() can be used: no exit leads to a row below.
  [[nodiscard]] bool can_march() const;

  /// How march() finds the visits of a row: by `sums` over more and more moves, or by `elimination`
  /// of its columns (row_solver.h), which takes as long whatever the number of moves, if the chain
  /// lets it; `cheapest`: what takes fewer operations by estimate.
  enum class RowMethod { cheapest, elimination, sums };

  /// Without limit, row by row: of what enters a row so little is left walking in it that at most
  /// `tolerance` is left in all (`remainder`; elimination may leave more where rounding lets it not
  /// do better), then the next row is entered. Memory: a few rows x n_in numbers, whatever the
  /// number of rows, and for elimination up to 512 MiB. Throws std::invalid_argument unless
  /// can_march(); std::runtime_error when walks can circle (almost) for ever: a row takes more than
  /// `most_sums` sums, or is solved to fewer than 6 digits.
  [[nodiscard]] FinalDistribution march(const Field& field, const Start& start,
                                        double tolerance = 1e-12,
                                        RowMethod method = RowMethod::cheapest,
                                        int most_sums = 1'000'000) const;
  [[nodiscard]] std::vector<FinalDistribution> march_all(const Field& field,
                                                         const std::vector<Start>& starts,
                                                         double tolerance = 1e-12,
                                                         RowMethod method = RowMethod::cheapest,
                                                         int most_sums = 1'000'000) const;

  /// Without limit march(), if it can be used; else propagate().
  [[nodiscard]] FinalDistribution predict(const Field& field, const Start& start,
                                          int max_cells) const;
  [[nodiscard]] std::vector<FinalDistribution> predict_all(const Field& field,
                                                           const std::vector<Start>& starts,
                                                           int max_cells) const;

 private:
  std::unique_ptr<const PredictionPlan> plan_;
};

}  // namespace gatewalk::markov
