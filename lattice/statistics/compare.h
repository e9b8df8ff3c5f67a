// SPDX-License-Identifier: MIT
#pragma once
/// How alike two distributions of the final gate are, and how alike sampling noise would let them
/// be. corrcoef and RMSE are those of Sec. III-C, over all gates of the field, RMSE in trials per
/// 100.

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

/// Counts divided by their sum. Throws std::invalid_argument if there is no trial.
[[nodiscard]] CellProbabilities shares(const CellCounts& counts);

/// Pearson correlation over the gates; NaN if one distribution is the same in every gate.
[[nodiscard]] double corrcoef(const CellProbabilities& a, const CellProbabilities& b);
/// Root mean squared difference over the gates, in trials per 100.
[[nodiscard]] double rmse_per_100(const CellProbabilities& a, const CellProbabilities& b);
/// Total variation: half the summed absolute difference.
[[nodiscard]] double total_variation(const CellProbabilities& a, const CellProbabilities& b);
/// Energy distance (Szekely, Rizzo), with the Euclidean distance between gates; unit: gates.
[[nodiscard]] double energy_distance(const CellProbabilities& a, const CellProbabilities& b);

/// Unbiased estimate of sum p^2 of the distribution behind a sample: sum c(c-1) / N(N-1).
[[nodiscard]] double concentration(const CellCounts& counts);

/// The mean corrcoef and RMSE of two samples from the same distribution: sampling noise alone.
struct NoiseFloor {
  double corrcoef = 0.0;
  double rmse_per_100 = 0.0;
};
/// E[RMSE^2] = 100^2 (1-s)(1/N + 1/m)/n and corrcoef = V / sqrt((V + e_N)(V + e_m)), with
/// V = (s - 1/n)/n and e_N = (1-s)/(nN). s: `concentration`, n: `gates`, N: `trials`,
/// m: `second_trials`; 0: the second distribution is exact (m -> inf).
[[nodiscard]] NoiseFloor noise_floor(double concentration, std::int64_t gates, std::int64_t trials,
                                     std::int64_t second_trials);

/// Mean total variation between `p` and the shares of `trials` draws from `p`. Exact: the count of
/// a gate is binomial, with de Moivre's E|X - np| = 2 (1-p) m P(X = m), m = floor(np) + 1.
[[nodiscard]] double expected_total_variation(const CellProbabilities& p, std::int64_t trials);
/// The least number of trials whose expected_total_variation is at most `total_variation` (> 0), or
/// 2^40 if that is less.
[[nodiscard]] std::int64_t trials_for(const CellProbabilities& p, double total_variation);

/// 95 % error bounds of a prediction: 95 % of such predictions are at least this close to the
/// truth.
struct Error95 {
  double total_variation = 0.0;  // of the final gates, at most
  double corrcoef = 1.0;         // with the true shares, at least; NaN if there is no bound
  double rmse_per_100 = 0.0;     // at most
};

/// Counts of `trials` draws from `p`. The number `replicate` names the draw: equal numbers give
/// equal counts.
[[nodiscard]] CellCounts sampled(const CellProbabilities& p, std::int64_t trials,
                                 std::uint64_t seed, std::uint64_t replicate);

/// Above this number of reached gates the energy distance is left out: its cost grows with the
/// square.
inline constexpr int kMostEnergyGates = 1000;

/// One comparison of two distributions, with its noise floors and p-values. A p-value is the
/// probability that sampling noise alone gives at least this difference.
struct Comparison {
  double corrcoef = 0.0, rmse_per_100 = 0.0, total_variation = 0.0;
  NoiseFloor floor;
  double floor_total_variation = 0.0;     // mean over the null draws
  double floor_total_variation_95 = 0.0;  // 95 % of the null draws are at most this
  double p_chi_squared = 0.0, p_total_variation = 0.0;
  double p_energy = 0.0;  // NaN above kMostEnergyGates reached gates
  std::int64_t null_draws = 0;
};

/// Above this number of pooled trials both samples are drawn from the pooled shares instead of
/// permuted: the result hardly differs, and no memory for single trials is needed.
inline constexpr std::int64_t kMostDealt = std::int64_t{1} << 22;
/// Compares two independent samples by a permutation test: `null_draws` times, the pooled trials
/// are dealt out anew.
[[nodiscard]] Comparison compare(const CellCounts& sample, const CellCounts& other,
                                 std::int64_t null_draws, std::uint64_t seed);

