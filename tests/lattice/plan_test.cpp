// SPDX-License-Identifier: MIT
#include "lattice/study/plan.h"
#include "lattice/field/running_trial.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "lattice/field/field_trials.h"
#include "lattice/scene/scene.h"
#include "lattice/scene/scene_problem.h"
#include "tests/support/threads.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

constexpr double kGood = 0.95, kBad = 0.2;
constexpr int kRows = 5;

/// A lane of cells. A body enters at a place in [-1, 1], and passes with probability `left` if the
/// place is below 0, else `right`; its place in the next cell is random.
Action lane(std::string name, double left, double right, FieldParams field = {1, kRows, 0}) {
  Section section;
  section.faces = {{"S", 0, 1, 0, 1, "from below", {}}};
  section.coordinates = {{"x", "x", "1", "place", 1.0}};
  const auto cell = std::make_shared<FunctionCell>(section, [=](Body& body) {
    const double chance = body.entry.at[0] < 0.0 ? left : right;
    const Fate fate = body.random.uniform() < chance ? Fate::left : Fate::trapped;
    body.entry = {0, {2.0 * body.random.uniform() - 1.0}};
    return Passage{fate, body.entry};
  });
  Problem problem;
  problem.cells = CellField::uniform(cell);
  problem.field = field;
  problem.start = {0, {-0.5}};
  return {std::move(name), std::move(problem)};
}
std::vector<Action> two_ways(FieldParams field = {1, kRows, 0}) {
  return {lane("left", kGood, kBad, field), lane("right", kBad, kGood, field)};
}

/// Lanes of two types of cells: every other row is that of `others`.
std::vector<Action> in_turn(std::vector<Action> actions, const std::vector<Action>& others) {
  for (std::size_t a = 0; a < 2; ++a) {
    CellField& cells = actions[a].problem.cells;
    cells.cells.push_back(others[a].problem.cells.cells[0]);
    cells.map.types.push_back({});
    cells.map.columns = 1;
    for (int row = 0; row < kRows; ++row) cells.map.type_of_cell.push_back(row % 2);
  }
  return actions;
}

bool holds(const std::array<double, 2>& interval, double value) {
  return interval[0] <= value && value <= interval[1];
}

TEST(Plan, EachBodyTakesTheActionThatItsEntryAsksFor) {
  for (const int limit : {0, kRows + 1}) {
    const Plan plan = make_plan(two_ways({1, kRows, limit}), {.accuracy = 0.01, .seed = 3});
    EXPECT_TRUE(plan.settled) << limit;
    const double best = std::pow(kGood, kRows);
    EXPECT_TRUE(holds(plan.crossings.interval_95(), best)) << plan.crossings.share();
    EXPECT_NEAR(plan.chain_says, best, 0.02);
    EXPECT_EQ(plan.crossings.trials, 9604);
    const double either = 0.5 * (kGood + kBad);
    for (const auto& [action, first] : {std::pair{0U, kGood}, {1U, kBad}}) {
      const double alone = first * std::pow(either, kRows - 1);
      EXPECT_TRUE(holds(plan.alone[action].interval_95(), alone)) << action;
      EXPECT_TRUE(holds(plan.gains[action].interval_95, best - alone)) << action;
      EXPECT_NEAR(plan.gains[action].difference,
                  plan.crossings.share() - plan.alone[action].share(), 1e-12);
    }
    for (int row = 0; row < kRows; ++row)
      for (const double x : {-0.9, -0.5, -0.1, 0.1, 0.9}) {
        EXPECT_EQ(plan.policy.action({0, row, row}, {0, {x}}), x < 0.0 ? 0 : 1) << row << ' ' << x;
      }
    // A body that does not know its entry passes each cell but the first at random.
    ASSERT_TRUE(plan.by_cell);
    const double blind = kGood * std::pow(either, kRows - 1);
    EXPECT_TRUE(holds(plan.by_cell->crossings.interval_95(), blind));
    EXPECT_TRUE(holds(plan.by_cell->worth.interval_95, best - blind));
    for (const double x : {-0.5, 0.5})
      EXPECT_EQ(plan.by_cell->policy.action({0, 0, 0}, {0, {x}}), 0);
    ASSERT_EQ(plan.usage.size(), 2U * kRows);
    EXPECT_NEAR(plan.usage[0], 1.0, 1e-12);  // at the start
    for (int row = 1; row < kRows; ++row) {
      EXPECT_NEAR(plan.usage[static_cast<std::size_t>(row)], 0.5 * std::pow(kGood, row), 0.02);
      EXPECT_NEAR(plan.usage[static_cast<std::size_t>(kRows + row)], 0.5 * std::pow(kGood, row),
                  0.02);
    }
  }
}

