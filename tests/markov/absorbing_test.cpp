// SPDX-License-Identifier: MIT
/// One set of tests for all kinds of number: exact fractions are the truth, doubles must be within
/// some roundings of it, and enclosures must contain it.

#include "tests/support/absorbing.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "tests/markov/chains.h"
#include "tests/markov/fractions.h"

namespace gatewalk::markov {
namespace {

using test::expect_is;
using test::Rational;

template <class Number>
class Absorbing : public testing::Test {};
using Numbers = testing::Types<double, long double, Rational, Enclosure>;
TYPED_TEST_SUITE(Absorbing, Numbers);

template <class Number>
Number fraction(int a, int b) {
  return Number(a) / Number(b);
}

template <class Number>
void expect_is(const Absorption<Number>& a, const Absorption<Rational>& exact) {
  const Eigen::Index n = exact.visits.rows();
  ASSERT_EQ(a.visits.rows(), n);
  for (Eigen::Index i = 0; i < n; ++i) {
    SCOPED_TRACE("from state " + std::to_string(i));
    for (Eigen::Index j = 0; j < exact.ends.cols(); ++j)
      expect_is(a.ends(i, j), exact.ends(i, j), n);
    for (Eigen::Index j = 0; j < n; ++j) expect_is(a.visits(i, j), exact.visits(i, j), n);
    expect_is(a.steps[static_cast<std::size_t>(i)], exact.steps[static_cast<std::size_t>(i)], n);
  }
}

/// State 0 goes to 1 or ends as 0, with 1/2 each; state 1 goes to 0 with 1/3 or ends as 1.
template <class Number>
AbsorbingChain<Number> two_states() {
  AbsorbingChain<Number> chain(2, 2);
  chain.moves(0, 1) = chain.ends(0, 0) = fraction<Number>(1, 2);
  chain.moves(1, 0) = fraction<Number>(1, 3);
  chain.ends(1, 1) = fraction<Number>(2, 3);
  return chain;
}

TYPED_TEST(Absorbing, TwoStatesByHand) {
  const auto a = absorption(two_states<TypeParam>());
  // A round trip has probability 1/6, so state 0 is visited 1 / (1 - 1/6) = 6/5 times from itself.
  const int fifths[2][2][2] = {{{3, 2}, {1, 4}}, {{6, 3}, {2, 6}}};  // ends, visits
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) {
      expect_is(a.ends(i, j), Rational(fifths[0][i][j], 5), 2);
      expect_is(a.visits(i, j), Rational(fifths[1][i][j], 5), 2);
    }
  expect_is(a.steps[0], Rational(9, 5), 2);
  expect_is(a.steps[1], Rational(8, 5), 2);
}

/// A fair die from fair coins (Knuth and Yao 1976).
template <class Number>
AbsorbingChain<Number> die() {
  AbsorbingChain<Number> chain(7, 6);
  const Number half = fraction<Number>(1, 2);
  const int moves[][2] = {{0, 1}, {0, 2}, {1, 3}, {1, 4}, {2, 5}, {2, 6}, {3, 1}, {6, 2}};
  const int ends[][2] = {{3, 0}, {4, 1}, {4, 2}, {5, 3}, {5, 4}, {6, 5}};
  for (const auto& [from, to] : moves) chain.moves(from, to) = half;
  for (const auto& [from, to] : ends) chain.ends(from, to) = half;
  return chain;
}

TYPED_TEST(Absorbing, ADieFromCoins) {
  const auto a = absorption(die<TypeParam>());
  for (int face = 0; face < 6; ++face) expect_is(a.ends(0, face), Rational(1, 6), 7);
  expect_is(a.steps[0], Rational(11, 3), 7);
}

/// Capital 1 to n; a game is won with a / c, and it ends at 0 or n + 1.
template <class Number>
AbsorbingChain<Number> gambler(int n, int a, int c) {
  AbsorbingChain<Number> chain(n, 2);
  const Number won = fraction<Number>(a, c), lost = fraction<Number>(c - a, c);
  for (int k = 0; k < n; ++k) {
    (k + 1 < n ? chain.moves(k, k + 1) : chain.ends(k, 1)) = won;
    (k > 0 ? chain.moves(k, k - 1) : chain.ends(k, 0)) = lost;
  }
  return chain;
}

TYPED_TEST(Absorbing, GamblersRuin) {
  const int n = 9, most = n + 1;
  const auto fair = absorption(gambler<TypeParam>(n, 1, 2));
  for (int i = 1; i <= n; ++i) {
    expect_is(fair.ends(i - 1, 1), Rational(i, most), n);
    expect_is(fair.steps[static_cast<std::size_t>(i - 1)], Rational(i * (most - i)), n);
  }
  // With r = lost / won = 3/2: (1 - r^i) / (1 - r^most) of the gamblers win; the mean duration is
  // (i - most * that) / (3/5 - 2/5).
  const auto unfair = absorption(gambler<TypeParam>(n, 2, 5));
  const auto power = [](int k) {
    Rational p(1);
    for (int i = 0; i < k; ++i) p *= Rational(3, 2);
    return p;
  };
  for (int i = 1; i <= n; ++i) {
    const Rational wins = (1 - power(i)) / (1 - power(most));
    expect_is(unfair.ends(i - 1, 1), wins, n);
    expect_is(unfair.ends(i - 1, 0), Rational(1 - wins), n);
    expect_is(unfair.steps[static_cast<std::size_t>(i - 1)], Rational((i - most * wins) * 5), n);
  }
}

template <class Number>
AbsorbingChain<Number> random_chain(int n, std::uint64_t seed) {
  AbsorbingChain<Number> chain(n, 2);
  test::Words words(seed);
  for (int i = 0; i < n; ++i) {
    std::vector<int> counts;
    int total = 0;
    for (int j = 0; j < n + 2; ++j)
      total += counts.emplace_back(words.below(3) == 0 ? 0 : 1 + words.below(30));
    for (int j = 0; j < n + 2; ++j)
      (j < n ? chain.moves(i, j) : chain.ends(i, j - n)) =
          fraction<Number>(counts[static_cast<std::size_t>(j)], total);
  }
  return chain;
}

TYPED_TEST(Absorbing, RandomFractions) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5})
    expect_is(absorption(random_chain<TypeParam>(6, seed)),
              absorption(random_chain<Rational>(6, seed)));
  expect_is(absorption(random_chain<TypeParam>(20, 6)), absorption(random_chain<Rational>(20, 6)));
}

