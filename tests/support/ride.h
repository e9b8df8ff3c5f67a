// SPDX-License-Identifier: MIT
#pragma once
/// Advances the state of one gate by a method, and keeps what tests check afterwards.

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "dynamics/disc/gate.h"
#include "dynamics/disc/methods/method.h"

namespace gatewalk::test {

constexpr double kHold = 0.02;  // s, duration of a hold of the random force

/// A body between two beams at rest.
inline dynamics::GateState at_rest(double x, double y, double vx = 0.0, double vy = 0.0) {
  dynamics::GateState s;
  s.body = {x, y, vx, vy};
  return s;
}

/// The disc far away at rest, the left beam released at angle theta.
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

struct Ride {
  dynamics::GateParams p;
  dynamics::GateState s;
  std::unique_ptr<dynamics::Method> method;
  dynamics::Watch watch;
  dynamics::EnergyLedger ledger;

  Ride(const dynamics::GateParams& params, const dynamics::GateState& start)
      : p(params), s(start), method(dynamics::make_method(p)), ledger(p, s) {}
  Ride(const Ride&) = delete;
  Ride& operator=(const Ride&) = delete;

  double go(double seconds, double force_x = 0.0) {
    return method->advance(s, force_x, seconds, ledger, watch);
  }
  double step(double force_x = 0.0) { return go(p.run.step, force_x); }
  [[nodiscard]] dynamics::Touch touch(dynamics::Side side) const {
    return dynamics::nearest(p, side, s.body, s.beams[side].theta);
  }
};

inline void go_in_holds(Ride& ride, double seconds, double force_x = 0.0) {
  for (int i = 0; i < std::lround(seconds / kHold); ++i) ride.go(kHold, force_x);
}

/// The largest difference in any component of body and beams: m, m/s, rad, rad/s.
inline double largest_difference(const dynamics::GateState& a, const dynamics::GateState& b) {
  double d = std::max({std::abs(a.body.x - b.body.x), std::abs(a.body.y - b.body.y),
                       std::abs(a.body.vx - b.body.vx), std::abs(a.body.vy - b.body.vy)});
  for (const dynamics::Side side : {dynamics::kLeft, dynamics::kRight})
    d = std::max({d, std::abs(a.beams[side].theta - b.beams[side].theta),
                  std::abs(a.beams[side].omega - b.beams[side].omega)});
  return d;
}

/// Energy created (J) in noisy runs from the default start: mean and worst.
inline std::array<double, 2> energy_created(const dynamics::GateParams& p, int trials) {
  const auto method = dynamics::make_method(p);
  std::vector<double> created(trials);
  tbb::parallel_for(0, trials, [&](int trial) {
    dynamics::RandomForce force(
        p.forces,
        dynamics::Random(dynamics::Purpose::gate, {1, 0, static_cast<std::uint64_t>(trial)}));
    created[trial] = dynamics::run_gate(p, *method, {}, force).watch.energy_created;
  });
  std::array<double, 2> result{};
  for (const double c : created) {
    result[0] += c / trials;
    result[1] = std::max(result[1], c);
  }
  return result;
}

}  // namespace gatewalk::test
