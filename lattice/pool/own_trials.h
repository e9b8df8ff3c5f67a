// SPDX-License-Identifier: MIT
#pragma once
/// A chain set against the full trials that it was made from. Trials keep what a chain may lose:
/// what bodies remember from gate to gate, what differs within a state, which gate is of which
/// type. So a wrong chain is found out, as far as so many trials can tell.

#include <cstdint>
#include <optional>

#include "lattice/reference.h"
#include "markov/predict.h"

namespace gatewalk::lattice {

/// Hausman's test (1978): where the chain is right it is the better estimate of the same shares
/// from the same runs, and the difference has at most the variance of the trials' own shares. So
/// the p-value of as many draws from the chain's answer (Judgement: final gates and endings) is
/// rather too large than too small.
struct OwnTrials {
  static constexpr double kLevel = 0.01;  // of all that are looked at together

  std::int64_t trials = 0;
  double total_variation = 0.0;         // of the final gates
  double chance_total_variation = 0.0;  // mean over the draws
  double p = 1.0;
  bool differs = false;
};

/// `chain`: its answer for the bodies of these trials. `looked_at`: so many answers are tested
/// together.
[[nodiscard]] OwnTrials own_trials(const FieldTrials& trials, const FieldParams& field,
                                   const markov::FinalDistribution& chain, std::int64_t looked_at,
                                   std::uint64_t seed);

}  // namespace gatewalk::lattice
