// SPDX-License-Identifier: MIT
#pragma once
/// Scene S1 for methods that step through free motion: a beam let go, against its closed form.

#include <gtest/gtest.h>

#include <cmath>
#include <string_view>

#include "tests/support/measured.h"
#include "tests/support/ride.h"

namespace gatewalk::test {

/// The disc far away at rest, the left beam let go.
inline dynamics::GateState let_go(double theta = 0.5) {
  dynamics::GateState s;
  s.beams[dynamics::kLeft].theta = theta;
  return s;
}

inline dynamics::GateParams quiet_gate() {
  dynamics::GateParams p;
  p.forces.propulsion = 0.0;
  return p;
}

/// The error after 2 s, hypot(theta, omega / w0): at 0.004 s `error` +- `digits`, then falling with
/// that order over five halvings.
inline void expect_free_beam_order(std::string_view method, double order, double error,
                                   double digits) {
  dynamics::GateParams p = quiet_gate();
  p.run.method = method;
  const double w0 = std::sqrt(400.0 / p.beams.inertia()), wd = std::sqrt(w0 * w0 - 1.44);
  const double decay = 0.5 * std::exp(-2.4), c = std::cos(2 * wd), s = std::sin(2 * wd);
  const double theta = decay * (c + 1.2 / wd * s), omega = -decay * w0 * w0 / wd * s;
  double last = 0.0, off = 0.0;
  for (int halvings = 0; halvings <= 5; ++halvings) {
    p.run.step = 0.004 / (1 << halvings);
    Ride ride(p, let_go());
    ride.go(2.0);
    const dynamics::BeamState& beam = ride.s.beams[dynamics::kLeft];
    const double now = std::hypot(beam.theta - theta, (beam.omega - omega) / w0);
    if (halvings == 0) {
      EXPECT_NEAR(now, error, digits);
      measured({.requirement = 1,
                .method = method,
                .what = "free beam after 2 s, error",
                .figure = now,
                .unit = "rad",
                .limit = 1e-8});
    } else {
      EXPECT_NEAR(std::log2(last / now), order, 0.1) << halvings;
      off = std::max(off, std::abs(std::log2(last / now) - order));
    }
    last = now;
  }
  measured({.requirement = 1,
            .method = method,
            .what = "order over 5 halvings, off the nominal",
            .figure = off,
            .limit = 0.1});
}

}  // namespace gatewalk::test
