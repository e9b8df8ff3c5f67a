#pragma once
/// Free motion in closed form: a disc under constant force and linear drag, a damped torsional
/// spring under constant torque. Exact for any step, so free flight costs one evaluation.

#include "dynamics/contact.h"

namespace gatewalk::dynamics {

/// v' = decay v + (F/M) rise;  x' = x + rise v + (F/M) fall.  Drag -> 0: 1, dt, dt^2/2.
struct BodyFlow {
  double decay = 1.0, rise = 0.0, fall = 0.0;
  BodyFlow(double drag_over_mass, double dt);

  void apply(BodyState& b, double ax, double ay) const {
    b.x += rise * b.vx + fall * ax;
    b.y += rise * b.vy + fall * ay;
    b.vx = decay * b.vx + rise * ax;
    b.vy = decay * b.vy + rise * ay;
  }
};

/// theta'' = -(k/I) theta - (d/I) theta' + a, from Eq. (3), for constant a (rad/s^2):
/// (theta, omega)' = [tt tw; wt ww] (theta, omega) + a (ta, wa). Any damping, k = 0 and d = 0 too.
struct BeamFlow {
  double tt = 1.0, tw = 0.0, wt = 0.0, ww = 1.0, ta = 0.0, wa = 0.0;
  BeamFlow(double stiffness_over_inertia, double damping_over_inertia, double dt);

  void apply(BeamState& beam, double a) const {
    const double theta = tt * beam.theta + tw * beam.omega + ta * a;
    beam.omega = wt * beam.theta + ww * beam.omega + wa * a;
    beam.theta = theta;
  }
};

/// Body and both beams over one dt.
struct GateFlow {
  double dt;
  BodyFlow body;
  BeamFlow left, right;
  GateFlow(const GateParams& p, double dt);
};

}  // namespace gatewalk::dynamics
