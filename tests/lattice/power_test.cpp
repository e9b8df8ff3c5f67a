// SPDX-License-Identifier: MIT
// Power by hand, by enumeration, and by running the tests themselves.
#include "lattice/statistics/power.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/base/random.h"
#include "lattice/statistics/draws.h"
#include "markov/predict.h"
#include "tests/support/threads.h"

namespace gatewalk::lattice {
namespace {

using dynamics::Purpose;
using dynamics::Random;

using Pairs = std::vector<std::pair<double, double>>;

constexpr PowerGoal kGoal{.power = 0.8, .level = 0.05};

/// Records in the test's entry of --gtest_output=json how often this number of trials found
/// something.
void record(const std::string& name, std::int64_t trials, double seen, double without) {
  testing::Test::RecordProperty(
      "found_" + name, std::to_string(seen) + " with " + std::to_string(trials) + " trials, " +
                           std::to_string(without) + " without a difference");
}

double choose(int n, int k) {
  double c = 1.0;
  for (int i = 1; i <= k; ++i) c *= static_cast<double>(n - k + i) / i;
  return c;
}
double binomial_chance(int n, double p, int k) {
  return choose(n, k) * std::pow(p, k) * std::pow(1.0 - p, n - k);
}

// Ten coins: none or one, nine or ten heads are 22 of 1024 cases; adding two and eight would make
// 112.
TEST(PowerOfShare, ByHand) {
  EXPECT_NEAR(power_of_share(10, 0.5, 0.5, 0.05), 22.0 / 1024, 1e-14);
  EXPECT_NEAR(power_of_share(10, 0.5, 0.8, 0.05),
              10 * std::pow(0.8, 9) * 0.2 + std::pow(0.8, 10) + std::pow(0.2, 10) +
                  10 * 0.8 * std::pow(0.2, 9),
              1e-14);
  EXPECT_NEAR(power_of_share(10, 0.5, 0.5, 0.11), 112.0 / 1024, 1e-14);
  EXPECT_EQ(power_of_share(4, 0.5, 1.0, 0.05), 0.0);  // even 4 of 4 has probability 2/16
}

// An outcome that never happens is detected by a single case: 1 - .98^n reaches 0.8 at n = 80.
TEST(PowerOfShare, OfWhatShouldNeverHappen) {
  EXPECT_NEAR(power_of_share(60, 0.0, 0.02, 0.05), 1.0 - std::pow(0.98, 60), 1e-13);
  EXPECT_EQ(trials_for_share(0.0, 0.02, kGoal), 80);
  EXPECT_EQ(trials_for_share(1.0, 0.98, kGoal), 80);
  const SmallestDifference d = smallest_difference(60, 0.0, kGoal);
  EXPECT_NEAR(d.more.value(), 1.0 - std::pow(0.2, 1.0 / 60), 1e-9);
  EXPECT_FALSE(d.fewer);
}

/// Logarithms of 0!, ..., n!.
std::vector<long double> log_factorials(int n) {
  std::vector<long double> logs{0.0L};
  for (int k = 1; k <= n; ++k) logs.push_back(logs.back() + std::log(static_cast<long double>(k)));
  return logs;
}
/// Probabilities of 0, ..., n successes.
std::vector<double> binomial_chances(int n, double p) {
  const std::vector<long double> logs = log_factorials(n);
  const long double success = std::log(static_cast<long double>(p)),
                    failure = std::log(1.0L - static_cast<long double>(p));
  std::vector<double> chances;
  for (std::size_t k = 0; k < logs.size(); ++k) {
    const std::size_t rest = logs.size() - 1 - k;
    chances.push_back(static_cast<double>(std::exp(logs.back() - logs[k] - logs[rest] +
                                                   static_cast<long double>(k) * success +
                                                   static_cast<long double>(rest) * failure)));
  }
  return chances;
}

// By definition: p of a count is the probability of all counts at least as far from the mean.
double power_by_definition(int n, double expected, double truth, double level) {
  double power = 0.0;
  for (int seen = 0; seen <= n; ++seen) {
    double p = 0.0;
    for (int k = 0; k <= n; ++k)
      if (std::abs(k - n * expected) >= std::abs(seen - n * expected) - 1e-9)
        p += binomial_chance(n, expected, k);
    if (p <= level) power += binomial_chance(n, truth, seen);
  }
  return power;
}

TEST(PowerOfShare, IsThatOfTheDefinition) {
  for (const int n : {1, 7, 20, 61})
    for (const double expected : {0.0, 0.013, 0.25, 0.3, 0.5, 0.9, 1.0})
      for (const double truth : {0.0, 0.1, 0.25, 0.6, 0.97, 1.0})
        for (const double level : {0.05, 0.01})
          EXPECT_NEAR(power_of_share(n, expected, truth, level),
                      power_by_definition(n, expected, truth, level), 1e-12)
              << n << " " << expected << " " << truth << " " << level;
}

TEST(PowerOfShare, OfManyTrialsIsThatOfTheDefinition) {
  for (const int n : {400, 2000})
    for (const double expected : {0.0007, 0.2, 0.5, 0.985}) {
      const std::vector<double> null = binomial_chances(n, expected);
      std::vector<double> p(null.size(), 0.0);
      for (int seen = 0; seen <= n; ++seen)
        for (int k = 0; k <= n; ++k)
          if (std::abs(k - n * expected) >= std::abs(seen - n * expected) - 1e-9)
            p[static_cast<std::size_t>(seen)] += null[static_cast<std::size_t>(k)];
      for (const double truth : {0.001, 0.18, 0.25, 0.55, 0.97})
        for (const double level : {0.05, 0.01}) {
          const std::vector<double> chances = binomial_chances(n, truth);
          double power = 0.0;
          for (std::size_t seen = 0; seen < p.size(); ++seen)
            if (p[seen] <= level) power += chances[seen];
          EXPECT_NEAR(power_of_share(n, expected, truth, level), power, 1e-12 * power)
              << n << " " << expected << " " << truth << " " << level;
        }
    }
}

// Two of two, of a tenth each, have p = 0.01, which 0.1 * 0.1 exceeds by its rounding.
TEST(PowerOfShare, AtTheLevelItselfIsSignificant) {
  EXPECT_NEAR(power_of_share(2, 0.1, 0.3, 0.01), 0.09, 1e-15);
}

TEST(PowerOfShare, NoDifferenceIsFoundNoMoreOftenThanTheLevelSays) {
  for (const std::int64_t n : {5, 60, 333, 5000})
    for (const double p : {0.001, 0.1, 0.37, 0.5})
      EXPECT_LE(power_of_share(n, p, p, 0.05), 0.05) << n << " " << p;
}

TEST(TrialsForShare, AreTheLeastThatStayEnough) {
  for (const auto& [expected, truth] :
       Pairs{{0.28, 0.48}, {0.1, 0.05}, {0.002, 0.022}, {0.5, 0.6}}) {
    const std::int64_t n = trials_for_share(expected, truth, kGoal).value();
    EXPECT_LT(power_of_share(n - 1, expected, truth, 0.05), 0.8);
    for (std::int64_t more = 0; more < n; ++more)
      ASSERT_GE(power_of_share(n + more, expected, truth, 0.05), 0.8) << n << " + " << more;
  }
  EXPECT_FALSE(trials_for_share(0.3, 0.3, kGoal));
  EXPECT_FALSE(trials_for_share(0.3, 0.3001, kGoal));  // 1.6 10^8 by the normal distribution
  EXPECT_THROW((void)trials_for_share(0.3, 1.1, kGoal), std::invalid_argument);
}

// Runs the experiment 2000 times: 80 % find the difference at the recommended number of trials, and
// at most 5 % find one where there is none. Four standard errors.
TEST(TrialsForShare, KeepWhatTheyPromise) {
  constexpr int kRepeats = 2000;
  std::uint64_t row = 0;
  for (const auto& pair : Pairs{{0.28, 0.38}, {0.1, 0.2}, {0.6, 0.4}}) {
    const double expected = pair.first, truth = pair.second;
    const int n = static_cast<int>(trials_for_share(expected, truth, kGoal).value());
    const auto found = [&](double share) {
      ++row;
      int count = 0;
      for (int k = 0; k < kRepeats; ++k) {
        Random random(Purpose::comparison, {7, row + 100, static_cast<std::uint64_t>(k)});
        const auto seen = static_cast<int>(binomial(n, share, random));
        double p = 0.0;
        for (int c = 0; c <= n; ++c)
          if (std::abs(c - n * expected) >= std::abs(seen - n * expected) - 1e-9)
            p += std::exp(std::lgamma(n + 1.0) - std::lgamma(c + 1.0) - std::lgamma(n - c + 1.0) +
                          c * std::log(expected) +
                          static_cast<double>(n - c) * std::log1p(-expected));
        count += p <= 0.05;
      }
      return static_cast<double>(count) / kRepeats;
    };
    const double error = std::sqrt(0.8 * 0.2 / kRepeats),
                 at_level = std::sqrt(0.05 * 0.95 / kRepeats);
    const double seen = found(truth), without = found(expected);
    EXPECT_NEAR(seen, power_of_share(n, expected, truth, 0.05), 4 * error);
    EXPECT_GE(power_of_share(n, expected, truth, 0.05), 0.8);
    EXPECT_LE(without, 0.05 + 4 * at_level);
    record(std::to_string(expected), n, seen, without);
  }
}

// All of three against none of three: 2 of the 20 ways to deal them; of four: 2 of 70.
TEST(PowerOfTwoShares, ByHand) {
  EXPECT_EQ(power_of_two_shares(3, 0.0, 1.0, 0.05), 0.0);
  EXPECT_NEAR(power_of_two_shares(4, 0.0, 1.0, 0.05), 1.0, 1e-12);
  EXPECT_NEAR(power_of_two_shares(4, 0.0, 0.5, 0.05), 1.0 / 16, 1e-12);
  EXPECT_EQ(trials_for_two_shares(0.0, 1.0, kGoal), 4);
  EXPECT_FALSE(trials_for_two_shares(0.4, 0.4, kGoal));
}

TEST(PowerOfTwoShares, IsThatOfAllDeals) {
  for (const int n : {5, 12, 23})
    for (const auto& [first, second] : Pairs{{0.1, 0.6}, {0.5, 0.5}, {0.03, 0.3}}) {
      double power = 0.0;
      for (int x = 0; x <= n; ++x)
        for (int y = 0; y <= n; ++y) {
          double p = 0.0;
          const int total = x + y;
          for (int k = std::max(0, total - n); k <= std::min(n, total); ++k)
            if (std::abs(2 * k - total) >= std::abs(x - y))
              p += choose(n, k) * choose(n, total - k) / choose(2 * n, total);
          if (p <= 0.05 + 1e-12)
            power += binomial_chance(n, first, x) * binomial_chance(n, second, y);
        }
      EXPECT_NEAR(power_of_two_shares(n, first, second, 0.05), power, 1e-10) << n << " " << first;
    }
}

// By the probabilities of all deals of each number of successes.
TEST(PowerOfTwoShares, OfManyTrialsIsThatOfAllDeals) {
  for (const int n : {90, 700}) {
    const std::vector<long double> logs = log_factorials(2 * n);
    const auto log_choose = [&](int of, int k) {
      return logs[static_cast<std::size_t>(of)] - logs[static_cast<std::size_t>(k)] -
             logs[static_cast<std::size_t>(of - k)];
    };
    const auto size = static_cast<Eigen::Index>(n + 1);
    Eigen::MatrixXd p = Eigen::MatrixXd::Ones(size, size);
    for (int total = 0; total <= 2 * n; ++total) {
      double at_most = 0.0;
      for (int k = std::max(0, total - n); 2 * k < total; ++k) {
        at_most += static_cast<double>(
            std::exp(log_choose(n, k) + log_choose(n, total - k) - log_choose(2 * n, total)));
        p(k, total - k) = p(total - k, k) = 2.0 * at_most;
      }
    }
    for (const auto& [first, second] :
         Pairs{{0.001, 0.02}, {0.2, 0.27}, {0.5, 0.5}, {0.97, 0.9}, {0.995, 0.3}})
      for (const double level : {0.05, 0.01}) {
        const std::vector<double> a = binomial_chances(n, first), b = binomial_chances(n, second);
        double power = 0.0;
        for (Eigen::Index x = 0; x < size; ++x)
          for (Eigen::Index y = 0; y < size; ++y)
            if (p(x, y) <= level)
              power += a[static_cast<std::size_t>(x)] * b[static_cast<std::size_t>(y)];
        EXPECT_NEAR(power_of_two_shares(n, first, second, level), power, 1e-12)
            << n << " " << first << " " << second << " " << level;
      }
  }
}

TEST(TrialsForTwoShares, AreEnoughAndHardlyMore) {
  const auto n = trials_for_two_shares(0.28, 0.48, kGoal).value();
  EXPECT_GE(power_of_two_shares(n, 0.28, 0.48, 0.05), 0.8);
  EXPECT_LT(power_of_two_shares(n - 1, 0.28, 0.48, 0.05), 0.8);
  EXPECT_LE(power_of_two_shares(n, 0.28, 0.28, 0.05), 0.05);
}

// ---- Distributions ----

CellProbabilities some_gates() {
  CellProbabilities p(3, 3);
  p << 0.30, 0.05, 0.02, 0.20, 0.10, 0.03, 0.05, 0.20, 0.05;
  return p;
}

markov::FinalDistribution known(const CellProbabilities& p) {
  markov::FinalDistribution d;
  d.final_cells = p;
  d.endings[static_cast<std::size_t>(markov::Ending::trapped)] = 1.0;
  return d;
}

CellProbabilities as_gates(const Eigen::VectorXd& shares) {
  CellProbabilities p(3, 3);
  std::copy(shares.begin(), shares.end(), p.data());
  return p;
}

TEST(HardestToSee, HasTheTotalVariationAndTheLeastChiSquared) {
  const Eigen::VectorXd equal = Eigen::VectorXd::Constant(4, 0.25);
  const auto other = hardest_to_see(equal, 0.1).value();
  EXPECT_NEAR((other - equal).cwiseAbs().sum(), 0.2, 1e-15);
  EXPECT_NEAR(((other - equal).array().square() / 0.25).sum(), 4 * 0.1 * 0.1, 1e-15);
  const Eigen::VectorXd p = gate_outcomes(some_gates()).shares;
  for (const double tv : {0.01, 0.2, 0.4}) {
    const auto q = hardest_to_see(p, tv).value();
    EXPECT_NEAR(q.sum(), 1.0, 1e-14);
    EXPECT_GE(q.minCoeff(), 0.0);
    EXPECT_NEAR(0.5 * (q - p).cwiseAbs().sum(), tv, 1e-14);
  }
  EXPECT_FALSE(hardest_to_see(p, 0.8));
  EXPECT_FALSE(hardest_to_see(Eigen::VectorXd::Ones(1), 0.1));
}

// At the recommended number of trials, joint_test() itself finds 80 % of such experiments, and at
// most 5 % without a difference.
TEST(TrialsForTotalVariation, KeepWhatTheyPromise) {
  constexpr std::uint64_t kRepeats = 400;
  const CellProbabilities base = some_gates();
  const Outcomes gates = gate_outcomes(base);
  const auto truth = as_gates(hardest_to_see(gates.shares, 0.2).value());
  const auto n = trials_for_total_variation(gates, 0.2, kGoal, 1).value();
  const auto found = [&](const CellProbabilities& p, std::uint64_t seed) {
    double count = 0.0;
    for (std::uint64_t k = 0; k < kRepeats; ++k)
      count +=
          joint_test({sampled(p, n, seed, k), {}}, known(base), {known(base)}, 0, 399, k).differs();
    return count / kRepeats;
  };
  const double error = std::sqrt(0.8 * 0.2 / kRepeats);
  const double seen = found(truth, 11), without = found(base, 12);
  EXPECT_NEAR(seen, 0.8, 4 * error);
  EXPECT_LE(without, 0.05 + 4 * std::sqrt(0.05 * 0.95 / kRepeats));
  record("gates", n, seen, without);
  // The smallest difference that this number detects is the one asked for.
  EXPECT_NEAR(smallest_total_variation(gates, n, kGoal, 1).value(), 0.2, 0.01);
}

TEST(TrialsForTwo, KeepWhatTheyPromise) {
  constexpr std::uint64_t kRepeats = 300;
  const CellProbabilities a = some_gates();
  CellProbabilities b = a;
  b(0, 0) = 0.15;
  b(2, 2) = 0.20;
  const auto [first, second] = gate_outcomes(a, b);
  const auto n = trials_for_two(first, second, kGoal, 1).value();
  const auto found = [&](const CellProbabilities& p, std::uint64_t seed) {
    double count = 0.0;
    for (std::uint64_t k = 0; k < kRepeats; ++k)
      count += joint_test({sampled(a, n, seed, k), {}}, {sampled(p, n, seed + 1, k), {}}, 399, k)
                   .differs();
    return count / kRepeats;
  };
  const double seen = found(b, 21), without = found(a, 31);
  EXPECT_NEAR(seen, 0.8, 4 * std::sqrt(0.8 * 0.2 / kRepeats));
  EXPECT_LE(without, 0.05 + 4 * std::sqrt(0.05 * 0.95 / kRepeats));
  record("two", n, seen, without);
  EXPECT_FALSE(trials_for_two(first, first.shares, kGoal, 1));
}

// Endings: the largest difference of a single ending decides; with two endings, both have it.
TEST(SimulatedTest, OfTwoEndingsIsTheBinomial) {
  std::array<double, markov::kEndings> endings{};
  endings[0] = 0.7;
  endings[1] = 0.3;
  Outcomes two = ending_outcomes(endings);
  Eigen::VectorXd truth = two.shares;
  truth[0] = 0.55;
  truth[1] = 0.45;
  const SimulatedTest test(two, 60, 0.05, 3);
  // 4000 draws decide which counts are significant: a neighbouring count may be among them.
  const double low = power_of_share(60, 0.3, 0.45, 0.035),
               high = power_of_share(60, 0.3, 0.45, 0.065),
               error = 4 * std::sqrt(0.25 / static_cast<double>(two.draws));
  EXPECT_GE(test.power(truth), low - error);
  EXPECT_LE(test.power(truth), high + error);
}

TEST(SimulatedTest, SameBitsOnAnyNumberOfThreads) {
  const Outcomes gates = gate_outcomes(some_gates());
  const auto power = [&](int threads) {
    return test::on_threads(threads, [&] {
      return SimulatedTest(gates, 50, 0.05, 5).power(*hardest_to_see(gates.shares, 0.25));
    });
  };
  EXPECT_EQ(power(1), power(3));
}

}  // namespace
}  // namespace gatewalk::lattice
