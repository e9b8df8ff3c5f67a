// SPDX-License-Identifier: MIT
#pragma once
/// Counts drawn at once instead of trial by trial: binomial and multinomial; and gamma. From own
/// samplers (the standard library's differ between vendors).

#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "dynamics/base/random.h"

namespace gatewalk::lattice {

/// Successes among `trials` (0 to 2^53), each with chance `p` in [0, 1]: exact but for the rounding
/// of doubles, in a time that hardly depends on the trials. Throws std::invalid_argument for
/// others.
[[nodiscard]] std::int64_t binomial(std::int64_t trials, double p, dynamics::Random& random);

/// `trials` shared out over outcomes with these weights (>= 0, not all 0), into `counts` of the
/// same length: one binomial per outcome, given those before. None goes to a weight of 0.
void multinomial(std::int64_t trials, std::span<const double> weights,
                 std::span<std::int64_t> counts, dynamics::Random& random);

/// Of the gamma distribution with this shape (> 0) and scale 1 (Marsaglia and Tsang, ACM Trans.
/// Math. Softw. 26, 2000). Several of them over their sum are a draw from a Dirichlet distribution.
[[nodiscard]] double gamma(double shape, dynamics::Random& random);

/// 1 or -1 each, with the same chance (Rademacher weights).
[[nodiscard]] Eigen::VectorXd random_signs(Eigen::Index count, dynamics::Random& random);

}  // namespace gatewalk::lattice
