// SPDX-License-Identifier: MIT
#pragma once
/// Quantiles of distributions, in one source file, because Boost.Math takes seconds to compile.

namespace gatewalk::lattice {

/// The value that a chi-squared variable with these degrees of freedom exceeds with probability
/// `chance`.
[[nodiscard]] double chi_squared_exceeded(double degrees, double chance);
/// The 97.5 % quantile of Student's t.
[[nodiscard]] double student_t_975(double degrees);

}  // namespace gatewalk::lattice
