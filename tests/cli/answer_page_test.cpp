// SPDX-License-Identifier: MIT
#include "cli/render/answer_page.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "cli/render/final_gates.h"
#include "lattice/pool/pool_answers.h"
#include "lattice/pool/pooled_prediction.h"
#include "lattice/pool/predict_pooled.h"
#include "lattice/pool/tree_chain.h"
#include "tests/support/disc_fields.h"

namespace gatewalk::cli {
namespace {

/// The text that the page makes of a share's code (cli/web/answer.js).
std::string shown(std::uint16_t code) {
  if (code <= 10'000) {
    char text[16];
    (void)std::snprintf(text, sizeof text, "%.2f", code / 100.0);
    return text;
  }
  const int power = 3 + (code - 10'001) / 90, digits = 10 + (code - 10'001) % 90;
  char text[32];
  (void)std::snprintf(text, sizeof text, "%.2g", digits * std::pow(10.0, -power - 1));
  return text;
}

TEST(AnswerPage, SharesAreTheDigitsThatAreShown) {
  for (const double share :
       {0.0, 1.0, 0.5, 0.123456, 0.99994, 0.99995, 5e-5, 4.999e-5, 4.95e-5, 4.94e-5, 1.049e-5,
        1.051e-5, 9.96e-6, 6.9e-6, 1e-6, 1.23e-9, 9.99e-12, 3e-17, 2.2e-300})
    EXPECT_EQ(shown(share_code(share)), percents(share)) << share;
  EXPECT_EQ(share_code(std::nan("")), 65'535);
}

lattice::Scene open_scene() {
  lattice::Scene scene;
  scene.gate.forces.propulsion = 9.0;
  scene.gate.forces.random = 30.0;
  scene.field = {5, 3, 8};
  scene.gate.run.method = "moreau";
  scene.gate.run.step = 0.02;
  scene.start = {4, 0, 1, 15};
  return scene;
}

/// A chain made of `trials` trials.
class Made {
 public:
  explicit Made(std::int64_t trials)
      : prediction(lattice::predict_pooled(problem, pool, {problem.start}, {.trials = trials})),
        chain(lattice::analysed_chain(problem, pool, pool.first_row(problem.start))),
        outcomes(lattice::chain_outcomes(chain, problem.field)) {}

  lattice::Problem problem = lattice::problem_of(open_scene());
  lattice::RunPool pool;
  lattice::PooledPrediction prediction;
  lattice::AnalysedChain chain;
  lattice::ChainOutcomes outcomes;
};

TEST(StartStates, SayWhatPredictSaysOfTheirStates) {
  const Made m(1500);
  const auto states = lattice::start_states(m.problem, m.pool, m.chain, m.outcomes, {0},
                                            dynamics::kEntriesPerLeaf, 1'000'000);
  ASSERT_GT(states.states.size(), 20U);
  EXPECT_EQ(states.least_runs, 1);
  for (std::size_t i = 0; i < states.states.size(); i += 7) {
    const lattice::StartState& s = states.states[i];
    const dynamics::Entry start = m.chain.space.range(s.first_leaf).middle();
    // A start without first runs of its own has the row of its leaf.
    const auto asked =
        lattice::predict_whole(m.problem, m.pool, {start}, dynamics::kEntriesPerLeaf, 1);
    for (std::size_t e = 0; e < markov::kEndings; ++e) {
      EXPECT_NEAR(s.endings.share[e], asked[0].endings[e], 1e-13);
      EXPECT_LE(s.endings.interval[e][0], s.endings.share[e]);
      EXPECT_GE(s.endings.interval[e][1], s.endings.share[e]);
    }
    EXPECT_LE((s.gates - asked[0].final_cells).abs().maxCoeff(), 1e-13);
    EXPECT_LE((s.gates_95[0] - s.gates).maxCoeff(), 1e-15);
    EXPECT_GE((s.gates_95[1] - s.gates).minCoeff(), -1e-15);
  }
}

TEST(StartStates, AreJoinedWhereTheyAreTooMany) {
  const Made m(1500);
  const auto all = lattice::start_states(m.problem, m.pool, m.chain, m.outcomes, {0},
                                         dynamics::kEntriesPerLeaf, 1'000'000);
  const auto few = lattice::start_states(m.problem, m.pool, m.chain, m.outcomes, {0},
                                         dynamics::kEntriesPerLeaf, 15 * 10);
  EXPECT_LE(few.states.size(), 10U);
  // Joined states have the same runs, and so the same mean; states with more runs have narrower
  // intervals.
  const auto mean = [](const lattice::StartStates& s) {
    double runs = 0.0, sum = 0.0, width = 0.0;
    for (const lattice::StartState& one : s.states) {
      runs += static_cast<double>(one.runs);
      sum += static_cast<double>(one.runs) * one.endings.share[0];
      width +=
          static_cast<double>(one.runs) * (one.endings.interval[0][1] - one.endings.interval[0][0]);
    }
    return std::array{runs, sum / runs, width / runs};
  };
  EXPECT_EQ(mean(all)[0], mean(few)[0]);
  EXPECT_NEAR(mean(all)[1], mean(few)[1], 1e-12);
  EXPECT_LT(mean(few)[2], 0.6 * mean(all)[2]);
}

TEST(CellsAhead, OfTheFirstCellAreTheStartsOwn) {
  const Made m(1500);
  const auto cells =
      lattice::cells_ahead(m.outcomes, m.problem.field, m.pool.bodies(), m.pool.gate_runs());
  double trapped = 0.0;
  for (const lattice::CellAhead& a : cells)
    if (!a.next.empty()) trapped += a.visits.mean * a.next.back().mean;
  const lattice::Kernel kernel = lattice::kernel_of(m.problem.map(), m.pool);
  const auto row = lattice::first_rows(kernel, m.problem.map(), m.pool, {&m.pool.starts.front()},
                                       m.problem.start_type());
  const auto whole = lattice::answers_of(kernel, m.problem.map(), row, m.problem.field, 1).final;
  EXPECT_NEAR(trapped, whole[0].trapped(), 1e-12);
  const lattice::CellAhead& first = cells[static_cast<std::size_t>(m.problem.field.start_column())];
  EXPECT_GE(first.visits.mean, 1.0);
  for (const lattice::CellAhead& a : cells) {
    if (a.next.empty()) continue;
    double next = 0.0;
    for (const auto& share : a.next) next += share.mean;
    EXPECT_NEAR(next, 1.0, 1e-12);
    EXPECT_NEAR(a.gates.sum(), 1.0, 1e-12);
  }
}

}  // namespace
}  // namespace gatewalk::cli