// An independent route for the fractions: visits = 1 + moves visits, ends = visits times the
// chain's ends.
TEST(AbsorbingFractions, SolveTheirEquations) {
  const int n = 6;
  const auto chain = random_chain<Rational>(n, 1);
  const auto a = absorption(chain);
  for (int i = 0; i < n; ++i) {
    Rational total(0);
    for (int j = 0; j < n; ++j) {
      Rational visits(i == j ? 1 : 0);
      for (int k = 0; k < n; ++k) visits += chain.moves(i, k) * a.visits(k, j);
      EXPECT_TRUE(visits == a.visits(i, j)) << i << " " << j;
    }
    for (int e = 0; e < 2; ++e) {
      Rational chance(0);
      for (int k = 0; k < n; ++k) chance += a.visits(i, k) * chain.ends(k, e);
      EXPECT_TRUE(chance == a.ends(i, e)) << i << " " << e;
      total += chance;
    }
    EXPECT_TRUE(total == 1);
  }
}

/// Three states that hardly ever end: two of them end with 1 and 3 times 2^-996 (1.5e-300).
template <class Number>
AbsorbingChain<Number> nearly_closed() {
  AbsorbingChain<Number> chain(3, 2);
  const int sevenths[3][3] = {{1, 4, 2}, {3, 0, 4}, {2, 1, 4}};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) chain.moves(i, j) = fraction<Number>(sevenths[i][j], 7);
  chain.ends(0, 0) = Number(std::ldexp(1.0, -996));
  chain.ends(2, 1) = Number(std::ldexp(3.0, -996));
  return chain;
}

TYPED_TEST(Absorbing, EndsWithChance1e300) {
  const auto exact = absorption(nearly_closed<Rational>());
  expect_is(absorption(nearly_closed<TypeParam>()), exact);
  EXPECT_TRUE(exact.ends(0, 0) > Rational(1, 10) && exact.ends(0, 0) < Rational(9, 10));
  EXPECT_TRUE(exact.steps[0] > Rational(1e299));
}

// LU of I - Q computes 1 - q_kk as a difference, in which the probability of leaving is lost.
TEST(AbsorbingDoubles, KeepDigitsWhereLuHasNone) {
  const auto chain = nearly_closed<double>();
  const auto exact = absorption(nearly_closed<Rational>());
  Eigen::MatrixXd q(3, 3), r(3, 2);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) q(i, j) = chain.moves(i, j);
    for (int e = 0; e < 2; ++e) r(i, e) = chain.ends(i, e);
  }
  const Eigen::MatrixXd lu = (Eigen::MatrixXd::Identity(3, 3) - q).partialPivLu().solve(r);
  const Dense<double> gth = end_chances(chain, 3);
  for (int i = 0; i < 3; ++i)
    for (int e = 0; e < 2; ++e) {
      const auto right = exact.ends(i, e).convert_to<double>();
      EXPECT_NEAR(gth(i, e), right, 1e-14 * right);
      EXPECT_FALSE(std::abs(lu(i, e) - right) < 0.1) << "LU: " << lu(i, e) << " for " << right;
    }
}

