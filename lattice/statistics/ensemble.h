// SPDX-License-Identifier: MIT
#pragma once
/// Draws from any density of a few numbers: walkers that stretch towards and away from each other,
/// which needs no tuning and does not mind correlated numbers (Goodman and Weare 2010, "Ensemble
/// samplers with affine invariance").

#include <Eigen/Core>
#include <functional>

#include "dynamics/base/random.h"

namespace gatewalk::lattice {

/// The log of a density, up to a constant; minus infinity where there is none.
using LogDensity = std::function<double(const Eigen::VectorXd&)>;

class Ensemble {
 public:
  /// Walkers (numbers x walkers), an even number of them, at least twice as many as numbers, where
  /// the density is not 0. Throws std::invalid_argument for others.
  Ensemble(LogDensity density, Eigen::MatrixXd walkers);
  /// Moves each walker once, or leaves it where it is.
  void step(dynamics::Random& random);
  [[nodiscard]] const Eigen::MatrixXd& walkers() const { return walkers_; }
  [[nodiscard]] const Eigen::VectorXd& log_densities() const { return logs_; }

 private:
  LogDensity density_;
  Eigen::MatrixXd walkers_;
  Eigen::VectorXd logs_;
};

}  // namespace gatewalk::lattice
