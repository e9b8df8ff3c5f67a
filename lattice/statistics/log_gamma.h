// SPDX-License-Identifier: MIT
#pragma once
/// A thread-safe logarithm of the gamma function.

#include <cmath>

namespace gatewalk::lattice {

/// log |gamma(x)|. Unlike std::lgamma, writes the sign to no variable that threads share.
[[nodiscard]] inline double log_gamma(double x) {
  int sign = 0;
  return ::lgamma_r(x, &sign);
}

}  // namespace gatewalk::lattice
