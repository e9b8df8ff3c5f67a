#include "dynamics/methods/penalty.h"

#include <stdexcept>

namespace gatewalk::dynamics {

double PenaltyMethod::advance(GateState&, double, double, EnergyLedger&, Watch&) const {
  throw std::logic_error("not written yet");
}

}  // namespace gatewalk::dynamics
