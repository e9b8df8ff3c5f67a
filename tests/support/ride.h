#pragma once
/// One gate's state carried by a method, with everything that a test looks at afterwards.

#include "dynamics/methods/method.h"

namespace gatewalk::test {

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

}  // namespace gatewalk::test
