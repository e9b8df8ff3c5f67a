// SPDX-License-Identifier: MIT
#include "lattice/pool/own_trials.h"

#include <map>

#include "lattice/statistics/compare.h"

namespace gatewalk::lattice {
namespace {

using markov::FinalDistribution;

/// What a body of any of the trials does by the chains: their mean, by numbers of trials.
FinalDistribution mean_of(const std::vector<TrialsAndChain>& all, const FieldParams& field,
                          double trials) {
  FinalDistribution mean;
  mean.final_cells = CellProbabilities::Zero(field.rows, field.columns);
  std::map<std::int64_t, std::array<double, markov::kEndings>> by_ending;
  for (const auto& [of, chain] : all) {
    const double weight = static_cast<double>(of.final_gates.size()) / trials;
    mean.final_cells += weight * chain.final_cells;
    for (std::size_t e = 0; e < markov::kEndings; ++e) mean.endings[e] += weight * chain.endings[e];
    for (const auto& cell : chain.mixed_cells) by_ending.try_emplace(cell.cell);
  }
  constexpr auto kTrapped = static_cast<std::size_t>(markov::Ending::trapped);
  for (const auto& [of, chain] : all) {
    const double weight = static_cast<double>(of.final_gates.size()) / trials;
    auto mixed = chain.mixed_cells.begin();
    for (auto& [cell, endings] : by_ending) {
      if (mixed == chain.mixed_cells.end() || mixed->cell != cell) {
        endings[kTrapped] += weight * chain.final_cells.data()[cell];
        continue;
      }
      for (std::size_t e = 0; e < markov::kEndings; ++e) endings[e] += weight * mixed->by_ending[e];
      ++mixed;
    }
  }
  for (const auto& [cell, endings] : by_ending) mean.mixed_cells.push_back({cell, endings});
  return mean;
}

}  // namespace

std::optional<OwnTrials> own_trials(const std::vector<TrialsAndChain>& all,
                                    const FieldParams& field, std::uint64_t seed) {
  constexpr std::int64_t kDraws = 999;
  FieldTally tally(field);
  for (const TrialsAndChain& one : all)
    for (std::size_t i = 0; i < one.trials.final_gates.size(); ++i)
      tally.count(one.trials.final_gates[i], one.trials.endings[i]);
  const std::int64_t trials = tally.final_gates.sum();
  if (trials == 0) return {};
  const FinalDistribution chain = mean_of(all, field, static_cast<double>(trials));
  const Judgement j = judge({tally.final_gates, tally.endings}, chain, {chain}, 0, kDraws, seed);
  return OwnTrials{.trials = trials,
                   .total_variation = j.total_variation.seen,
                   .chance_total_variation = j.chance_total_variation,
                   .p = j.p};
}

}  // namespace gatewalk::lattice
