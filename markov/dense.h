// SPDX-License-Identifier: MIT
#pragma once
/// Eigen's dense factorizations, compiled once for all that use them: each takes seconds.

#include <Eigen/Core>

namespace gatewalk::markov {

/// Orthonormal columns that span the same (n x k, k <= n), by Householder reflections.
[[nodiscard]] Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns);

/// Absolute values of the eigenvalues of a square matrix, the largest first.
[[nodiscard]] Eigen::VectorXd eigenvalue_moduli(const Eigen::MatrixXd& m);

/// a b
[[nodiscard]] Eigen::MatrixXd product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Of a symmetric matrix: eigenvalues, the smallest first, and their eigenvectors, column by
/// column.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
[[nodiscard]] SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& m);

}  // namespace gatewalk::markov
