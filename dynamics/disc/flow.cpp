// SPDX-License-Identifier: MIT
#include "dynamics/disc/flow.h"

#include "dynamics/disc/flow-inl.h"

namespace gatewalk::dynamics {

BodyFlow::BodyFlow(double g, double dt) {
  const double z = g * dt;
  if (z < kSeries) {
    const auto f = HWY_NAMESPACE::body_series(g, dt);
    decay = f.decay;
    rise = f.rise;
    fall = f.fall;
  } else {
    decay = std::exp(-z);
    rise = -std::expm1(-z) / g;
    fall = (dt - rise) / g;
  }
}

BeamFlow::BeamFlow(double k, double d, double dt) : BeamFlow(BeamLaw(k, d).over(dt)) {}

BeamLaw::BeamLaw(double stiffness, double damping)
    : k(stiffness), d(damping), rate(std::sqrt(stiffness) + damping) {
  // Power series of theta'' = 1 - d theta' - k theta. In units of `rate` no root exceeds 1, so
  // |omega[i]| <= 1 / i!.
  const double scaled_d = rate > 0.0 ? d / rate : 0.0;
  const double scaled_k = rate > 0.0 ? k / rate / rate : 0.0;
  for (int i = 0; i < kTerms; ++i) {
    double accel = i == 0 ? 1.0 : -scaled_d * omega[i - 1];
    if (i >= 2) accel -= scaled_k * theta[i - 2];
    omega[i] = accel / (i + 1);
    theta[i] = omega[i] / (i + 2);
  }
}

BeamFlow BeamLaw::over(double dt) const {
  BeamFlow f;
  if (rate * std::abs(dt) < kSeries) {
    const auto of = HWY_NAMESPACE::beam_series(*this, dt);
    f.tt = of.tt;
    f.tw = of.tw;
    f.wt = of.wt;
    f.ww = of.ww;
    f.ta = of.ta;
    f.wa = of.wa;
    return f;
  }
  const double a = d / 2;
  const double z = (a * a - k) * dt * dt;  // > 0: overdamped
  if (z > 1e-4) {
    const double s = std::sqrt(a * a - k);
    const double fast = -(a + s), slow = k / fast;  // roots; slow without cancellation
    const double ef = std::exp(fast * dt), es = std::exp(slow * dt);
    f.wa = (es - ef) / (2 * s);
    f.ww = (slow * es - fast * ef) / (2 * s);
    const double slow_part = slow == 0.0 ? dt : std::expm1(slow * dt) / slow;
    f.ta = (slow_part - std::expm1(fast * dt) / fast) / (2 * s);
  } else {
    const double e = std::exp(-a * dt);
    double sine, cosine;  // sin(w dt)/w and cos(w dt), w^2 = k - a^2
    if (z < -1e-4) {
      const double w = std::sqrt(k - a * a);
      sine = std::sin(w * dt) / w;
      cosine = std::cos(w * dt);
    } else {  // near critical damping both are entire functions of z
      sine = dt * (1 + z / 6 * (1 + z / 20 * (1 + z / 42)));
      cosine = 1 + z / 2 * (1 + z / 12 * (1 + z / 30));
    }
    f.wa = e * sine;
    f.ww = e * (cosine - a * sine);
    f.ta = (1 - e * (cosine + a * sine)) / k;
  }
  f.tw = f.wa;
  f.wt = -k * f.wa;
  f.tt = 1 - k * f.ta;
  return f;
}

double BeamLaw::swing(BeamState beam, double dt) const {
  // omega(t) = e^(-at) (omega cos(wt) - pull sin(wt)/w) with w^2 = k - a^2 is zero where
  // tan(wt)/w = omega/pull; tanh for w^2 < 0.
  const double a = d / 2, pull = k * beam.theta + a * beam.omega;
  const double w2 = k - a * a, w = std::sqrt(std::abs(w2));
  const double ratio = beam.omega / pull;
  double when;
  if (w2 > 0.0)
    when = std::atan2(w * std::abs(beam.omega), std::copysign(pull, pull * beam.omega)) / w;
  else
    when = w > 0.0 ? std::atanh(w * ratio) / w : ratio;
  if (!(when > 0.0 && when < dt)) return 0.0;
  over(when).apply(beam, 0.0);
  return std::abs(beam.theta);
}

namespace {

BeamLaw beam_law(const GateParams& p, Side side) {
  const double inertia = p.beams.inertia();
  return {p.beams.stiffness(side) / inertia, p.beams.damping / inertia};
}

}  // namespace

GateLaw::GateLaw(const GateParams& p)
    : drag(p.forces.drag / p.body.mass), beams{beam_law(p, kLeft), beam_law(p, kRight)} {}

}  // namespace gatewalk::dynamics
