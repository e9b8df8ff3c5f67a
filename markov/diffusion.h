// SPDX-License-Identifier: MIT
#pragma once
/// How walks spread over an endless lattice of cells of one type, where nobody is trapped. Lengths
/// are in the unit of the lattice, times in that of the draws (without times: draws).

#include <Eigen/Core>
#include <vector>

#include "markov/chain.h"
#include "markov/totals.h"

namespace gatewalk::markov {

/// After a long time t a walk has gone drift t in the mean, with covariance 2 tensor t.
struct Diffusion {
  std::vector<double>
      states;              // (inputs) the share of all draws made in each, in the long run; sum 1
  double mean_time = 1.0;  // of a draw, in the long run
  Eigen::Vector2d drift{0.0, 0.0};                  // length / time
  Eigen::Matrix2d tensor{Eigen::Matrix2d::Zero()};  // length^2 / time
  /// <r^2> = 4 D t, without drift.
  [[nodiscard]] double coefficient() const { return 0.5 * tensor.trace(); }
};

/// `lattice`: where the moves (1, 0) and (0, 1) lead, as columns. `time`: what draws take, mean and
/// mean square for each nonzero of the chain's matrix, in their order; without it each takes 1.
///
/// It is the Green-Kubo sum over moves (Klages and Korabel, J. Phys. A 35:4823, 2002; by steps of
/// memory Gilbert and Sanders, Phys. Rev. E 80:041121, 2009) of a walk whose draws take different
/// times. Its first term alone is a walk without memory (Machta and Zwanzig, Phys. Rev. Lett.
/// 50:1959, 1983). With a draw's move l and time T in the long run, f = l - drift T,
/// drift = <l> / <T>:
///   tensor = (<f_0 f_0'> + sum over k > 0 of <f_0 f_k'> + <f_k f_0'>) / (2 <T>)
/// The sum is one linear solve for two right-hand sides: with (I - P) h = E[f | state], Poisson's
/// equation, m = f + h(next) - h(state) knows nothing of later draws, and the sum is <m m'>. So the
/// tensor is never negative.
///
/// Throws std::invalid_argument where a walk can be trapped or get into a row never sampled, where
/// it depends on the start among which states it stays, when `time` does not belong to the chain
/// or <T> is not > 0; std::runtime_error when the solve has fewer than 9 digits.
[[nodiscard]] Diffusion diffusion(const Chain& chain,
                                  const Eigen::Matrix2d& lattice = Eigen::Matrix2d::Identity(),
                                  const Reward& time = {});

}  // namespace gatewalk::markov
