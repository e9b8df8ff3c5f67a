// SPDX-License-Identifier: MIT
#include "lattice/study/experiment.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace gatewalk::lattice {
namespace {

using Trials = std::optional<std::int64_t>;

/// The level of each ending if `endings` endings are tested (Bonferroni).
PowerGoal of_all(const PowerGoal& goal, std::size_t endings) {
  return {goal.power, goal.level / static_cast<double>(endings)};
}

/// The larger number; nullopt, which is more than any number, if one of them is.
Trials larger(const Trials& a, const Trials& b) {
  return a && b ? Trials(std::max(*a, *b)) : std::nullopt;
}

double share_of(const StartAnswer& a, const EndingName& e) {
  return std::clamp(a.final.endings[static_cast<std::size_t>(e.ending)], 0.0, 1.0);
}

/// The longer side of an ending's interval.
double error_of(const StartAnswer& a, const EndingName& e) {
  const auto [low, high] = a.endings.interval[static_cast<std::size_t>(e.ending)];
  return std::max(high - share_of(a, e), share_of(a, e) - low);
}

/// The shares that are larger and smaller by `difference`, as far as they exist.
std::vector<double> shares_off_by(double difference, double share) {
  std::vector<double> shares;
  if (share + difference <= 1.0) shares.push_back(share + difference);
  if (share - difference >= 0.0) shares.push_back(share - difference);
  return shares;
}

Effect effect_on(double share, double difference, double error, const PowerGoal& all,
                 const ExperimentOptions& options) {
  Effect effect{.difference = difference, .within_error = error >= difference};
  const std::vector<double> truths = shares_off_by(difference, share);
  effect.trials = effect.trials_of_all = truths.empty() ? Trials() : Trials(1);
  for (const double truth : truths) {
    effect.trials = larger(effect.trials, trials_for_share(share, truth, options.goal));
    effect.trials_of_all = larger(effect.trials_of_all, trials_for_share(share, truth, all));
    if (options.trials)
      effect.power = std::min(effect.power.value_or(1.0),
                              power_of_share(*options.trials, share, truth, options.goal.level));
  }
  return effect;
}

Effect effect_on_groups(double share, double difference, const PowerGoal& all,
                        const ExperimentOptions& options) {
  Effect effect{.difference = difference};
  const std::vector<double> others = shares_off_by(difference, share);
  effect.trials = effect.trials_of_all = others.empty() ? Trials() : Trials(1);
  for (const double other : others) {
    effect.trials = larger(effect.trials, trials_for_two_shares(share, other, options.goal));
    effect.trials_of_all = larger(effect.trials_of_all, trials_for_two_shares(share, other, all));
    if (options.trials)
      effect.power =
          std::min(effect.power.value_or(1.0),
                   power_of_two_shares(*options.trials, share, other, options.goal.level));
  }
  return effect;
}

}  // namespace

std::vector<std::size_t> endings_to_look_at(const StartAnswer& a, const StartAnswer& b) {
  std::vector<std::size_t> places;
  for (std::size_t e = 0; e < kAllEndingNames.size(); ++e)
    if (!a.endings.rules_out(kAllEndingNames[e].ending) ||
        !b.endings.rules_out(kAllEndingNames[e].ending))
      places.push_back(e);
  return places;
}

ExperimentPlan plan_experiment(const StartAnswer& prediction, const ExperimentOptions& options) {
  ExperimentPlan plan;
  const PowerGoal all = of_all(options.goal, endings_to_look_at(prediction, prediction).size());
  tbb::parallel_for(std::size_t{0}, plan.endings.size(), [&](std::size_t e) {
    const double share = share_of(prediction, kAllEndingNames[e]);
    EndingPlan& of_ending = plan.endings[e];
    for (std::size_t k = 0; k < kShareDifferences.size(); ++k)
      of_ending.effects[k] = effect_on(share, kShareDifferences[k],
                                       error_of(prediction, kAllEndingNames[e]), all, options);
    for (std::size_t k = 0; k < kGroupDifferences.size(); ++k)
      of_ending.of_groups[k] = effect_on_groups(share, kGroupDifferences[k], all, options);
    if (!options.trials) return;
    of_ending.least = smallest_difference(*options.trials, share, options.goal);
    of_ending.least_of_all = smallest_difference(*options.trials, share, all);
  });
  const Outcomes gates = gate_outcomes(prediction.final.final_cells);
  for (std::size_t k = 0; k < kTotalVariations.size(); ++k) {
    Effect& effect = plan.final_gates[k];
    effect.difference = kTotalVariations[k];
    effect.within_error = prediction.error.total_variation >= effect.difference;
    effect.trials =
        trials_for_total_variation(gates, effect.difference, options.goal, options.seed);
    if (const auto truth = hardest_to_see(gates.shares, effect.difference); options.trials && truth)
      effect.power =
          SimulatedTest(gates, *options.trials, options.goal.level, options.seed).power(*truth);
  }
  if (options.trials)
    plan.least_total_variation =
        smallest_total_variation(gates, *options.trials, options.goal, options.seed);
  return plan;
}

TwoScenesPlan tell_apart(const StartAnswer& first, const StartAnswer& second,
                         const ExperimentOptions& options) {
  const CellProbabilities &a = first.final.final_cells, &b = second.final.final_cells;
  TwoScenesPlan plan;
  plan.final_gates.difference = total_variation(a, b);
  plan.final_gates.within_error =
      std::hypot(first.error.total_variation, second.error.total_variation) >=
      plan.final_gates.difference;
  const PowerGoal all = of_all(options.goal, endings_to_look_at(first, second).size());
  tbb::parallel_for(std::size_t{0}, plan.endings.size(), [&](std::size_t e) {
    const EndingName& name = kAllEndingNames[e];
    const double p = share_of(first, name), q = share_of(second, name);
    Effect& effect = plan.endings[e];
    effect.difference = q - p;
    effect.within_error =
        std::hypot(error_of(first, name), error_of(second, name)) >= std::abs(q - p);
    effect.trials = trials_for_two_shares(p, q, options.goal);
    effect.trials_of_all = trials_for_two_shares(p, q, all);
    if (options.trials)
      effect.power = power_of_two_shares(*options.trials, p, q, options.goal.level);
  });
  const auto [gates, other] = gate_outcomes(a, b);
  plan.final_gates.trials = trials_for_two(gates, other, options.goal, options.seed);
  if (options.trials)
    plan.final_gates.power =
        SimulatedTest(gates, other, *options.trials, options.goal.level, options.seed).power();
  return plan;
}

}  // namespace gatewalk::lattice