/// Compares two paired samples: first[t] and second[t] belong together, as two models of one trial
/// under the same noise do; gates are row * columns + column. The null swaps each pair with
/// probability 1/2. Only pairs that differ count, so the test detects far smaller differences than
/// between independent samples. `floor` is NaN: no formula exists for pairs.
[[nodiscard]] Comparison compare_pairs(const std::vector<std::int32_t>& first,
                                       const std::vector<std::int32_t>& second, int rows,
                                       int columns, std::int64_t null_draws, std::uint64_t seed);

/// Compares a sample with an exact distribution, by `null_draws` samples drawn from the latter.
[[nodiscard]] Comparison compare(const CellCounts& sample, const CellProbabilities& exact,
                                 std::int64_t null_draws, std::uint64_t seed);

/// How many trials of the full dynamics, or of an experiment, ended in each gate and in each way.
/// An experiment may have counted only one of the two.
struct SeenEndings {
  CellCounts final_gates{};                              // (rows x columns), all trials; or empty
  std::array<std::int64_t, markov::kEndings> endings{};  // by Ending; or all 0

  [[nodiscard]] bool has_gates() const { return final_gates.size() > 0; }
  [[nodiscard]] bool has_endings() const;
  [[nodiscard]] std::int64_t trials() const;
};

/// A test of the hypothesis "the chain is right": do trials of the dynamics differ from the chain's
/// prediction by more than sampling error of the trials and of the matrix explains? Draw k of the
/// null takes the same number of trials from the prediction of a resampled matrix, and compares
/// them with the prediction.
struct JointTest {
  /// One statistic: its observed value, its p-value, and the p-value adjusted for testing all
  /// statistics together. The adjustment is the single-step minP of Westfall and Young, from the
  /// same draws. p-values are at least 1 / (draws + 1), and NaN where there is no value.
  struct Test {
    double seen = 0.0, p = 1.0, p_adjusted = 1.0;
  };
  static constexpr double kLevel = 0.05;

  /// Of the final gates; energy is NaN above kMostEnergyGates gates. NaN here and below: not
  /// counted.
  Test total_variation, energy, chi_squared;
  std::array<Test, markov::kEndings> endings;  // |difference of the shares|, by Ending
  double p = 1.0;                              // overall: the smallest adjusted p-value
  double chance_total_variation = 0.0;         // mean over the null draws
  double chance_total_variation_95 = 0.0;      // 95 % of the null draws are at most this
  double single_level = 0.0;                   // the largest single p that is significant
  std::int64_t null_draws = 0;

  /// The verdict at level kLevel; consistent with the adjusted p-values.
  [[nodiscard]] bool differs() const { return p <= kLevel; }
  [[nodiscard]] bool differs(markov::Ending e) const {
    return endings[static_cast<std::size_t>(e)].p_adjusted <= kLevel;
  }
};

/// Resampled matrices without a prediction: their walks circle (almost) for ever in more states
/// than can be solved.
struct LeftOut {
  std::int64_t matrices = 0, of = 0;
  std::string why{};  // the reason for the last one

  LeftOut& operator+=(const LeftOut& other);
  /// True if more than half are left out, so that the rest represents too little.
  [[nodiscard]] bool too_many() const { return 2 * matrices > of; }
};

/// Tests trials of the dynamics or of an experiment against the chain. `replicates`: predictions
/// from resampled matrices, used in turn; at least one. `runs`: simulated runs from the start; 0:
/// the replicates already include their sampling error, or there are infinitely many. Outcomes that
/// no run showed stay possible: each ending gets, in gates where fewer than one run is expected, a
/// share drawn from Beta(1, runs) in each null draw. Throws std::invalid_argument for fields of
/// different sizes, no trials or no draws.
[[nodiscard]] JointTest joint_test(const SeenEndings& seen,
                                   const markov::FinalDistribution& prediction,
                                   const std::vector<markov::FinalDistribution>& replicates,
                                   std::int64_t runs, std::int64_t null_draws, std::uint64_t seed);

/// Tests the hypothesis "both samples come from one distribution" in whatever both samples counted,
/// by a permutation test (above kMostDealt pooled trials: by new draws). Gates and endings are
/// permuted independently, because an experiment may not say which belong together; the adjusted
/// p-values then err on the large side. Throws std::invalid_argument for fields of different sizes,
/// no trials, no draws, or nothing counted in both.
[[nodiscard]] JointTest joint_test(const SeenEndings& seen, const SeenEndings& other,
                                   std::int64_t null_draws, std::uint64_t seed);

}  // namespace gatewalk::lattice
