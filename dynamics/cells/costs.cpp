// SPDX-License-Identifier: MIT
#include "dynamics/cells/costs.h"

namespace gatewalk::dynamics {

void CostSums::add(const Costs& costs) {
  for (std::size_t c = 0; c < kMostCosts; ++c) {
    sum[c] += costs[c];
    squares[c] += costs[c] * costs[c];
  }
}
CostSums& CostSums::operator+=(const CostSums& other) {
  for (std::size_t c = 0; c < kMostCosts; ++c) {
    sum[c] += other.sum[c];
    squares[c] += other.squares[c];
  }
  return *this;
}

}  // namespace gatewalk::dynamics
