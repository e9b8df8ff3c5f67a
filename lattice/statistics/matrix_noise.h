// SPDX-License-Identifier: MIT
#pragma once
/// How far a prediction is to be trusted because its matrix was sampled: what matrices of other
/// runs would have predicted. The chain's own error (bins, memory) is not in it.

#include <array>
#include <cstdint>
#include <vector>

#include "lattice/statistics/compare.h"
#include "lattice/statistics/share_95.h"
#include "markov/predict.h"

namespace gatewalk::lattice {

/// What the cells of a field draw from, with the counts behind it.
struct CountedField {
  markov::FieldChain chains;
  std::vector<markov::Counts> counts;  // one per type, as chains.chains()
  bool small_rows = false;  // as those of trees: neighbours that are equal are the same runs
  /// By matrix and row: how many counts a run makes in it, 2 with its mirror image; empty: 1.
  std::vector<std::vector<std::int64_t>> images{};
  bool exact = false;  // probabilities were given, not counted: nothing is known of their sampling

  /// Runs of the row that a walk begins in, mirror images not counted twice.
  [[nodiscard]] std::int64_t runs_at(const markov::Start& start) const;
  /// These, those of all rows, and what rows of one outcome may hide from walks without a limit of
  /// cells (`max_cells` 0) or with it.
  [[nodiscard]] Evidence evidence_at(const markov::Start& start, const markov::Field& field,
                                     int max_cells) const;
};

/// A matrix that another set of runs might have given: each row a draw from a Dirichlet
/// distribution around its own shares (a Bayesian bootstrap), in whole steps of 2^-52, which matter
/// by their ratios alone. Its concentration is n - 1 for n runs, so that shares p vary by p (1 - p)
/// / n, as in n other runs. Predictions average to the prediction itself where walks pass a row but
/// once, and every way that was seen stays possible, so that no walk circles that did not before.
/// What a row never saw does not happen in it: resampled_95() leaves that open. `small_rows`, as
/// CountedField's: neighbouring rows that are equal are the same runs, and stay equal. `images`, as
/// CountedField's of this matrix: a row in which a run makes two counts has half as many runs: that
/// is right for starts in the middle; for others, which see one row of a mirrored pair more than
/// the other, the spread is up to sqrt(2) too large.
[[nodiscard]] markov::Counts resampled(const markov::Counts& counts, std::uint64_t seed,
                                       std::uint64_t replicate, bool small_rows = false,
                                       const std::vector<std::int64_t>& images = {});

struct Replicates {
  std::vector<std::vector<markov::FinalDistribution>> predictions;  // (starts x matrices)
  LeftOut left_out;                                                 // of these there are none
};

/// Predictions from replicates first, ... first + count - 1: each matrix resampled() on its own.
/// By Predictor::predict, on all threads of the current TBB arena; the same bits for any number of
/// them. `own`, if given, by start: the predictions of the matrix itself, which say whether sums
/// take too long, and whether walks circle for ever in it too: only then are replicates in which
/// they do not left out. Throws std::invalid_argument as Predictor::predict does.
[[nodiscard]] Replicates replicate_predictions(
    const CountedField& gates, const markov::Field& field, const std::vector<markov::Start>& starts,
    int max_cells, std::uint64_t seed, std::int64_t first, std::int64_t count,
    const std::vector<markov::FinalDistribution>& own = {});

/// Fewer replicates than this are not made.
inline constexpr std::int64_t kLeastReplicates = 50;

/// How many replicates a field and a matrix of this size let one make in some seconds: 0 to `most`.
/// Below kLeastReplicates it is 0.
/// `nonzeros` of the matrix.
[[nodiscard]] std::int64_t affordable_replicates(const markov::Field& field, int max_cells,
                                                 std::int64_t nonzeros, std::int64_t most);

/// The same for these matrices.
[[nodiscard]] std::int64_t affordable_replicates(const CountedField& gates,
                                                 const markov::Field& field, int max_cells,
                                                 std::int64_t most);

/// The spread of predictions that the sampling of the matrix makes.
class MatrixNoise {
 public:
  /// `from`: the runs behind it, see resampled_95().
  MatrixNoise(const markov::FinalDistribution& prediction, const Evidence& from);
  void add(const markov::FinalDistribution& replicate);

  [[nodiscard]] std::int64_t replicates() const {
    return static_cast<std::int64_t>(distances_.size());
  }
  [[nodiscard]] const Evidence& from() const { return from_; }
  /// By resampled_95(), of the shares of this ending. Needs a replicate at least.
  [[nodiscard]] std::array<double, 2> interval_95(markov::Ending e) const;
  /// Total variation of the final cells between replicates and the prediction (NaN without
  /// replicates).
  [[nodiscard]] double mean_total_variation() const;
  [[nodiscard]] double sd_total_variation() const;
  [[nodiscard]] double total_variation_95() const;  // 95 % of the replicates have no more

 private:
  const markov::FinalDistribution& prediction_;
  Evidence from_;
  std::vector<std::array<double, markov::kEndings>> endings_;  // (replicates) by Ending
  std::vector<double> distances_;
};

}  // namespace gatewalk::lattice
