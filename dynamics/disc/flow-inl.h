// SPDX-License-Identifier: MIT
// Free motion over short times as power series, for Wide and for double (wide-inl.h): plain code
// and lanes have the same bits.
#if defined(GATEWALK_DYNAMICS_FLOW_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef GATEWALK_DYNAMICS_FLOW_INL_H_
#undef GATEWALK_DYNAMICS_FLOW_INL_H_
#else
#define GATEWALK_DYNAMICS_FLOW_INL_H_
#endif

#include "dynamics/base/wide-inl.h"
#include "dynamics/disc/flow.h"

HWY_BEFORE_NAMESPACE();
namespace gatewalk::dynamics {
namespace HWY_NAMESPACE {

/// The coefficients of BodyFlow and BeamFlow as Numbers.
template <class Number>
struct BodyFlowOf {
  Number decay, rise, fall;
};
template <class Number>
struct BeamFlowOf {
  Number tt, tw, wt, ww, ta, wa;
};

/// The body's coefficients for g dt < BodyFlow::kSeries, from the series of (1 - e^-z)/z and (z - 1
/// + e^-z)/z^2 with z = g dt; omitted terms are below 1e-17.
template <class Number>
HWY_INLINE BodyFlowOf<Number> body_series(double g, Number dt) {
  constexpr double kRise[] = {1.0, -1.0 / 2, 1.0 / 6, -1.0 / 24, 1.0 / 120, -1.0 / 720, 1.0 / 5040};
  constexpr double kFall[] = {1.0 / 2,   -1.0 / 6,    1.0 / 24,   -1.0 / 120,
                              1.0 / 720, -1.0 / 5040, 1.0 / 40320};
  const Number z = g * dt;
  const Number rise = dt * series(z, kRise);
  return {like(z, 1.0) - g * rise, rise, dt * dt * series(z, kFall)};
}

/// The beam's coefficients for |rate dt| < BeamLaw::kSeries.
template <class Number>
HWY_INLINE BeamFlowOf<Number> beam_series(const BeamLaw& law, Number dt) {
  const Number x = law.rate * dt;
  BeamFlowOf<Number> f;
  f.ta = dt * dt * series(x, law.theta);
  f.wa = dt * series(x, law.omega);
  // The response to a unit velocity is the derivative of the response to a unit acceleration.
  f.ww = like(x, 1.0) - law.d * f.wa - law.k * f.ta;
  f.tw = f.wa;
  f.wt = -law.k * f.wa;
  f.tt = like(x, 1.0) - law.k * f.ta;
  return f;
}

}  // namespace HWY_NAMESPACE
}  // namespace gatewalk::dynamics
HWY_AFTER_NAMESPACE();

#endif
