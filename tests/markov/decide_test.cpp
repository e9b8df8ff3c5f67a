// SPDX-License-Identifier: MIT
#include "markov/decide.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "markov/predict.h"
#include "markov/solvers.h"
#include "tests/markov/chains.h"
#include "tests/support/propagation.h"

namespace gatewalk::markov {
namespace {

using test::matrix;

using test::crossing;
using test::few;
using test::kFar;
using test::propagate;
using test::random_chain;

/// A chain that goes from column 0 in state 0 to column 1 in state 1, and back, for ever.
Chain closed() {
  return Chain::from_probabilities(matrix(2, 2, {{0, 1, 1.0}, {1, 0, 1.0}}),
                                   {{0, -1, 0}, {1, 1, 0}});
}

/// The gain in each cell and state if `decisions` are kept for ever, by a dense solve.
template <int N>
Eigen::Matrix<double, N, 1> gained(const std::vector<FieldChain>& actions, const Field& field,
                                   const Gains& gains, const std::uint16_t* action) {
  Eigen::Matrix<double, N, N> moves = Eigen::Matrix<double, N, N>::Identity();
  Eigen::Matrix<double, N, 1> now;
  for (int s = 0; s < N; ++s) {
    const int cell = s / 2, input = s % 2;
    now(s) = gains.draw.empty() ? 0.0 : gains.draw[action[s]][0][static_cast<std::size_t>(input)];
    const Chain& chain = actions[action[s]].at(cell % field.columns, cell / field.columns);
    for (Probabilities::InnerIterator it(chain.matrix(), input); it; ++it) {
      std::int64_t column = cell % field.columns, row = cell / field.columns;
      const Exit& exit = chain.exits()[static_cast<std::size_t>(it.col())];
      if (const auto end = follow(field, exit, false, column, row))
        now(s) += it.value() * gains.ending[static_cast<std::size_t>(*end)];
      else
        moves(s, (row * field.columns + column) * 2 + exit.next_input) -= it.value();
    }
  }
  return moves.partialPivLu().solve(now);
}

TEST(Decide, IsTheBestOfAllPoliciesOfASmallField) {
  test::Words words(7);
  constexpr int kStates = 3 * 3 * 2;
  const Field field{3, 3};
  Gains slow = crossing();  // crossing is worth as much as some 20 draws
  slow.draw = {{{-0.05, -0.06}}, {{-0.04, -0.02}}};
  for (const Gains& gains : {crossing(), slow}) {
    const std::vector<FieldChain> actions{random_chain(words), random_chain(words)};
    const Decisions best = decide(actions, field, gains);
    Eigen::Matrix<double, kStates, 1> most = Eigen::Matrix<double, kStates, 1>::Constant(-1e300);
    std::uint16_t action[kStates];
    for (int policy = 0; policy < 1 << kStates; ++policy) {
      for (int s = 0; s < kStates; ++s) action[s] = static_cast<std::uint16_t>(policy >> s & 1);
      most = most.cwiseMax(gained<kStates>(actions, field, gains, action));
    }
    const auto own = gained<kStates>(actions, field, gains, best.action.data());
    for (int s = 0; s < kStates; ++s) {
      EXPECT_NEAR(best.value[static_cast<std::size_t>(s)], most(s), 1e-12);
      EXPECT_NEAR(own(s), most(s), 1e-12);
    }
  }
}

/// The largest gain in this number of draws, by trying all ways.
double most_gained(const std::vector<FieldChain>& actions, const Field& field, const Gains& gains,
                   const Start& from, int draws) {
  double most = -1e300;
  for (std::size_t a = 0; a < actions.size(); ++a) {
    double sum = gains.draw.empty() ? 0.0 : gains.draw[a][0][static_cast<std::size_t>(from.input)];
    const Chain& chain = actions[a].at(from.column, from.row);
    for (Probabilities::InnerIterator it(chain.matrix(), from.input); it; ++it) {
      const Exit& exit = chain.exits()[static_cast<std::size_t>(it.col())];
      std::int64_t column = from.column, row = from.row;
      const auto end = follow(field, exit, draws == 1, column, row);
      sum += it.value() *
             (end ? gains.ending[static_cast<std::size_t>(*end)]
                  : most_gained(actions, field, gains,
                                {static_cast<int>(column), static_cast<int>(row), exit.next_input},
                                draws - 1));
    }
    most = std::max(most, sum);
  }
  return most;
}

TEST(Decide, WithALimitKnowsHowManyDrawsAreLeft) {
  test::Words words(3);
  const Field field{3, 2};
  const std::vector<FieldChain> actions{random_chain(words), random_chain(words)};
  Gains gains = crossing();
  gains.ending[static_cast<std::size_t>(Ending::trapped)] = -0.3;
  gains.ending[static_cast<std::size_t>(Ending::cut_off)] = 0.1;
  gains.draw = {{{0.01, -0.02}}, {{0.03, 0.0}}};
  for (const int limit : {1, 2, 5}) {
    const Decisions best = decide(actions, field, gains, {.max_cells = limit});
    for (int row = 0; row < 2; ++row)
      for (int column = 0; column < 3; ++column)
        for (int input = 0; input < 2; ++input)
          EXPECT_NEAR(best.value[best.at(column, row, input)],
                      most_gained(actions, field, gains, {column, row, input}, limit), 1e-14);
  }
}

/// The paper's size: 87 states, one chain per action.
std::vector<FieldChain> nine_actions() {
  std::vector<FieldChain> actions;
  for (int a = 0; a < 9; ++a)
    actions.emplace_back(Chain::from_counts(test::lattice_counts(static_cast<std::uint64_t>(a) + 1),
                                            test::lattice_exits()));
  return actions;
}

TEST(Decide, ValueIsWhatPlainPropagationOfItsDecisionsSays) {
  const std::vector<FieldChain> actions = nine_actions();
  const Field field;
  const Decisions best = decide(actions, field, crossing());
  const FieldChain chain = decided(actions, best);
  double most_single = 0.0;
  for (const int input : {0, 13, 30, 86}) {
    const Start start{4, 0, input};
    const auto chance = [&](const FieldChain& of) {
      return propagate(of, field, start).endings[kFar];
    };
    EXPECT_NEAR(chance(chain), best.value[best.at(4, 0, input)], 1e-10);
    for (const FieldChain& action : actions) most_single = std::max(most_single, chance(action));
    EXPECT_GT(best.value[best.at(4, 0, input)], most_single);
  }
  // With a limit, each draw follows the decisions for its number.
  constexpr int kLimit = 13;
  const Decisions limited = decide(actions, field, crossing(), {.max_cells = kLimit});
  std::vector<double> now(static_cast<std::size_t>(9 * 9 * 87), 0.0);
  now[limited.at(4, 0, 13)] = 1.0;
  double crossed = 0.0;
  for (int draws = 0; draws < kLimit; ++draws) {
    const FieldChain step = decided(actions, limited, draws);
    std::vector<double> next(now.size(), 0.0);
    for (int cell = 0; cell < 81; ++cell)
      for (int input = 0; input < 87; ++input) {
        const Chain& at = step.at(cell % 9, cell / 9);
        for (Probabilities::InnerIterator it(at.matrix(), input); it; ++it) {
          const Exit& exit = at.exits()[static_cast<std::size_t>(it.col())];
          std::int64_t column = cell % 9, row = cell / 9;
          const double mass = now[static_cast<std::size_t>(cell * 87 + input)] * it.value();
          const auto end = follow(field, exit, draws == kLimit - 1, column, row);
          if (!end)
            next[static_cast<std::size_t>((row * 9 + column) * 87 + exit.next_input)] += mass;
          else if (*end == Ending::far_edge)
            crossed += mass;
        }
      }
    now = next;
  }
  EXPECT_NEAR(crossed, limited.value[limited.at(4, 0, 13)], 1e-10);
}

// By the equation of optimality, actions between which walks could circle for ever are as good as
// the one that goes on; a walk that takes them gains nothing.
TEST(Decide, DoesNotCircleWhereAllWaysLookAlike) {
  const FieldChain aside(few({{0, 1, 1.0}, {1, 1, 1.0}}));  // right for sure
  const FieldChain back(few({{0, 2, 1.0}, {1, 2, 1.0}}));   // left for sure
  const FieldChain ahead(few({{0, 0, 0.5}, {0, 4, 0.5}, {1, 0, 0.5}, {1, 4, 0.5}}));
  for (const std::vector<FieldChain>& actions :
       {std::vector{aside, back, ahead}, std::vector{ahead, back, aside}}) {
    const Field field{4, 1};
    const Decisions best = decide(actions, field, crossing());
    for (const double value : best.value) EXPECT_NEAR(value, 0.5, 1e-15);
    const FieldChain chain = decided(actions, best);
    for (int column = 0; column < 4; ++column)
      EXPECT_NEAR(solve_absorption(chain, field, {column, 0, 1}).endings[kFar], 0.5, 1e-12);
  }
  // If walks can only circle, the gain is 0.
  const Decisions none = decide({closed()}, {2, 1}, crossing());
  EXPECT_EQ(*std::max_element(none.value.begin(), none.value.end()), 0.0);
}

/// The chain with its outputs in another order, so that sums round differently.
Chain reversed(const Chain& chain) {
  const int outputs = chain.outputs();
  Probabilities p(chain.inputs(), outputs);
  for (int input = 0; input < chain.inputs(); ++input)
    for (Probabilities::InnerIterator it(chain.matrix(), input); it; ++it)
      p.coeffRef(input, outputs - 1 - it.col()) = it.value();
  std::vector<Exit> exits(chain.exits().rbegin(), chain.exits().rend());
  return Chain::from_probabilities(std::move(p), std::move(exits));
}

// Of actions that are equal up to rounding, the first is chosen.
TEST(Decide, ADrawThatWasNeverSampledCostsToo) {
  // The first action's row is unsampled: a walk ends there, which gains nothing and costs the draw.
  const Chain never = Chain::from_counts(Counts(1, 1), {{0, 0, 1}});
  const Chain sure = Chain::from_probabilities(matrix(1, 1, {{0, 0, 1.0}}), {{0, 0, 1}});
  for (const double cost : {-0.4, -2.0}) {
    Gains gains = crossing();
    gains.draw = {{{cost}}, {{-1.5}}};
    const Decisions best = decide({never, sure}, {1, 1}, gains, {.max_cells = 2});
    EXPECT_EQ(best.action[0], cost == -0.4 ? 0 : 1);
    EXPECT_EQ(best.value[0], cost == -0.4 ? -0.4 : -0.5);
  }
}

TEST(Decide, TakesTheFirstOfEqualActions) {
  const Chain one = nine_actions()[3].chains()[0];
  Gains gains = crossing();
  for (const int limit : {0, 13}) {
    const Decisions best = decide({one, reversed(one), one}, Field{}, gains, {.max_cells = limit});
    EXPECT_EQ(*std::max_element(best.action.begin(), best.action.end()), 0) << limit;
  }
  gains.draw.assign(3, {std::vector<double>(87, -0.01)});
  const Decisions best = decide({one, reversed(one), one}, Field{}, gains);
  EXPECT_EQ(*std::max_element(best.action.begin(), best.action.end()), 0);
}

// Circling costs little at first.
TEST(Decide, LeavesACheapCircle) {
  const FieldChain ahead(
      Chain::from_probabilities(matrix(2, 1, {{0, 0, 1.0}, {1, 0, 1.0}}), {{0, 0, 1}}));
  Gains gains = crossing();
  gains.draw = {{{-0.01, -0.01}}, {{-2.0, -2.0}}};
  const std::vector<FieldChain> actions{closed(), ahead};
  const Decisions best = decide(actions, {2, 1}, gains);
  EXPECT_EQ(best.action[best.at(0, 0, 0)], 1);
  EXPECT_NEAR(best.value[best.at(0, 0, 0)], -1.0, 1e-12);
  // The better action has the initial value.
  const FieldChain trapped(
      Chain::from_probabilities(matrix(2, 1, {{0, 0, 1.0}, {1, 0, 1.0}}), {{}}));
  gains.draw = {{{-1.0, -1.0}}, {{-1.0, -1.0}}};
  const Decisions free = decide({trapped, ahead}, {1, 1}, gains);
  EXPECT_EQ(free.action[0], 1);
  EXPECT_EQ(free.value[0], 0.0);
}

// Tiny probabilities and the decisions for them are found.
TEST(Decide, FindsRareChances) {
  const std::vector<FieldChain> actions{few({{0, 0, 0.001}, {0, 4, 0.999}, {1, 4, 1.0}}),
                                        few({{0, 0, 0.002}, {0, 4, 0.998}, {1, 4, 1.0}})};
  const Field field{1, 20};
  const Decisions best = decide(actions, field, crossing());
  EXPECT_NEAR(best.value[best.at(0, 0, 0)] / std::pow(0.002, 20), 1.0, 1e-12);
  EXPECT_EQ(best.action[best.at(0, 0, 0)], 1);
}

// Rows that no longer change keep their decisions. Moves lead over several cells, and each edge and
// ending has another gain.
TEST(Decide, WithALongLimitIsPlainPropagation) {
  test::Words words(21);
  std::vector<FieldChain> actions;
  for (int a = 0; a < 3; ++a) {
    Counts counts = test::lattice_counts(static_cast<std::uint64_t>(a) + 40);
    test::empty_row(counts, 17);
    actions.emplace_back(
        Chain::from_counts(counts, a == 2 ? test::leaps() : test::lattice_exits()));
  }
  Gains gains;
  for (std::size_t e = 0; e < kEndings; ++e) gains.ending[e] = 0.1 * words.below(10) + 0.05;
  const Field field{4, 12};
  constexpr int kLimit = 80;
  const Decisions best = decide(actions, field, gains, {.max_cells = kLimit});
  // Far from the limit, decisions have the same value as without a limit.
  const Decisions endless = decide(actions, field, gains);
  const FieldChain first = decided(actions, best), always = decided(actions, endless);
  for (const int input : {0, 17, 40}) {
    const Start start{1, 0, input};
    const auto gained = [&](const FieldChain& chain) {
      const FinalDistribution d = propagate(chain, field, start);
      double sum = 0.0;
      for (std::size_t e = 0; e < kEndings; ++e) sum += gains.ending[e] * d.endings[e];
      return sum;
    };
    EXPECT_NEAR(gained(always), endless.value[endless.at(1, 0, input)], 1e-10);
    EXPECT_NEAR(gained(first), best.value[best.at(1, 0, input)], 1e-7);
    EXPECT_NEAR(best.value[best.at(1, 0, input)], endless.value[endless.at(1, 0, input)], 1e-7);
  }
  // The decisions after the first draws as well.
  const FieldChain later = decided(actions, best, 5);
  EXPECT_EQ(propagate(later, field, {1, 3, 0}).endings, propagate(first, field, {1, 3, 0}).endings);
}

TEST(Decide, TypesOfCellsHaveActionsOfTheirOwn) {
  test::Words words(11);
  const Chain easy = random_chain(words), hard = random_chain(words), other = random_chain(words);
  const Field field{3, 3};
  const std::vector<int> types{0, 1, 0, 1, 1, 0, 0, 0, 1};
  const std::vector<FieldChain> actions{FieldChain::by_cell({easy, hard}, 3, types),
                                        FieldChain::by_cell({other, easy}, 3, types)};
  const Decisions best = decide(actions, field, crossing());
  const FieldChain chain = decided(actions, best);
  for (int column = 0; column < 3; ++column)
    for (const int input : {0, 1})
      EXPECT_NEAR(propagate(chain, field, {column, 0, input}).endings[kFar],
                  best.value[best.at(column, 0, input)], 1e-12);
}

TEST(Decide, RefusesWhatHasNoAnswer) {
  test::Words words(1);
  const std::vector<FieldChain> actions{random_chain(words), random_chain(words)};
  const Field field{3, 3};
  EXPECT_THROW((void)decide({}, field, crossing()), std::invalid_argument);
  EXPECT_THROW((void)decide({actions[0], nine_actions()[0]}, field, crossing()),
               std::invalid_argument);
  Gains gains = crossing();
  gains.ending[0] = -1.0;  // circling would be better
  EXPECT_THROW((void)decide(actions, field, gains), std::invalid_argument);
  EXPECT_NO_THROW((void)decide(actions, field, gains, {.max_cells = 3}));
  gains = crossing();
  gains.draw = {{{-0.1, 0.0}}, {{-0.1, -0.1}}};  // a draw without cost
  EXPECT_THROW((void)decide(actions, field, gains), std::invalid_argument);
  gains.draw.pop_back();
  EXPECT_THROW((void)decide(actions, field, gains, {.max_cells = 3}), std::invalid_argument);
  // Each draw costs something and no walk ends, so there is no value.
  gains.draw = {{{-0.1, -0.1}}};
  EXPECT_THROW((void)decide({closed()}, {2, 1}, gains, {.max_sweeps = 1000}), std::runtime_error);
  const Decisions best = decide(actions, field, crossing());
  EXPECT_THROW((void)decided(nine_actions(), best), std::invalid_argument);
  EXPECT_THROW((void)decided({actions[0]}, best), std::invalid_argument);
  EXPECT_THROW((void)decided({actions[0], nine_actions()[0]}, best), std::invalid_argument);
  const Chain one = random_chain(words);
  EXPECT_THROW((void)decided({actions[0], FieldChain::by_row({one}, {0, 0})}, best),
               std::invalid_argument);
}

}  // namespace
}  // namespace gatewalk::markov
