// SPDX-License-Identifier: MIT
#include "lattice/statistics/draws.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace gatewalk::lattice {
namespace {

using dynamics::Purpose;
using dynamics::Random;

Random random(std::uint64_t trial) { return {Purpose::resampling, {7, 3, trial}}; }

// Kolmogorov's distance between 20 000 draws and the exact distribution function, at its 0.1 %
// point (for a discrete distribution the true level is lower). Covers both samplers, both sides of
// p = 1/2, and counts from a few to 10^12.
TEST(Binomial, HasItsDistribution) {
  constexpr int kDraws = 20'000;
  struct Case {
    std::int64_t n;
    double p;
  };
  std::uint64_t trial = 0;
  for (const auto& [n, p] : {Case{1, 0.3},
                             {10, 0.5},
                             {19, 0.5},
                             {20, 0.5},
                             {21, 0.5},
                             {100, 0.02},
                             {100, 0.0999},
                             {100, 0.1},
                             {100, 0.45},
                             {100, 0.97},
                             {1000, 0.012},
                             {10'000, 0.3},
                             {1'000'000, 1e-6},
                             {1'000'000, 0.2},
                             {1'000'000'000, 0.7},
                             {1'000'000'000'000, 1e-11},
                             {1'000'000'000'000, 1e-4}}) {
    SCOPED_TRACE(testing::Message() << "n " << n << ", p " << p);
    Random r = random(++trial);
    std::vector<std::int64_t> drawn(kDraws);
    double sum = 0.0, squares = 0.0;
    const double mean = static_cast<double>(n) * p, variance = mean * (1 - p);
    for (auto& k : drawn) {
      k = binomial(n, p, r);
      ASSERT_GE(k, 0);
      ASSERT_LE(k, n);
      const double z = (static_cast<double>(k) - mean) / std::sqrt(variance);
      sum += z;
      squares += z * z;
    }
    std::sort(drawn.begin(), drawn.end());
    const boost::math::binomial exact(static_cast<double>(n), p);
    double worst = 0.0;
    for (int i = 0; i < kDraws; ++i)
      if (i + 1 == kDraws || drawn[i + 1] != drawn[i])
        worst = std::max(worst,
                         std::abs((i + 1.0) / kDraws - cdf(exact, static_cast<double>(drawn[i]))));
    EXPECT_LT(worst, 1.95 / std::sqrt(kDraws));
    EXPECT_LT(std::abs(sum), 5 * std::sqrt(kDraws));
    const double fourth = 2.0 + 1.0 / variance;  // upper bound of the fourth moment of z, minus 1
    EXPECT_NEAR(squares / kDraws, 1.0, 5 * std::sqrt(fourth / kDraws));
  }
}

TEST(Binomial, EdgesAndRefusals) {
  Random r = random(1);
  EXPECT_EQ(binomial(0, 0.5, r), 0);
  EXPECT_EQ(binomial(5, 0.0, r), 0);
  EXPECT_EQ(binomial(5, 1.0, r), 5);
  for (int i = 0; i < 1000; ++i) EXPECT_LE(binomial(3, 5e-324, r), 0);
  EXPECT_THROW((void)binomial(-1, 0.5, r), std::invalid_argument);
  EXPECT_THROW((void)binomial((std::int64_t{1} << 53) + 1, 0.5, r), std::invalid_argument);
  EXPECT_THROW((void)binomial(5, -0.1, r), std::invalid_argument);
  EXPECT_THROW((void)binomial(5, std::nan(""), r), std::invalid_argument);
}

TEST(Binomial, SameStreamSameDraws) {
  Random a = random(4), b = random(4), c = random(5);
  bool differs = false;
  for (int i = 0; i < 100; ++i) {
    const std::int64_t k = binomial(1000, 0.3, a);
    EXPECT_EQ(k, binomial(1000, 0.3, b));
    differs = differs || k != binomial(1000, 0.3, c);
  }
  EXPECT_TRUE(differs);
}

// The covariance of two counts is -n p q, and all counts sum to the number of trials.
TEST(Multinomial, SharesOutAllTrials) {
  const std::array<double, 5> weights{3.0, 0.0, 1.0, 2.0, 0.0};
  constexpr int kDraws = 20'000;
  constexpr std::int64_t kTrials = 60;
  std::array<double, 5> sum{};
  double products = 0.0;
  Random r = random(9);
  for (int i = 0; i < kDraws; ++i) {
    std::array<std::int64_t, 5> counts{};
    multinomial(kTrials, weights, counts, r);
    ASSERT_EQ(std::accumulate(counts.begin(), counts.end(), std::int64_t{0}), kTrials);
    ASSERT_EQ(counts[1] + counts[4], 0);
    for (std::size_t k = 0; k < 5; ++k) sum[k] += static_cast<double>(counts[k]);
    products += (static_cast<double>(counts[0]) - 30) * (static_cast<double>(counts[3]) - 20);
  }
  for (const auto& [k, p] : {std::pair<std::size_t, double>{0, 0.5}, {2, 1 / 6.0}, {3, 1 / 3.0}})
    EXPECT_NEAR(sum[k] / kDraws, 60 * p, 5 * std::sqrt(60 * p * (1 - p) / kDraws));
  EXPECT_NEAR(products / kDraws, -60.0 * 0.5 / 3.0,
              5 * 16.0 / std::sqrt(kDraws));  // sd of a product about 15
  std::array<std::int64_t, 5> counts{};
  EXPECT_THROW(multinomial(3, std::array<double, 5>{}, counts, r), std::invalid_argument);
  EXPECT_THROW(multinomial(3, std::array<double, 2>{1, 1}, counts, r), std::invalid_argument);
  EXPECT_THROW(multinomial(3, std::array<double, 5>{1, -1, 1, 1, 1}, counts, r),
               std::invalid_argument);
}

// Kolmogorov's distance between 20 000 draws and the exact distribution function, at its 0.1 %
// point.
TEST(Gamma, HasItsDistribution) {
  constexpr int kDraws = 20'000;
  std::uint64_t trial = 1000;
  for (const double shape : {0.25, 0.9, 1.0, 3.5, 100.0, 1e6}) {
    SCOPED_TRACE(shape);
    Random r = random(++trial);
    std::vector<double> drawn(kDraws);
    for (double& x : drawn) x = gamma(shape, r);
    std::sort(drawn.begin(), drawn.end());
    double distance = 0.0;
    for (int k = 0; k < kDraws; ++k) {
      const double below = boost::math::gamma_p(shape, drawn[static_cast<std::size_t>(k)]);
      distance = std::max({distance, (k + 1.0) / kDraws - below, below - 1.0 * k / kDraws});
    }
    EXPECT_LT(distance, 1.95 / std::sqrt(kDraws));
  }
}

}  // namespace
}  // namespace gatewalk::lattice
