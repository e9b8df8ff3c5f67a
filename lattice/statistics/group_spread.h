// SPDX-License-Identifier: MIT
#pragma once
/// How far off a prediction may be that was made from trials: predictions from groups of the
/// trials, each with states of its own, differ from each other by sampling, and their mean from the
/// whole one's by what larger states cost (a group of an eighth of the trials has states eight
/// times as large). Both are counted, at the cost of one prediction more. In the field's words:
/// random groups, or batch means, as in Wolter, Introduction to Variance Estimation (2007), ch. 2.

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
/// Fewer bodies than this make no intervals: groups of one would stand for all.
inline constexpr std::int64_t kLeastBodies = 2 * kTrialGroups;

/// Any number of all trials with its 95 % interval by kTrialGroups groups of them: their spread is
/// sampling; their mean less the whole's, what larger states would change. NaN: not known, as
/// without groups, or where all of them are alike, which no number of trials makes certain.
struct Mean95 {
  double mean = 0.0;
  std::array<double, 2> interval{};
};
[[nodiscard]] Mean95 mean_95(double whole, const std::vector<double>& groups);

/// A mean of fewer runs, or of fewer in some group, has no interval: a few long ones in a hundred
/// make much of a mean, and groups in which none of these happened to be are alike.
inline constexpr double kLeastRunsOfMean = 100.0, kLeastRunsOfGroup = 8.0;
/// Runs behind a mean: in all, and by group. Those of an ending are as many as the chain expects.
struct RunsBehind {
  double all = 0.0;
  std::vector<double> groups;
};
struct Mean95OfRuns : Mean95 {
  std::string why_none{};  // why there is no interval though there are groups, in words
};
[[nodiscard]] Mean95OfRuns mean_95(double whole, const std::vector<double>& groups,
                                   const RunsBehind& runs);
/// Half of the 95 % interval of the mean of kTrialGroups numbers that do not depend on each other:
/// Student's t.
[[nodiscard]] double half_width_95(const std::vector<double>& groups);

/// Of a prediction from so many trials.
[[nodiscard]] Evidence evidence_of(const markov::FinalDistribution& whole, std::int64_t trials);

class GroupSpread {
 public:
  /// `groups`: two or more, from disjoint parts of the trials of equal size. Throws
  /// std::invalid_argument for fewer, and for other fields.
  GroupSpread(const markov::FinalDistribution& whole,
              const std::vector<markov::FinalDistribution>& groups);

  /// From errors drawn as the groups differ. `trials`: behind the prediction. Where no
  /// group has a share, so many trials say how large it can be; here and below.
  [[nodiscard]] Error95 error(std::int64_t trials, std::uint64_t seed) const;
  /// Final gates: low and high (rows x columns).
  [[nodiscard]] std::array<CellProbabilities, 2> gates_95(std::int64_t trials) const;
  [[nodiscard]] EndingShares endings_95(std::int64_t trials) const;

 private:
  const markov::FinalDistribution& whole_;
  const std::vector<markov::FinalDistribution>& groups_;
};

/// The same of the shares of `trials` themselves, which `counts` (rows x columns) are.
[[nodiscard]] Error95 error_of_shares(const CellCounts& counts, std::uint64_t seed);

}  // namespace gatewalk::lattice
