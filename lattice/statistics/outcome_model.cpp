// SPDX-License-Identifier: MIT
#include "lattice/statistics/outcome_model.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

namespace gatewalk::lattice {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// All exponents of `numbers` variables with a sum of at most `degree`; the constant term first.
std::vector<std::vector<int>> all_powers(Index numbers, int degree) {
  std::vector<std::vector<int>> all;
  std::vector<int> powers(static_cast<std::size_t>(numbers), 0);
  const std::function<void(std::size_t, int)> choose = [&](std::size_t number, int left) {
    if (number == powers.size()) {
      all.push_back(powers);
      return;
    }
    for (int p = 0; p <= left; ++p) {
      powers[number] = p;
      choose(number + 1, left - p);
    }
    powers[number] = 0;
  };
  choose(0, degree);
  return all;
}

/// Log probabilities (points x outcomes) from rows of terms.
MatrixXd log_chances_of(const MatrixXd& terms, const MatrixXd& coefficients) {
  MatrixXd logs(terms.rows(), coefficients.cols() + 1);
  logs.leftCols(coefficients.cols()) = terms * coefficients;
  logs.rightCols(1).setZero();
  const VectorXd most = logs.rowwise().maxCoeff();
  logs.colwise() -= most;
  const VectorXd sums = logs.array().exp().rowwise().sum().log();
  logs.colwise() -= sums;
  return logs;
}

/// Second derivatives of the negative log likelihood (parameters x parameters), outcome by outcome;
/// lower half only.
MatrixXd curvature(const MatrixXd& terms, const VectorXd& trials, const MatrixXd& chances) {
  const Index of_each = terms.cols(), outcomes = chances.cols() - 1;
  MatrixXd all(of_each * outcomes, of_each * outcomes);
  for (Index a = 0; a < outcomes; ++a)
    for (Index b = 0; b <= a; ++b) {
      VectorXd weights = -chances.col(a).cwiseProduct(chances.col(b));
      if (a == b) weights += chances.col(a);
      const MatrixXd weighted = weights.cwiseProduct(trials).asDiagonal() * terms;
      auto block = all.block(a * of_each, b * of_each, of_each, of_each);
      // Each block is symmetric; sums in the order of over_rows.
      for (Index t = 0; t < of_each; ++t) {
        const Index below = of_each - t;
        block.col(t).tail(below).noalias() =
            terms.rightCols(below).transpose().lazyProduct(weighted.col(t));
        block.row(t).tail(below) = block.col(t).tail(below).transpose();
      }
    }
  return all;
}

double log_likelihood(const MatrixXd& counts, const MatrixXd& log_chances) {
  return counts.cwiseProduct(log_chances).sum();
}

}  // namespace

Index OutcomeModel::terms(Index numbers, int degree) {
  Index all = 1;
  for (int k = 1; k <= degree; ++k) all = all * (numbers + k) / k;
  return all;
}

double lack_of_fit(double chi_squared, double degrees_of_freedom, double trials) {
  const double by_chance = degrees_of_freedom + 2.0 * std::sqrt(2.0 * degrees_of_freedom);
  return std::max(0.0, chi_squared - by_chance) / (2.0 * trials);
}

OutcomeModel::OutcomeModel(const OutcomeCounts& seen, int degree)
    : OutcomeModel(seen, degree,
                   seen.counts.colwise().sum().transpose() / std::max(1.0, seen.counts.sum())) {}

