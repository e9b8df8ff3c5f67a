#pragma once
/// How far a prediction is to be trusted because its matrix was sampled: what matrices of other
/// runs would have predicted. The chain's own error (bins, memory) is not in it.

#include <array>
#include <cstdint>
#include <vector>

#include "dynamics/transitions.h"
#include "markov/predict.h"

namespace gatewalk::lattice {

/// The matrices behind a field's rows: row r draws from matrices[matrix_of_row[r]].
struct FieldMatrices {
  std::vector<const dynamics::Transitions*> matrices;
  std::vector<int> matrix_of_row;  // (rows)
};

/// Predictions from replicates first, ... first + count - 1: each matrix resampled() row by row on
/// its own. (starts x count) by Predictor::predict, on all threads of the current TBB arena; the
/// same bits for any number of them. Throws as Predictor::predict does.
[[nodiscard]] std::vector<std::vector<markov::FinalDistribution>> replicate_predictions(
    const FieldMatrices& rows, const markov::Field& field, const std::vector<markov::Start>& starts,
    int max_cells, std::uint64_t seed, std::int64_t first, std::int64_t count);

/// How many replicates a field of this size lets one make in some seconds: 0 to `most`. Below 50 it
/// is 0: so few say too little.
[[nodiscard]] std::int64_t affordable_replicates(const markov::Field& field, int max_cells,
                                                 std::int64_t most);

/// The spread of predictions that the sampling of the matrix makes.
class MatrixNoise {
 public:
  /// `runs`: of the matrix's row that the walks begin in.
  MatrixNoise(const markov::FinalDistribution& prediction, std::int64_t runs);
  void add(const markov::FinalDistribution& replicate);

  [[nodiscard]] std::int64_t replicates() const {
    return static_cast<std::int64_t>(distances_.size());
  }
  [[nodiscard]] std::int64_t runs() const { return runs_; }
  /// Between what lie the shares of this ending in the middle 95 % of the replicates, and the
  /// prediction's own. Needs a replicate at least. No spread at all says only that no run of the
  /// matrix shows any.
  [[nodiscard]] std::array<double, 2> interval_95(markov::Ending e) const;
  /// Total variation of the final cells between replicates and the prediction (NaN without
  /// replicates).
  [[nodiscard]] double mean_total_variation() const;
  [[nodiscard]] double sd_total_variation() const;
  [[nodiscard]] double total_variation_95() const;  // 95 % of the replicates have no more

 private:
  const markov::FinalDistribution& prediction_;
  std::int64_t runs_;
  std::vector<std::array<double, markov::kEndings>> endings_;  // (replicates) by Ending
  std::vector<double> distances_;
};

}  // namespace gatewalk::lattice
