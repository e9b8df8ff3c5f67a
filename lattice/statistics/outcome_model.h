// SPDX-License-Identifier: MIT
#pragma once
/// Chances of several outcomes as a smooth function of a few numbers, from counts at many points:
/// multinomial logistic regression on polynomials (Agresti 2013, Categorical Data Analysis, ch. 8).

#include <Eigen/Core>
#include <vector>

#include "dynamics/base/random.h"

namespace gatewalk::lattice {

/// a' b, each sum in the order of the rows: Eigen's own product adds in blocks whose size is that
/// of the processor's caches, which the last digits show. For matrices of many more rows than
/// columns.
[[nodiscard]] inline Eigen::MatrixXd over_rows(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.transpose().lazyProduct(b);
}

/// What was counted where.
struct OutcomeCounts {
  Eigen::MatrixXd points;  // (points x numbers), each with the same scale
  Eigen::MatrixXd counts;  // (points x outcomes)
};

/// Relative entropy (nats a trial) of the chances at some points from a model's: Pearson's
/// chi-squared by 2 trials, less what chance makes in 97 of 100 models that are right.
[[nodiscard]] double lack_of_fit(double chi_squared, double degrees_of_freedom, double trials);

class OutcomeModel {
 public:
  /// (terms x outcomes - 1): the log of each chance over that of the last outcome.
  using Coefficients = Eigen::MatrixXd;

  /// Of greatest likelihood, where as many trials as there are terms are added, the same at all
  /// points, ended as all do: no chance is nothing because a few points saw none. Throws
  /// std::invalid_argument for fewer points than terms, and for fewer than two outcomes or one that
  /// nobody had; std::runtime_error where none is found.
  OutcomeModel(const OutcomeCounts& seen, int degree);
  /// The same, where these points are a part of all: added trials end by these shares.
  OutcomeModel(const OutcomeCounts& seen, int degree, const Eigen::VectorXd& shares);

  /// Terms of a polynomial of so many numbers.
  [[nodiscard]] static Eigen::Index terms(Eigen::Index numbers, int degree);
  [[nodiscard]] int degree() const { return degree_; }
  [[nodiscard]] Eigen::Index parameters() const { return best_.size(); }
  /// Akaike's, of which the least is best: -2 log likelihood + 2 parameters.
  [[nodiscard]] double criterion() const { return criterion_; }
  [[nodiscard]] double lack_of_fit() const {
    return lattice::lack_of_fit(chi_squared_, degrees_of_freedom_, trials_);
  }
  [[nodiscard]] double chi_squared() const { return chi_squared_; }
  [[nodiscard]] double degrees_of_freedom() const { return degrees_of_freedom_; }
  [[nodiscard]] const Coefficients& best() const { return best_; }
  /// As uncertain as the counts leave them: normal, with the likelihood's curvature.
  [[nodiscard]] Coefficients drawn(dynamics::Random& random) const;
  /// Logs of the chances (outcomes) at a point (numbers).
  void log_chances(const Coefficients& coefficients, const Eigen::VectorXd& point,
                   Eigen::VectorXd& out) const;

 private:
  void terms_at(const Eigen::VectorXd& point, Eigen::VectorXd& out) const;

  int degree_;
  std::vector<std::vector<int>> powers_;  // by term and number
  Eigen::VectorXd middle_;                // of the points
  Eigen::MatrixXd to_even_;               // (numbers x numbers): makes them uncorrelated
  Coefficients best_;
  Eigen::MatrixXd root_;  // lower; root root' is the curvature
  double criterion_ = 0.0, chi_squared_ = 0.0, degrees_of_freedom_ = 0.0, trials_ = 0.0;
};

}  // namespace gatewalk::lattice
