// SPDX-License-Identifier: MIT
#pragma once
/// One gate's state carried by a method, with everything that a test looks at afterwards.

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <vector>

#include "dynamics/disc/gate.h"
#include "dynamics/disc/methods/method.h"

namespace gatewalk::test {

/// A body among two beams at rest.
inline dynamics::GateState at_rest(double x, double y, double vx = 0.0, double vy = 0.0) {
  dynamics::GateState s;
  s.body = {x, y, vx, vy};
  return s;
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

/// Energy created (J) in 300 noisy runs from the default start: their mean, and the worst.
inline std::array<double, 2> energy_created(const dynamics::GateParams& p) {
  constexpr int kTrials = 300;
  const auto method = dynamics::make_method(p);
  std::vector<double> created(kTrials);
  tbb::parallel_for(0, kTrials, [&](int trial) {
    dynamics::RandomForce force(
        p.forces,
        dynamics::Random(dynamics::Purpose::gate, {1, 0, static_cast<std::uint64_t>(trial)}));
    created[trial] = dynamics::run_gate(p, *method, {}, force).watch.energy_created;
  });
  std::array<double, 2> result{};
  for (const double c : created) {
    result[0] += c / kTrials;
    result[1] = std::max(result[1], c);
  }
  return result;
}

}  // namespace gatewalk::test
