// SPDX-License-Identifier: MIT
#include "dynamics/base/random.h"
#include "dynamics/disc/random_force.h"

#include <Random123/philox.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <vector>

#include "tests/support/instruction_sets.h"
#include "tests/support/numbers.h"

namespace gatewalk::dynamics {
namespace {

using Words = std::array<std::uint64_t, 4>;

Words philox(const Words& counter, std::array<std::uint64_t, 2> key) {
  const auto out =
      r123::Philox4x64()({{counter[0], counter[1], counter[2], counter[3]}}, {{key[0], key[1]}});
  return {out[0], out[1], out[2], out[3]};
}

// philox4x64-10 of Random123's kat_vectors.
TEST(Philox, KnownAnswers) {
  constexpr std::uint64_t ones = ~std::uint64_t{0};
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}), (Words{0x16554d9eca36314c, 0xdb20fe9d672d0fdc,
                                                 0xd7e772cee186176b, 0x7e68b68aec7ba23b}));
  EXPECT_EQ(
      philox({ones, ones, ones, ones}, {ones, ones}),
      (Words{0x87b092c3013fe90b, 0x438c3c67be8d0224, 0x9cc7d7c69cd777b6, 0xa09caebf594f0ba0}));
  EXPECT_EQ(
      philox({0x243f6a8885a308d3, 0x13198a2e03707344, 0xa4093822299f31d0, 0x082efa98ec4e6c89},
             {0x452821e638d01377, 0xbe5466cf34e90c6c}),
      (Words{0xa528f45403e61d95, 0x38c72dbd566e9788, 0xa5a1610e72fd18b5, 0x57bd43b5e52b7fe6}));
}

// A stream is the key {seed, purpose and row} and the counter {block, trial}, so the names in a
// result file replay it at any time.
TEST(Random, WordsAreThePhiloxBlocksOfItsStream) {
  Random none(Purpose{0}, {.seed = 0, .row = 0, .trial = 0});
  EXPECT_EQ(none.word(), 0x16554d9eca36314cu);  // the first known answer
  Random random(Purpose::field, {.seed = 7, .row = 41, .trial = 123});
  for (std::uint64_t block = 0; block < 3; ++block) {
    for (const std::uint64_t word : philox({block, 123, 0, 0}, {7, (std::uint64_t{3} << 56) ^ 41}))
      EXPECT_EQ(random.word(), word);
  }
}

TEST(Random, EveryPartOfTheNameMakesAnotherStream) {
  std::vector<Random> streams;
  const std::vector<Purpose> purposes{Purpose::gate, Purpose::row, Purpose::field,
                                      Purpose::comparison};
  for (const Purpose purpose : purposes)
    for (std::uint64_t seed = 0; seed < 4; ++seed)
      for (std::uint64_t row = 0; row < 4; ++row)
        for (std::uint64_t trial = 0; trial < 4; ++trial)
          streams.emplace_back(purpose, Stream{seed, row, trial});
  std::set<std::uint64_t> words;
  for (Random& stream : streams)
    for (int i = 0; i < 16; ++i) words.insert(stream.word());
  EXPECT_EQ(words.size(), streams.size() * 16);  // a repeat by chance has probability 1e-12
}

TEST(Random, SameNameSameNumbers) {
  const Stream name{5, 6, 7};
  Random a(Purpose::row, name), b(Purpose::row, name);
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(a.normal(), b.normal());
}

TEST(OpenUniform, KeepsBothEndsOut) {
  EXPECT_GT(open_uniform(0), 0.0);
  EXPECT_LT(open_uniform(~std::uint64_t{0}), 1.0);
}

TEST(OpenUniform, IsTheWordAsAFraction) {
  for (const std::uint64_t word :
       {std::uint64_t{1} << 63, std::uint64_t{1} << 62, std::uint64_t{3} << 62,
        std::uint64_t{0x123456789abcdef0}, std::uint64_t{0xfedcba9876543210}}) {
    EXPECT_NEAR(open_uniform(word), std::ldexp(static_cast<double>(word), -64), 0x1p-52);
  }
}

TEST(Random, UniformsFillTheirInterval) {
  Random random(Purpose::gate, {.seed = 1, .row = 0, .trial = 0});
  constexpr int n = 1'000'000, bins = 100;
  std::vector<int> count(bins);
  for (int i = 0; i < n; ++i) ++count[static_cast<std::size_t>(random.uniform() * bins)];
  double chi2 = 0.0;
  for (const int c : count) chi2 += (c - n / bins) * static_cast<double>(c - n / bins) / (n / bins);
  EXPECT_NEAR(chi2, bins - 1, 4 * std::sqrt(2.0 * (bins - 1)));  // 4 standard deviations
}

