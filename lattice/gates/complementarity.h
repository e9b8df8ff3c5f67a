// SPDX-License-Identifier: MIT
#pragma once
/// Impulses of any number of simultaneous contacts; dynamics::unilateral_impulses handles one and
/// two.

#include <Eigen/Core>

namespace gatewalk::lattice {

/// Solves z >= 0, W z + b >= 0, z.(W z + b) = 0. W is symmetric and positive semi-definite, with
/// positive diagonal.
///
/// One and two contacts are solved by cases (dynamics::unilateral_impulses). For more, the solver
/// minimises z.W z / 2 + b.z over z >= 0, which has the same conditions, by the active-set method
/// of Lawson and Hanson. Contacts join one by one, the fastest closing contact first, and leave
/// when they would pull. The method ends, because each contact that joins lowers the minimum over
/// the set, so that no set comes twice. A contact whose column of W depends on those of the joined
/// contacts is never needed (neighbouring gates share their joints' places: one pin, two contacts).
///
/// Remaining round-off: W z + b >= -1e-12 max|b|.
[[nodiscard]] Eigen::VectorXd solve_lcp(const Eigen::MatrixXd& w, const Eigen::VectorXd& b);

}  // namespace gatewalk::lattice
