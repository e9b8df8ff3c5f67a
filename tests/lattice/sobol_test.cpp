// SPDX-License-Identifier: MIT
#include "lattice/statistics/sobol.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>

#include "dynamics/base/random.h"

namespace gatewalk::lattice {
namespace {

using Outcome = std::function<double(const std::vector<double>& at)>;

/// `noise`: standard deviation of each answer.
SobolIndices indices_of(const Outcome& outcome, int numbers, int rows, std::uint64_t seed,
                        double noise = 0.0) {
  const IndexDesign design(numbers, seed);
  dynamics::Random random(dynamics::Purpose::comparison, {seed});
  std::vector<double> one, other;
  for (std::int64_t i = 0; i < kTrialGroups * rows * design.points_of_row(); ++i) {
    const double answer = outcome(design.point(i));
    one.push_back(answer + noise * random.normal());
    other.push_back(answer + noise * random.normal());
  }
  return sobol_indices(design, one, other);
}

/// Ishigami and Homma 1990, with a = 7 and b = 0.1.
double ishigami(const std::vector<double>& at) {
  const auto x = [&](std::size_t k) { return std::numbers::pi * (2.0 * at[k] - 1.0); };
  return std::sin(x(0)) + 7.0 * std::pow(std::sin(x(1)), 2.0) +
         0.1 * std::pow(x(2), 4.0) * std::sin(x(0));
}
struct Known {
  double mean, variance;
  std::vector<double> first, total;
};
Known known_of_ishigami() {
  const double pi4 = std::pow(std::numbers::pi, 4.0), one = 0.5 * std::pow(1.0 + pi4 / 50.0, 2.0),
               two = 49.0 / 8.0, both = pi4 * pi4 * 0.01 * 8.0 / 225.0, v = one + two + both;
  return {3.5, v, {one / v, two / v, 0.0}, {(one + both) / v, two / v, both / v}};
}

/// Sobol's g-function.
const std::vector<double> kG = {0.0, 1.0, 4.5, 9.0};
double g_function(const std::vector<double>& at) {
  double product = 1.0;
  for (std::size_t k = 0; k < at.size(); ++k)
    product *= (std::abs(4.0 * at[k] - 2.0) + kG[k]) / (1.0 + kG[k]);
  return product;
}
Known known_of_g() {
  std::vector<double> own;
  double with = 1.0;
  for (const double a : kG) {
    own.push_back(1.0 / (3.0 * (1.0 + a) * (1.0 + a)));
    with *= 1.0 + own.back();
  }
  Known known{1.0, with - 1.0, {}, {}};
  for (const double v : own) {
    known.first.push_back(v / known.variance);
    known.total.push_back(v * with / (1.0 + v) / known.variance);
  }
  return known;
}

struct Held {
  int inside = 0, of = 0;
  void add(const Mean95& found, double truth) {
    inside += found.interval[0] <= truth && truth <= found.interval[1];
    ++of;
  }
};
Held held(const Outcome& outcome, const Known& known, int rows, double noise) {
  Held held;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const SobolIndices found =
        indices_of(outcome, static_cast<int>(known.first.size()), rows, seed, noise);
    held.add(found.mean, known.mean);
    held.add(found.variance, known.variance);
    for (std::size_t k = 0; k < known.first.size(); ++k) {
      held.add(found.first[k], known.first[k]);
      held.add(found.total[k], known.total[k]);
    }
  }
  return held;
}

TEST(Sobol, IndicesOfKnownFunctions) {
  for (const auto& [outcome, known] :
       {std::pair<Outcome, Known>{ishigami, known_of_ishigami()}, {g_function, known_of_g()}}) {
    const SobolIndices found = indices_of(outcome, static_cast<int>(known.first.size()), 1024, 1);
    EXPECT_NEAR(found.mean.mean, known.mean, 0.002);
    EXPECT_NEAR(found.variance.mean, known.variance, 0.01 * known.variance);
    EXPECT_EQ(found.noise, 0.0);
    for (std::size_t k = 0; k < known.first.size(); ++k) {
      EXPECT_NEAR(found.first[k].mean, known.first[k], 0.02) << k;
      EXPECT_NEAR(found.total[k].mean, known.total[k], 0.02) << k;
      EXPECT_LT(found.total[k].interval[1] - found.total[k].interval[0], 0.1) << k;
    }
  }
}

TEST(Sobol, IntervalsHold) {
  for (const double noise : {0.0, 1.0}) {  // more than the g-function's own spread
    const Held i = held(ishigami, known_of_ishigami(), 64, noise),
               g = held(g_function, known_of_g(), 64, noise);
    RecordProperty("ishigami", i.inside), RecordProperty("g", g.inside);
    EXPECT_GE(i.inside, i.of * 93 / 100) << noise;
    EXPECT_GE(g.inside, g.of * 93 / 100) << noise;
    EXPECT_LE(i.inside, i.of * 98 / 100) << noise;
    EXPECT_LE(g.inside, g.of * 98 / 100) << noise;
  }
}

TEST(Sobol, NoiseIsNoVariance) {
  const SobolIndices found = indices_of([](const auto&) { return 0.5; }, 2, 64, 3, 0.2);
  EXPECT_NEAR(found.noise, 0.04, 0.002);
  EXPECT_LT(found.variance.interval[0], 0.0);
  EXPECT_TRUE(std::isnan(found.first[0].mean));
  EXPECT_TRUE(std::isnan(found.total[1].interval[0]));
}

TEST(Sobol, OfAnswersThatAreAllAlikeNothingIsKnown) {
  const SobolIndices found = indices_of([](const auto&) { return 0.0; }, 2, 16, 1);
  EXPECT_EQ(found.mean.mean, 0.0);
  EXPECT_TRUE(std::isnan(found.mean.interval[0]));
  EXPECT_TRUE(std::isnan(found.first[1].mean));
}

TEST(Sobol, ShapesAreChecked) {
  EXPECT_THROW(IndexDesign(0, 1), std::invalid_argument);
  EXPECT_THROW(IndexDesign(kMostVaried + 1, 1), std::invalid_argument);
  const IndexDesign design(2, 1);
  for (const std::size_t size : {0, 4, 30, 96})
    EXPECT_THROW((void)sobol_indices(design, std::vector<double>(size), std::vector<double>(size)),
                 std::invalid_argument)
        << size;
  EXPECT_THROW((void)sobol_indices(design, std::vector<double>(32), std::vector<double>(64)),
               std::invalid_argument);
}

}  // namespace
}  // namespace gatewalk::lattice
