// SPDX-License-Identifier: MIT
#include "lattice/pool/own_trials.h"

#include <algorithm>

#include "lattice/statistics/compare.h"

namespace gatewalk::lattice {

OwnTrials own_trials(const FieldTrials& trials, const FieldParams& field,
                     const markov::FinalDistribution& chain, std::int64_t looked_at,
                     std::uint64_t seed) {
  // So many that a p-value can be below the level of a single answer.
  constexpr std::int64_t kDraws = 999, kMostDraws = 9999;
  FieldTally tally(field);
  for (std::size_t i = 0; i < trials.final_gates.size(); ++i)
    tally.count(trials.final_gates[i], trials.endings[i]);
  const Judgement j = judge({tally.final_gates, tally.endings}, chain, {chain}, 0,
                            std::min(kDraws * looked_at, kMostDraws), seed);
  return {.trials = tally.final_gates.sum(),
          .total_variation = j.total_variation.seen,
          .chance_total_variation = j.chance_total_variation,
          .p = j.p,
          .differs = j.p * static_cast<double>(looked_at) <= OwnTrials::kLevel};
}

}  // namespace gatewalk::lattice
