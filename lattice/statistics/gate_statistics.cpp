// SPDX-License-Identifier: MIT
#include "lattice/statistics/gate_statistics.h"

#include <cmath>
#include <limits>
#include <utility>

#include "lattice/statistics/draws.h"

namespace gatewalk::lattice {

Support support_of(const CellProbabilities& pooled) {
  Support s;
  for (Eigen::Index i = 0; i < pooled.size(); ++i)
    if (pooled.data()[i] > 0.0) s.gates.push_back(i);
  return s;
}

Support with_distances(Support s, Eigen::Index columns) {
  const auto n = static_cast<Eigen::Index>(s.gates.size());
  s.distance.resize(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      const auto dx = static_cast<double>(s.gates[i] % columns - s.gates[j] % columns);
      const auto dy = static_cast<double>(s.gates[i] / columns - s.gates[j] / columns);
      s.distance(i, j) = std::hypot(dx, dy);
    }
  return s;
}

Support affordable_support_of(const CellProbabilities& pooled) {
  Support s = support_of(pooled);
  return s.gates.size() <= kMostEnergyGates ? with_distances(std::move(s), pooled.cols()) : s;
}

double energy_of(const Eigen::VectorXd& difference, const Support& s) {
  if (s.distance.size() == 0) return std::numeric_limits<double>::quiet_NaN();
  return -difference.dot(s.distance * difference);
}

Eigen::VectorXd on_support(const CellProbabilities& p, const Support& s) {
  Eigen::VectorXd v(static_cast<Eigen::Index>(s.gates.size()));
  for (Eigen::Index i = 0; i < v.size(); ++i) v[i] = p.data()[s.gates[i]];
  return v;
}

double rare_share(const Eigen::VectorXd& expected, std::int64_t n) {
  const double rare = 5.0 / static_cast<double>(n);
  return (expected.array() < rare).select(expected, 0.0).sum() < 0.5 ? rare : 0.0;
}

Statistics statistics(const Eigen::VectorXd& a, const Eigen::VectorXd& b,
                      const Eigen::VectorXd& expected, double rare, const Support& support) {
  const Eigen::VectorXd difference = a - b;
  Statistics s;
  // Rare gates are merged: otherwise a single trial in one of them would outweigh all others.
  double rare_difference = 0.0, rare_expected = 0.0;
  for (Eigen::Index i = 0; i < difference.size(); ++i) {
    if (expected[i] < rare) {
      rare_difference += difference[i];
      rare_expected += expected[i];
    } else {
      s.chi_squared += difference[i] * difference[i] / expected[i];
    }
  }
  if (rare_difference != 0.0)
    s.chi_squared += rare_expected > 0.0 ? rare_difference * rare_difference / rare_expected
                                         : std::numeric_limits<double>::infinity();
  s.total_variation = 0.5 * difference.cwiseAbs().sum();
  s.energy = energy_of(difference, support);
  return s;
}

Eigen::VectorXd drawn_shares(const Eigen::VectorXd& p, std::int64_t n, dynamics::Random& random) {
  std::vector<std::int64_t> counts(static_cast<std::size_t>(p.size()));
  const Eigen::VectorXd weights = p.cwiseMax(0.0);  // rounding may leave negative shares
  multinomial(n, {weights.data(), counts.size()}, counts, random);
  Eigen::VectorXd drawn(p.size());
  for (Eigen::Index i = 0; i < p.size(); ++i)
    drawn[i] = static_cast<double>(counts[static_cast<std::size_t>(i)]) / static_cast<double>(n);
  return drawn;
}

}  // namespace gatewalk::lattice