TEST(Random, BelowIsUniformOnWholeNumbers) {
  Random random(Purpose::gate, {.seed = 4, .row = 0, .trial = 0});
  constexpr int n = 7, draws = 700'000;
  std::vector<int> count(n);
  for (int i = 0; i < draws; ++i) {
    const std::int64_t k = random.below(n);
    ASSERT_TRUE(k >= 0 && k < n) << k;
    ++count[static_cast<std::size_t>(k)];
  }
  double chi2 = 0.0;
  for (const int c : count) chi2 += std::pow(c - draws / n, 2) / (draws / n);
  EXPECT_NEAR(chi2, n - 1, 4 * std::sqrt(2.0 * (n - 1)));
  EXPECT_EQ(random.below(1), 0);
  constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
  std::int64_t largest = 0;
  for (int i = 0; i < 100; ++i) largest = std::max(largest, random.below(most));
  EXPECT_GT(largest, most / 2);  // all 63 bits are in play
}

// Moments of N(0,1) within 4 standard errors; sine and cosine draws are uncorrelated.
TEST(Random, NormalsAreStandardNormal) {
  Random random(Purpose::gate, {.seed = 2, .row = 0, .trial = 0});
  constexpr int n = 1'000'000;
  double m1 = 0, m2 = 0, m3 = 0, m4 = 0, pairs = 0, neighbours = 0, last = 0;
  int beyond = 0;
  for (int i = 0; i < n; ++i) {
    const double x = random.normal();
    m1 += x;
    m2 += x * x;
    m3 += x * x * x;
    m4 += x * x * x * x;
    (i % 2 ? pairs : neighbours) += x * last;
    beyond += std::abs(x) > 3.0;
    last = x;
  }
  const double root = std::sqrt(n);
  EXPECT_NEAR(m1 / n, 0.0, 4 / root);
  EXPECT_NEAR(m2 / n, 1.0, 4 * std::sqrt(2.0) / root);
  EXPECT_NEAR(m3 / n, 0.0, 4 * std::sqrt(15.0) / root);
  EXPECT_NEAR(m4 / n, 3.0, 4 * std::sqrt(96.0) / root);
  EXPECT_NEAR(pairs / (n / 2), 0.0, 4 / std::sqrt(n / 2));
  EXPECT_NEAR(neighbours / (n / 2), 0.0, 4 / std::sqrt(n / 2));
  const double tail = std::erfc(3 / std::sqrt(2.0));
  EXPECT_NEAR(beyond, n * tail, 4 * std::sqrt(n * tail));
}

// The plain reference takes the same uniforms. Differences are rounding, relative to the radius of
// a pair and including that of the angle, 2 pi eps.
TEST(Random, NormalsByTheBatchAreThoseOfThePlainReference) {
  constexpr double eps = std::numeric_limits<double>::epsilon();
  double worst = 0.0;
  for (std::uint64_t trial = 0; trial < 2000; ++trial) {
    const Stream name{.seed = 9, .row = 1, .trial = trial};
    Random plain(Purpose::gate, name), batch(Purpose::gate, name);
    for (int round = 0; round < 3; ++round) {
      Random::Normals normals;
      batch.normals(normals);
      for (std::size_t i = 0; i < normals.size(); i += 2) {
        const double x = plain.normal(), y = plain.normal();
        const double radius = std::hypot(x, y);
        worst = std::max(
            {worst, std::abs(normals[i] - x) / radius, std::abs(normals[i + 1] - y) / radius});
      }
    }
    EXPECT_EQ(plain.word(), batch.word());  // both took the same number
  }
  EXPECT_LE(worst, 10 * eps);
  EXPECT_GT(worst, 0.0);
}

TEST(Random, NormalsHaveTheSameBitsWithAnyInstructionSet) {
  const auto draw = [] {
    std::vector<double> all;
    Random random(Purpose::gate, {.seed = 9, .row = 2, .trial = 0});
    for (int round = 0; round < 500; ++round) {
      Random::Normals normals;
      random.normals(normals);
      all.insert(all.end(), normals.begin(), normals.end());
    }
    return all;
  };
  const std::vector<double> best = draw();
  test::on_every_instruction_set([&] { EXPECT_EQ(draw(), best); });
}

