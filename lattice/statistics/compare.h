// SPDX-License-Identifier: MIT
#pragma once
/// How alike two distributions of the final gate are, and how alike they could be at all.
/// corrcoef and RMSE as in Sec. III-C, over all gates of the field, RMSE in trials per 100.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "markov/ends.h"

namespace gatewalk::markov {
struct FinalDistribution;
}

namespace gatewalk::lattice {

using markov::CellCounts;
using markov::CellProbabilities;

/// Counts as shares of all. Throws std::invalid_argument when there is no trial.
[[nodiscard]] CellProbabilities shares(const CellCounts& counts);

/// Pearson correlation over the gates; NaN when one of them is the same everywhere.
[[nodiscard]] double corrcoef(const CellProbabilities& a, const CellProbabilities& b);
/// Root mean squared difference over the gates, in trials per 100.
[[nodiscard]] double rmse_per_100(const CellProbabilities& a, const CellProbabilities& b);
/// Total variation: half the summed absolute difference.
[[nodiscard]] double total_variation(const CellProbabilities& a, const CellProbabilities& b);
/// Energy distance (Szekely, Rizzo) with the Euclidean distance between gates, in gates.
[[nodiscard]] double energy_distance(const CellProbabilities& a, const CellProbabilities& b);

/// sum p^2 of the distribution a sample was drawn from, without bias: sum c(c-1) / N(N-1).
[[nodiscard]] double concentration(const CellCounts& counts);

/// What two samples of the same distribution show on average, by sampling alone.
struct NoiseFloor {
  double corrcoef = 0.0;
  double rmse_per_100 = 0.0;
};
/// E[RMSE^2] = 100^2 (1-s)(1/N + 1/m)/n and corrcoef = V / sqrt((V + e_N)(V + e_m)) with
/// V = (s - 1/n)/n, e_N = (1-s)/(nN). `second_trials` 0: the second one is exact (m -> inf).
[[nodiscard]] NoiseFloor noise_floor(double concentration, std::int64_t gates, std::int64_t trials,
                                     std::int64_t second_trials);

/// Mean total variation between `trials` draws from `p` and `p` itself. Exact: the count of a gate
/// is binomial, and de Moivre's E|X - np| = 2 (1-p) m P(X = m), m = floor(np) + 1 there.
[[nodiscard]] double expected_total_variation(const CellProbabilities& p, std::int64_t trials);
/// The least number of trials whose expected_total_variation is at most `total_variation` (> 0),
/// or 2^40 if that is fewer.
[[nodiscard]] std::int64_t trials_for(const CellProbabilities& p, double total_variation);

/// 95 % of predictions like this one are no further from the truth.
struct Error95 {
  double total_variation = 0.0;  // of the final gates, at most
  double corrcoef = 1.0;         // with the true shares, at least; NaN where there is none
  double rmse_per_100 = 0.0;     // at most
};

/// `trials` draws from `p` as counts; a replicate is named by its number.
[[nodiscard]] CellCounts sampled(const CellProbabilities& p, std::int64_t trials,
                                 std::uint64_t seed, std::uint64_t replicate);

/// The energy distance costs the square of the gates reached; beyond this it is left out.
inline constexpr int kMostEnergyGates = 1000;

/// One comparison with its floors and p-values: how often chance alone would look at least this
/// different if both came from one distribution.
struct Comparison {
  double corrcoef = 0.0, rmse_per_100 = 0.0, total_variation = 0.0;
  NoiseFloor floor;
  double floor_total_variation = 0.0;     // mean over the null draws
  double floor_total_variation_95 = 0.0;  // 95 % of the null draws have no more
  double p_chi_squared = 0.0, p_total_variation = 0.0;
  double p_energy = 0.0;  // NaN above kMostEnergyGates reachable gates
  std::int64_t null_draws = 0;
};

/// Two samples: permutation test, the pooled trials dealt out anew `null_draws` times. Of more than
/// kMostDealt trials together both are drawn from the pooled shares instead, which hardly differs
/// there and takes no memory for trials.
inline constexpr std::int64_t kMostDealt = std::int64_t{1} << 22;
[[nodiscard]] Comparison compare(const CellCounts& sample, const CellCounts& other,
                                 std::int64_t null_draws, std::uint64_t seed);

/// Two samples whose trials belong together, first[t] with second[t], as two models of one trial
/// under the same noise do; gates as row * columns + column. The null swaps each pair with
/// probability 1/2, so only pairs that differ count, and far smaller differences are seen than
/// between independent samples. `floor` has no formula here: NaN.
[[nodiscard]] Comparison compare_pairs(const std::vector<std::int32_t>& first,
                                       const std::vector<std::int32_t>& second, int rows,
                                       int columns, std::int64_t null_draws, std::uint64_t seed);

/// A sample against an exact distribution: `null_draws` samples drawn from the latter.
[[nodiscard]] Comparison compare(const CellCounts& sample, const CellProbabilities& exact,
                                 std::int64_t null_draws, std::uint64_t seed);

/// How trials of the full dynamics, or of an experiment, ended: where, and how. Of an experiment
/// either may not have been counted.
struct SeenEndings {
  CellCounts final_gates{};                              // (rows x columns), all trials; or empty
  std::array<std::int64_t, markov::kEndings> endings{};  // by Ending; or all 0

