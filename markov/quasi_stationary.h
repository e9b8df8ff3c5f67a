// SPDX-License-Identifier: MIT
#pragma once
/// The quasi-stationary distribution: the states of walks that have survived for long in an endless
/// field.

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "markov/chain.h"

namespace gatewalk::markov {

inline constexpr std::ptrdiff_t kToldEigenvalues = 6;

/// The implied time scale of an eigenvalue of this modulus: -1 / ln(modulus), in cells. Infinite at
/// 1, up to rounding.
[[nodiscard]] inline double implied_time_scale(double modulus) {
  constexpr double kRoundingOfOne = 1e-13;
  if (modulus > 1.0 - kRoundingOfOne) return std::numeric_limits<double>::infinity();
  return modulus > 0.0 ? -1.0 / std::log(modulus) : 0.0;
}

/// The quasi-stationary distribution over the states of walks that are not trapped yet, wherever
/// they are, with the leading eigenvalues.
struct QuasiStationary {
  std::vector<double> states;  // (inputs) the left eigenvector; sums to 1
  double survival = 0.0;       // the largest eigenvalue: probability to survive one more cell
  double second = 0.0;         // modulus of the second eigenvalue: decay of the start's effect
  double rows_per_cell = 0.0;  // mean di_y of a move
  /// The moduli of the largest eigenvalues, at most kToldEigenvalues; fewer for many states if the
  /// others are too close to each other.
  std::vector<double> moduli;
  [[nodiscard]] double spectral_gap() const { return survival - second; }
};

/// Computes the distribution. `share[c]` is the share of cells that draw from chains[c]; cells are
/// mixed as if each walk met a random field of its own. The method is simultaneous iteration of a
/// block of vectors (Rutishauser 1969). Throws std::invalid_argument for another number of shares,
/// std::runtime_error if no walk survives or the iteration does not converge.
[[nodiscard]] QuasiStationary quasi_stationary(const FieldChain& chain,
                                               const std::vector<double>& share);

}  // namespace gatewalk::markov