TEST(Random, NormalsFollowTheNormalDistribution) {
  Random random(Purpose::gate, {.seed = 3, .row = 0, .trial = 0});
  std::vector<double> x(100'000);
  for (double& v : x) v = random.normal();
  std::sort(x.begin(), x.end());
  double worst = 0.0;
  const auto n = static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double cdf = 0.5 * std::erfc(-x[i] / std::sqrt(2.0));
    const auto rank = static_cast<double>(i);
    worst = std::max({worst, cdf - rank / n, (rank + 1) / n - cdf});
  }
  EXPECT_LT(worst, 1.95 / std::sqrt(n));  // Kolmogorov's 0.1 % point
}

// ---- Held force ----

const Forces kForces{.propulsion = 0.0, .random = 20.0, .random_rate = 50.0, .drag = 0.0};

RandomForce force_of(std::uint64_t trial, double sign = 1.0) {
  return {kForces, Random(Purpose::gate, {.seed = 1, .row = 0, .trial = trial}), sign};
}

TEST(RandomForce, HoldsEachDrawForOneFiftiethOfASecond) {
  RandomForce force = force_of(0);
  Random draws(Purpose::gate, {.seed = 1, .row = 0, .trial = 0});
  Random::Normals normals;
  for (int hold = 0; hold < 1000; ++hold) {
    const std::size_t used = static_cast<std::size_t>(hold) % normals.size();
    if (used == 0) draws.normals(normals);
    const double expected = 20.0 * normals[used];
    for (int step = 0; step < 5; ++step) {
      EXPECT_EQ(force.value(), expected) << hold << ' ' << step;
      EXPECT_NEAR(force.left(), 0.02 - 0.004 * step, 1e-15);
      force.pass(0.004);
    }
  }
}

// For any division of the time: 20 000 steps of 1e-6 s, unequal pieces, or whole holds.
TEST(RandomForce, DoesNotCareHowTimeIsCut) {
  for (const int cuts : {1, 2, 3, 7, 1000, 20'000}) {
    RandomForce whole = force_of(4), cut = force_of(4);
    for (int hold = 0; hold < 20; ++hold) {
      const double expected = whole.value();
      whole.pass(whole.left());
      for (int i = 0; i < cuts; ++i) {
        ASSERT_EQ(cut.value(), expected) << cuts << ' ' << hold << ' ' << i;
        ASSERT_GT(cut.left(), 0.0);
        cut.pass(0.02 / cuts);
      }
    }
  }
}

// A step that fits its hold within the permitted 1e-6: one draw per hold, whichever the sign.
TEST(RandomForce, ForgivesStepsThatNearlyAddUpToAHold) {
  Forces f;
  f.random_rate = 60.0;
  for (const double step : {0.00333333333, 0.00333333666, 1.0 / 300.0}) {
    RandomForce force(f, Random(Purpose::gate, {1, 0, 0}));
    for (int hold = 0; hold < 2000; ++hold) {
      const double value = force.value();
      for (int i = 0; i < 5; ++i) {
        ASSERT_EQ(force.value(), value) << step << " s, hold " << hold << ", step " << i;
        force.pass(step);
      }
      ASSERT_NE(force.value(), value) << step << " s, hold " << hold;
    }
  }
}

TEST(RandomForce, AskingDoesNotDraw) {
  RandomForce a = force_of(5), b = force_of(5);
  for (int i = 0; i < 10; ++i) (void)a.value();
  a.pass(0.02);
  (void)b.value();
  b.pass(0.02);
  EXPECT_EQ(a.value(), b.value());
}

TEST(RandomForce, DropsTheRestOfAHoldAndGoesOnInTheSequence) {
  RandomForce whole = force_of(7), dropped = force_of(7);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(whole.value(), dropped.value());
    EXPECT_NEAR(dropped.left(), 0.02, 1e-15);
    whole.pass(0.02);
    dropped.pass(0.013);
    dropped.drop_hold();
    dropped.drop_hold();  // once more changes nothing
  }
}

TEST(RandomForce, NegativeSignIsTheMirrorImage) {
  RandomForce a = force_of(6), b = force_of(6, -1.0);
  for (int i = 0; i < 1000; ++i) {
    EXPECT_EQ(a.value(), -b.value());
    a.pass(0.02);
    b.pass(0.02);
  }
}

TEST(RandomForce, NoMagnitudeNoForce) {
  Forces quiet = kForces;
  quiet.random = 0.0;
  RandomForce force(quiet, Random(Purpose::gate, {}));
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(force.value(), 0.0);
    force.pass(0.02);
  }
}

}  // namespace
}  // namespace gatewalk::dynamics
