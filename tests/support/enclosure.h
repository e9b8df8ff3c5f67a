// SPDX-License-Identifier: MIT
#pragma once
/// A number bounded by two doubles, with sums, products and quotients rounded outwards.

#include <cmath>
#include <limits>

namespace gatewalk::markov {

/// A non-negative number, such as a probability or visits. The bounds hold with any compiler: a
/// sum, product or quotient rounded to the nearest double is less than one double away from the
/// exact value, so its two neighbours enclose that value. (Boost's interval switches the
/// processor's rounding mode instead, which optimising compilers ignore without -frounding-math.)
struct Enclosure {
  double lo = 0.0, hi = 0.0;

  Enclosure() = default;
  Enclosure(double exactly)  // NOLINT(google-explicit-constructor): a double is an enclosure
      : lo(exactly), hi(exactly) {}
  Enclosure(double low, double high) : lo(low), hi(high) {}

  friend Enclosure operator+(const Enclosure& a, const Enclosure& b) {
    if (a.hi == 0.0) return b;
    if (b.hi == 0.0) return a;
    return {down(a.lo + b.lo), up(a.hi + b.hi)};
  }
  friend Enclosure operator*(const Enclosure& a, const Enclosure& b) {
    if (a.hi == 0.0 || b.hi == 0.0) return 0.0;
    return {down(a.lo * b.lo), up(a.hi * b.hi)};
  }
  friend Enclosure operator/(const Enclosure& a, const Enclosure& b) {
    if (a.hi == 0.0) return 0.0;
    return {down(a.lo / b.hi), up(a.hi / b.lo)};
  }
  Enclosure& operator+=(const Enclosure& b) { return *this = *this + b; }
  Enclosure& operator/=(const Enclosure& b) { return *this = *this / b; }

  /// Comparisons are true if they hold for certain.
  friend bool operator==(const Enclosure&, const Enclosure&) = default;
  friend bool operator>(const Enclosure& a, const Enclosure& b) { return a.lo > b.hi; }
  friend bool operator>=(const Enclosure& a, const Enclosure& b) { return a.lo >= b.hi; }
  friend bool operator<=(const Enclosure& a, const Enclosure& b) { return a.hi <= b.lo; }

 private:
  static double down(double x) { return x > 0.0 ? std::nextafter(x, 0.0) : 0.0; }
  static double up(double x) { return std::nextafter(x, std::numeric_limits<double>::infinity()); }
};

}  // namespace gatewalk::markov
