// SPDX-License-Identifier: MIT
#include "dynamics/base/points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/random/sobol.hpp>
#include <cmath>
#include <numeric>
#include <vector>

#include "dynamics/disc/random_force.h"

namespace gatewalk::dynamics {
namespace {

Random stream(std::uint64_t trial) { return Random(Purpose::points, {3, 1, trial}); }

std::vector<Point> scrambled(std::uint64_t trial, std::uint32_t first, std::uint32_t count) {
  Random random = stream(trial);
  const ScrambledPoints points(random);
  std::vector<Point> all;
  for (std::uint32_t i = first; i < first + count; ++i) all.push_back(points(i));
  return all;
}

// Any 2^k points that begin at a multiple of 2^k have one point in each of 2^k intervals of every
// coordinate.
TEST(Points, EachCoordinateIsStratified) {
  for (const std::uint32_t first : {0U, 256U, 1U << 20})
    for (std::size_t axis = 0; axis < kPointDimensions; ++axis) {
      std::vector<int> in(256);
      for (const Point& p : scrambled(7, first, 256)) ++in[static_cast<std::size_t>(p[axis] * 256)];
      EXPECT_TRUE(std::all_of(in.begin(), in.end(), [](int n) { return n == 1; })) << axis;
    }
}

/// The numbers of points in each of 8 x 8 boxes of two coordinates, sorted.
std::vector<int> boxes(const std::vector<Point>& points, std::size_t a, std::size_t b) {
  std::vector<int> in(64);
  for (const Point& p : points)
    ++in[static_cast<std::size_t>(p[a] * 8) * 8 + static_cast<std::size_t>(p[b] * 8)];
  std::sort(in.begin(), in.end());
  return in;
}

// A scramble moves whole boxes: the sorted numbers of points are those of the plain sequence, which
// Boost.Random has from its second point on.
TEST(Points, AreThoseOfSobol) {
  constexpr std::uint32_t kCount = 128;
  boost::random::sobol sobol(kPointDimensions);
  std::vector<Point> plain(1);
  while (plain.size() < kCount) {
    Point& p = plain.emplace_back();
    for (double& x : p) x = std::ldexp(static_cast<double>(sobol()), -64);
  }
  const auto ours = scrambled(1, 0, kCount);
  for (std::size_t a = 0; a < kPointDimensions; ++a)
    for (std::size_t b = a + 1; b < kPointDimensions; ++b)
      EXPECT_EQ(boxes(ours, a, b), boxes(plain, a, b)) << a << " " << b;
}

// Over scrambles each point is uniform, and so is each pair of points within its restriction.
TEST(Points, EachIsUniform) {
  constexpr int kScrambles = 4000;
  for (const std::uint32_t number : {0U, 5U, 1000U}) {
    std::vector<int> in(10);
    for (std::uint64_t s = 0; s < kScrambles; ++s) {
      const Point point = scrambled(s, number, 1).front();
      for (const double x : point) {
        EXPECT_GT(x, 0.0);
        EXPECT_LT(x, 1.0);
        ++in[static_cast<std::size_t>(x * 10)];
      }
    }
    double chi_squared = 0.0;
    const double expected = kScrambles * kPointDimensions / 10.0;
    for (const int n : in) chi_squared += (n - expected) * (n - expected) / expected;
    EXPECT_LT(chi_squared, 27.9) << number;  // 9 degrees of freedom, 0.999
  }
}

// The mean of a smooth function over the points has far less variance than over as many random
// numbers.
TEST(Points, AMeanOverThemHasLessVariance) {
  double squares = 0.0;
  constexpr int kScrambles = 50, kCount = 256;
  for (std::uint64_t s = 0; s < kScrambles; ++s) {
    double mean = 0.0;
    for (const Point& p : scrambled(s, 0, kCount))
      mean += std::accumulate(p.begin(), p.end(), -0.5 * kPointDimensions) / kCount;
    squares += mean * mean / kScrambles;
  }
  EXPECT_LT(squares, 0.01 * kPointDimensions / 12.0 / kCount);
}

Forces unit_force() {
  Forces forces;
  forces.random = 1.0;
  return forces;
}

/// The next draws of a force.
std::vector<double> draws(RandomForce& force, std::size_t count) {
  std::vector<double> all;
  while (all.size() < count) {
    all.push_back(force.value());
    force.pass(force.left());
  }
  return all;
}

TEST(LaidForce, HasTheModesOfItsPoint) {
  const Point point{0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8};
  const auto wanted = normals_of(point);
  for (const int block : {1, 4, 32}) {
    RandomForce force(unit_force(), stream(5));
    force.lay(point, block);
    const auto x = draws(force, kSlowBlocks * static_cast<std::size_t>(block));
    for (std::size_t m = 0; m < kPointDimensions; ++m) {
      double mode = 0.0;
      for (std::size_t i = 0; i < x.size(); ++i)
        mode += x[i] * std::cos(std::numbers::pi * static_cast<double>(m) *
                                (static_cast<double>(i / static_cast<std::size_t>(block)) + 0.5) /
                                static_cast<double>(kSlowBlocks));
      mode *= std::sqrt((m == 0 ? 1.0 : 2.0) / static_cast<double>(x.size()));
      EXPECT_NEAR(mode, wanted[m], 1e-12) << block << " " << m;
    }
  }
}

TEST(LaidForce, OfUniformPointsIsAsADrawnOne) {
  constexpr std::size_t kForces = 20'000, kDraws = 72;  // 64 laid, then others
  std::vector<double> sum(kDraws * kDraws), mean(kDraws);
  for (std::size_t i = 0; i < kForces; ++i) {
    Random random(Purpose::first_points, {1, 2, i});
    Point point;
    for (double& x : point) x = random.uniform();
    RandomForce force(unit_force(), stream(i));
    force.lay(point, 2);
    const auto x = draws(force, kDraws);
    for (std::size_t a = 0; a < kDraws; ++a) {
      mean[a] += x[a] / kForces;
      for (std::size_t b = a; b < kDraws; ++b) sum[a * kDraws + b] += x[a] * x[b] / kForces;
    }
  }
  const double five = 5.0 / std::sqrt(static_cast<double>(kForces));
  for (std::size_t a = 0; a < kDraws; ++a) {
    EXPECT_NEAR(mean[a], 0.0, five);
    for (std::size_t b = a; b < kDraws; ++b)
      EXPECT_NEAR(sum[a * kDraws + b], a == b ? 1.0 : 0.0, a == b ? 1.5 * five : five)
          << a << " " << b;
  }
}

TEST(LaidForce, HoldsTheDrawInForceOn) {
  RandomForce force(unit_force(), stream(9));
  const double first = force.value(), left = force.left();
  force.pass(0.5 * left);
  force.lay({0.9, 0.9, 0.9, 0.9, 0.9, 0.9, 0.9, 0.9}, 4);
  EXPECT_EQ(force.value(), first);
  EXPECT_EQ(force.left(), 0.5 * left);
  force.pass(force.left());
  EXPECT_NE(force.value(), first);
}

}  // namespace
}  // namespace gatewalk::dynamics
