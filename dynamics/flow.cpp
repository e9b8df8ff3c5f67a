#include "dynamics/flow.h"

#include <array>

namespace gatewalk::dynamics {
namespace {

constexpr int kTerms = 20;  // 0.5^20 / 20! < 1e-24
constexpr std::array<double, kTerms + 1> kInverse = [] {
  std::array<double, kTerms + 1> inverse{};
  for (int n = 1; n <= kTerms; ++n) inverse[n] = 1.0 / n;
  return inverse;
}();

}  // namespace

BodyFlow::BodyFlow(double g, double dt) {
  const double z = g * dt;
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

BeamFlow::BeamFlow(double k, double d, double dt) {
  const double a = d / 2;
  const double z = (a * a - k) * dt * dt;  // > 0: overdamped
  const double fastest = dt * (std::sqrt(k) + d);
  if (fastest < 0.5) {
    // Power series of the response to a unit push from rest, theta'' = 1 - d theta' - k theta, with
    // terms b_n = c_n dt^(n-2). The other five follow from it by differentiation.
    double b0 = 0.0, b1 = 0.0;
    double theta = 0.0, omega = 0.0, accel = 0.0;
    for (int n = 2; n <= kTerms; ++n) {
      const double rest = n == 2 ? 1.0 : -(d * dt * (n - 1)) * b1 - (k * dt * dt) * b0;
      const double b2 = rest * kInverse[n] * kInverse[n - 1];
      theta += b2;
      omega += n * b2;
      accel += n * (n - 1) * b2;
      if (std::abs(b1) + std::abs(b2) < 1e-20) break;  // two in a row: one may vanish by itself
      b0 = b1;
      b1 = b2;
    }
    ta = dt * dt * theta;
    wa = dt * omega;
    ww = accel;  // the response to a unit velocity is the derivative of the one to a unit push
  } else if (z > 1e-4) {
    const double s = std::sqrt(a * a - k);
    const double fast = -(a + s), slow = k / fast;  // roots; slow without cancellation
    const double ef = std::exp(fast * dt), es = std::exp(slow * dt);
    wa = (es - ef) / (2 * s);
    ww = (slow * es - fast * ef) / (2 * s);
    const double slow_part = slow == 0.0 ? dt : std::expm1(slow * dt) / slow;
    ta = (slow_part - std::expm1(fast * dt) / fast) / (2 * s);
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
    wa = e * sine;
    ww = e * (cosine - a * sine);
    ta = (1 - e * (cosine + a * sine)) / k;
  }
  tw = wa;
  wt = -k * wa;
  tt = 1 - k * ta;
}

GateFlow::GateFlow(const GateParams& p, double step)
    : dt(step),
      body(p.forces.drag / p.body.mass, step),
      left(p.beams.stiffness_left / p.beams.inertia(), p.beams.damping / p.beams.inertia(), step),
      right(p.beams.stiffness_right / p.beams.inertia(), p.beams.damping / p.beams.inertia(), step) {}

}  // namespace gatewalk::dynamics
