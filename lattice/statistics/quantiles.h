// SPDX-License-Identifier: MIT
#pragma once
/// Quantiles of distributions, in one source: Boost.Math takes seconds to compile.

namespace gatewalk::lattice {

/// What a chi-squared number of so many degrees of freedom exceeds with this chance.
[[nodiscard]] double chi_squared_exceeded(double degrees, double chance);
/// The 97.5 % quantile of Student's t.
[[nodiscard]] double student_t_975(double degrees);

}  // namespace gatewalk::lattice
