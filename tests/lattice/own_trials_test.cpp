// SPDX-License-Identifier: MIT
#include "lattice/pool/own_trials.h"

#include <gtest/gtest.h>

#include "lattice/pool/pool_answers.h"
#include "lattice/pool/pooled_prediction.h"
#include "lattice/pool/tree_chain.h"
#include "tests/support/disc_fields.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;
using markov::FinalDistribution;

Scene unlike_beams() {
  Scene scene;
  scene.gate.run.method = "moreau";
  scene.gate.run.step = 0.02;
  scene.gate.beams.stiffness_left = 150.0;
  scene.gate.beams.stiffness_right = 800.0;
  return scene;
}

/// Trials of a field of two gates side by side: so many trapped in either.
FieldTrials trapped_in(std::int64_t left, std::int64_t right) {
  FieldTrials t;
  for (std::int64_t i = 0; i < left + right; ++i) {
    t.final_gates.push_back(i < left ? 0 : 1);
    t.endings.push_back(markov::Ending::trapped);
  }
  return t;
}

FinalDistribution trapped_with(double left) {
  FinalDistribution d;
  d.final_cells = markov::CellProbabilities::Zero(1, 2);
  d.final_cells << left, 1.0 - left;
  d.endings[static_cast<std::size_t>(markov::Ending::trapped)] = 1.0;
  d.trapped = 1.0;
  return d;
}

TEST(OwnTrials, ByHand) {
  const FieldParams field{.columns = 2, .rows = 1};
  // 45 of 100 where 50 are said: |45 - 50| or more of Binomial(100, 1/2) has the chance 0.3682.
  const OwnTrials alike = own_trials(trapped_in(45, 55), field, trapped_with(0.5), 1, 1);
  EXPECT_EQ(alike.trials, 100);
  EXPECT_NEAR(alike.total_variation, 0.05, 1e-12);
  EXPECT_NEAR(alike.chance_total_variation, 0.0398, 0.006);  // E|X - 50| / 100
  EXPECT_NEAR(alike.p, 0.3682, 0.09);
  EXPECT_FALSE(alike.differs);
  // 38 or fewer, 62 or more: 0.0210, not below 1 %. 35, 65: 0.0035.
  EXPECT_FALSE(own_trials(trapped_in(38, 62), field, trapped_with(0.5), 1, 1).differs);
  EXPECT_TRUE(own_trials(trapped_in(34, 66), field, trapped_with(0.5), 1, 1).differs);
  // Of a hundred answers one is as far off now and then.
  EXPECT_FALSE(own_trials(trapped_in(34, 66), field, trapped_with(0.5), 100, 1).differs);
  EXPECT_TRUE(own_trials(trapped_in(25, 75), field, trapped_with(0.5), 100, 1).differs);
}

TEST(OwnTrials, RightChainsAreLeftAlone) {
  const Scene scene = unlike_beams();
  int alarms = 0;
  constexpr int kSeeds = 25;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    RunPool pool;
    const auto p = predict_pooled(problem_of(scene), pool, {entry_of(scene.start)},
                                  {.accuracy = 0.1, .seed = seed});
    ASSERT_TRUE(p.starts[0].own_trials || p.starts[0].from_trials) << seed;
    if (!p.starts[0].own_trials) continue;
    EXPECT_EQ(p.starts[0].own_trials->trials, p.starts[0].trials);
    alarms += p.starts[0].own_trials->differs;
  }
  EXPECT_LE(alarms, 1);
}

// Beams of unlike stiffness, counted as if they were mirror images of each other.
TEST(OwnTrials, AMirrorThatIsNoneIsFoundOut) {
  const Problem problem = problem_of(unlike_beams());
  RunPool pool;
  StartTrials& s = pool.starts.emplace_back();
  s.start = problem.start;
  (void)run_field(problem.cells, problem.field, problem.start, 3, {0, 4000}, &s.full);
  const auto answer_by = [&](const CellMap& map) {
    const Kernel kernel = kernel_of(map, pool);
    return answers_of(kernel, map, {first_row(kernel, map, pool, pool.starts[0], 0)}, problem.field,
                      1)
        .final[0];
  };
  CellMap mirrored = problem.map();
  ASSERT_FALSE(mirrored.types[0].symmetric);
  mirrored.types[0].symmetric = true;
  EXPECT_FALSE(own_trials(s.full, problem.field, answer_by(problem.map()), 1, 1).differs);
  EXPECT_TRUE(own_trials(s.full, problem.field, answer_by(mirrored), 1, 1).differs);
}

// One state for each face cannot be right; the trials say so.
TEST(OwnTrials, StatesThatAreTooFewAreFoundOut) {
  const Problem problem = problem_of(unlike_beams());
  const auto made = [&](std::optional<int> most) {
    return make_tree_chain(
        problem,
        {.accuracy = {.trials = 4000}, .range = usual_range(problem), .most_states = most});
  };
  const auto right = made({}).range->own_trials, wrong = made(5).range->own_trials;
  ASSERT_TRUE(right && wrong);
  EXPECT_EQ(right->trials, 4000);
  EXPECT_FALSE(right->differs) << right->p;
  EXPECT_TRUE(wrong->differs) << wrong->p;
}

}  // namespace
}  // namespace gatewalk::lattice
