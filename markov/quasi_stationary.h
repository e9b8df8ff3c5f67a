// SPDX-License-Identifier: MIT
#pragma once
/// What is left of walks that have been going on for long in an endless field.

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "markov/chain.h"

namespace gatewalk::markov {

inline constexpr std::ptrdiff_t kToldEigenvalues = 6;

/// How long what goes with an eigenvalue of this modulus lasts: -1 / ln of it, in cells. Infinite
/// at 1, but for the rounding of an eigenvalue.
[[nodiscard]] inline double implied_time_scale(double modulus) {
  constexpr double kRoundingOfOne = 1e-13;
  if (modulus > 1.0 - kRoundingOfOne) return std::numeric_limits<double>::infinity();
  return modulus > 0.0 ? -1.0 / std::log(modulus) : 0.0;
}

/// Of the states that walks are in which have not been trapped yet, wherever they are.
struct QuasiStationary {
  std::vector<double> states;  // (inputs) sums to 1: the left eigenvector
  double survival = 0.0;       // the largest eigenvalue: the chance to survive one more cell
  double second = 0.0;  // the modulus of the second one: what the start has left goes with it
  double rows_per_cell = 0.0;  // mean di_y of a move
  /// Moduli of the largest eigenvalues, at most kToldEigenvalues; where there are many states
  /// fewer, if the others lie too close to each other.
  std::vector<double> moduli;
  [[nodiscard]] double spectral_gap() const { return survival - second; }
};

/// `share[c]`: of the field's cells that draw from chains[c]; all cells of the field are mixed as
/// if each walk met its own field of them. By simultaneous iteration of a block of vectors
/// (Rutishauser 1969). Throws std::invalid_argument for other numbers of shares,
/// std::runtime_error when nobody survives or the iteration does not settle.
[[nodiscard]] QuasiStationary quasi_stationary(const FieldChain& chain,
                                               const std::vector<double>& share);

}  // namespace gatewalk::markov
