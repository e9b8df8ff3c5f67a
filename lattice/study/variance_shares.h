// SPDX-License-Identifier: MIT
#pragma once
/// The share of each number of a field in the variance of a probability, if the numbers vary over
/// ranges.

#include <cstdint>
#include <functional>
#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/cells/health.h"
#include "lattice/field/problem.h"
#include "lattice/statistics/sobol.h"
#include "markov/totals.h"

namespace gatewalk::lattice {

struct VarianceSharesOptions {
  std::int64_t trials = 200'000;  // through the field, all points together: no more than that
  std::uint64_t seed = 1;
};
/// Least number of trials for indices of `numbers` numbers.
[[nodiscard]] std::int64_t least_trials_of_shares(int numbers);

/// The results of variance_shares().
struct VarianceShares {
  SobolIndices indices;  // of the probability that a trial ends in the target
  std::int64_t points = 0, trials = 0, ended = 0;  // ended: number of trials in the target
  dynamics::Health health;
  double seconds = 0.0;
};

/// The field at a point of the unit cube, whose coordinates are the numbers, each in its range.
using ProblemAt = std::function<Problem(const std::vector<double>& point)>;

/// Computes the indices from full trials: 16 for each of a point's two answers, under the same
/// noise at the points of a row as long as bodies take the same ways. No chain is used, so the only
/// error is sampling error, which the indices leave out. Throws std::invalid_argument for too few
/// trials, and as IndexDesign.
[[nodiscard]] VarianceShares variance_shares(int numbers, const ProblemAt& problem_at,
                                             markov::Ending target,
                                             const VarianceSharesOptions& options,
                                             const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