/// A lane whose cells let a body through with probability `chance`, and take this time.
Action toll(std::string name, double chance, double time, int rows) {
  Action action = lane(std::move(name), chance, chance, {1, rows, 0});
  Section section = action.problem.map().section;
  section.costs = {{"time_s", "s", "duration"}};
  action.problem.cells =
      CellField::uniform(std::make_shared<FunctionCell>(section, [=](Body& body) {
        const Fate fate = body.random.uniform() < chance ? Fate::left : Fate::trapped;
        return Passage{fate, body.entry, {time}};
      }));
  return action;
}

TEST(Plan, TheFrontIsThatOfAllPoliciesAndEndsWhereACrossingTakesLeast) {
  // Slow is certain, fast is not: all eight policies by row for three rows, in closed form.
  constexpr int kThree = 3;
  constexpr double kChance[] = {0.95, 0.75}, kTime[] = {4.0, 1.0};
  const auto exact = [&](int policy) {
    double alive = 1.0, time = 0.0;
    for (int row = 0; row < kThree; ++row) {
      time += alive * kTime[policy >> row & 1];
      alive *= kChance[policy >> row & 1];
    }
    return std::pair(alive, time);
  };
  const std::vector<Action> actions{toll("slow", kChance[0], kTime[0], kThree),
                                    toll("fast", kChance[1], kTime[1], kThree)};
  const Plan plan = make_plan(actions, {.accuracy = 0.01, .seed = 8, .thrift = ThriftOptions{}});
  ASSERT_GE(plan.front.size(), 3U);
  double least = 1e9;
  for (int policy = 0; policy < 1 << kThree; ++policy)
    least = std::min(least, exact(policy).second / exact(policy).first);
  double price = -1.0;
  for (const FrontPoint& point : plan.front) {
    int policy = 0;
    for (int row = 0; row < kThree; ++row)
      policy |= point.policy.action({0, row, row}, {0, {-0.5}}) << row;
    const auto [chance, time] = exact(policy);
    for (int other = 0; other < 1 << kThree; ++other)
      EXPECT_LE(exact(other).first - point.price * exact(other).second,
                chance - point.price * time + 0.01)
          << policy << ' ' << other << ' ' << point.price;
    EXPECT_NEAR(point.crossings.share(), chance, 0.015);
    EXPECT_NEAR(point.spent.mean, time, point.spent.mean_95[1] - point.spent.mean_95[0]);
    EXPECT_TRUE(point.spent.mean_95[0] < point.spent.mean &&
                point.spent.mean < point.spent.mean_95[1]);
    EXPECT_NEAR(point.spent.per_crossing, point.spent.mean / point.crossings.share(), 1e-9);
    EXPECT_GT(point.price, price);
    price = point.price;
    EXPECT_EQ(point.crossings.trials, plan.crossings.trials);
  }
  EXPECT_EQ(plan.front[0].price, 0.0);
  EXPECT_EQ(plan.front[0].crossings.crossed, plan.crossings.crossed);
  EXPECT_NEAR(plan.front.back().spent.per_crossing, least, 0.1);
  for (const ThriftOptions& wrong :
       {ThriftOptions{.cost = 1}, ThriftOptions{.points = 0}, ThriftOptions{.chance = 1.0}})
    EXPECT_THROW((void)make_plan(actions, {.thrift = wrong}), std::invalid_argument);
}

TEST(Plan, IsNotLostWherePassagesMayTakeNothing) {
  const std::vector<Action> actions{toll("sure", 0.95, 1.0, 3), toll("free", 0.75, 0.0, 3)};
  const Plan plan = make_plan(actions, {.accuracy = 0.05, .seed = 8, .thrift = ThriftOptions{}});
  EXPECT_NE(plan.front_refused.find("may be 0 or less"), std::string::npos);
  EXPECT_FALSE(plan.front_finished);
  EXPECT_EQ(plan.front.size(), 1U);
  EXPECT_GT(plan.crossings.share(), 0.75);
}

