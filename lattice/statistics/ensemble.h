// SPDX-License-Identifier: MIT
#pragma once
/// An ensemble sampler for any density of a few numbers (Goodman and Weare 2010, "Ensemble samplers
/// with affine invariance"). Walkers stretch towards and away from each other, which needs no
/// tuning and handles correlated numbers.

#include <Eigen/Core>
#include <functional>

#include "dynamics/base/random.h"

namespace gatewalk::lattice {

/// The log of a density, up to a constant; minus infinity where the density is 0.
using LogDensity = std::function<double(const Eigen::VectorXd&)>;

/// Walkers that sample a density.
class Ensemble {
 public:
  /// `walkers` (numbers x walkers): an even number of walkers, at least twice the number of
  /// numbers, all where the density is not 0. Throws std::invalid_argument otherwise.
  Ensemble(LogDensity density, Eigen::MatrixXd walkers);
  /// Proposes one move for each walker, and accepts or rejects it.
  void step(dynamics::Random& random);
  [[nodiscard]] const Eigen::MatrixXd& walkers() const { return walkers_; }
  [[nodiscard]] const Eigen::VectorXd& log_densities() const { return logs_; }

 private:
  LogDensity density_;
  Eigen::MatrixXd walkers_;
  Eigen::VectorXd logs_;
};

}  // namespace gatewalk::lattice
