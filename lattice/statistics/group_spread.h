// SPDX-License-Identifier: MIT
#pragma once
/// Errors of a prediction made from trials, by random groups (batch means; Wolter, Introduction to
/// Variance Estimation, 2007, ch. 2). A prediction is made from each group of the trials, with
/// states of its own. The spread between the groups measures sampling error. The offset of their
/// mean from the whole prediction measures the bias of coarser states: a group of an eighth of the
/// trials has states eight times as large.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "lattice/statistics/compare.h"
#include "lattice/statistics/ending_shares.h"
#include "lattice/statistics/share_95.h"
#include "markov/predict.h"

namespace gatewalk::lattice {

inline constexpr int kTrialGroups = 8;
/// kBiasLeft for states that differ by this number of coordinates. The width of a state grows with
/// the power 1 / coordinates of its size, and so does the bias; kBiasLeft is for three coordinates.
/// Fewer keep that factor, on the safe side.
[[nodiscard]] double bias_left(int coordinates);
/// Fewer bodies than this give no intervals: a group of one body would stand for all.
inline constexpr std::int64_t kLeastBodies = 2 * kTrialGroups;

/// A number from all trials with its 95 % interval from kTrialGroups groups. The spread of the
/// groups gives sampling error; the offset of their mean gives the bias of coarser states. NaN:
/// unknown, because there are no groups, or because all groups agree, which no number of trials
/// makes certain.
struct Mean95 {
  double mean = 0.0;
  std::array<double, 2> interval{};
};
[[nodiscard]] Mean95 mean_95(double whole, const std::vector<double>& groups);

/// A mean of fewer runs, in all or in any group, has no interval: a few long runs in a hundred
/// dominate a mean, and groups without any of them agree by chance.
inline constexpr double kLeastRunsOfMean = 100.0, kLeastRunsOfGroup = 8.0;
/// Numbers of runs behind a mean: in all, and by group. For one ending, the number that the chain
/// expects.
struct RunsBehind {
  double all = 0.0;
  std::vector<double> groups;
};
struct Mean95OfRuns : Mean95 {
  std::string why_none{};  // why there is no interval although there are groups, in words
};
[[nodiscard]] Mean95OfRuns mean_95(double whole, const std::vector<double>& groups,
                                   const RunsBehind& runs);
/// Half of the 95 % interval of the mean of kTrialGroups independent numbers (Student's t).
[[nodiscard]] double half_width_95(const std::vector<double>& groups);

/// The evidence behind a prediction from this number of trials.
[[nodiscard]] Evidence evidence_of(const markov::FinalDistribution& whole, std::int64_t trials);

/// Error bars of a prediction from predictions of groups of the trials.
class GroupSpread {
 public:
  /// `groups`: two or more predictions, from disjoint parts of the trials of equal size.
  /// `coordinates`: number by which the states differ. Throws std::invalid_argument for fewer
  /// groups, and for fields of another size.
  GroupSpread(const markov::FinalDistribution& whole,
              const std::vector<markov::FinalDistribution>& groups, int coordinates);

  /// Error bounds, from errors drawn with the groups' spread. `trials`: number behind the
  /// prediction. A share that is 0 in all groups is bounded by this number; the same holds for the
  /// other members.
  [[nodiscard]] Error95 error(std::int64_t trials, std::uint64_t seed) const;
  /// Bounds of the final gates' shares: low and high (rows x columns).
  [[nodiscard]] std::array<CellProbabilities, 2> gates_95(std::int64_t trials) const;
  [[nodiscard]] EndingShares endings_95(std::int64_t trials) const;

 private:
  const markov::FinalDistribution& whole_;
  const std::vector<markov::FinalDistribution>& groups_;
  double bias_left_;
};

/// Final gates (rows x columns) by all trials, and by each group of the trials.
struct GroupedMaps {
  CellProbabilities whole;
  std::vector<CellProbabilities> groups;
  /// Share of all bodies that end where the chain of all trials has no run; they count in that
  /// gate.
  double unsampled = 0.0;
};
/// A difference between two predictions from the same trials, whose errors are mostly the same.
struct GroupDifference {
  double total_variation = 0.0;
  /// 95 % of differences by chance are at most this: sampling error as the groups show it, beside
  /// what the bias of states explains, or what is small beside the first prediction's own error.
  double chance_95 = 0.0;
  double p = 1.0;  // share of such differences that are as large; 1 for rounding alone
};
/// Compares two predictions; `coordinates`: number by which the states differ. `number` tells apart
/// the draws of several comparisons with one seed.
[[nodiscard]] GroupDifference group_difference(const GroupedMaps& first, const GroupedMaps& second,
                                               int coordinates, std::uint64_t seed,
                                               std::uint64_t number);

/// Error bounds of the shares of the trials themselves; `counts`: trials by final gate (rows x
/// columns).
[[nodiscard]] Error95 error_of_shares(const CellCounts& counts, std::uint64_t seed);

}  // namespace gatewalk::lattice
