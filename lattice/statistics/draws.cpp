// SPDX-License-Identifier: MIT
#include "lattice/statistics/draws.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace gatewalk::lattice {
namespace {

using dynamics::Random;

constexpr std::int64_t kMostDrawn = std::int64_t{1} << 53;  // whole numbers that a double holds
constexpr double kFew = 10.0;  // up to this many expected successes, by inversion

/// Binomial draw by inversion: subtracts P(0), P(1), ... from a uniform number until it is used up.
/// Needs p <= 1/2 and n p < kFew.
std::int64_t counted_up(double n, double p, Random& random) {
  const double odds = p / (1.0 - p);
  const double none = std::exp(n * std::log1p(-p));
  for (;;) {
    double left = random.uniform(), chance = none;
    for (double k = 0.0; k <= n; ++k) {
      if (left <= chance) return static_cast<std::int64_t>(k);
      left -= chance;
      chance *= odds * (n - k) / (k + 1.0);
      if (chance == 0.0) break;  // rounding left a remainder that belongs to no count: draws again
    }
  }
}

/// log k! - (log sqrt(2 pi) + (k + 1/2) log(k + 1) - (k + 1)): the remainder of Stirling's formula.
double stirling_rest(double k) {
  static constexpr std::array<double, 10> kFirst{
      0.08106146679532726,  0.04134069595540929, 0.02767792568499834, 0.02079067210376509,
      0.01664469118982119,  0.01387612882307075, 0.01189670994589177, 0.01041126526197209,
      0.009255462182712733, 0.008330563433362871};
  if (k < 10.0) return kFirst[static_cast<std::size_t>(k)];
  const double x = 1.0 / ((k + 1.0) * (k + 1.0));
  return (1.0 / 12.0 - (1.0 / 360.0 - 1.0 / 1260.0 * x) * x) / (k + 1.0);
}

/// Binomial draw by transformed rejection with squeeze (BTRS; Hormann, The generation of binomial
/// random variates, J. Statist. Comput. Simul. 46, 1993). Needs p <= 1/2 and n p >= kFew.
std::int64_t by_rejection(double n, double p, Random& random) {
  const double q = 1.0 - p, sd = std::sqrt(n * p * q);
  const double b = 1.15 + 2.53 * sd, a = -0.0873 + 0.0248 * b + 0.01 * p, c = n * p + 0.5;
  const double v_r = 0.92 - 4.2 / b, alpha = (2.83 + 5.1 / b) * sd;
  const double r = p / q, m = std::floor((n + 1.0) * p);
  for (;;) {
    const double u = random.uniform() - 0.5, v = random.uniform();
    const double us = 0.5 - std::abs(u);
    const double k = std::floor((2.0 * a / us + b) * u + c);
    if (!(k >= 0.0 && k <= n)) continue;
    if (us >= 0.07 && v <= v_r) return static_cast<std::int64_t>(k);
    const double bar = (m + 0.5) * std::log((m + 1.0) / (r * (n - m + 1.0))) +
                       (n + 1.0) * std::log((n - m + 1.0) / (n - k + 1.0)) +
                       (k + 0.5) * std::log(r * (n - k + 1.0) / (k + 1.0)) + stirling_rest(m) +
                       stirling_rest(n - m) - stirling_rest(k) - stirling_rest(n - k);
    if (std::log(v * alpha / (a / (us * us) + b)) <= bar) return static_cast<std::int64_t>(k);
  }
}

}  // namespace

std::int64_t binomial(std::int64_t trials, double p, Random& random) {
  if (trials < 0 || trials > kMostDrawn || !(p >= 0.0 && p <= 1.0))
    throw std::invalid_argument("binomial: trials " + std::to_string(trials) +
                                " must lie in [0, 2^53], p " + fmt::format("{:f}", p) +
                                " in [0, 1]");
  if (trials == 0 || p == 0.0) return 0;
  if (p == 1.0) return trials;
  if (p > 0.5) return trials - binomial(trials, 1.0 - p, random);
  const auto n = static_cast<double>(trials);
  return n * p < kFew ? counted_up(n, p, random) : by_rejection(n, p, random);
}

void multinomial(std::int64_t trials, std::span<const double> weights,
                 std::span<std::int64_t> counts, Random& random) {
  if (weights.size() != counts.size())
    throw std::invalid_argument("multinomial: weights and counts differ in length");
  // Sums of the remaining weights, from the last outcome backwards, so that nothing cancels.
  std::vector<double> left(weights.size() + 1);
  for (std::size_t i = weights.size(); i-- > 0;) {
    if (!(weights[i] >= 0.0 && std::isfinite(weights[i])))
      throw std::invalid_argument("multinomial: weights must be >= 0 and finite");
    left[i] = left[i + 1] + weights[i];
  }
  if (!(left.front() > 0.0)) throw std::invalid_argument("multinomial: all weights are 0");
  for (std::size_t i = 0; i < weights.size(); ++i) {
    counts[i] = trials > 0 && weights[i] > 0.0
                    ? binomial(trials, std::min(1.0, weights[i] / left[i]), random)
                    : 0;
    trials -= counts[i];
  }
}

double gamma(double shape, Random& random) {
  // A draw with a larger shape, times a power of a uniform number.
  if (shape < 1.0) return gamma(shape + 1.0, random) * std::pow(random.uniform(), 1.0 / shape);
  const double d = shape - 1.0 / 3.0, c = 1.0 / std::sqrt(9.0 * d);
  for (;;) {
    const double x = random.normal(), root = 1.0 + c * x;
    if (root <= 0.0) continue;
    const double v = root * root * root;
    if (std::log(random.uniform()) < 0.5 * x * x + d - d * v + d * std::log(v)) return d * v;
  }
}

Eigen::VectorXd random_signs(Eigen::Index count, dynamics::Random& random) {
  Eigen::VectorXd signs(count);
  for (double& sign : signs) sign = random.uniform() < 0.5 ? -1.0 : 1.0;
  return signs;
}

}  // namespace gatewalk::lattice