// A cycle 0, 1, 2, 0, ...: from state 2 one in eight ends.
TYPED_TEST(Absorbing, APeriodicChain) {
  AbsorbingChain<TypeParam> chain(3, 1);
  chain.moves(0, 1) = chain.moves(1, 2) = TypeParam(1);
  chain.moves(2, 0) = fraction<TypeParam>(7, 8);
  chain.ends(2, 0) = fraction<TypeParam>(1, 8);
  const auto a = absorption(chain);
  for (int i = 0; i < 3; ++i) {
    expect_is(a.ends(i, 0), Rational(1), 3);
    for (int j = 0; j < 3; ++j) expect_is(a.visits(i, j), Rational(j >= i ? 8 : 7), 3);
    expect_is(a.steps[static_cast<std::size_t>(i)], Rational(24 - i), 3);
  }
}

// State 2 is never reached, and end 1 is never reached from state 0.
TYPED_TEST(Absorbing, StatesThatNobodyReaches) {
  AbsorbingChain<TypeParam> chain(3, 2);
  chain.moves(0, 0) = chain.ends(0, 0) = fraction<TypeParam>(1, 2);
  chain.moves(1, 0) = chain.ends(1, 1) = fraction<TypeParam>(1, 2);
  chain.moves(2, 1) = TypeParam(1);
  const auto a = absorption(chain);
  const int twice_the_visits[3][3] = {{4, 0, 0}, {2, 2, 0}, {2, 2, 2}};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) expect_is(a.visits(i, j), Rational(twice_the_visits[i][j], 2), 3);
  expect_is(a.ends(0, 0), Rational(1), 3);
  expect_is(a.ends(0, 1), Rational(0), 3);
  expect_is(a.ends(2, 1), Rational(1, 2), 3);
}

template <class Number>
std::string complaint(const AbsorbingChain<Number>& chain) {
  try {
    (void)absorption(chain);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "none";
}

TYPED_TEST(Absorbing, RefusesStatesThatNeverEnd) {
  AbsorbingChain<TypeParam> chain(3, 1);
  chain.moves(0, 1) = chain.ends(0, 0) = fraction<TypeParam>(1, 2);
  chain.moves(1, 2) = chain.moves(2, 1) = TypeParam(1);
  EXPECT_EQ(complaint(chain), "absorbing chain: state 1 (counted from 0) never ends");
}

TYPED_TEST(Absorbing, RefusesWhatIsNoChain) {
  auto chain = two_states<TypeParam>();
  chain.moves(1, 0) = fraction<TypeParam>(1, 4);
  EXPECT_EQ(complaint(chain),
            "absorbing chain: state 1 (counted from 0) has chances that do not sum to 1");
  chain.moves(0, 1) = TypeParam(-1);
  EXPECT_EQ(complaint(chain), "absorbing chain: state 0 (counted from 0) has a negative chance");
  chain.ends = Dense<TypeParam>(3, 1);
  EXPECT_EQ(complaint(chain),
            "absorbing chain: n x n moves and n x m ends are needed, not 2 x 2 and 3 x 1");
}

TYPED_TEST(Absorbing, EndChancesAreThoseOfAll) {
  const auto chain = random_chain<TypeParam>(7, 9);
  const auto all = absorption(chain);
  const auto some = end_chances(chain, 3);
  ASSERT_EQ(some.rows(), 3);
  ASSERT_EQ(some.cols(), 2);
  for (int i = 0; i < 3; ++i)
    for (int e = 0; e < 2; ++e) EXPECT_TRUE(some(i, e) == all.ends(i, e)) << i << " " << e;
}

TEST(Enclosure, HoldsTheExactNumber) {
  const Enclosure third = Enclosure(1) / Enclosure(3);
  Enclosure sum = 0.0, product = 1.0;
  Rational exact_sum(0), exact_product(1);
  for (int k = 0; k < 50; ++k) {
    sum += third;
    product = product * third;
    exact_sum += Rational(1, 3);
    exact_product *= Rational(1, 3);
    expect_is(sum, exact_sum, k + 2);
    expect_is(product, exact_product, k + 2);
  }
  EXPECT_LT(third.lo, third.hi);
  EXPECT_TRUE(third > Enclosure(0.3) && !(third > third) && !(third >= third));
}

// Zero is exactly zero, and a number too small for a double is still enclosed.
TEST(Enclosure, KnowsNothingFromNextToNothing) {
  const Enclosure tiny = std::numeric_limits<double>::min();
  EXPECT_TRUE(Enclosure(0) * tiny == Enclosure(0));
  EXPECT_TRUE(Enclosure(0) + tiny == tiny);
  EXPECT_TRUE(Enclosure(0) / tiny == Enclosure(0));
  const Enclosure square = tiny * tiny;
  EXPECT_EQ(square.lo, 0.0);
  EXPECT_GT(square.hi, 0.0);
}

}  // namespace
}  // namespace gatewalk::markov
