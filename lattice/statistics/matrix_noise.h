// SPDX-License-Identifier: MIT
#pragma once
/// The sampling error of a matrix: how much predictions vary between matrices counted from other
/// sets of runs. The chain's own approximation error (bins, memory) is not included.

#include <array>
#include <cstdint>
#include <vector>

#include "lattice/statistics/compare.h"
#include "lattice/statistics/share_95.h"
#include "markov/predict.h"

namespace gatewalk::lattice {

/// The chain of a field's cells, with the counts behind it.
struct CountedField {
  markov::FieldChain chains;
  std::vector<markov::Counts> counts;  // one per type, as chains.chains()
  bool small_rows = false;  // matrices of trees: equal neighbouring rows are the same runs
  /// By matrix and row: the number of counts per run, 2 with its mirror image; empty: 1.
  std::vector<std::vector<std::int64_t>> images{};
  bool exact = false;  // imported probabilities, whose sampling error is unknown

  /// Number of runs of the row that a walk begins in, without mirror images.
  [[nodiscard]] std::int64_t runs_at(const markov::Start& start) const;
  /// The evidence behind a prediction: the runs of the start's row, the runs of all rows, and what
  /// rows with a single outcome may hide, for walks with a limit of cells or without one
  /// (`max_cells` 0).
  [[nodiscard]] Evidence evidence_at(const markov::Start& start, const markov::Field& field,
                                     int max_cells) const;
};

/// A matrix that another set of runs might have given (Bayesian bootstrap): each row is a Dirichlet
/// draw around its own shares, as multiples of 2^-52 of which only the ratios matter. The
/// concentration n - 1 for n runs makes shares p vary by p (1 - p) / n. Observed outcomes stay
/// possible, so that no new circles arise; outcomes that a row never showed stay impossible
/// (resampled_95() allows for them). Where walks pass a row only once, the mean of the predictions
/// is the prediction itself. `small_rows`: equal neighbouring rows are the same runs, and stay
/// equal. `images`: a row with two counts per run has half as many runs, which is right for starts
/// in the middle; for other starts the spread is up to sqrt(2) too large.
[[nodiscard]] markov::Counts resampled(const markov::Counts& counts, std::uint64_t seed,
                                       std::uint64_t replicate, bool small_rows = false,
                                       const std::vector<std::int64_t>& images = {});

/// Predictions from resampled matrices.
struct Replicates {
  std::vector<std::vector<markov::FinalDistribution>> predictions;  // (starts x matrices)
  LeftOut left_out;  // matrices that gave no prediction
};

/// Predicts from resampled matrices number first, ... first + count - 1, on all threads of the
/// current TBB arena; the bits do not depend on the number of threads. A matrix whose walks circle
/// for ever is left out, unless walks of the original matrix do so too. `own`, if given: by start,
/// the predictions of the original matrix, which show that, and whether sums take too long. Throws
/// std::invalid_argument as Predictor::predict does.
[[nodiscard]] Replicates replicate_predictions(
    const CountedField& gates, const markov::Field& field, const std::vector<markov::Start>& starts,
    int max_cells, std::uint64_t seed, std::int64_t first, std::int64_t count,
    const std::vector<markov::FinalDistribution>& own = {});

/// The least number of replicates that are made.
inline constexpr std::int64_t kLeastReplicates = 50;

/// The number of replicates, up to `most`, that take some seconds for a field of this size and a
/// matrix of `nonzeros`; 0 if fewer than kLeastReplicates.
[[nodiscard]] std::int64_t affordable_replicates(const markov::Field& field, int max_cells,
                                                 std::int64_t nonzeros, std::int64_t most);

/// The number of replicates, up to `most`, that take some seconds for these matrices; 0 if fewer
/// than kLeastReplicates.
[[nodiscard]] std::int64_t affordable_replicates(const CountedField& gates,
                                                 const markov::Field& field, int max_cells,
                                                 std::int64_t most);

/// The spread of predictions that comes from the sampling of the matrix.
class MatrixNoise {
 public:
  /// `from`: the evidence behind the prediction, for resampled_95().
  MatrixNoise(const markov::FinalDistribution& prediction, const Evidence& from);
  void add(const markov::FinalDistribution& replicate);

  [[nodiscard]] std::int64_t replicates() const {
    return static_cast<std::int64_t>(distances_.size());
  }
  [[nodiscard]] const Evidence& from() const { return from_; }
  /// The 95 % interval of this ending's share (resampled_95()). Needs at least one replicate.
  [[nodiscard]] std::array<double, 2> interval_95(markov::Ending e) const;
  /// Total variation of the final cells between replicates and the prediction; NaN without
  /// replicates.
  [[nodiscard]] double mean_total_variation() const;
  [[nodiscard]] double sd_total_variation() const;
  [[nodiscard]] double total_variation_95() const;  // 95 % of the replicates are at most this far

 private:
  const markov::FinalDistribution& prediction_;
  Evidence from_;
  std::vector<std::array<double, markov::kEndings>> endings_;  // (replicates) by Ending
  std::vector<double> distances_;
};

}  // namespace gatewalk::lattice