// By simulation: 2000 sets of trials with known means.
TEST(Plan, WhatTrialsTakeIsHeldByItsIntervals) {
  int mean = 0, ratio = 0;
  for (int set = 0; set < 2000; ++set) {
    Random random(Purpose::plan, {7, static_cast<std::uint64_t>(set), 0});
    FieldTrials trials;
    for (int i = 0; i < 200; ++i) {
      const bool crosses = random.uniform() < 0.3;
      trials.endings.emplace_back(crosses ? markov::Ending::far_edge : markov::Ending::trapped);
      trials.costs.push_back({crosses ? 3.0 : 1.0 + random.uniform()});
    }
    const Spent spent = spent_by(trials, 0);
    mean += holds(spent.mean_95, 0.3 * 3.0 + 0.7 * 1.5);
    ratio += holds(spent.per_crossing_95, (0.3 * 3.0 + 0.7 * 1.5) / 0.3);
  }
  for (const int held : {mean, ratio}) EXPECT_NEAR(held, 1900, 5 * std::sqrt(2000 * 0.95 * 0.05));
  FieldTrials none;
  none.endings.assign(2, markov::Ending::trapped);
  none.costs.assign(2, {1.0});
  EXPECT_TRUE(std::isnan(spent_by(none, 0).per_crossing));
  EXPECT_TRUE(std::isnan(spent_by(none, 0).mean_95[0]));  // for fewer than 100 trials
  none.endings[0] = markov::Ending::far_edge;
  EXPECT_TRUE(std::isinf(spent_by(none, 0).per_crossing_95[1]));
  EXPECT_GT(spent_by(none, 0).per_crossing_95[0], 0.0);
  none.endings.pop_back();
  none.costs.pop_back();
  EXPECT_THROW((void)spent_by(none, 0), std::invalid_argument);
}

TEST(Plan, WhereAllActionsAreAlikeNothingIsGained) {
  const Plan plan = make_plan({lane("one", 0.9, 0.9), lane("other", 0.9, 0.9)}, {.seed = 5});
  for (const Gain& gain : plan.gains) {
    EXPECT_EQ(gain.difference, 0.0);  // under the same noise
    // The gain over the action that the policy always takes is not an estimate.
    const auto taken = static_cast<std::size_t>(plan.policy.always.value());
    EXPECT_EQ(std::isnan(gain.interval_95[0]), &gain == &plan.gains[taken]);
    EXPECT_EQ(holds(gain.interval_95, 0.0), &gain != &plan.gains[taken]);
  }
}

// A robust policy takes what is known to be good, and keeps its promise: less than the truth, and
// more than any single action could achieve.
TEST(Plan, RobustPoliciesKeepWhatTheyPromise) {
  const double best = std::pow(kGood, kRows), alone = kGood * std::pow(0.5 * (kGood + kBad), 4);
  for (const int limit : {0, kRows + 1}) {
    const Plan plan =
        make_plan(two_ways({1, kRows, limit}), {.accuracy = 0.01, .seed = 3, .robust = true});
    ASSERT_TRUE(plan.worst_case) << limit;
    EXPECT_LT(*plan.worst_case, best);
    EXPECT_GT(*plan.worst_case, alone + 0.1);
    EXPECT_LT(*plan.worst_case, plan.crossings.share() + 0.01);
    EXPECT_TRUE(std::isnan(plan.chain_says));
    EXPECT_TRUE(holds(plan.crossings.interval_95(), best)) << plan.crossings.share();
    for (const double x : {-0.9, -0.5, 0.5, 0.9})
      EXPECT_EQ(plan.policy.action({0, 2, 2}, {0, {x}}), x < 0.0 ? 0 : 1) << x;
  }
  // A single action has its own worst case, a row of all runs of each cell.
  const Plan same = make_plan({lane("good", kGood, kGood), lane("none", 0.0, 0.0)},
                              {.accuracy = 0.01, .seed = 4, .robust = true});
  EXPECT_EQ(same.policy.always, 0);
  ASSERT_TRUE(same.worst_case);
  EXPECT_LT(*same.worst_case, best);
  EXPECT_GT(*same.worst_case, best - 0.25);
  EXPECT_FALSE(make_plan(two_ways(), {.seed = 3}).worst_case);
}

