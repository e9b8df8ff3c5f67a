#include "dynamics/flow.h"

namespace gatewalk::dynamics {

BodyFlow::BodyFlow(double g, double dt) {
  const double z = g * dt;
  if (z == 0.0) {
    rise = dt;
    fall = 0.5 * dt * dt;
    return;
  }
  if (z < 1e-2) {
    // Taylor series of (1 - e^-z)/z and (z - 1 + e^-z)/z^2; the next term is below 1e-16.
    rise = dt * (1 - z / 2 * (1 - z / 3 * (1 - z / 4 * (1 - z / 5 * (1 - z / 6 * (1 - z / 7))))));
    decay = 1 - g * rise;
    fall = dt * dt / 2 *
           (1 - z / 3 * (1 - z / 4 * (1 - z / 5 * (1 - z / 6 * (1 - z / 7 * (1 - z / 8))))));
  } else {
    decay = std::exp(-z);
    rise = -std::expm1(-z) / g;
    fall = (dt - rise) / g;
  }
}

BeamFlow::BeamFlow(double k, double d, double dt) : BeamFlow(BeamLaw(k, d).over(dt)) {}

BeamLaw::BeamLaw(double k, double d) : k_(k), d_(d), rate_(std::sqrt(k) + d) {
  // theta'' = 1 - d theta' - k theta, power by power. In units of `rate` no root exceeds 1, so that
  // |omega_[i]| <= 1 / i!.
  const double scaled_d = rate_ > 0.0 ? d / rate_ : 0.0;
  const double scaled_k = rate_ > 0.0 ? k / rate_ / rate_ : 0.0;
  for (int i = 0; i < kTerms; ++i) {
    double accel = i == 0 ? 1.0 : -scaled_d * omega_[i - 1];
    if (i >= 2) accel -= scaled_k * theta_[i - 2];
    omega_[i] = accel / (i + 1);
    theta_[i] = omega_[i] / (i + 2);
  }
}

BeamFlow BeamLaw::over(double dt) const {
  const double k = k_, d = d_, a = d / 2;
  const double z = (a * a - k) * dt * dt;  // > 0: overdamped
  const double phase = rate_ * std::abs(dt);
  BeamFlow f;
  if (phase < 0.5) {
    // As many terms as leave z^n / n! below 1e-17.
    const int terms = phase < 1e-3 ? 6 : phase < 0.02 ? 8 : phase < 0.15 ? 12 : kTerms;
    const double x = rate_ * dt;
    double theta = 0.0, omega = 0.0;
    for (int i = terms - 1; i >= 0; --i) {
      theta = theta * x + theta_[i];
      omega = omega * x + omega_[i];
    }
    f.ta = dt * dt * theta;
    f.wa = dt * omega;
    f.ww =
        1 - d * f.wa - k * f.ta;  // response to a unit velocity: the derivative of that to a push
  } else if (z > 1e-4) {
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
  const double a = d_ / 2, pull = k_ * beam.theta + a * beam.omega;
  const double w2 = k_ - a * a, w = std::sqrt(std::abs(w2));
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
