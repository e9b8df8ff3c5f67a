// SPDX-License-Identifier: MIT
#pragma once
/// Free motion in closed form: a disc under constant force and linear drag, and a damped torsional
/// spring under constant torque. The formulas are exact for any step, so free flight costs one
/// evaluation.

#include <array>

#include "dynamics/disc/contact.h"

namespace gatewalk::dynamics {

/// Motion of the body over a time dt: v' = decay v + (F/M) rise, x' = x + rise v + (F/M) fall.
/// Without drag the coefficients are 1, dt, dt^2/2.
struct BodyFlow {
  static constexpr double kSeries = 1e-2;  // a power series is used below this (D/M) dt
  double decay = 1.0, rise = 0.0, fall = 0.0;
  BodyFlow(double drag_over_mass, double dt);

  void apply(BodyState& b, double ax, double ay) const {
    b.x += rise * b.vx + fall * ax;
    b.y += rise * b.vy + fall * ay;
    b.vx = decay * b.vx + rise * ax;
    b.vy = decay * b.vy + rise * ay;
  }
};

/// Motion of a beam over a time dt: theta'' = -(k/I) theta - (d/I) theta' + a, from Eq. (3), for
/// constant a (rad/s^2): (theta, omega)' = [tt tw; wt ww] (theta, omega) + a (ta, wa). Any k and d
/// >= 0 are allowed.
struct BeamFlow {
  double tt = 1.0, tw = 0.0, wt = 0.0, ww = 1.0, ta = 0.0, wa = 0.0;
  BeamFlow() = default;
  BeamFlow(double stiffness_over_inertia, double damping_over_inertia, double dt);

  void apply(BeamState& beam, double a) const {
    const double theta = tt * beam.theta + tw * beam.omega + ta * a;
    beam.omega = wt * beam.theta + ww * beam.omega + wa * a;
    beam.theta = theta;
  }
};

/// The flows of one beam over any dt, with common terms computed once.
struct BeamLaw {
  static constexpr double kSeries = 0.5;  // a power series is used below this phase, rate |dt|
  static constexpr int kTerms = 16;       // 0.5^16 / 16! < 1e-18
  double k, d;  // 1/s^2, 1/s: stiffness and damping divided by the inertia
  double rate;  // 1/s, upper bound of both characteristic roots
  // Coefficients of the response to a unit acceleration from rest: theta = dt^2 sum theta[i] z^i,
  // omega = dt sum omega[i] z^i with z = rate dt.
  double theta[kTerms], omega[kTerms];

  BeamLaw(double stiffness_over_inertia, double damping_over_inertia);
  [[nodiscard]] BeamFlow over(double dt) const;
  /// |theta| (rad) where the free beam first comes to rest, if within `dt` (s), else 0. Later
  /// swings are never larger.
  [[nodiscard]] double swing(BeamState beam, double dt) const;
};

/// The flows of the body and both beams over one dt.
struct GateFlow {
  double dt;
  BodyFlow body;
  BeamFlow left, right;
};

/// The flows of a gate over any dt.
struct GateLaw {
  double drag;  // 1/s, drag divided by the body's mass
  std::array<BeamLaw, 2> beams;
  explicit GateLaw(const GateParams& p);
  [[nodiscard]] GateFlow over(double dt) const {
    return {dt, BodyFlow(drag, dt), beams[kLeft].over(dt), beams[kRight].over(dt)};
  }
};

}  // namespace gatewalk::dynamics
