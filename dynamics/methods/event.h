#pragma once
#include "dynamics/methods/method.h"

namespace gatewalk::dynamics {

class EventMethod final : public Method {
 public:
  explicit EventMethod(const GateParams& p) : p_(p) {}

  double advance(GateState& s, double force_x, double duration, EnergyLedger& ledger,
                 Watch& watch) const override;

 private:
  const GateParams& p_;
};

}  // namespace gatewalk::dynamics
