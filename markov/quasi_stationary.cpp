// SPDX-License-Identifier: MIT
#include "markov/quasi_stationary.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "markov/dense.h"

namespace gatewalk::markov {
namespace {

constexpr int kBlock = 8;  // vectors; the ninth eigenvalue limits the convergence of the second
constexpr int kMostIterations = 20'000;
constexpr Eigen::Index kDense = 300;  // states up to which all eigenvalues are computed densely
constexpr double kEigenTolerance = 1e-12;   // relative change of the first eigenvalue per step
constexpr double kSecondTolerance = 1e-10;  // relative change of the second eigenvalue per step

struct Kernel {
  Probabilities from_to;  // transposed: left eigenvectors become right ones
  Eigen::VectorXd rows;   // (inputs) mean di_y of a draw that goes on, times its probability
};

Kernel kernel_of(const FieldChain& chain, const std::vector<double>& share) {
  std::vector<Eigen::Triplet<double>> entries;
  Kernel kernel{{chain.inputs(), chain.inputs()}, Eigen::VectorXd::Zero(chain.inputs())};
  for (std::size_t c = 0; c < share.size(); ++c) {
    const Chain& from = chain.chains()[c];
    for (int input = 0; input < from.inputs(); ++input)
      for (Probabilities::InnerIterator it(from.matrix(), input); it; ++it) {
        const Exit& exit = from.exits()[static_cast<std::size_t>(it.col())];
        if (exit.next_input == Exit::kTrapped) continue;
        const double p = share[c] * it.value();
        entries.emplace_back(exit.next_input, input, p);
        kernel.rows[input] += p * exit.di_y;
      }
  }
  kernel.from_to.setFromTriplets(entries.begin(), entries.end());
  return kernel;
}

}  // namespace

QuasiStationary quasi_stationary(const FieldChain& chain, const std::vector<double>& share) {
  if (share.size() != chain.chains().size())
    throw std::invalid_argument("quasi-stationary: one share for each type of cell is needed");
  const auto [kernel, rows] = kernel_of(chain, share);
  const Eigen::Index n = kernel.rows(), block = std::min<Eigen::Index>(kBlock, n);
  // The start may be any block that is not orthogonal to the solution: here triangular waves of
  // incommensurable lengths, computed by operations that round alike on all processors.
  constexpr double kTurns = 0.11803398874989485;  // (sqrt(5) - 2) / 2
  Eigen::MatrixXd v(n, block);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index k = 0; k < block; ++k) {
      const double turns = static_cast<double>(k * (2 * i + 1)) * kTurns;
      v(i, k) = 4.0 * std::abs(turns - std::floor(turns) - 0.5) - 1.0;
    }
  double first = 0.0, second = 0.0;
  for (int iteration = 0;; ++iteration) {
    if (iteration == kMostIterations)
      throw std::runtime_error("quasi-stationary: does not settle, the spectral gap is too small");
    const Eigen::MatrixXd q = orthonormal(v);
    v = kernel * q;
    const Eigen::VectorXd moduli = eigenvalue_moduli(product(q.transpose(), v));
    const double was_first = first, was_second = second;
    first = moduli[0];
    second = moduli.size() > 1 ? moduli[1] : 0.0;
    if (std::abs(first - was_first) <= kEigenTolerance * first &&
        std::abs(second - was_second) <= kSecondTolerance * first)
      break;
  }
  if (!(first > 0.0)) throw std::runtime_error("quasi-stationary: nobody gets into a second cell");
  std::vector<double> told;
  const auto tell = [&](const Eigen::VectorXd& moduli, std::ptrdiff_t most) {
    told.assign(moduli.data(), moduli.data() + std::min<std::ptrdiff_t>(moduli.size(), most));
  };
  if (n <= kDense) {
    tell(eigenvalue_moduli(kernel.toDense()), kToldEigenvalues);
  } else {  // iterate the block until these eigenvalues converge
    constexpr int kMoreIterations = 2000, kApart = 10;
    Eigen::VectorXd was = Eigen::VectorXd::Zero(block);
    for (int iteration = 0; iteration < kMoreIterations; ++iteration) {
      const Eigen::MatrixXd q = orthonormal(v);
      v = kernel * q;
      if (iteration % kApart != 0) continue;
      const Eigen::VectorXd moduli = eigenvalue_moduli(product(q.transpose(), v));
      std::ptrdiff_t settled = 0;
      while (settled < kToldEigenvalues &&
             std::abs(moduli[settled] - was[settled]) <= kSecondTolerance * first)
        ++settled;
      tell(moduli, settled);
      if (settled == kToldEigenvalues) break;
      was = moduli;
    }
  }
  // The first vector alone, from positive numbers, so nothing is subtracted.
  Eigen::VectorXd states = Eigen::VectorXd::Constant(n, 1.0 / static_cast<double>(n));
  for (int iteration = 0;; ++iteration) {
    if (iteration == kMostIterations)
      throw std::runtime_error("quasi-stationary: does not settle, the spectral gap is too small");
    Eigen::VectorXd next = kernel * states;
    next /= next.sum();
    const double change = (next - states).cwiseAbs().sum();
    states = std::move(next);
    if (change <= kEigenTolerance) break;
  }
  QuasiStationary out;
  out.states.assign(states.data(), states.data() + n);
  out.survival = (kernel * states).sum();
  out.second = second;
  out.moduli = std::move(told);
  out.rows_per_cell = rows.dot(states) / out.survival;
  return out;
}

}  // namespace gatewalk::markov
