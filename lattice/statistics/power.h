// SPDX-License-Identifier: MIT
#pragma once
/// How many trials an experiment needs to show a difference, and what difference so many can show.

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "lattice/statistics/compare.h"

namespace gatewalk::lattice {

/// A test that finds a difference where there is none in `level` of all experiments, and is to find
/// one that there is in `power` of them.
struct PowerGoal {
  double power = 0.8;
  double level = 0.05;
};

/// More trials than this are not looked for.
inline constexpr std::int64_t kMostPlanned = 100'000;

// ---- Shares: the exact binomial ----

/// How often the share among `trials` is found to differ from the one that is expected, two-sided
/// by the distance of both as in joint_test(), if the true share is `truth`.
[[nodiscard]] double power_of_share(std::int64_t trials, double expected, double truth,
                                    double level);
/// How often two samples of so many trials each are found to differ in their shares: the
/// permutation test, which is Fisher's exact test.
[[nodiscard]] double power_of_two_shares(std::int64_t trials_each, double first, double second,
                                         double level);

/// The least number of trials (of each sample) from which on the power is that of the goal: it goes
/// up with the trials in teeth, and does not fall below it again. None up to kMostPlanned.
[[nodiscard]] std::optional<std::int64_t> trials_for_share(double expected, double truth,
                                                           const PowerGoal& goal);
[[nodiscard]] std::optional<std::int64_t> trials_for_two_shares(double first, double second,
                                                                const PowerGoal& goal);

/// By how much more or less than expected a share must be to be found by so many trials; none:
/// not even all or none of them would be.
struct SmallestDifference {
  std::optional<double> more{}, fewer{};
};
[[nodiscard]] SmallestDifference smallest_difference(std::int64_t trials, double expected,
                                                     const PowerGoal& goal);

// ---- Distributions: by simulation of the test ----

/// What is looked at together: statistics of two vectors of shares, of samples of at least
/// `trials`, that grow with their difference; `expected`: shares against whose noise it counts.
using Differences =
    std::function<std::vector<double>(const Eigen::VectorXd& a, const Eigen::VectorXd& b,
                                      const Eigen::VectorXd& expected, std::int64_t trials)>;

/// Shares of some kinds of outcome, and what is looked at in them.
struct Outcomes {
  Eigen::VectorXd shares;
  Differences differences;
  std::int64_t draws = 0;  // that are affordable
};
/// Final gates that one of the two can reach, and the statistics of joint_test(); the second's
/// shares are on the same gates.
[[nodiscard]] Outcomes gate_outcomes(const CellProbabilities& prediction);
[[nodiscard]] std::pair<Outcomes, Eigen::VectorXd> gate_outcomes(const CellProbabilities& first,
                                                                 const CellProbabilities& second);
/// Endings, and the differences of their shares.
[[nodiscard]] Outcomes ending_outcomes(const std::array<double, markov::kEndings>& prediction);

/// The test of joint_test() for samples of one size: its critical values from draws of the null,
/// found once for many experiments.
class SimulatedTest {
 public:
  /// A sample of `trials` against outcomes that are known exactly. `single_level`: the largest p of
  /// a single statistic that is a finding; without it that which all together keep `level` with.
  SimulatedTest(const Outcomes& expected, std::int64_t trials, double level, std::uint64_t seed,
                std::optional<double> single_level = {});
  /// Two samples of so many trials each; the null draws both from the mean of the shares.
  SimulatedTest(const Outcomes& first, const Eigen::VectorXd& second, std::int64_t trials_each,
                double level, std::uint64_t seed);

  /// How often the difference is found: of a sample from `truth`; of samples from both.
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

/// Shares that are off by this total variation in the way that is hardest to see: in two halves of
/// the outcomes each share is the same part larger or smaller. (Of all with this total variation
/// these have the least chi-squared, 4 TV^2 where the halves are equal: Cauchy-Schwarz.) None where
/// a half has less than that to lose.
[[nodiscard]] std::optional<Eigen::VectorXd> hardest_to_see(const Eigen::VectorXd& shares,
                                                            double total_variation);

/// The least number of trials that show a total variation, hardest_to_see; two samples' difference.
/// To some 3 %, by simulation. None: more than kMostPlanned, or there is no such difference.
[[nodiscard]] std::optional<std::int64_t> trials_for_total_variation(const Outcomes& expected,
                                                                     double total_variation,
                                                                     const PowerGoal& goal,
                                                                     std::uint64_t seed);
[[nodiscard]] std::optional<std::int64_t> trials_for_two(const Outcomes& first,
                                                         const Eigen::VectorXd& second,
                                                         const PowerGoal& goal, std::uint64_t seed);
/// The least total variation, hardest_to_see, that so many trials show; none: not the largest that
/// there is of that kind.
[[nodiscard]] std::optional<double> smallest_total_variation(
    const Outcomes& expected, std::int64_t trials, const PowerGoal& goal, std::uint64_t seed,
    std::optional<double> single_level = {});

}  // namespace gatewalk::lattice
