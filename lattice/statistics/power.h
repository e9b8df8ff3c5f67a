// SPDX-License-Identifier: MIT
#pragma once
/// Sample size and power: how many trials detect a difference, and which difference trials detect.

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "lattice/statistics/compare.h"

namespace gatewalk::lattice {

/// A test that finds a difference with probability `level` if there is none, and with probability
/// `power` if there is one.
struct PowerGoal {
  double power = 0.8;
  double level = 0.05;
};

/// The largest number of trials that is considered.
inline constexpr std::int64_t kMostPlanned = 100'000;

// ---- Shares: the exact binomial ----

/// Power of a two-sided test of the share among `trials` against an expected one, if the true share
/// is `truth`. The test statistic is the distance of both, as in joint_test().
[[nodiscard]] double power_of_share(std::int64_t trials, double expected, double truth,
                                    double level);
/// Power to find that two samples of `trials_each` trials differ in a share: Fisher's exact test,
/// which is the permutation test.
[[nodiscard]] double power_of_two_shares(std::int64_t trials_each, double first, double second,
                                         double level);

/// The least number of trials (per sample) from which on the power reaches the goal. Power rises
/// with the number of trials in a sawtooth, and does not fall below the goal again from there.
/// nullopt: more than kMostPlanned.
[[nodiscard]] std::optional<std::int64_t> trials_for_share(double expected, double truth,
                                                           const PowerGoal& goal);
[[nodiscard]] std::optional<std::int64_t> trials_for_two_shares(double first, double second,
                                                                const PowerGoal& goal);

/// How far above or below its expected value a share must be to be detected by this number of
/// trials; nullopt: not even a share of 1, or of 0, would be.
struct SmallestDifference {
  std::optional<double> more{}, fewer{};
};
[[nodiscard]] SmallestDifference smallest_difference(std::int64_t trials, double expected,
                                                     const PowerGoal& goal);

// ---- Distributions: by simulation of the test ----

/// Computes test statistics of two vectors of shares, of samples of at least `trials` trials; the
/// statistics grow with the difference. `expected`: shares that give its sampling noise.
using Differences =
    std::function<std::vector<double>(const Eigen::VectorXd& a, const Eigen::VectorXd& b,
                                      const Eigen::VectorXd& expected, std::int64_t trials)>;

/// Shares of several outcomes, and the test statistics for them.
struct Outcomes {
  Eigen::VectorXd shares;
  Differences differences;
  std::int64_t draws = 0;  // affordable number of null draws
};
/// Final gates that either prediction can reach, and the statistics of joint_test(). The second
/// form also returns the second prediction's shares of the same gates.
[[nodiscard]] Outcomes gate_outcomes(const CellProbabilities& prediction);
[[nodiscard]] std::pair<Outcomes, Eigen::VectorXd> gate_outcomes(const CellProbabilities& first,
                                                                 const CellProbabilities& second);
/// Endings, and the differences of their shares.
[[nodiscard]] Outcomes ending_outcomes(const std::array<double, markov::kEndings>& prediction);

/// The test of joint_test() for samples of one size. Its critical values come from draws of the
/// null, made once for many experiments.
class SimulatedTest {
 public:
  /// A sample of `trials` against exactly known outcomes. `single_level`: the largest p of a single
  /// statistic that is significant; by default, the value with which all statistics together keep
  /// `level`.
  SimulatedTest(const Outcomes& expected, std::int64_t trials, double level, std::uint64_t seed,
                std::optional<double> single_level = {});
  /// Two samples of `trials_each` trials; the null draws both from the mean of the shares.
  SimulatedTest(const Outcomes& first, const Eigen::VectorXd& second, std::int64_t trials_each,
                double level, std::uint64_t seed);

  /// Power: probability that the test finds the difference, for a sample from `truth`, or for
  /// samples from both.
  [[nodiscard]] double power(const Eigen::VectorXd& truth) const;
  [[nodiscard]] double power() const;

 private:
  using Row = std::vector<double>;
  [[nodiscard]] std::vector<Row> rows(std::uint64_t use, const Eigen::VectorXd& first,
                                      const Eigen::VectorXd* second) const;
  void calibrate(const Eigen::VectorXd& null, double level, std::optional<double> single_level);
  [[nodiscard]] bool finds(const Row& row) const;
  [[nodiscard]] double found(const std::vector<Row>& rows) const;

  Outcomes outcomes_;
  std::optional<Eigen::VectorXd> second_;
  std::int64_t trials_;
  std::uint64_t seed_;
  std::vector<std::vector<double>> null_;  // (statistics x draws), ascending
  double single_level_ = 0.0;
};

/// The shares at this total variation from `shares` that are hardest to detect. Each outcome of one
/// half loses the same fraction, each outcome of the other half gains the same fraction. (Of all
/// such shares these have the least chi-squared, 4 TV^2 for equal halves: Cauchy-Schwarz.) nullopt
/// if the losing half has less than that to lose.
[[nodiscard]] std::optional<Eigen::VectorXd> hardest_to_see(const Eigen::VectorXd& shares,
                                                            double total_variation);

/// The least number of trials that detects a total variation of the kind hardest_to_see(), or the
/// difference of two samples; by simulation, to about 3 %. nullopt: more than kMostPlanned, or
/// there is no such difference.
[[nodiscard]] std::optional<std::int64_t> trials_for_total_variation(const Outcomes& expected,
                                                                     double total_variation,
                                                                     const PowerGoal& goal,
                                                                     std::uint64_t seed);
[[nodiscard]] std::optional<std::int64_t> trials_for_two(const Outcomes& first,
                                                         const Eigen::VectorXd& second,
                                                         const PowerGoal& goal, std::uint64_t seed);
/// The least total variation of the kind hardest_to_see() that this number of trials detects;
/// nullopt: not even the largest of that kind.
[[nodiscard]] std::optional<double> smallest_total_variation(
    const Outcomes& expected, std::int64_t trials, const PowerGoal& goal, std::uint64_t seed,
    std::optional<double> single_level = {});

}  // namespace gatewalk::lattice
