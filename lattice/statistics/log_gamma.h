// SPDX-License-Identifier: MIT
#pragma once
/// The logarithm of the gamma function on several threads at a time.

#include <cmath>

namespace gatewalk::lattice {

/// std::lgamma(x), which also writes its sign to a place that all threads share.
[[nodiscard]] inline double log_gamma(double x) {
  int sign = 0;
  return ::lgamma_r(x, &sign);
}

}  // namespace gatewalk::lattice