// In every other row, left and right are exchanged.
TEST(Plan, TypesOfCellsAreToldApart) {
  const std::vector<Action> actions =
      in_turn(two_ways(), {lane("", kBad, kGood), lane("", kGood, kBad)});
  const Plan plan = make_plan(actions, {.seed = 6});
  // The best one within the accuracy, and as much again by sampling error.
  EXPECT_NEAR(plan.crossings.share(), std::pow(kGood, kRows), 0.04);
  for (int row = 0; row < kRows; ++row)
    for (const double x : {-0.5, 0.5})
      EXPECT_EQ(plan.policy.action({0, row, row}, {0, {x}}), (x > 0.0) != (row % 2 == 1)) << row;
  EXPECT_THROW((void)plan.policy.action({0, kRows, 0}, {0, {0.5}}), std::out_of_range);
  EXPECT_THROW((void)plan.policy.action({1, 0, 0}, {0, {0.5}}), std::out_of_range);
  EXPECT_THROW((void)plan.policy.action({0, 0, 0}, {1, {0.5}}), std::out_of_range);
}

// If the entry tells nothing, knowing the cell is enough.
TEST(Plan, KnowsTheCellAlone) {
  const std::vector<Action> actions = in_turn({lane("even", kGood, kGood), lane("odd", kBad, kBad)},
                                              {lane("", kBad, kBad), lane("", kGood, kGood)});
  const Plan plan = make_plan(actions, {.seed = 6});
  ASSERT_TRUE(plan.by_cell);
  EXPECT_NEAR(plan.by_cell->crossings.share(), std::pow(kGood, kRows), 0.04);
  EXPECT_NEAR(plan.by_cell->worth.difference, 0.0, 0.02);
  for (int row = 0; row < kRows; ++row)
    EXPECT_EQ(plan.by_cell->policy.action({0, row, row}, {0, {0.5}}), row % 2) << row;
}

// The best policy tries again until the last cell, and rushes there.
TEST(Plan, KnowsHowManyCellsAreLeft) {
  const auto action = [](std::string name, double ahead, Fate else_) {
    Section section;
    section.faces = {{"S", 0, 1, 0, 0, "from below", {}}, {"W", 1, 0, kNoMirror, 0, "", {}}};
    section.coordinates = {{"x", "x", "1", "place", 1.0}};
    const auto cell = std::make_shared<FunctionCell>(section, [=](Body& body) {
      const bool goes_on = body.random.uniform() < ahead;
      body.entry = {goes_on ? 0 : 1, {body.random.uniform()}};
      return Passage{goes_on ? Fate::left : else_, body.entry};
    });
    Problem problem;
    problem.cells = CellField::uniform(cell);
    problem.field = {9, 1, 3};
    problem.start = {0, {0.5}};
    return Action{std::move(name), std::move(problem)};
  };
  const std::vector<Action> actions{action("try", 0.5, Fate::left),
                                    action("rush", 0.7, Fate::trapped)};
  const Plan plan = make_plan(actions, {.accuracy = 0.01, .seed = 7});
  EXPECT_TRUE(holds(plan.crossings.interval_95(), 0.925)) << plan.crossings.share();
  EXPECT_TRUE(holds(plan.alone[0].interval_95(), 0.875));
  EXPECT_TRUE(holds(plan.alone[1].interval_95(), 0.7));
  EXPECT_EQ(plan.policy.action({4, 0, 0}, {0, {0.5}}), 0);
  EXPECT_EQ(plan.policy.action({5, 0, 1}, {1, {0.5}}), 0);
  EXPECT_EQ(plan.policy.action({6, 0, 2}, {1, {0.5}}), 1);
}

/// The paper's field, with two actions: push hard, or gently.
std::vector<Action> pushes() {
  std::vector<Action> actions;
  for (const auto& [name, push] : {std::pair{"gently", 6.0}, {"hard", 8.0}}) {
    Scene scene;
    scene.gate.forces.propulsion = push;
    scene.gate.forces.random = 30.0;
    scene.gate.run.method = "moreau";
    scene.gate.run.step = 0.02;
    scene.field.columns = scene.field.rows = 3;
    actions.push_back({name, problem_of(scene)});
  }
  return actions;
}