OutcomeModel::OutcomeModel(const OutcomeCounts& seen, int degree, const VectorXd& shares)
    : degree_(degree) {
  const Index points = seen.points.rows(), numbers = seen.points.cols(),
              outcomes = seen.counts.cols(), terms_of_each = terms(numbers, degree);
  if (outcomes < 2 || shares.minCoeff() <= 0.0)
    throw std::invalid_argument("OutcomeModel: two outcomes or more, each of which was seen");
  if (points <= terms_of_each)
    throw std::invalid_argument("OutcomeModel: " + std::to_string(terms_of_each) +
                                " terms need more points than " + std::to_string(points));
  powers_ = all_powers(numbers, degree);
  middle_ = seen.points.colwise().mean();
  const MatrixXd from_middle = seen.points.rowwise() - middle_.transpose();
  const Eigen::LLT<MatrixXd> spread(over_rows(from_middle, from_middle) /
                                    static_cast<double>(points));
  if (spread.info() != Eigen::Success)
    throw std::invalid_argument("OutcomeModel: the points lie in a plane");
  to_even_ = spread.matrixL().solve(MatrixXd::Identity(numbers, numbers));

  MatrixXd of_points(points, terms_of_each);
  VectorXd row(terms_of_each);
  for (Index i = 0; i < points; ++i) {
    terms_at(seen.points.row(i).transpose(), row);
    of_points.row(i) = row.transpose();
  }
  const double more = static_cast<double>(terms_of_each) / static_cast<double>(points);
  const MatrixXd counts = seen.counts.rowwise() + more * shares.transpose();
  const VectorXd trials = counts.rowwise().sum(), all = counts.colwise().sum();

  best_ = MatrixXd::Zero(terms_of_each, outcomes - 1);
  for (Index k = 0; k + 1 < outcomes; ++k) best_(0, k) = std::log(all[k] / all[outcomes - 1]);
  MatrixXd logs = log_chances_of(of_points, best_);
  double likelihood = log_likelihood(counts, logs);
  constexpr int kMostSteps = 100;
  constexpr double kEnough = 1e-6;  // of a log likelihood; far below its sampling error of 1/2
  for (int step = 0;; ++step) {
    const MatrixXd chances = logs.array().exp();
    const MatrixXd slope =
        over_rows(of_points, counts - trials.asDiagonal() * chances).leftCols(outcomes - 1);
    const Eigen::LLT<MatrixXd> bent(curvature(of_points, trials, chances));
    const VectorXd change = bent.solve(slope.reshaped());
    const double gain = change.dot(slope.reshaped());  // twice the gain of Newton's step
    if (bent.info() != Eigen::Success || !std::isfinite(gain) || step == kMostSteps)
      throw std::runtime_error("OutcomeModel: no polynomials of degree " + std::to_string(degree) +
                               " are found");
    root_ = bent.matrixL();
    if (gain < kEnough) break;
    // Newton's step, or a fraction of it that increases the likelihood.
    for (double part = 1.0;; part *= 0.5) {
      const Coefficients next = best_ + part * change.reshaped(terms_of_each, outcomes - 1);
      MatrixXd next_logs = log_chances_of(of_points, next);
      const double next_likelihood = log_likelihood(counts, next_logs);
      if (!(next_likelihood >= likelihood) && part > kEnough) continue;
      best_ = next;
      logs = std::move(next_logs);
      likelihood = next_likelihood;
      break;
    }
  }
  const auto count = static_cast<double>(parameters());
  criterion_ = 2.0 * (count - likelihood);
  const VectorXd seen_trials = seen.counts.rowwise().sum();
  const MatrixXd expected = (seen_trials.asDiagonal() * logs.array().exp().matrix())
                                .cwiseMax(std::numeric_limits<double>::min());
  chi_squared_ = (seen.counts - expected).cwiseAbs2().cwiseQuotient(expected).sum();
  degrees_of_freedom_ = static_cast<double>(points * (outcomes - 1)) - count;
  trials_ = seen_trials.sum();
}

OutcomeModel::Coefficients OutcomeModel::drawn(dynamics::Random& random) const {
  VectorXd chance(parameters());
  for (double& x : chance) x = random.normal();
  // root' y = x gives y the inverse of the curvature as covariance.
  root_.triangularView<Eigen::Lower>().transpose().solveInPlace(chance);
  return best_ + chance.reshaped(best_.rows(), best_.cols());
}

void OutcomeModel::log_chances(const Coefficients& coefficients, const VectorXd& point,
                               VectorXd& out) const {
  VectorXd row(coefficients.rows());
  terms_at(point, row);
  const Index last = coefficients.cols();
  out.resize(last + 1);
  out.head(last).noalias() = coefficients.transpose() * row;
  out[last] = 0.0;
  const double most = out.maxCoeff();
  out.array() -= most + std::log((out.array() - most).exp().sum());
}

void OutcomeModel::terms_at(const VectorXd& point, VectorXd& out) const {
  const VectorXd x = to_even_ * (point - middle_);
  for (std::size_t t = 0; t < powers_.size(); ++t) {
    double term = 1.0;
    for (std::size_t k = 0; k < powers_[t].size(); ++k)
      for (int p = 0; p < powers_[t][k]; ++p) term *= x[static_cast<Index>(k)];
    out[static_cast<Index>(t)] = term;
  }
}

}  // namespace gatewalk::lattice
