// SPDX-License-Identifier: MIT
#pragma once
/// The exact distribution of a body in free flight under the held random force.
///
/// From M x'' = F_k - D x' (MODEL: M a = F_rand - D v), with F_k = Rm N(0,1) held from t_k = k tau
/// to t_(k+1), the last hold cut at T, and g = D/M (1/s):
///     v(T) = v(0) e^(-g T)               + sum F_k a_k
///     x(T) = x(0) + v(0) (1 - e^(-g T))/g + sum F_k b_k
///     a_k = (e_(k+1) - e_k)/D,   e_k = e^(-g (T - t_k))
///     b_k = (t_(k+1) - t_k - (e_(k+1) - e_k)/g)/D
/// so that v and x are normal, with
///     var v = Rm^2 sum a_k^2,   var x = Rm^2 sum b_k^2,   cov = Rm^2 sum a_k b_k.
/// In its hold, a force does the work F_k v(t_k) rise + F_k^2 fall/M. The first term has the mean
/// 0, because the velocity is independent of later forces:
///     mean work = Rm^2 sum f_k/M,   f_k = (g dt - 1 + e^(-g dt))/g^2,   dt = t_(k+1) - t_k.
/// Without drag, T = n tau:  var v = n (Rm tau/M)^2,  var x = (Rm tau^2/M)^2 n (4 n^2 - 1)/12,
/// cov = Rm^2 tau^3 n^2/(2 M^2),  mean work = n (Rm tau)^2/(2 M), the mean kinetic energy.

#include <algorithm>
#include <cmath>

#include "dynamics/disc/params.h"

namespace gatewalk::test {

struct FreeFlight {
  double mean_x = 0.0, mean_v = 0.0;           // m, m/s
  double var_x = 0.0, var_v = 0.0, cov = 0.0;  // m^2, m^2/s^2, m^2/s
  double mean_work = 0.0;                      // J, of the random force
};

/// The distribution after T seconds, from place x (m) and velocity v (m/s).
inline FreeFlight free_flight(const dynamics::GateParams& p, double x, double v, double T) {
  const double mass = p.body.mass, g = p.forces.drag / mass, tau = 1.0 / p.forces.random_rate;
  const double power = p.forces.random * p.forces.random;  // N^2
  FreeFlight f{x + v * (g > 0.0 ? -std::expm1(-g * T) / g : T), v * std::exp(-g * T)};
  for (int k = 0; k * tau < T - 1e-9 * tau; ++k) {
    const double from = k * tau, to = std::min((k + 1) * tau, T), dt = to - from;
    double a = dt / mass, b = dt * (T - 0.5 * (from + to)) / mass, fall = 0.5 * dt * dt;
    if (g > 0.0) {
      const double e = std::exp(-g * (T - to)) * -std::expm1(-g * dt);
      a = e / p.forces.drag;
      b = (dt - e / g) / p.forces.drag;
      fall = (g * dt + std::expm1(-g * dt)) / (g * g);
    }
    f.var_v += power * a * a;
    f.var_x += power * b * b;
    f.cov += power * a * b;
    f.mean_work += power * fall / mass;
  }
  return f;
}

/// The time (s) at which a body in free flight has risen by `way` (m): F/D t + (v - F/D) (1 - e^(-g
/// t))/g, without drag v t + F t^2/(2 M).
inline double rise_time(const dynamics::GateParams& p, double v, double way) {
  const double mass = p.body.mass, g = p.forces.drag / mass, force = p.forces.propulsion;
  const auto risen = [&](double t) {
    if (g == 0.0) return v * t + 0.5 * force / mass * t * t;
    return force / p.forces.drag * t + (v - force / p.forces.drag) * -std::expm1(-g * t) / g;
  };
  double low = 0.0, high = 1.0;
  while (risen(high) < way) high *= 2.0;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (risen(middle) < way ? low : high) = middle;
  }
  return high;
}

/// `p` with a gate so wide that no body meets beams or sides: free flight, ended by the far end.
inline dynamics::GateParams without_beams(dynamics::GateParams p) {
  p.beams.joint_x = 1e5 * p.body.radius;
  return p;
}

}  // namespace gatewalk::test
