// SPDX-License-Identifier: MIT
#pragma once
/// Exact fractions, and tests of other kinds of number against them. Boost's cpp_rational needs no
/// library (mpq_rational needs GMP) and is fast enough here.

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <limits>

#include "tests/support/enclosure.h"

namespace gatewalk::markov::test {

using Rational = boost::multiprecision::cpp_rational;

/// Expects a number within n * 1e-15 of the exact one, relative to it, or as many roundings of a
/// longer floating-point type.
template <class Float>
void expect_within_roundings(Float x, const Rational& exact, std::int64_t n) {
  ASSERT_TRUE(std::isfinite(x));
  const double most =
      static_cast<double>(n) * 4.5 * static_cast<double>(std::numeric_limits<Float>::epsilon());
  const Rational off = abs(Rational(Rational(x) - exact));
  EXPECT_TRUE(off <= Rational(exact * Rational(most)))
      << x << " for " << exact.convert_to<double>() << ": off by " << off.convert_to<double>();
}
inline void expect_is(double x, const Rational& exact, std::int64_t n) {
  expect_within_roundings(x, exact, n);
}
inline void expect_is(long double x, const Rational& exact, std::int64_t n) {
  expect_within_roundings(x, exact, n);
}
inline void expect_is(const Rational& x, const Rational& exact, std::int64_t) {
  EXPECT_TRUE(x == exact) << x << " for " << exact;
}
/// Expects an enclosure of the exact number that is not much wider than needed: some roundings per
/// state, which grow as they propagate.
inline void expect_is(const Enclosure& x, const Rational& exact, std::int64_t n) {
  ASSERT_TRUE(std::isfinite(x.hi));
  EXPECT_TRUE(Rational(x.lo) <= exact && exact <= Rational(x.hi))
      << "[" << x.lo << ", " << x.hi << "] for " << exact.convert_to<double>();
  EXPECT_LE(x.hi - x.lo, static_cast<double>(n * n) * 1e-14 * x.hi);
}

}  // namespace gatewalk::markov::test
