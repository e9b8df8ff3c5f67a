// SPDX-License-Identifier: MIT
#pragma once
/// Outcome probabilities as a smooth function of a few numbers, fitted to counts at many points:
/// multinomial logistic regression on polynomials (Agresti 2013, Categorical Data Analysis, ch. 8).

#include <Eigen/Core>
#include <vector>

#include "dynamics/base/random.h"

namespace gatewalk::lattice {

/// a' b, with each sum in the order of the rows. Eigen's own product adds in blocks that depend on
/// the processor's cache sizes, which changes the last digits. For matrices with many more rows
/// than columns.
[[nodiscard]] inline Eigen::MatrixXd over_rows(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.transpose().lazyProduct(b);
}

/// Counts of outcomes at points.
struct OutcomeCounts {
  Eigen::MatrixXd points;  // (points x numbers), all numbers on the same scale
  Eigen::MatrixXd counts;  // (points x outcomes)
};

/// Lack of fit of a model, in nats per trial: Pearson's chi-squared / (2 trials), minus the value
/// that 97 of 100 correct models do not exceed by chance.
[[nodiscard]] double lack_of_fit(double chi_squared, double degrees_of_freedom, double trials);

/// A polynomial model of outcome probabilities, fitted to counts.
class OutcomeModel {
 public:
  /// (terms x outcomes - 1): log of each probability over that of the last outcome.
  using Coefficients = Eigen::MatrixXd;

  /// Fits by maximum likelihood. Adds as many pseudo-trials as there are terms, spread evenly over
  /// the points with the overall shares of outcomes, so that no probability becomes 0 because few
  /// points showed none. Throws std::invalid_argument for no more points than terms, fewer than two
  /// outcomes, or an outcome that never occurred; std::runtime_error if the fit fails.
  OutcomeModel(const OutcomeCounts& seen, int degree);
  /// Fits to a part of the points; the pseudo-trials have these shares of outcomes.
  OutcomeModel(const OutcomeCounts& seen, int degree, const Eigen::VectorXd& shares);

  /// Number of terms of a polynomial in this number of variables.
  [[nodiscard]] static Eigen::Index terms(Eigen::Index numbers, int degree);
  [[nodiscard]] int degree() const { return degree_; }
  [[nodiscard]] Eigen::Index parameters() const { return best_.size(); }
  /// Akaike's information criterion, smaller is better: -2 log likelihood + 2 parameters.
  [[nodiscard]] double criterion() const { return criterion_; }
  [[nodiscard]] double lack_of_fit() const {
    return lattice::lack_of_fit(chi_squared_, degrees_of_freedom_, trials_);
  }
  [[nodiscard]] double chi_squared() const { return chi_squared_; }
  [[nodiscard]] double degrees_of_freedom() const { return degrees_of_freedom_; }
  [[nodiscard]] const Coefficients& best() const { return best_; }
  /// Coefficients drawn from their sampling distribution: normal, with the likelihood's curvature.
  [[nodiscard]] Coefficients drawn(dynamics::Random& random) const;
  /// Logs of the outcomes' probabilities at a point (numbers).
  void log_chances(const Coefficients& coefficients, const Eigen::VectorXd& point,
                   Eigen::VectorXd& out) const;

 private:
  void terms_at(const Eigen::VectorXd& point, Eigen::VectorXd& out) const;

  int degree_;
  std::vector<std::vector<int>> powers_;  // by term and number
  Eigen::VectorXd middle_;                // mean of the points
  Eigen::MatrixXd to_even_;               // (numbers x numbers) makes the numbers uncorrelated
  Coefficients best_;
  Eigen::MatrixXd root_;  // lower triangle; root root' is the curvature
  double criterion_ = 0.0, chi_squared_ = 0.0, degrees_of_freedom_ = 0.0, trials_ = 0.0;
};

}  // namespace gatewalk::lattice