TEST(Plan, TheSameOnAnyThreads) {
  const auto run = [] { return make_plan(pushes(), {.accuracy = 0.05, .seed = 2}); };
  const Plan one = test::on_threads(1, run), three = test::on_threads(3, run);
  EXPECT_EQ(one.crossings.crossed, three.crossings.crossed);
  EXPECT_EQ(one.rounds, three.rounds);
  EXPECT_EQ(one.policy.decisions.action, three.policy.decisions.action);
  EXPECT_EQ(one.usage, three.usage);
  ASSERT_TRUE(one.by_cell && three.by_cell);
  EXPECT_EQ(one.by_cell->policy.decisions.action, three.by_cell->policy.decisions.action);
  EXPECT_EQ(one.by_cell->crossings.crossed, three.by_cell->crossings.crossed);
  EXPECT_EQ(one.gate_runs, three.gate_runs);
}

TEST(Plan, AnActionAloneIsThatField) {
  const std::vector<Action> actions = pushes();
  for (const int a : {0, 1}) {
    const Problem& p = actions[static_cast<std::size_t>(a)].problem;
    FieldTrials chosen, own;
    const CellField cells = cells_of(actions);
    (void)run_field(cells, p.field,
                    [&](std::int64_t i, Body& body) {
                      begin_trial(p.cells.at(p.field.start_column(), 0), p.start, 4, i, body);
                    },
                    {0, 300}, &chosen, nullptr, Memory::kept,
                    {p.start, [a](const Place&, const Entry&) { return a; }});
    (void)run_field(p.cells, p.field, p.start, 4, {0, 300}, &own);
    EXPECT_EQ(chosen.final_gates, own.final_gates);
    EXPECT_EQ(chosen.endings, own.endings);
  }
}

// In the full dynamics the policy achieves what the plan says.
TEST(Plan, APolicyRunsWithTheNoiseOfFieldTrials) {
  const std::vector<Action> actions = pushes();
  const Plan plan = make_plan(actions, {.accuracy = 0.1, .seed = 2});
  const FieldTally run = policy_trials(actions, plan.policy, {0, 4000}, 8);
  const double share =
      static_cast<double>(run.endings[static_cast<std::size_t>(markov::Ending::far_edge)]) / 4000.0;
  const auto [low, high] = plan.crossings.interval_95();
  EXPECT_TRUE(low - 0.03 < share && share < high + 0.03) << low << ' ' << share << ' ' << high;
  Policy hard = plan.policy;
  hard.always = 1;
  const FieldTally always = policy_trials(actions, hard, {0, 500}, 8),
                   own = field_trials(actions[1].problem, {0, 500}, 8);
  EXPECT_TRUE((always.final_cells == own.final_cells).all());
  hard.always = 2;
  EXPECT_THROW((void)policy_trials(actions, hard, {0, 10}, 8), std::out_of_range);
  std::vector<Action> longer = actions;
  for (Action& action : longer) ++action.problem.field.rows;
  EXPECT_THROW((void)policy_trials(longer, plan.policy, {0, 500}, 8), std::out_of_range);
}

TEST(Plan, RefusesWhatDoesNotBelongTogether) {
  const auto refused = [](std::vector<Action> actions, const PlanOptions& options = {}) {
    EXPECT_THROW((void)make_plan(actions, options), std::invalid_argument);
  };
  refused({});
  refused({lane("one", 0.5, 0.5)});
  refused({lane("one", 0.5, 0.5), lane("other", 0.5, 0.5, {3, kRows, 0})});
  refused({lane("one", 0.5, 0.5), lane("other", 0.5, 0.5, {1, kRows, 9})});
  refused({lane("one", 0.5, 0.5), pushes()[0]});
  std::vector<Action> elsewhere = two_ways();
  elsewhere[1].problem.start.at[0] = 0.5;
  refused(elsewhere);
  std::vector<Action> many(257, lane("many", 0.5, 0.5));
  refused(many);
  std::vector<Action> wider = pushes();
  wider[1].problem.width *= 2.0;
  refused(wider);
  refused(two_ways(), {.accuracy = 0.0});
  refused(two_ways(), {.per_leaf = 0});
  refused(two_ways(), {.accuracy = 0.5});
  refused(two_ways(), {.accuracy = std::nan("")});
  refused({toll("slow", 0.9, 2.0, 2), toll("fast", 0.5, 1.0, 2)},
          {.thrift = ThriftOptions{}, .robust = true});
}

}  // namespace
}  // namespace gatewalk::lattice
