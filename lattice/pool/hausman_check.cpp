// SPDX-License-Identifier: MIT
#include "lattice/pool/hausman_check.h"

#include "lattice/statistics/compare.h"

namespace gatewalk::lattice {
namespace {

using markov::FinalDistribution;

/// The mean of the chains' answers, weighted by numbers of trials.
FinalDistribution mean_of(const std::vector<TrialsAndChain>& all, double trials) {
  FinalDistribution mean;
  for (const auto& [of, chain] : all) {
    const double weight = static_cast<double>(of.final_gates.size()) / trials;
    mean += markov::shares_of(chain, [=](double share) { return weight * share; });
  }
  return mean;
}

}  // namespace

std::optional<HausmanCheck> hausman_check(const std::vector<TrialsAndChain>& all,
                                          const FieldParams& field, std::uint64_t seed) {
  constexpr std::int64_t kDraws = 999;
  FieldTally tally(field);
  for (const TrialsAndChain& one : all) tally.count(one.trials.final_gates, one.trials.endings);
  const std::int64_t trials = tally.trials;
  if (trials == 0) return {};
  const FinalDistribution chain = mean_of(all, static_cast<double>(trials));
  const JointTest j =
      joint_test({tally.final_cells, tally.endings}, chain, {chain}, 0, kDraws, seed);
  return HausmanCheck{.trials = trials,
                      .total_variation = j.total_variation.seen,
                      .chance_total_variation = j.chance_total_variation,
                      .p = j.p};
}

}  // namespace gatewalk::lattice
