// SPDX-License-Identifier: MIT
// How many trials an experiment needs, for predictions made by hand.
#include "lattice/study/experiment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace gatewalk::lattice {
namespace {

constexpr std::size_t kCrossed = 0, kLeft = 1, kTrapped = 3;  // indices in kEndingNames

/// A body crosses with this probability, else it is trapped; +- `error` in all shares.
StartAnswer crossing(double chance, double error) {
  StartAnswer a;
  a.final.final_cells = CellProbabilities::Zero(2, 2);
  a.final.final_cells << 0.5 * (1.0 - chance), 0.5 * (1.0 - chance), 0.5 * chance, 0.5 * chance;
  a.final.endings[static_cast<std::size_t>(markov::Ending::far_edge)] = chance;
  a.final.endings[static_cast<std::size_t>(markov::Ending::trapped)] = 1.0 - chance;
  a.endings = EndingShares(a.final.endings);
  for (std::size_t e = 0; e < markov::kEndings; ++e)
    a.endings.interval[e] = {a.final.endings[e] - error, a.final.endings[e] + error};
  a.error.total_variation = error;
  return a;
}

TEST(ExperimentPlan, TakesTheWorseOfMoreAndFewer) {
  const ExperimentOptions options{.goal = {}, .trials = 60};
  const ExperimentPlan plan = plan_experiment(crossing(0.3, 0.01), options);
  const Effect& ten = plan.endings[kCrossed].effects[2];
  EXPECT_EQ(ten.difference, 0.10);
  EXPECT_EQ(ten.trials, std::max(trials_for_share(0.3, 0.4, options.goal),
                                 trials_for_share(0.3, 0.2, options.goal)));
  EXPECT_NEAR(*ten.power,
              std::min(power_of_share(60, 0.3, 0.4, 0.05), power_of_share(60, 0.3, 0.2, 0.05)),
              1e-12);
  EXPECT_EQ(ten.trials_of_all, std::max(trials_for_share(0.3, 0.4, {0.8, 0.01}),
                                        trials_for_share(0.3, 0.2, {0.8, 0.01})));
  EXPECT_GT(*ten.trials_of_all, *ten.trials);
  // No body leaves to the left: 1 - .95^n is 0.8 with n = 32.
  EXPECT_EQ(plan.endings[kLeft].effects[1].trials, 32);
  EXPECT_EQ(plan.endings[kTrapped].least.more, smallest_difference(60, 0.7, options.goal).more);
  EXPECT_FALSE(plan.endings[kLeft].least.fewer);
  // 0.05 is harder to detect than 0.2, and needs more than 60 trials.
  EXPECT_GT(*plan.final_gates[0].trials, 4 * *plan.final_gates[2].trials);
  EXPECT_LT(*plan.final_gates[0].power, 0.5);
  EXPECT_GT(*plan.least_total_variation, 0.05);
}

TEST(ExperimentPlan, SaysWhereThePredictionIsTooUncertain) {
  const ExperimentPlan plan = plan_experiment(crossing(0.3, 0.06), {});
  for (std::size_t k = 0; k < kShareDifferences.size(); ++k)
    EXPECT_EQ(plan.endings[kCrossed].effects[k].within_error, kShareDifferences[k] < 0.06);
  EXPECT_TRUE(plan.final_gates[0].within_error);
  EXPECT_FALSE(plan.final_gates[1].within_error);
  EXPECT_FALSE(plan.least_total_variation);
  EXPECT_FALSE(plan.endings[kCrossed].effects[0].power);
}

// Then four endings are tested instead of five, unless the other scene has a limit.
TEST(ExperimentPlan, WithoutALimitOfGatesCuttingOffIsNotLookedAt) {
  const ExperimentOptions options{.goal = {}, .trials = 60};
  const StartAnswer limited = crossing(0.3, 0.01);
  StartAnswer free = limited;
  free.endings = free.endings.with_limit(0);
  EXPECT_EQ(endings_to_look_at(limited, limited), (std::vector<std::size_t>{0, 1, 2, 3, 4}));
  EXPECT_EQ(endings_to_look_at(free, free), (std::vector<std::size_t>{0, 1, 2, 3}));
  EXPECT_EQ(endings_to_look_at(free, limited).size(), 5u);
  EXPECT_EQ(plan_experiment(free, options).endings[kCrossed].effects[2].trials_of_all,
            std::max(trials_for_share(0.3, 0.4, {0.8, 0.0125}),
                     trials_for_share(0.3, 0.2, {0.8, 0.0125})));
  const StartAnswer other = crossing(0.5, 0.01);
  EXPECT_EQ(tell_apart(free, other, options).endings[kCrossed].trials_of_all,
            trials_for_two_shares(0.3, 0.5, {0.8, 0.01}));
}

TEST(TellApart, TwoScenes) {
  const ExperimentOptions options{.goal = {}, .trials = 60};
  const TwoScenesPlan plan = tell_apart(crossing(0.3, 0.01), crossing(0.5, 0.01), options);
  const Effect& crossed = plan.endings[kCrossed];
  EXPECT_NEAR(crossed.difference, 0.2, 1e-15);
  EXPECT_EQ(crossed.trials, trials_for_two_shares(0.3, 0.5, options.goal));
  EXPECT_EQ(crossed.power, power_of_two_shares(60, 0.3, 0.5, 0.05));
  EXPECT_FALSE(crossed.within_error);
  EXPECT_FALSE(plan.endings[kLeft].trials);  // equal in both
  EXPECT_TRUE(plan.endings[kLeft].within_error);
  EXPECT_NEAR(plan.final_gates.difference, 0.2, 1e-15);
  // Four gates that differ as the two endings do: slightly harder to detect than in the endings.
  EXPECT_GT(*plan.final_gates.trials, 0.8 * static_cast<double>(*crossed.trials));
  EXPECT_LT(*plan.final_gates.trials, 2.0 * static_cast<double>(*crossed.trials));
  EXPECT_TRUE(tell_apart(crossing(0.3, 0.2), crossing(0.5, 0.2), {}).final_gates.within_error);
  StartAnswer other = crossing(0.3, 0.01);
  other.final.final_cells = CellProbabilities::Constant(1, 4, 0.25);
  EXPECT_THROW((void)tell_apart(crossing(0.3, 0.01), other, {}), std::invalid_argument);
}

}  // namespace
}  // namespace gatewalk::lattice
