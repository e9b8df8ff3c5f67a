#include "dynamics/methods/event.h"

#include <stdexcept>

namespace gatewalk::dynamics {

double EventMethod::advance(GateState&, double, double, EnergyLedger&, Watch&) const {
  throw std::logic_error("not written yet");
}

}  // namespace gatewalk::dynamics
