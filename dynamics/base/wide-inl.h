// SPDX-License-Identifier: MIT
// Wide: two vector registers of numbers, used like a single number inside Highway's foreach_target
// (hence no plain include guard). Two registers hide latency, because they do not depend on each
// other. No operation is fused and no sum runs over lanes, so every lane has the same bits with any
// instruction set.
#if defined(GATEWALK_DYNAMICS_WIDE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef GATEWALK_DYNAMICS_WIDE_INL_H_
#undef GATEWALK_DYNAMICS_WIDE_INL_H_
#else
#define GATEWALK_DYNAMICS_WIDE_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace gatewalk::dynamics {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, 8>;  // 16 numbers at most
using V = hn::Vec<D>;
using M = hn::Mask<D>;

struct Wide {
  V a, b;
};
struct WideMask {
  M a, b;
};

HWY_INLINE std::size_t width() { return 2 * hn::Lanes(D()); }
HWY_INLINE Wide all(double x) { return {hn::Set(D(), x), hn::Set(D(), x)}; }
HWY_INLINE Wide load(const double* from) {
  return {hn::LoadU(D(), from), hn::LoadU(D(), from + hn::Lanes(D()))};
}
HWY_INLINE void store(Wide x, double* to) {
  hn::StoreU(x.a, D(), to);
  hn::StoreU(x.b, D(), to + hn::Lanes(D()));
}

HWY_INLINE Wide operator+(Wide x, Wide y) { return {hn::Add(x.a, y.a), hn::Add(x.b, y.b)}; }
HWY_INLINE Wide operator-(Wide x, Wide y) { return {hn::Sub(x.a, y.a), hn::Sub(x.b, y.b)}; }
HWY_INLINE Wide operator*(Wide x, Wide y) { return {hn::Mul(x.a, y.a), hn::Mul(x.b, y.b)}; }
HWY_INLINE Wide operator/(Wide x, Wide y) { return {hn::Div(x.a, y.a), hn::Div(x.b, y.b)}; }
HWY_INLINE Wide operator*(double x, Wide y) { return all(x) * y; }
HWY_INLINE Wide operator-(Wide x) { return {hn::Neg(x.a), hn::Neg(x.b)}; }
HWY_INLINE Wide sqrt(Wide x) { return {hn::Sqrt(x.a), hn::Sqrt(x.b)}; }
HWY_INLINE Wide abs(Wide x) { return {hn::Abs(x.a), hn::Abs(x.b)}; }
HWY_INLINE Wide max(Wide x, Wide y) { return {hn::Max(x.a, y.a), hn::Max(x.b, y.b)}; }
HWY_INLINE Wide min(Wide x, Wide y) { return {hn::Min(x.a, y.a), hn::Min(x.b, y.b)}; }

HWY_INLINE WideMask operator<(Wide x, Wide y) { return {hn::Lt(x.a, y.a), hn::Lt(x.b, y.b)}; }
HWY_INLINE WideMask operator<=(Wide x, Wide y) { return {hn::Le(x.a, y.a), hn::Le(x.b, y.b)}; }
HWY_INLINE WideMask operator>(Wide x, Wide y) { return y < x; }
HWY_INLINE WideMask operator>=(Wide x, Wide y) { return y <= x; }
HWY_INLINE WideMask operator==(Wide x, Wide y) { return {hn::Eq(x.a, y.a), hn::Eq(x.b, y.b)}; }
HWY_INLINE WideMask finite(Wide x) { return {hn::IsFinite(x.a), hn::IsFinite(x.b)}; }
HWY_INLINE WideMask operator&(WideMask x, WideMask y) {
  return {hn::And(x.a, y.a), hn::And(x.b, y.b)};
}
HWY_INLINE WideMask operator|(WideMask x, WideMask y) {
  return {hn::Or(x.a, y.a), hn::Or(x.b, y.b)};
}
HWY_INLINE WideMask operator~(WideMask x) { return {hn::Not(x.a), hn::Not(x.b)}; }
HWY_INLINE bool any(WideMask x) { return !hn::AllFalse(D(), hn::Or(x.a, x.b)); }

HWY_INLINE Wide choose(WideMask m, Wide yes, Wide no) {
  return {hn::IfThenElse(m.a, yes.a, no.a), hn::IfThenElse(m.b, yes.b, no.b)};
}
HWY_INLINE WideMask choose(WideMask m, WideMask yes, WideMask no) { return (m & yes) | (~m & no); }
HWY_INLINE Wide or_zero(WideMask m, Wide yes) {
  return {hn::IfThenElseZero(m.a, yes.a), hn::IfThenElseZero(m.b, yes.b)};
}

// Functions of a Number work for Wide and for double, so the plain code has the same bits as the
// lanes.
HWY_INLINE Wide like(Wide, double x) { return all(x); }
HWY_INLINE double like(double, double x) { return x; }
HWY_INLINE double choose(bool m, double yes, double no) { return m ? yes : no; }

/// The polynomial c[0] + c[1] z + ... Even and odd powers are summed apart, so that neither sum
/// waits for the other.
template <class Number, std::size_t N>
HWY_INLINE Number series(Number z, const double (&c)[N]) {
  static_assert(N >= 2);
  const Number zz = z * z;
  Number last = like(z, c[N - 1]), other = like(z, c[N - 2]);
  for (std::size_t i = N - 2; i-- > 0;) {
    const Number next = last * zz + like(z, c[i]);
    last = other;
    other = next;
  }
  return other + last * z;
}

