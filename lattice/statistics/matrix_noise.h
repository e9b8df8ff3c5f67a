// SPDX-License-Identifier: MIT
#pragma once
/// How far a prediction is to be trusted because its matrix was sampled: what matrices of other
/// runs would have predicted. The chain's own error (bins, memory) is not in it.

#include <array>
#include <cstdint>
#include <vector>

#include "lattice/statistics/share_95.h"
#include "markov/predict.h"

namespace gatewalk::lattice {

/// What the cells of a field draw from, with the counts behind it.
struct CountedField {
  markov::FieldChain chains;
  std::vector<markov::Counts> counts;  // one per type, as chains.chains()
  bool small_rows = false;             // rows of a few runs each, as those of trees
  /// By matrix and row: how many counts a run makes in it, 2 with its mirror image; empty: 1.
  std::vector<std::vector<std::int64_t>> images{};
  bool exact = false;  // probabilities were given, not counted: nothing is known of their sampling

  /// Runs of the row that a walk begins in, mirror images not counted twice.
  [[nodiscard]] std::int64_t runs_at(const markov::Start& start) const;
  /// These, and where rows are small (else 0) those of all rows.
  [[nodiscard]] Evidence evidence_at(const markov::Start& start) const;
};

/// The counts that another set of runs might have given: every row's trials drawn anew from its own
/// counts, as one binomial per entry, and of one run more that may end as any of all rows: what a
/// row never saw may yet happen in it. (Not in small rows, of which one run is a large part; there,
/// predictions average over many rows. Neighbouring small rows that are equal are the same runs,
/// and stay equal.) `images`, as CountedField's of this matrix: of a row in which a run makes two
/// counts half as many are drawn: that is right for starts in the middle; for others, which see one
/// row of a mirrored pair more than the other, the spread is up to sqrt(2) too large. Chains of
/// such counts, which matter by their ratios alone, show what the sampling of the matrix alone does
/// to a prediction.
[[nodiscard]] markov::Counts resampled(const markov::Counts& counts, std::uint64_t seed,
                                       std::uint64_t replicate, bool small_rows = false,
                                       const std::vector<std::int64_t>& images = {});

/// Resampled matrices that cannot be predicted from: in a leaf of which all ways out were drawn
/// away bodies circle for ever.
struct LeftOut {
  std::int64_t matrices = 0, of = 0;
  std::string why{};  // of the last one

  LeftOut& operator+=(const LeftOut& other);
  /// The others would say too little of what all do.
  [[nodiscard]] bool too_many() const { return 2 * matrices > of; }
};

struct Replicates {
  std::vector<std::vector<markov::FinalDistribution>> predictions;  // (starts x matrices)
  LeftOut left_out;                                                 // of these there are none
};

/// Predictions from replicates first, ... first + count - 1: each matrix resampled() on its own.
/// By Predictor::predict, on all threads of the current TBB arena; the same bits for any number of
/// them. Throws std::invalid_argument as Predictor::predict does.
[[nodiscard]] Replicates replicate_predictions(const CountedField& gates,
                                               const markov::Field& field,
                                               const std::vector<markov::Start>& starts,
                                               int max_cells, std::uint64_t seed,
                                               std::int64_t first, std::int64_t count);

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
  Evidence from_;
  std::vector<std::array<double, markov::kEndings>> endings_;  // (replicates) by Ending
  std::vector<double> distances_;
};

}  // namespace gatewalk::lattice
