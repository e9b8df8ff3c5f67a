// SPDX-License-Identifier: MIT
#pragma once
/// What comparisons share: statistics of final gates, which grow with the difference between two
/// distributions, and draws.

#include <cstdint>
#include <vector>

#include "dynamics/base/random.h"
#include "lattice/statistics/compare.h"

namespace gatewalk::lattice {

/// Rows of the streams of Purpose::comparison: one for each use, so that no two share their draws.
enum Use : std::uint64_t {
  kDeals = 0,
  kExactDraws = 1,
  kSamples = 2,
  kSwaps = 3,
  kPooledDraws = 4,
  kJointTests = 5,
  kDealtJudgements = 6,
  kPowerNull = 7,
  kExperiments = 8
};

/// The gates that either distribution can reach, and the distances between them.
struct Support {
  std::vector<Eigen::Index> gates;  // linear index
  Eigen::MatrixXd distance;         // empty: there are too many of them
};

[[nodiscard]] Support support_of(const CellProbabilities& pooled);
/// Fills in the distances between the gates.
[[nodiscard]] Support with_distances(Support s, Eigen::Index columns);
/// With distances up to kMostEnergyGates.
[[nodiscard]] Support affordable_support_of(const CellProbabilities& pooled);

/// NaN for a support without distances.
[[nodiscard]] double energy_of(const Eigen::VectorXd& difference, const Support& s);

[[nodiscard]] Eigen::VectorXd on_support(const CellProbabilities& p, const Support& s);

/// Gates of a smaller expected share than this are rare in a sample of n: under 5 trials expected.
/// 0, none, when nearly all would be.
[[nodiscard]] double rare_share(const Eigen::VectorXd& expected, std::int64_t n);

struct Statistics {
  double chi_squared = 0.0, total_variation = 0.0, energy = 0.0;
};

/// a, b: shares on the support; `expected`: shares against whose sampling noise a difference
/// counts; gates of a smaller expected share than `rare` count as one.
[[nodiscard]] Statistics statistics(const Eigen::VectorXd& a, const Eigen::VectorXd& b,
                                    const Eigen::VectorXd& expected, double rare,
                                    const Support& support);

/// Shares of `n` draws from other shares, as a few binomials.
[[nodiscard]] Eigen::VectorXd drawn_shares(const Eigen::VectorXd& p, std::int64_t n,
                                           dynamics::Random& random);

}  // namespace gatewalk::lattice
