// SPDX-License-Identifier: MIT
#include "lattice/study/trials.h"

#include <gtest/gtest.h>

#include "lattice/scene/bins.h"
#include "markov/walk.h"
#include "tests/support/disc_fields.h"

namespace gatewalk::lattice {
namespace {

TEST(FieldTrials, AreThoseOfRunFieldAndChecked) {
  const Scene scene = parse_scene("field = { columns = 3, rows = 3 }", "scene");
  const FieldTally tally = field_trials(scene, {0, 150}, 4);
  const dynamics::StateSpace fixed = fixed_space(scene);
  const FieldTally plain =
      run_field(scene.gate, scene.field, scene.start, 4, {0, 150}, nullptr, &fixed);
  EXPECT_TRUE((tally.final_cells == plain.final_cells).all());
  EXPECT_EQ(tally.entries, plain.entries);
  EXPECT_EQ(tally.held, plain.held);
  EXPECT_EQ(tally.health.steps, plain.health.steps);
  EXPECT_GT(tally.health.checked_trials, 0);
}

TEST(Walks, AreThoseOfTheWalker) {
  // Up or trapped, with equal probability.
  dynamics::Transitions t(dynamics::table3_space({}));
  for (auto& row : t.rows) row = {{0, 1}, {t.space.trapped(), 1}};
  for (auto& n : t.trials) n = 2;
  const FieldParams field{.columns = 3, .rows = 3, .max_gates = 9};
  const ChainStart start = chain_start(t.space, field, {0, {0.0, 0.0, 15.0}});
  const markov::WalkTally tally = walks(make_chain(t), field, start.start, 1000, 2);
  const markov::WalkTally plain =
      markov::Walker(make_chain(t)).walk({3, 3}, start.start, 9, 2, {0, 1000});
  EXPECT_EQ(tally.endings, plain.endings);
  EXPECT_NEAR(static_cast<double>(tally.trapped()) / 1000, 7.0 / 8, 5 * std::sqrt(7.0 / 64 / 1000));
}

}  // namespace
}  // namespace gatewalk::lattice