template <class Number>
struct Direction2 {
  Number c, s;
};

/// The nearest whole number, ties to even, for |x| < 2^51.
template <class Number>
HWY_INLINE Number rounded(Number x) {
  const Number big = like(x, 0x1.8p+52);
  return (x + big) - big;
}

/// cos and sin with an absolute error of 3e-16 for |angle| < 10^6; near zeros the relative error is
/// larger. The angle is reduced to [-pi/4, pi/4] by three parts of pi/2, of which the first two are
/// short enough for exact products. Taylor series follow, with omitted terms below 6e-17 of the
/// sum.
template <class Number>
HWY_INLINE Direction2<Number> direction_of(Number angle) {
  const Number quarter = rounded(0x1.45f306dc9c883p-1 * angle);  // 2/pi
  Number r = angle - 0x1.921fb54p+0 * quarter;
  r = r - 0x1.10b46118p-30 * quarter;
  r = r - 0x1.313198a2e0370p-61 * quarter;
  const Number z = r * r;
  constexpr double kSin[] = {
      -1.0 / 6,        1.0 / 120,          -1.0 / 5040,           1.0 / 362880,
      -1.0 / 39916800, 1.0 / 6227020800.0, -1.0 / 1307674368000.0};
  constexpr double kCos[] = {
      -1.0 / 2,       1.0 / 24,          -1.0 / 720,           1.0 / 40320,
      -1.0 / 3628800, 1.0 / 479001600.0, -1.0 / 87178291200.0, 1.0 / 20922789888000.0};
  const Number sine = r + r * z * series(z, kSin);
  const Number cosine = like(z, 1.0) + z * series(z, kCos);
  if constexpr (std::is_same_v<Number, double>)
    if (quarter == 0.0) return {cosine, sine};
  // quarter modulo 4: 0 (c, s), 1 (-s, c), 2 (-c, -s), 3 (s, -c).
  const Number turn = quarter - 4.0 * rounded(0.25 * quarter - like(z, 0.375));
  const auto one = turn == like(z, 1.0), upper = turn >= like(z, 2.0);
  const auto odd = one | (turn == like(z, 3.0));
  const Number c = choose(odd, sine, cosine), s = choose(odd, cosine, sine);
  return {choose(one | (turn == like(z, 2.0)), -c, c), choose(upper, -s, s)};
}

/// The direction rotated by d, |d| < 1/16, exact to the last digits: Taylor series with omitted
/// terms d^10 / 10! < 3e-19 and d^11 / 11!.
template <class Number>
HWY_INLINE Direction2<Number> turned_by(Number d, const Direction2<Number>& from) {
  constexpr double kSin[] = {-1.0 / 6, 1.0 / 120, -1.0 / 5040, 1.0 / 362880};
  constexpr double kCos[] = {-1.0 / 2, 1.0 / 24, -1.0 / 720, 1.0 / 40320};
  const Number z = d * d;
  const Number c = like(z, 1.0) + z * series(z, kCos), s = d + d * z * series(z, kSin);
  return {from.c * c - from.s * s, from.s * c + from.c * s};
}

/// log to 1 or 2 units in the last place, for normal x > 0. With x = 2^e m and m in [1/sqrt 2, sqrt
/// 2), log m = 2 artanh s for s = (m - 1)/(m + 1), |s| < 0.172; omitted terms of the series are
/// below 3e-17.
HWY_INLINE Wide log(Wide x) {
  const hn::RebindToUnsigned<D> du;
  const hn::RebindToSigned<D> di;
  const auto fraction = [&](V v) HWY_ATTR {
    const auto low = hn::And(hn::BitCast(du, v), hn::Set(du, 0xfffffffffffff));
    return hn::BitCast(D(), hn::Or(low, hn::Set(du, 0x3ff0000000000000)));
  };
  const auto exponent = [&](V v) HWY_ATTR {
    const auto biased = hn::BitCast(di, hn::ShiftRight<52>(hn::BitCast(du, v)));
    return hn::ConvertTo(D(), hn::Sub(biased, hn::Set(di, 1023)));
  };
  Wide m{fraction(x.a), fraction(x.b)}, e{exponent(x.a), exponent(x.b)};
  const WideMask upper = m > all(0x1.6a09e667f3bcdp+0);  // sqrt 2
  m = choose(upper, 0.5 * m, m);
  e = choose(upper, e + all(1.0), e);
  const Wide s = (m - all(1.0)) / (m + all(1.0));
  const Wide z = s * s, twice = s + s;
  constexpr double kArtanh[] = {1.0 / 3,  1.0 / 5,  1.0 / 7,  1.0 / 9, 1.0 / 11,
                                1.0 / 13, 1.0 / 15, 1.0 / 17, 1.0 / 19};
  // log 2 in two parts, the first short enough for exact products.
  const Wide low = twice * z * series(z, kArtanh) + 0x1.ef35793c76730p-45 * e;
  return 0x1.62e42fefa3800p-1 * e + (twice + low);
}

}  // namespace HWY_NAMESPACE
}  // namespace gatewalk::dynamics
HWY_AFTER_NAMESPACE();

#endif
