// SPDX-License-Identifier: MIT
#include "lattice/statistics/ensemble.h"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace gatewalk::lattice {

using Eigen::Index;
using Eigen::VectorXd;

Ensemble::Ensemble(LogDensity density, Eigen::MatrixXd walkers)
    : density_(std::move(density)), walkers_(std::move(walkers)), logs_(walkers_.cols()) {
  if (walkers_.cols() % 2 != 0 || walkers_.cols() < 2 * walkers_.rows() || walkers_.rows() == 0)
    throw std::invalid_argument("Ensemble: an even number of walkers, twice the numbers or more");
  for (Index i = 0; i < walkers_.cols(); ++i) {
    logs_[i] = density_(walkers_.col(i));
    if (!(logs_[i] > -HUGE_VAL))
      throw std::invalid_argument("Ensemble: a walker stands where the density is 0");
  }
}

void Ensemble::step(dynamics::Random& random) {
  const Index half = walkers_.cols() / 2, numbers = walkers_.rows();
  for (const Index first : {Index{0}, half})  // each half moves along lines to the other half
    for (Index i = first; i < first + half; ++i) {
      const Index other = (first == 0 ? half : 0) + static_cast<Index>(random.below(half));
      // z in [1/2, 2] with density proportional to 1 / sqrt(z): equation (9) of Goodman and Weare,
      // a = 2.
      const double root = 1.0 + random.uniform(), z = 0.5 * root * root;
      const VectorXd to = walkers_.col(other) + z * (walkers_.col(i) - walkers_.col(other));
      const double log = density_(to);
      const double gain = static_cast<double>(numbers - 1) * std::log(z) + log - logs_[i];
      if (!(std::log(random.uniform()) < gain)) continue;
      walkers_.col(i) = to;
      logs_[i] = log;
    }
}

}  // namespace gatewalk::lattice
