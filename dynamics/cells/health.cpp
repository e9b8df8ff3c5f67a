// SPDX-License-Identifier: MIT
#include "dynamics/cells/health.h"

#include <algorithm>

namespace gatewalk::dynamics {

Health& Health::operator+=(const Health& o) {
  for (const HealthNumber& n : kHealthNumbers)
    if (n.count != nullptr)
      this->*n.count += o.*n.count;
    else
      this->*n.largest = std::max(this->*n.largest, o.*n.largest);
  return *this;
}

}  // namespace gatewalk::dynamics
