// SPDX-License-Identifier: MIT
#include "lattice/statistics/outcome_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "lattice/statistics/draws.h"
#include "lattice/statistics/ensemble.h"

namespace gatewalk::lattice {
namespace {

using dynamics::Purpose;
using dynamics::Random;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Probabilities of three outcomes at a point (x, y); their logs are polynomials of degree 2.
VectorXd true_chances(const VectorXd& at, double third_degree = 0.0) {
  const double x = at[0], y = at[1];
  VectorXd chances{{std::exp(1.0 - 2.0 * x + y * y), std::exp(0.5 * x * y - y),
                    std::exp(third_degree * (2.0 * x - 1.0) * (x * x - x))}};
  return chances / chances.sum();
}

OutcomeCounts counted(Index points, std::int64_t trials, double third_degree, Random& random) {
  OutcomeCounts seen{MatrixXd(points, 2), MatrixXd(points, 3)};
  std::vector<std::int64_t> counts(3);
  for (Index i = 0; i < points; ++i) {
    seen.points.row(i) << random.uniform(), random.uniform();
    const VectorXd chances = true_chances(seen.points.row(i).transpose(), third_degree);
    multinomial(trials, {chances.data(), 3}, counts, random);
    for (Index k = 0; k < 3; ++k)
      seen.counts(i, k) = static_cast<double>(counts[static_cast<std::size_t>(k)]);
  }
  return seen;
}

// With this many rows, the bits of Eigen's own product depend on the processor's caches.
TEST(OutcomeModel, SumsOverRowsHaveTheOrderOfTheRows) {
  const Eigen::MatrixXd a = Eigen::MatrixXd::Random(20000, 3);
  const Eigen::MatrixXd product = over_rows(a, a);
  for (Eigen::Index i = 0; i < 3; ++i)
    for (Eigen::Index j = 0; j < 3; ++j) {
      double sum = 0.0;
      for (Eigen::Index row = 0; row < a.rows(); ++row) sum += a(row, i) * a(row, j);
      EXPECT_EQ(product(i, j), sum);
    }
}

TEST(OutcomeModel, FindsChancesThatItCanSay) {
  Random random(Purpose::fit, {1, 0, 0});
  const OutcomeModel model(counted(60, 20'000, 0.0, random), 2);
  EXPECT_EQ(model.parameters(), 12);
  const VectorXd at{{0.3, 0.8}};
  VectorXd logs;
  model.log_chances(model.best(), at, logs);
  const VectorXd chances = true_chances(at);
  EXPECT_NEAR(logs.array().exp().sum(), 1.0, 1e-14);
  // Drawn coefficients are as far from the estimated ones as these are from the truth: the squared
  // distance, relative to the variance of each probability, is 1 on average.
  constexpr int kDraws = 400;
  MatrixXd drawn(kDraws, 3);
  for (Index i = 0; i < kDraws; ++i) {
    VectorXd one;
    model.log_chances(model.drawn(random), at, one);
    drawn.row(i) = one.array().exp().matrix().transpose();
  }
  for (Index k = 0; k < 3; ++k) {
    const double mean = drawn.col(k).mean();
    const double sd = std::sqrt((drawn.col(k).array() - mean).square().sum() / (kDraws - 1));
    EXPECT_LT(sd, 0.003);
    EXPECT_LT(std::abs(std::exp(logs[k]) - chances[k]), 3.5 * sd) << k;
  }
  // Chi-squared has 60 * 2 - 12 degrees of freedom; minus these, its standard deviation is 15.
  EXPECT_LT(model.lack_of_fit() * 2.0 * 60 * 20'000, 60.0);
}

TEST(OutcomeModel, CoversTheTruthAsOftenAsItSays) {
  const VectorXd at{{0.6, 0.4}};
  const double truth = std::log(true_chances(at)[0]);
  int within = 0;
  constexpr int kModels = 200;
  for (int m = 0; m < kModels; ++m) {
    Random random(Purpose::fit, {2, 0, static_cast<std::uint64_t>(m)});
    const OutcomeModel model(counted(20, 50, 0.0, random), 2);
    std::vector<double> drawn;
    for (int i = 0; i < 200; ++i) {
      VectorXd logs;
      model.log_chances(model.drawn(random), at, logs);
      drawn.push_back(logs[0]);
    }
    std::sort(drawn.begin(), drawn.end());
    within += drawn[5] <= truth && truth <= drawn[194];
  }
  EXPECT_GE(within, 180);  // 190 expected; 4 standard deviations would be 178
  EXPECT_LE(within, 200);
}

TEST(OutcomeModel, SaysWhatItCannotSay) {
  Random random(Purpose::fit, {3, 0, 0});
  const OutcomeCounts seen = counted(60, 20'000, 20.0, random);
  const OutcomeModel two(seen, 2), three(seen, 3);
  EXPECT_GT(two.lack_of_fit(), 1e-4);
  EXPECT_LT(three.lack_of_fit(), 1e-4);
  EXPECT_LT(three.criterion(), two.criterion());
  EXPECT_EQ(OutcomeModel::terms(4, 3), 35);
}

TEST(OutcomeModel, RefusesWhatItCannotLearnFrom) {
  Random random(Purpose::fit, {4, 0, 0});
  OutcomeCounts seen = counted(6, 10, 0.0, random);
  EXPECT_THROW(OutcomeModel(seen, 2), std::invalid_argument);  // six terms
  seen.counts.col(1).setZero();
  EXPECT_THROW(OutcomeModel(seen, 1), std::invalid_argument);
  seen = counted(30, 10, 0.0, random);
  seen.points.col(1) = seen.points.col(0);
  EXPECT_THROW(OutcomeModel(seen, 1), std::invalid_argument);
}

TEST(Ensemble, DrawsFromTheDensity) {
  // Normal, with correlation 0.9 and a wall: x > 0.
  const auto density = [](const VectorXd& at) {
    const double x = at[0], y = at[1];
    return x <= 0.0 ? -HUGE_VAL : -(x * x - 2.0 * 0.9 * x * y + y * y) / (2.0 * (1.0 - 0.81));
  };
  Random random(Purpose::fit, {5, 0, 0});
  MatrixXd from(2, 32);
  for (Index i = 0; i < 32; ++i) from.col(i) << 1.0 + random.uniform(), random.uniform();
  Ensemble walk(density, from);
  double sum_x = 0.0, sum_y = 0.0, sum_xx = 0.0, n = 0.0;
  for (int step = 0; step < 5000; ++step) {
    walk.step(random);
    if (step < 200) continue;
    for (const auto at : walk.walkers().colwise()) {
      ASSERT_GT(at[0], 0.0);
      sum_x += at[0];
      sum_y += at[1];
      sum_xx += at[0] * at[0];
      n += 1.0;
    }
  }
  // Half a normal distribution: mean sqrt(2 / pi), mean square 1.
  EXPECT_NEAR(sum_x / n, 0.7979, 0.02);
  EXPECT_NEAR(sum_y / n, 0.9 * 0.7979, 0.03);
  EXPECT_NEAR(sum_xx / n, 1.0, 0.04);
  EXPECT_EQ(walk.log_densities()[3], density(walk.walkers().col(3)));
}

TEST(Ensemble, RefusesWalkersThatCannotWalk) {
  const auto flat = [](const VectorXd& at) { return at[0] < 1.0 ? 0.0 : -HUGE_VAL; };
  EXPECT_THROW(Ensemble(flat, MatrixXd::Zero(2, 3)), std::invalid_argument);
  EXPECT_THROW(Ensemble(flat, MatrixXd::Zero(2, 2)), std::invalid_argument);
  EXPECT_THROW(Ensemble(flat, MatrixXd::Ones(2, 4)), std::invalid_argument);
}

}  // namespace
}  // namespace gatewalk::lattice
