// SPDX-License-Identifier: MIT
#pragma once
/// Impulses of any number of contacts at once: dynamics::unilateral_impulses beyond two.

#include <Eigen/Core>

namespace gatewalk::lattice {

/// Solves z >= 0, W z + b >= 0, z.(W z + b) = 0; W symmetric, positive semi-definite, with positive
/// diagonal.
///
/// One and two contacts are solved by cases (dynamics::unilateral_impulses). More are solved as the
/// least of z.W z / 2 + b.z over z >= 0, which has the same conditions, by the active-set method of
/// Lawson and Hanson: contacts join one by one, each time the one that closes fastest, and leave
/// when they would pull. It ends, because the least value over a set of contacts is lower each time
/// a contact joins, so no set comes twice. A contact whose column of W depends on those that have
/// joined already (neighbouring gates share their joints' places: one pin, two contacts) is never
/// needed.
///
/// What is left open by round-off: W z + b >= -1e-12 max|b|.
[[nodiscard]] Eigen::VectorXd solve_lcp(const Eigen::MatrixXd& w, const Eigen::VectorXd& b);

}  // namespace gatewalk::lattice
