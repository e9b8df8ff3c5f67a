#include "dynamics/methods/moreau.h"

#include <stdexcept>

namespace gatewalk::dynamics {

double MoreauMethod::advance(GateState&, double, double, EnergyLedger&, Watch&) const {
  throw std::logic_error("not written yet");
}

}  // namespace gatewalk::dynamics
