// SPDX-License-Identifier: MIT
#pragma once
/// Eigen's dense factorizations, compiled only here because each takes seconds to compile.

#include <Eigen/Core>

namespace gatewalk::markov {

/// Orthonormal columns (n x k, k <= n) with the same span, by Householder reflections.
[[nodiscard]] Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns);

/// The absolute values of the eigenvalues of a square matrix, largest first.
[[nodiscard]] Eigen::VectorXd eigenvalue_moduli(const Eigen::MatrixXd& m);

/// The product a b.
[[nodiscard]] Eigen::MatrixXd product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// The eigenvalues of a symmetric matrix, smallest first, and their eigenvectors as columns.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
[[nodiscard]] SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& m);

}  // namespace gatewalk::markov
