// SPDX-License-Identifier: MIT
#include "lattice/statistics/compare.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "dynamics/base/random.h"
#include "tests/support/numbers.h"
#include "tests/support/threads.h"

namespace gatewalk::lattice {
namespace {

using test::Draw;
using test::kEps;

CellProbabilities grid(int rows, int columns, std::initializer_list<double> values) {
  CellProbabilities p(rows, columns);
  std::copy(values.begin(), values.end(), p.data());
  return p;
}

CellCounts counts(int rows, int columns, std::initializer_list<std::int64_t> values) {
  CellCounts c(rows, columns);
  std::copy(values.begin(), values.end(), c.data());
  return c;
}

// ---- Statistics, by hand ----

// a = (1, 2, 3, 4)/10, b = (2, 1, 4, 3)/10: deviations (-3, -1, 1, 3)/20 and (-1, -3, 3, 1)/20,
// covariance 12, variances 20: corrcoef 12/20.
TEST(Statistics, BySmallNumbers) {
  const auto a = grid(2, 2, {0.1, 0.2, 0.3, 0.4}), b = grid(2, 2, {0.2, 0.1, 0.4, 0.3});
  EXPECT_NEAR(corrcoef(a, b), 0.6, 8 * kEps);
  EXPECT_NEAR(rmse_per_100(a, b), 10.0, 10 * 8 * kEps);  // all differ by 10 trials of 100
  EXPECT_NEAR(total_variation(a, b), 0.2, 4 * kEps);
  EXPECT_NEAR(corrcoef(a, a), 1.0, 4 * kEps);
  EXPECT_EQ(rmse_per_100(a, a), 0.0);
  EXPECT_EQ(total_variation(a, a), 0.0);
  EXPECT_EQ(energy_distance(a, a), 0.0);
}

TEST(Statistics, CountEmptyGatesToo) {
  // Sec. III-C: RMSE divides by n = 81, not by the number of gates reached.
  CellProbabilities a = CellProbabilities::Zero(9, 9), b = a;
  a(0, 0) = 1.0;
  b(8, 8) = 1.0;
  EXPECT_NEAR(rmse_per_100(a, b), 100 * std::sqrt(2.0 / 81), 32 * kEps);
  // Deviations (80, -1, -1, ...)/81: covariance -80 - 80 + 79 of a variance 80^2 + 80.
  EXPECT_NEAR(corrcoef(a, b), -1.0 / 80, 4 * kEps);
  EXPECT_EQ(total_variation(a, b), 1.0);
}

TEST(Statistics, AreSymmetricAndLinearInScale) {
  Draw draw(1);
  CellProbabilities a(3, 5), b(3, 5);
  for (int i = 0; i < 15; ++i) {
    a.data()[i] = draw.uniform(0, 1);
    b.data()[i] = draw.uniform(0, 1);
  }
  EXPECT_EQ(corrcoef(a, b), corrcoef(b, a));
  EXPECT_EQ(rmse_per_100(a, b), rmse_per_100(b, a));
  EXPECT_EQ(total_variation(a, b), total_variation(b, a));
  EXPECT_NEAR(energy_distance(a, b), energy_distance(b, a), 64 * kEps);
  EXPECT_NEAR(corrcoef(7 * a + 3, b), corrcoef(a, b), 32 * kEps);
}

TEST(Statistics, CorrcoefOfAConstantIsUndefined) {
  const auto flat = grid(2, 2, {0.25, 0.25, 0.25, 0.25}), other = grid(2, 2, {1, 0, 0, 0});
  EXPECT_TRUE(std::isnan(corrcoef(flat, other)));
  EXPECT_TRUE(std::isnan(corrcoef(other, flat)));
}

// Two points at distance d: 2 E|X-Y| - 0 - 0 = 2 d, for 3, 4 and 5 gates.
TEST(Statistics, EnergyDistanceIsEuclidean) {
  CellProbabilities at = CellProbabilities::Zero(9, 9), right = at, up = at, both = at;
  at(1, 2) = right(1, 5) = up(5, 2) = both(5, 5) = 1.0;
  EXPECT_NEAR(energy_distance(at, right), 6.0, 8 * kEps * 6);
  EXPECT_NEAR(energy_distance(at, up), 8.0, 8 * kEps * 8);
  EXPECT_NEAR(energy_distance(at, both), 10.0, 8 * kEps * 10);
  // If half of the mass moves: a quarter of that.
  const CellProbabilities half = 0.5 * (at + both);
  EXPECT_NEAR(energy_distance(at, half), 2.5, 8 * kEps * 5);
}

// Second route: the definition 2 E|X-Y| - E|X-X'| - E|Y-Y'|, as a sum over all pairs.
TEST(Statistics, EnergyDistanceIsItsDefinition) {
  Draw draw(2);
  CellProbabilities a(4, 6), b(4, 6);
  for (int i = 0; i < 24; ++i) {
    a.data()[i] = draw.below(3) ? draw.uniform(0, 1) : 0.0;
    b.data()[i] = draw.below(3) ? draw.uniform(0, 1) : 0.0;
  }
  a /= a.sum();
  b /= b.sum();
  const auto mean_distance = [](const CellProbabilities& p, const CellProbabilities& q) {
    double sum = 0.0;
    for (int i = 0; i < 24; ++i)
      for (int j = 0; j < 24; ++j)
        sum += p.data()[i] * q.data()[j] * std::hypot(i / 6 - j / 6, i % 6 - j % 6);
    return sum;
  };
  const double expected = 2 * mean_distance(a, b) - mean_distance(a, a) - mean_distance(b, b);
  EXPECT_NEAR(energy_distance(a, b), expected, 64 * kEps * mean_distance(a, b));
  EXPECT_GT(expected, 0.01);
}

TEST(Statistics, FieldsMustHaveOneSize) {
  const auto a = grid(2, 3, {1, 0, 0, 0, 0, 0}), b = grid(3, 2, {1, 0, 0, 0, 0, 0});
  EXPECT_THROW((void)corrcoef(a, b), std::invalid_argument);
  EXPECT_THROW((void)rmse_per_100(a, b), std::invalid_argument);
  EXPECT_THROW((void)total_variation(a, b), std::invalid_argument);
  EXPECT_THROW((void)energy_distance(a, b), std::invalid_argument);
  const auto n = counts(2, 3, {1, 0, 0, 0, 0, 0}), m = counts(3, 2, {1, 0, 0, 0, 0, 0});
  EXPECT_THROW((void)compare(n, m, 10, 1), std::invalid_argument);
  EXPECT_THROW((void)compare(n, b, 10, 1), std::invalid_argument);
}

// ---- Noise floor ----

// Reference figures for the paper's field: N = 100, n = 81, s = 0.06.
TEST(NoiseFloor, FiguresOfTheModel) {
  const NoiseFloor two = noise_floor(0.06, 81, 100, 100), exact = noise_floor(0.06, 81, 100, 0);
  EXPECT_NEAR(two.rmse_per_100, 1.52, 5e-3);
  EXPECT_NEAR(two.corrcoef, 0.83, 6e-3);  // 0.8352; simulated means print as 0.83
  EXPECT_NEAR(exact.rmse_per_100, 1.08, 5e-3);
  EXPECT_NEAR(exact.corrcoef, 0.91, 5e-3);
  // The same values from the formulas.
  const double v = (0.06 - 1.0 / 81) / 81, e = 0.94 / 8100;
  EXPECT_NEAR(two.rmse_per_100, 100 * std::sqrt(0.94 * 2 / 8100), 16 * kEps);
  EXPECT_NEAR(two.corrcoef, v / (v + e), 8 * kEps);
  EXPECT_NEAR(exact.corrcoef, std::sqrt(v / (v + e)), 8 * kEps);
}

TEST(NoiseFloor, FallsWithTheRootOfTheTrials) {
  const NoiseFloor few = noise_floor(0.06, 81, 100, 300);
  const NoiseFloor many = noise_floor(0.06, 81, 40'000, 120'000);
  EXPECT_NEAR(few.rmse_per_100 / many.rmse_per_100, 20.0, 1e-13);
  EXPECT_LT(few.corrcoef, many.corrcoef);
  EXPECT_LT(many.corrcoef, 1.0);
  // An exact second distribution is the limit of many trials.
  EXPECT_NEAR(noise_floor(0.06, 81, 100, 1'000'000'000'000).rmse_per_100,
              noise_floor(0.06, 81, 100, 0).rmse_per_100, 1e-9);
}

/// Shares that fall off from the middle of the first row; `spread` in gates.
CellProbabilities hill(double spread) {
  CellProbabilities p(9, 9);
  for (int row = 0; row < 9; ++row)
    for (int column = 0; column < 9; ++column)
      p(row, column) = std::exp(-std::hypot(row, column - 4) / spread);
  return p / p.sum();
}

CellCounts sample(const CellProbabilities& p, std::int64_t trials, Draw& draw) {
  std::vector<double> cumulative(p.size());
  double sum = 0.0;
  for (Eigen::Index i = 0; i < p.size(); ++i) cumulative[i] = sum += p.data()[i];
  CellCounts c = CellCounts::Zero(p.rows(), p.cols());
  for (std::int64_t t = 0; t < trials; ++t) {
    const double u = draw.uniform(0, sum);
    ++c.data()[std::upper_bound(cumulative.begin(), cumulative.end() - 1, u) - cumulative.begin()];
  }
  return c;
}

CellProbabilities shares(const CellCounts& c) {
  return c.cast<double>() / static_cast<double>(c.sum());
}

// The formula holds within 2 % in simulation. 4000 repeats give the means to about 0.3 %.
TEST(NoiseFloor, AgreesWithSimulation) {
  double low = 0.5, high = 5.0;  // sum p^2 = 0.06 by bisection
  for (int i = 0; i < 60; ++i) {
    const double mid = 0.5 * (low + high);
    (hill(mid).square().sum() > 0.06 ? low : high) = mid;
  }
  const CellProbabilities p = hill(low);
  ASSERT_NEAR(p.square().sum(), 0.06, 1e-12);
  constexpr int kRepeats = 4000;
  for (const std::int64_t second : {100, 300, 0}) {
    Draw draw(3);
    double squares = 0.0, correlation = 0.0;
    for (int i = 0; i < kRepeats; ++i) {
      const CellProbabilities a = shares(sample(p, 100, draw));
      const CellProbabilities b = second ? shares(sample(p, second, draw)) : p;
      squares += std::pow(rmse_per_100(a, b), 2) / kRepeats;
      correlation += corrcoef(a, b) / kRepeats;
    }
    const NoiseFloor floor = noise_floor(0.06, 81, 100, second);
    EXPECT_NEAR(std::sqrt(squares), floor.rmse_per_100, 0.02 * floor.rmse_per_100) << second;
    EXPECT_NEAR(correlation, floor.corrcoef, 0.02 * floor.corrcoef) << second;
  }
}

// sum c(c-1) / N(N-1): (3, 2, 0, 1) has (6 + 2) / 30.
// By hand: one trial of (p, 1-p) differs by p(1-p) + (1-p)p in both gates; half of the sum is
// 2p(1-p). Two trials of (1/2, 1/2) differ by 1/2 half of the time.
TEST(ExpectedTotalVariation, BySmallNumbers) {
  EXPECT_NEAR(expected_total_variation(grid(1, 2, {0.3, 0.7}), 1), 0.42, 16 * kEps);
  EXPECT_NEAR(expected_total_variation(grid(1, 2, {0.5, 0.5}), 2), 0.25, 16 * kEps);
  // Four equal gates, one trial: 3/4 for every outcome.
  EXPECT_NEAR(expected_total_variation(grid(2, 2, {0.25, 0.25, 0.25, 0.25}), 1), 0.75, 16 * kEps);
  EXPECT_EQ(expected_total_variation(grid(1, 2, {0.0, 1.0}), 7), 0.0);
}

// For many trials a count is normal: E|z| = sqrt(2/pi) sd.
TEST(ExpectedTotalVariation, BecomesTheNormalOne) {
  const auto p = grid(2, 2, {0.1, 0.2, 0.3, 0.4});
  double normal = 0.0;
  for (const double share : {0.1, 0.2, 0.3, 0.4})
    normal += 0.5 * std::sqrt(2 / test::kPi * share * (1 - share));
  for (const std::int64_t n : {100'000LL, 10'000'000LL, 1'000'000'000LL}) {
    const auto root = std::sqrt(static_cast<double>(n));
    // The next term has the relative size 1/n; logarithms of n! lose n log n eps.
    EXPECT_NEAR(expected_total_variation(p, n) * root / normal, 1.0,
                2.0 / static_cast<double>(n) + 40 * kEps * root * root);
  }
}

TEST(ExpectedTotalVariation, IsTheMeanOverSamples) {
  CellProbabilities p(3, 3);
  p << 0.4, 0.2, 0.1, 0.1, 0.08, 0.06, 0.03, 0.02, 0.01;
  for (const std::int64_t n : {1, 7, 50, 1000}) {
    constexpr int kRepeats = 4000;
    double sum = 0.0, squares = 0.0;
    for (int k = 0; k < kRepeats; ++k) {
      const CellCounts c = sampled(p, n, 1, static_cast<std::uint64_t>(k));
      ASSERT_EQ(c.sum(), n);
      const double tv = total_variation(c.cast<double>() / static_cast<double>(n), p);
      sum += tv;
      squares += tv * tv;
    }
    const double mean = sum / kRepeats, variance = squares / kRepeats - mean * mean;
    EXPECT_NEAR(mean, expected_total_variation(p, n), 4.5 * std::sqrt(variance / kRepeats)) << n;
  }
}

TEST(Sampled, IsNamedBySeedAndReplicate) {
  const auto p = grid(2, 2, {0.1, 0.0, 0.4, 0.5});
  const CellCounts a = sampled(p, 1000, 1, 2);
  EXPECT_TRUE((a == sampled(p, 1000, 1, 2)).all());
  EXPECT_FALSE((a == sampled(p, 1000, 1, 3)).all());
  EXPECT_FALSE((a == sampled(p, 1000, 2, 2)).all());
  EXPECT_EQ(a(0, 1), 0);
}

TEST(TrialsFor, IsTheLeastThatSuffices) {
  CellProbabilities p(3, 3);
  p << 0.4, 0.2, 0.1, 0.1, 0.08, 0.06, 0.03, 0.02, 0.01;
  EXPECT_EQ(trials_for(p, 1.0), 1);
  for (const double tv : {0.5, 0.2, 0.03, 0.004}) {
    const std::int64_t n = trials_for(p, tv);
    EXPECT_LE(expected_total_variation(p, n), tv);
    EXPECT_GT(expected_total_variation(p, n - 1), tv);
  }
  EXPECT_THROW((void)trials_for(p, 0.0), std::invalid_argument);
  EXPECT_THROW((void)expected_total_variation(p, 0), std::invalid_argument);
}

TEST(Concentration, IsTheShareOfEqualPairs) {
  EXPECT_NEAR(concentration(counts(2, 2, {3, 2, 0, 1})), 8.0 / 30, 2 * kEps);
  EXPECT_EQ(concentration(counts(1, 2, {5, 0})), 1.0);
  EXPECT_EQ(concentration(counts(2, 2, {1, 1, 1, 1})), 0.0);
  EXPECT_TRUE(std::isnan(concentration(counts(1, 2, {1, 0}))));
}

TEST(Concentration, HasNoBias) {
  const CellProbabilities p = hill(1.5);
  Draw draw(4);
  constexpr int n = 5000;
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < n; ++i) {
    const double s = concentration(sample(p, 20, draw));
    sum += s;
    squares += s * s;
  }
  const double deviation = std::sqrt((squares - sum * sum / n) / n);
  EXPECT_NEAR(sum / n, p.square().sum(), 4 * deviation / std::sqrt(n));
}

// ---- Comparisons ----

TEST(Compare, ReportsItsStatistics) {
  const CellCounts a = counts(2, 2, {10, 20, 30, 40}), b = counts(2, 2, {40, 20, 80, 60});
  const Comparison c = compare(a, b, 50, 1);
  EXPECT_EQ(c.corrcoef, corrcoef(shares(a), shares(b)));
  EXPECT_EQ(c.rmse_per_100, rmse_per_100(shares(a), shares(b)));
  EXPECT_EQ(c.total_variation, total_variation(shares(a), shares(b)));
  EXPECT_EQ(c.null_draws, 50);
  const NoiseFloor floor = noise_floor(concentration(a + b), 4, 100, 200);
  EXPECT_EQ(c.floor.corrcoef, floor.corrcoef);
  EXPECT_EQ(c.floor.rmse_per_100, floor.rmse_per_100);

  const auto exact = grid(2, 2, {0.2, 0.1, 0.4, 0.3});
  const Comparison e = compare(a, exact, 50, 1);
  EXPECT_EQ(e.corrcoef, corrcoef(shares(a), exact));
  EXPECT_EQ(e.floor.rmse_per_100, noise_floor(exact.square().sum(), 4, 100, 0).rmse_per_100);
}

TEST(Compare, EqualSamplesDifferByNothing) {
  const CellCounts a = counts(2, 2, {10, 20, 30, 40});
  const Comparison c = compare(a, a, 99, 1);
  EXPECT_EQ(c.total_variation, 0.0);
  EXPECT_EQ(c.p_chi_squared, 1.0);
  EXPECT_EQ(c.p_total_variation, 1.0);
  EXPECT_EQ(c.p_energy, 1.0);
}

// Two trials in two gates: half of all permutations differ as much as these samples.
TEST(Compare, PermutationsOfAHandfulAreExact) {
  // {2, 0} against {0, 2}: of the 6 ways to choose 2 of 4, 2 are as extreme.
  const Comparison c = compare(counts(1, 2, {2, 0}), counts(1, 2, {0, 2}), 9999, 1);
  const double p = 2.0 / 6, tolerance = 4 * std::sqrt(p * (1 - p) / 9999);
  EXPECT_NEAR(c.p_chi_squared, p, tolerance);
  EXPECT_NEAR(c.p_total_variation, p, tolerance);
  EXPECT_NEAR(c.p_energy, p, tolerance);
  // TV is 1 in those two and 0 in the other four.
  EXPECT_NEAR(c.floor_total_variation, p, tolerance);
}

// The exact distribution (1/2, 1/2) and a sample of 4 trials, all in one gate: 2/16 of all samples.
TEST(Compare, DrawsFromTheExactDistributionAreExact) {
  const Comparison c = compare(counts(1, 2, {4, 0}), grid(1, 2, {0.5, 0.5}), 9999, 1);
  const double p = 2.0 / 16, tolerance = 4 * std::sqrt(p * (1 - p) / 9999);
  EXPECT_NEAR(c.p_chi_squared, p, tolerance);
  EXPECT_NEAR(c.p_total_variation, p, tolerance);
  EXPECT_NEAR(c.p_energy, p, tolerance);
  // E|X/4 - 1/2| = (2 * 1/2 + 8 * 1/4) / 16 = 3/16, sd below 1/4.
  EXPECT_NEAR(c.floor_total_variation, 3.0 / 16, 4 * 0.25 / 100);
}

// Under the null, p-values are uniform. 300 splits; Kolmogorov's 0.1 % point, plus the steps of
// 1/200 that 199 draws cause. TV has ties, which only make p larger.
TEST(Compare, PValuesAreUniformUnderTheNull) {
  const CellProbabilities p = hill(1.5);
  Draw draw(5);
  constexpr int kSplits = 300;
  std::vector<double> chi[2], tv[2], energy[2];
  for (int i = 0; i < kSplits; ++i) {
    const CellCounts a = sample(p, 200, draw), b = sample(p, 300, draw);
    const auto seed = static_cast<std::uint64_t>(i);
    const Comparison c[] = {compare(a, b, 199, seed), compare(a, p, 199, seed)};
    for (int k = 0; k < 2; ++k) {
      chi[k].push_back(c[k].p_chi_squared);
      tv[k].push_back(c[k].p_total_variation);
      energy[k].push_back(c[k].p_energy);
    }
  }
  const auto excess = [&](std::vector<double> values, double sign) {
    std::sort(values.begin(), values.end());
    double worst = 0.0;
    for (int i = 0; i < kSplits; ++i)
      worst = std::max({worst, sign * ((i + 1.0) / kSplits - values[i]),
                        sign * (static_cast<double>(i) / kSplits - values[i])});
    return worst;
  };
  const double bound = 1.95 / std::sqrt(kSplits) + 1.0 / 200;
  for (int k = 0; k < 2; ++k) {
    SCOPED_TRACE(k ? "against an exact distribution" : "two samples");
    for (const auto& values : {chi[k], energy[k]}) {
      EXPECT_LT(excess(values, 1.0), bound);
      EXPECT_LT(excess(values, -1.0), bound);
    }
    EXPECT_LT(excess(tv[k], 1.0), bound);
  }
}

TEST(Compare, SeesAShift) {
  const CellProbabilities p = hill(1.5);
  CellProbabilities shifted = 0.8 * p;  // a fifth of all trials ends one gate further right
  shifted.rightCols(8) += 0.2 * p.leftCols(8);
  shifted.rightCols(1) += 0.2 * p.rightCols(1);
  Draw draw(6);
  const CellCounts a = sample(p, 10'000, draw), b = sample(shifted, 10'000, draw);
  for (const Comparison& c : {compare(a, b, 999, 1), compare(b, p, 999, 1)}) {
    EXPECT_LE(c.p_chi_squared, 0.01);
    EXPECT_LE(c.p_total_variation, 0.01);
    EXPECT_EQ(c.p_energy, 1.0 / 1000);  // no draw of the 999 is as large
    EXPECT_GT(c.total_variation, c.floor_total_variation);
    EXPECT_GT(c.rmse_per_100, c.floor.rmse_per_100);
  }
}

TEST(Compare, SampleWhereTheExactHasNothingIsImpossible) {
  const CellCounts a = counts(1, 3, {50, 49, 1});
  const Comparison c = compare(a, grid(1, 3, {0.5, 0.5, 0.0}), 99, 1);
  EXPECT_EQ(c.p_chi_squared, 0.01);
}

// 10 of 10 000 trials are expected in 100 gates of 1e-5 each. Tested gate by gate, ten in one gate
// would be significant; merged, the gates do not differ.
TEST(Compare, RareGatesCountAsOneInChiSquared) {
  CellProbabilities exact = CellProbabilities::Constant(1, 102, 1e-5);
  exact(0, 0) = 0.5;
  exact(0, 1) = 0.499;
  CellCounts seen = CellCounts::Zero(1, 102);
  seen(0, 0) = 5000;
  seen(0, 1) = 4990;
  seen(0, 50) = 10;
  EXPECT_GT(compare(seen, exact, 199, 1).p_chi_squared, 0.9);
  // But 60 trials instead of 10 are too many, wherever they are.
  seen(0, 0) = 4950;
  for (int i = 52; i < 102; ++i) seen(0, i) = 1;
  EXPECT_EQ(seen.sum(), 10'000);
  EXPECT_EQ(compare(seen, exact, 199, 1).p_chi_squared, 1.0 / 200);
}

// The cost grows with the square of the gates reached: above 1000 the energy is left out, and never
// silently zero.
TEST(Compare, EnergyIsLeftOutOfLargeFields) {
  for (const int gates : {kMostEnergyGates, kMostEnergyGates + 1}) {
    const CellCounts one = CellCounts::Ones(1, gates);
    const Comparison c = compare(one, one, 2, 1);
    EXPECT_EQ(std::isnan(c.p_energy), gates > kMostEnergyGates);
    EXPECT_EQ(c.p_total_variation, 1.0);
  }
}

TEST(Compare, SameSeedSameBitsOnAnyNumberOfThreads) {
  Draw draw(7);
  const CellProbabilities p = hill(1.5);
  const CellCounts a = sample(p, 500, draw), b = sample(p, 400, draw);
  const auto on = [&](int threads, std::uint64_t seed, bool exact) {
    return test::on_threads(
        threads, [&] { return exact ? compare(a, p, 200, seed) : compare(a, b, 200, seed); });
  };
  for (const bool exact : {false, true}) {
    const Comparison one = on(1, 3, exact);
    for (const int threads : {2, 8}) {
      const Comparison c = on(threads, 3, exact);
      EXPECT_EQ(c.p_chi_squared, one.p_chi_squared);
      EXPECT_EQ(c.p_total_variation, one.p_total_variation);
      EXPECT_EQ(c.p_energy, one.p_energy);
      EXPECT_TRUE(test::same_bits(c.floor_total_variation, one.floor_total_variation));
    }
    EXPECT_NE(on(1, 4, exact).floor_total_variation, one.floor_total_variation);
  }
}

// The order of the two samples only changes which draws are made.
TEST(Compare, IsSymmetric) {
  Draw draw(8);
  const CellProbabilities p = hill(1.5);
  const CellCounts a = sample(p, 300, draw), b = sample(hill(2.0), 900, draw);
  const Comparison c = compare(a, b, 999, 1), d = compare(b, a, 999, 1);
  EXPECT_EQ(c.corrcoef, d.corrcoef);
  EXPECT_EQ(c.floor.corrcoef, d.floor.corrcoef);
  // The smaller sample is dealt from the same pool with the same random words: the same null.
  EXPECT_EQ(c.p_chi_squared, d.p_chi_squared);
  EXPECT_EQ(c.p_energy, d.p_energy);
}

// Four pairs differ, all in one direction: of the 16 ways to swap them, 2 are as extreme. TV is |4
// - 2k|/N with k swapped: mean (2*4 + 8*2)/16 = 1.5 for N = 20 trials. 4 occurs in 1 of 8 cases, so
// it is the 95 % quantile. With six pairs, 6 occurs in 1 of 32 cases and 4 in 6 of 32, so 4 is.
TEST(ComparePairs, SwapsOfAHandfulAreExact) {
  std::vector<std::int32_t> first(20, 0), second(20, 0);
  for (int i = 3; i < 7; ++i) second[i] = 1;
  const Comparison c = compare_pairs(first, second, 1, 2, 9999, 1);
  const double p = 2.0 / 16, tolerance = 4 * std::sqrt(p * (1 - p) / 9999);
  EXPECT_NEAR(c.p_chi_squared, p, tolerance);
  EXPECT_NEAR(c.p_total_variation, p, tolerance);
  EXPECT_NEAR(c.p_energy, p, tolerance);
  EXPECT_DOUBLE_EQ(c.total_variation, 4.0 / 20);
  EXPECT_NEAR(c.floor_total_variation, 1.5 / 20, 4 * (1.33 / 20) / 100);  // sd of |4 - 2k|: 1.32
  EXPECT_DOUBLE_EQ(c.floor_total_variation_95, 4.0 / 20);
  second[7] = second[8] = 1;
  EXPECT_DOUBLE_EQ(compare_pairs(first, second, 1, 2, 9999, 1).floor_total_variation_95, 4.0 / 20);
}

// Two pairs differ in the same way. A null draw is as far apart as the data if its two coins, the
// lowest bits of its first word, are equal; p counts these draws. No other use of
// Purpose::comparison (rows 0, 1, 2: deals, draws from an exact distribution, samples) may draw the
// same coins.
TEST(ComparePairs, ThrowsCoinsOfItsOwn) {
  constexpr std::int64_t kDraws = 64;
  const auto alike_up_to = [](std::int64_t draws) {
    const auto n = static_cast<double>(draws + 1);
    return std::llround(n * compare_pairs({0, 0}, {1, 1}, 1, 2, draws, 1).p_total_variation) - 1;
  };
  std::vector<bool> seen, of_row[3];
  for (std::int64_t k = 0; k < kDraws; ++k) {
    seen.push_back(alike_up_to(k + 1) > (k == 0 ? 0 : alike_up_to(k)));
    for (std::uint64_t row = 0; row < 3; ++row) {
      dynamics::Random random(dynamics::Purpose::comparison,
                              {1, row, static_cast<std::uint64_t>(k)});
      const std::uint64_t coins = random.word();
      of_row[row].push_back((coins & 1) == (coins >> 1 & 1));
    }
  }
  for (const auto& other : of_row) EXPECT_NE(seen, other);
}

// The same statistics as without pairs, with another null: pairs that agree add no noise.
TEST(ComparePairs, SeesWhatIndependentSamplesCannot) {
  Draw draw(9);
  std::vector<std::int32_t> first, second;
  for (int t = 0; t < 2000; ++t) {
    first.push_back(draw.below(9));
    second.push_back(first.back() == 4 && draw.coin() && draw.coin() ? 5 : first.back());
  }
  CellCounts a = CellCounts::Zero(3, 3), b = a;
  for (const auto cell : first) ++a.data()[cell];
  for (const auto cell : second) ++b.data()[cell];
  const Comparison pairs = compare_pairs(first, second, 3, 3, 999, 1),
                   apart = compare(a, b, 999, 1);
  EXPECT_EQ(pairs.total_variation, apart.total_variation);
  EXPECT_EQ(pairs.corrcoef, apart.corrcoef);
  EXPECT_EQ(pairs.rmse_per_100, apart.rmse_per_100);
  EXPECT_EQ(pairs.p_total_variation, 0.001);  // the smallest value that 999 draws can give
  EXPECT_LT(pairs.floor_total_variation, apart.floor_total_variation / 4);
  EXPECT_TRUE(std::isnan(pairs.floor.rmse_per_100));
  const Comparison same = compare_pairs(first, first, 3, 3, 99, 1);
  EXPECT_EQ(same.p_total_variation, 1.0);
  EXPECT_EQ(same.floor_total_variation, 0.0);
}

// Kolmogorov's 0.1 % point, plus the steps of 1/100; ties only make p larger.
TEST(ComparePairs, PValuesAreUniformUnderTheNull) {
  Draw draw(10);
  constexpr int kRuns = 300;
  std::vector<double> p;
  for (int run = 0; run < kRuns; ++run) {
    std::vector<std::int32_t> first, second;
    for (int t = 0; t < 200; ++t) {
      first.push_back(draw.below(6));
      second.push_back(draw.coin() ? first.back() : draw.below(6));  // exchangeable
    }
    p.push_back(compare_pairs(first, second, 2, 3, 99, run).p_energy);
  }
  std::sort(p.begin(), p.end());
  double off = 0.0;
  for (int i = 0; i < kRuns; ++i)
    off = std::max({off, std::abs(p[i] - i / 300.0), std::abs(p[i] - (i + 1) / 300.0)});
  EXPECT_LT(off, 1.95 / std::sqrt(kRuns) + 0.01);
}

TEST(ComparePairs, SameBitsOnAnyNumberOfThreadsAndRefusals) {
  const std::vector<std::int32_t> a{0, 1, 2, 3, 2, 1}, b{1, 1, 3, 0, 2, 2};
  const auto on = [&](int threads) {
    return test::on_threads(threads, [&] { return compare_pairs(a, b, 2, 2, 500, 3); });
  };
  EXPECT_TRUE(test::same_bits(on(1).floor_total_variation, on(8).floor_total_variation));
  EXPECT_EQ(on(1).p_energy, on(8).p_energy);
  EXPECT_THROW((void)compare_pairs(a, {1, 2}, 2, 2, 9, 1), std::invalid_argument);
  EXPECT_THROW((void)compare_pairs({4}, {0}, 2, 2, 9, 1), std::invalid_argument);
  EXPECT_THROW((void)compare_pairs({}, {}, 2, 2, 9, 1), std::invalid_argument);
}

TEST(Compare, RefusesWhatCannotBeCompared) {
  const CellCounts empty = counts(1, 2, {0, 0}), some = counts(1, 2, {3, 4});
  EXPECT_THROW((void)compare(empty, some, 10, 1), std::invalid_argument);
  EXPECT_THROW((void)compare(some, empty, 10, 1), std::invalid_argument);
  EXPECT_THROW((void)compare(empty, grid(1, 2, {0.5, 0.5}), 10, 1), std::invalid_argument);
  EXPECT_THROW((void)compare(some, some, 0, 1), std::invalid_argument);
}

}  // namespace
}  // namespace gatewalk::lattice
