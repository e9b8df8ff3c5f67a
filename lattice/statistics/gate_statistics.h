// SPDX-License-Identifier: MIT
#pragma once
/// Building blocks of comparisons: test statistics of final gates, which grow with the difference
/// between two distributions, and random draws.

#include <cstdint>
#include <vector>

#include "dynamics/base/random.h"
#include "lattice/statistics/compare.h"

namespace gatewalk::lattice {

/// The second word of the streams of Purpose::comparison: one per use, so that no two uses share
/// draws.
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
  std::vector<Eigen::Index> gates;  // index row * columns + column
  Eigen::MatrixXd distance;         // empty: too many gates
};

[[nodiscard]] Support support_of(const CellProbabilities& pooled);
/// Adds the distances between the gates to `s`.
[[nodiscard]] Support with_distances(Support s, Eigen::Index columns);
/// The support of `pooled`, with distances if it has at most kMostEnergyGates gates.
[[nodiscard]] Support affordable_support_of(const CellProbabilities& pooled);

/// Energy distance of a difference of shares; NaN for a support without distances.
[[nodiscard]] double energy_of(const Eigen::VectorXd& difference, const Support& s);

[[nodiscard]] Eigen::VectorXd on_support(const CellProbabilities& p, const Support& s);

/// The expected share below which a gate is rare in a sample of n: fewer than 5 trials expected.
/// Returns 0 (no rare gates) if nearly all gates would be rare.
[[nodiscard]] double rare_share(const Eigen::VectorXd& expected, std::int64_t n);

struct Statistics {
  double chi_squared = 0.0, total_variation = 0.0, energy = 0.0;
};

/// Test statistics of two vectors of shares, `a` and `b`, on the support. `expected`: shares that
/// give the sampling noise of a difference; gates with an expected share below `rare` are merged
/// into one.
[[nodiscard]] Statistics statistics(const Eigen::VectorXd& a, const Eigen::VectorXd& b,
                                    const Eigen::VectorXd& expected, double rare,
                                    const Support& support);

/// Shares of `n` draws from the shares `p`.
[[nodiscard]] Eigen::VectorXd drawn_shares(const Eigen::VectorXd& p, std::int64_t n,
                                           dynamics::Random& random);

}  // namespace gatewalk::lattice
