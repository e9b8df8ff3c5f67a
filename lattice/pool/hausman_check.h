// SPDX-License-Identifier: MIT
#pragma once
/// A chain set against the full trials that it was made from. Trials keep what a chain may lose:
/// what bodies remember from gate to gate, what differs within a state, which gate is of which
/// type. So a wrong chain is found out, as far as so many trials can tell.

#include <cstdint>
#include <optional>
#include <vector>

#include "lattice/field/field_trials.h"
#include "markov/predict.h"

namespace gatewalk::lattice {

/// In the manner of Hausman's test (1978): where the chain is right it is the better estimate of
/// the same shares from the same runs, so that the difference varies less than the trials' own
/// shares would. The p-value is that of as many draws from the chain's answer (JointTest: final
/// gates and endings): rather too large than too small.
struct HausmanCheck {
  static constexpr double kLevel = 0.01;

  std::int64_t trials = 0;
  double total_variation = 0.0;         // of the final gates
  double chance_total_variation = 0.0;  // mean over the draws
  double p = 1.0;

  [[nodiscard]] bool differs() const { return p <= kLevel; }
};

/// Trials of one start, or of a range, and the chain's exact answer for their bodies.
struct TrialsAndChain {
  const FieldTrials& trials;
  const markov::FinalDistribution& chain;
};

/// All together, in one test. None: there are no trials.
[[nodiscard]] std::optional<HausmanCheck> hausman_check(const std::vector<TrialsAndChain>& all,
                                                        const FieldParams& field,
                                                        std::uint64_t seed);

}  // namespace gatewalk::lattice
