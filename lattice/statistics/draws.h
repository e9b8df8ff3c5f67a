// SPDX-License-Identifier: MIT
#pragma once
/// Random numbers from binomial, multinomial and gamma distributions. The samplers are our own,
/// because those of standard libraries differ between vendors.

#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "dynamics/base/random.h"

namespace gatewalk::lattice {

/// Number of successes in `trials` (0 to 2^53) trials with success probability `p` in [0, 1]. Exact
/// except for the rounding of doubles; the time hardly depends on `trials`. Throws
/// std::invalid_argument for arguments outside these ranges.
[[nodiscard]] std::int64_t binomial(std::int64_t trials, double p, dynamics::Random& random);

/// Multinomial draw: distributes `trials` over outcomes with these weights (>= 0, not all 0), into
/// `counts` of the same length. Each outcome takes one binomial draw, conditional on the outcomes
/// before. An outcome of weight 0 gets none.
void multinomial(std::int64_t trials, std::span<const double> weights,
                 std::span<std::int64_t> counts, dynamics::Random& random);

/// A draw from the gamma distribution with this shape (> 0) and scale 1 (Marsaglia and Tsang, ACM
/// Trans. Math. Softw. 26, 2000). Several such draws over their sum form a draw from a Dirichlet
/// distribution.
[[nodiscard]] double gamma(double shape, dynamics::Random& random);

/// `count` numbers, each 1 or -1 with equal probability (Rademacher weights).
[[nodiscard]] Eigen::VectorXd random_signs(Eigen::Index count, dynamics::Random& random);

}  // namespace gatewalk::lattice