  [[nodiscard]] bool has_gates() const { return final_gates.size() > 0; }
  [[nodiscard]] bool has_endings() const;
  [[nodiscard]] std::int64_t trials() const;
};

/// One test of "the chain is right": do trials of the dynamics differ from the chain's prediction
/// by more than chance in the trials and in the matrix together makes? Draw k of the null takes as
/// many trials from what a resampled matrix predicts, and sets them against the prediction.
struct JointTest {
  /// Of one statistic: what was seen, how often the null reaches it, and that p-value adjusted for
  /// looking at all of them (single-step minP of Westfall and Young, from the same draws): how
  /// often the null makes any of the p-values as small. At least 1 / (draws + 1); NaN where it is
  /// no number.
  struct Test {
    double seen = 0.0, p = 1.0, p_adjusted = 1.0;
  };
  static constexpr double kLevel = 0.05;

  /// Of the final gates; energy NaN above kMostEnergyGates. NaN here and below: not counted.
  Test total_variation, energy, chi_squared;
  std::array<Test, markov::kEndings> endings;  // |difference of the shares|, by Ending
  double p = 1.0;                              // of all together: the smallest adjusted one
  double chance_total_variation = 0.0;         // mean over the null draws
  double chance_total_variation_95 = 0.0;      // 95 % of them have no more
  double single_level = 0.0;  // the largest p of one of them alone that is a finding
  std::int64_t null_draws = 0;

  /// The verdict; it agrees with every adjusted p-value.
  [[nodiscard]] bool differs() const { return p <= kLevel; }
  [[nodiscard]] bool differs(markov::Ending e) const {
    return endings[static_cast<std::size_t>(e)].p_adjusted <= kLevel;
  }
};

/// Resampled matrices that cannot be predicted from: bodies circle (almost) for ever in more states
/// than can be solved.
struct LeftOut {
  std::int64_t matrices = 0, of = 0;
  std::string why{};  // of the last one

  LeftOut& operator+=(const LeftOut& other);
  /// The others would say too little of what all do.
  [[nodiscard]] bool too_many() const { return 2 * matrices > of; }
};

/// `replicates`: predictions from resampled matrices, used in turn; at least one.
/// `runs`: from the start, behind the matrix; 0: the replicates count all, or there are endlessly
/// many. What none of them showed may yet happen: each ending has, in gates where they would show
/// less than one, a share that they leave open, drawn from Beta(1, runs) for each draw of the null.
/// (Then n trials are unlike the runs in a kind of outcome as often as if all were dealt out anew:
/// once or more in n / (runs + n).) Throws std::invalid_argument for fields of different sizes, no
/// trials or no draws.
[[nodiscard]] JointTest joint_test(const SeenEndings& seen,
                                   const markov::FinalDistribution& prediction,
                                   const std::vector<markov::FinalDistribution>& replicates,
                                   std::int64_t runs, std::int64_t null_draws, std::uint64_t seed);

/// One test of "both samples come from one distribution", in what both have counted: permutation
/// test, the pooled trials dealt out anew (of more than kMostDealt together drawn anew). Gates and
/// endings are dealt out each for themselves, as an experiment may not say which belong together:
/// p-values adjusted for looking at all are those of independent tables, rather too large
/// than too small. Throws std::invalid_argument as the other.
[[nodiscard]] JointTest joint_test(const SeenEndings& seen, const SeenEndings& other,
                                   std::int64_t null_draws, std::uint64_t seed);

}  // namespace gatewalk::lattice
