// SPDX-License-Identifier: MIT
#include "lattice/pool/hausman_check.h"

#include <gtest/gtest.h>

#include "lattice/pool/pool_answers.h"
#include "lattice/pool/pooled_prediction.h"
#include "lattice/pool/predict_pooled.h"
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

/// Trials of a field of two gates side by side: these numbers of them trapped in each gate.
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
  return d;
}

TEST(HausmanCheck, ByHand) {
  const FieldParams field{.columns = 2, .rows = 1};
  const auto half = trapped_with(0.5);
  const auto of = [&](std::int64_t left) {
    const FieldTrials trials = trapped_in(left, 100 - left);
    return hausman_check({{trials, half}}, field, 1).value();
  };
  // 45 of 100 where the chain says 50: |X - 50| >= 5 has probability 0.3682 for Binomial(100, 1/2).
  const HausmanCheck alike = of(45);
  EXPECT_EQ(alike.trials, 100);
  EXPECT_NEAR(alike.total_variation, 0.05, 1e-12);
  EXPECT_NEAR(alike.chance_total_variation, 0.0398, 0.003);  // E|X - 50| / 100
  EXPECT_NEAR(alike.p, 0.3682, 0.05);
  EXPECT_FALSE(alike.differs());
  // 38 or fewer, 62 or more: 0.0210. 35, 65: 0.0035.
  EXPECT_FALSE(of(38).differs());
  EXPECT_TRUE(of(34).differs());
}

// 40 trials of which the chain says that a quarter ends left, and 60 of which three quarters do: 55
// in all.
TEST(HausmanCheck, OfSeveralStartsTogether) {
  const FieldParams field{.columns = 2, .rows = 1};
  const FieldTrials few = trapped_in(10, 30), many = trapped_in(45, 15), none;
  const auto quarter = trapped_with(0.25), most = trapped_with(0.75);
  const HausmanCheck right = hausman_check({{few, quarter}, {many, most}}, field, 1).value();
  EXPECT_EQ(right.trials, 100);
  EXPECT_NEAR(right.total_variation, 0.0, 1e-12);
  EXPECT_EQ(right.p, 1.0);
  EXPECT_NEAR(hausman_check({{few, most}, {many, quarter}}, field, 1)->total_variation, 0.1, 1e-12);
  EXPECT_FALSE(hausman_check({{none, most}}, field, 1).has_value());
}

TEST(HausmanCheck, RightChainsAreLeftAlone) {
  const Scene scene = unlike_beams();
  int alarms = 0, checked = 0;
  constexpr int kSeeds = 25;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    RunPool pool;
    const auto p = predict_pooled(problem_of(scene), pool, {entry_of(scene.start)},
                                  {.accuracy = 0.1, .seed = seed});
    ASSERT_NE(p.hausman_check.has_value(), p.starts[0].from_trials) << seed;
    if (!p.hausman_check) continue;
    EXPECT_EQ(p.hausman_check->trials, p.starts[0].trials);
    alarms += p.hausman_check->differs();
    ++checked;
  }
  EXPECT_GE(checked, kSeeds - 3);
  EXPECT_LE(alarms, 1);
}

TEST(HausmanCheck, TrialsThatAreTheAnswerAreNotCheckedByThemselves) {
  const Scene scene = read_scene(std::string(GATEWALK_SCENES) + "/walker.toml", {});
  RunPool pool;
  const auto p = predict_pooled(problem_of(scene), pool, {entry_of(scene.start)},
                                {.accuracy = 0.1, .seed = 1});
  EXPECT_TRUE(p.starts[0].from_trials);
  const auto& [low, high] = p.starts[0].gates_95;
  const CellProbabilities& share = p.starts[0].final.final_cells;
  EXPECT_TRUE((low <= share).all() && (share <= high).all());
  EXPECT_GT(high.minCoeff(), 0.0);  // also of gates in which no trial ended
  EXPECT_FALSE(p.hausman_check.has_value());
}

// Beams of different stiffness, counted as if they were mirror images of each other.
TEST(HausmanCheck, AMirrorThatIsNoneIsFoundOut) {
  const Problem problem = problem_of(unlike_beams());
  RunPool pool;
  OwnRuns& s = pool.starts.emplace_back();
  s.start = problem.start;
  (void)run_field(problem.cells, problem.field, problem.start, 3, {0, 4000}, &s.full);
  const auto answer_by = [&](const CellMap& map) {
    const Kernel kernel = kernel_of(map, pool);
    return answers_of(kernel, map, first_rows(kernel, map, pool, {&pool.starts[0]}, 0),
                      problem.field, 1)
        .final[0];
  };
  CellMap mirrored = problem.map();
  ASSERT_FALSE(mirrored.types[0].symmetric);
  mirrored.types[0].symmetric = true;
  const auto right = answer_by(problem.map()), wrong = answer_by(mirrored);
  EXPECT_FALSE(hausman_check({{s.full, right}}, problem.field, 1)->differs());
  EXPECT_TRUE(hausman_check({{s.full, wrong}}, problem.field, 1)->differs());
}

// One state per face cannot be right; the trials show that, from a range of starts and from one
// start.
TEST(HausmanCheck, StatesThatAreTooFewAreFoundOut) {
  const Problem problem = problem_of(unlike_beams());
  for (const bool all : {true, false}) {
    TreeOptions options{.accuracy = {.trials = 4000}};
    if (all)
      options.range = usual_range(problem);
    else
      options.starts = {problem.start};
    const auto right = make_tree_chain(problem, options).hausman_check;
    options.most_states = 5;
    const auto wrong = make_tree_chain(problem, options).hausman_check;
    ASSERT_TRUE(right && wrong);
    EXPECT_GE(right->trials, 4000);
    EXPECT_FALSE(right->differs()) << right->p;
    EXPECT_TRUE(wrong->differs()) << wrong->p;
  }
}

}  // namespace
}  // namespace gatewalk::lattice
