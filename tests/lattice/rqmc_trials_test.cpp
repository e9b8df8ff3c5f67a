// SPDX-License-Identifier: MIT
#include "lattice/field/rqmc_trials.h"
#include "dynamics/base/kept_pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "lattice/pool/pool_runner.h"
#include "lattice/pool/pooled_prediction.h"
#include "lattice/pool/predict_pooled.h"
#include "lattice/scene/scene_problem.h"
#include "lattice/statistics/compare.h"
#include "tests/support/threads.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;
using test::on_threads;

/// A scene with little noise, where evenly spread points gain most.
Scene calm_scene() {
  Scene scene;
  scene.gate.run.method = "moreau";
  scene.gate.run.step = 0.01;
  scene.gate.forces.propulsion = 8.0;
  scene.gate.forces.random = 10.0;
  scene.start = {0, 0, 0, 15};
  return scene;
}

struct Ran {
  FieldTally tally;
  FieldTrials each{.final_gates = {}, .keep_passages = true};
};
Ran run(const lattice::Problem& problem, RqmcTrials trials, std::uint64_t seed = 1) {
  const FirstPoints points(seed, 5, trials.numbers);
  trials.points = &points;
  trials.start = [&](std::int64_t) { return problem.start; };
  Ran ran{FieldTally(problem.field)};
  ran.tally =
      run_even_field(problem.cells, problem.field, trials, seed, &ran.each, [](std::int64_t) {});
  return ran;
}

bool same(const FieldTrials& a, const FieldTrials& b) {
  if (a.final_gates != b.final_gates || a.endings != b.endings || a.costs != b.costs ||
      a.passed != b.passed)
    return false;
  for (std::size_t i = 0; i < a.passages.size(); ++i)
    if (a.passages[i].entry != b.passages[i].entry) return false;
  return a.passages.size() == b.passages.size();
}

TEST(RqmcTrials, AreTheSameInAnyCompanyOnAnyThreads) {
  const lattice::Problem problem = problem_of(calm_scene());
  const RqmcTrials all{.first = 16, .of_array = 200};
  const Ran together = on_threads(1, [&] { return run(problem, all); });
  FieldTrials parts{.final_gates = {}, .keep_passages = true};
  std::int64_t runs = 0;
  for (const auto& [array, arrays] : {std::pair(0, 3), std::pair(3, 4), std::pair(7, 1)}) {
    RqmcTrials some = all;
    some.array = array;
    some.arrays = arrays;
    const Ran ran = on_threads(3, [&] { return run(problem, some); });
    parts.append(ran.each);
    runs += ran.tally.health.runs;
    EXPECT_EQ(ran.tally.trials, 200 * arrays);
  }
  EXPECT_TRUE(same(together.each, parts));
  EXPECT_EQ(together.tally.health.runs, runs);
  EXPECT_EQ(together.tally.trials, 1600);
}

// Each trial alone has the usual distribution: the means of arrays, which are independent, lie
// around the shares of plain trials.
TEST(RqmcTrials, EndAsPlainOnesDo) {
  const lattice::Problem problem = problem_of(calm_scene());
  constexpr std::int64_t kPlain = 40'000, kOfArray = 64, kSets = 25;
  const CellProbabilities plain =
      shares(run_field(problem.cells, problem.field, problem.start, 8, {0, kPlain}).final_cells);
  CellProbabilities mean = CellProbabilities::Zero(9, 9), squares = mean;
  constexpr double kMeans = kArrays * kSets;
  for (std::int64_t set = 0; set < kSets; ++set) {
    const Ran ran = run(problem, {.first = 512 * set, .of_array = kOfArray, .numbers = set << 40});
    for (std::size_t a = 0; a < kArrays; ++a) {
      CellCounts counts = CellCounts::Zero(9, 9);
      for (std::size_t j = 0; j < kOfArray; ++j)
        ++counts.data()[ran.each.final_gates[a * kOfArray + j]];
      mean += shares(counts) / kMeans;
      squares += shares(counts).square() / kMeans;
    }
  }
  for (Eigen::Index i = 0; i < mean.size(); ++i) {
    const double p = plain.data()[i], m = mean.data()[i];
    if (p < 0.01) continue;
    const double variance =
        (squares.data()[i] - m * m) / kMeans + p * (1.0 - p) / static_cast<double>(kPlain);
    EXPECT_NEAR(m, p, 3.5 * std::sqrt(variance)) << i;
  }
}

/// Squared sum of the standard deviations of the final gates' shares.
double spread(const std::vector<CellProbabilities>& replicates) {
  const auto n = static_cast<double>(replicates.size());
  CellProbabilities mean = CellProbabilities::Zero(9, 9), squares = mean;
  for (const auto& p : replicates) mean += p / n;
  for (const auto& p : replicates) squares += (p - mean).square() / (n - 1.0);
  const double sum = squares.sqrt().sum();
  return sum * sum;
}

// Binomial noise gives this sum the value 1 for as many plain trials.
TEST(RqmcTrials, HaveLessChanceTogether) {
  Scene scene = calm_scene();
  scene.start = {23, 0, -11, 16};
  const lattice::Problem problem = problem_of(scene);
  constexpr std::int64_t kTrials = 512;
  std::vector<CellProbabilities> replicates;
  const Ran ran = run(problem, {.of_array = kTrials});
  for (std::size_t a = 0; a < kArrays; ++a) {
    CellCounts counts = CellCounts::Zero(9, 9);
    for (std::size_t j = 0; j < kTrials; ++j)
      ++counts.data()[ran.each.final_gates[a * kTrials + j]];
    replicates.push_back(shares(counts));
  }
  const CellProbabilities p = shares(ran.tally.final_cells);
  const double plain = (p * (1.0 - p)).sqrt().sum();
  // 0.67 here; 0.77 if points set the noise of first passages alone.
  EXPECT_LT(spread(replicates), 0.72 * plain * plain / kTrials);
}

TEST(RqmcTrials, FirstPointsGoOnWhereTheyWere) {
  const FirstPoints points(1, 2, 0);
  EXPECT_EQ(points(3), points(3));
  EXPECT_NE(points(3), points(4));   // another array
  EXPECT_NE(points(3), points(11));  // the next point of the same array
  EXPECT_NE(points(3), FirstPoints(2, 2, 0)(3));
  EXPECT_NE(points(3), FirstPoints(1, 3, 0)(3));
  EXPECT_NE(points(3), FirstPoints(1, 2, std::int64_t{1} << 41)(3));
}

/// Permits at most three items at once.
class InThrees : public KeptPieces {
 public:
  void begin(const Stage& stage) override { end_ = stage.items.count; }
  std::optional<Next> next(std::int64_t at) override {
    return Next{{at, std::min<std::int64_t>(3, end_ - at)}, {}};
  }
  void keep(TrialRange, std::string bytes) override { bytes_ += bytes.size(); }
  [[nodiscard]] bool is_part() const override { return false; }
  [[nodiscard]] bool has_share(const Stage&) const override { return true; }
  void end_part() override {}
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  std::int64_t end_ = 0;
  std::size_t bytes_ = 0;
};

TEST(RqmcTrials, OfARunnerAreTheSameInPieces) {
  const lattice::Problem problem = problem_of(calm_scene());
  const auto trials_of = [&](const Work& work) {
    OwnRuns s;
    s.start = problem.start;
    PoolRunner runner(problem, 4, 1 << 30, work);
    runner.run_full(s, 100);                     // plain trials
    runner.run_full(s, PoolRunner::kLeastEven);  // arrays, from a number at which no array begins
    runner.run_full(s, PoolRunner::kLeastEven + 17);  // arrays of at least this many trials
    return s.full;
  };
  const FieldTrials whole = trials_of({});
  EXPECT_EQ(std::ssize(whole.final_gates), 100 + 4096 + 4120);
  InThrees kept;
  Work work;
  work.kept = &kept;
  EXPECT_TRUE(same(whole, trials_of(work)));
  EXPECT_GT(kept.bytes(), std::size_t{100'000});
}

// Trials from anywhere, in a field of two types, in several batches.
TEST(RqmcTrials, OfSeveralBatchesAreTheSameInPieces) {
  const Scene scene = read_scene(std::string(GATEWALK_SCENES) + "/mixed.toml",
                                 {"run.method=moreau", "run.step_s=0.01"});
  const lattice::Problem problem = problem_of(scene);
  const auto trials_of = [&](const Work& work) {
    RangeRuns s;
    PoolRunner runner(problem, 4, 1 << 30, work);
    runner.most_of_array = 200;
    runner.run_scattered(s, usual_range(problem), PoolRunner::kLeastEven);
    EXPECT_EQ(s.starts.size(), s.each.final_gates.size());
    return s.each;
  };
  const FieldTrials whole = trials_of({});
  EXPECT_EQ(std::ssize(whole.final_gates), 3 * 8 * 171);
  InThrees kept;
  Work work;
  work.kept = &kept;
  EXPECT_TRUE(same(whole, trials_of(work)));
}

TEST(RqmcTrials, ARunnerCanBeStopped) {
  const lattice::Problem problem = problem_of(calm_scene());
  struct Stop {};
  Work work;
  work.told = [](std::string_view, std::int64_t done, std::int64_t total) {
    if (2 * done > total) throw Stop();
  };
  OwnRuns s;
  s.start = problem.start;
  PoolRunner runner(problem, 4, 1 << 30, work);
  EXPECT_THROW(runner.run_full(s, PoolRunner::kLeastEven), Stop);
  EXPECT_TRUE(s.full.final_gates.empty());
}

TEST(RqmcTrials, AreOfCellsThatLayNoise) {
  CellField gates = problem_of(calm_scene()).cells, none;
  EXPECT_TRUE(lays_noise(gates));
  EXPECT_FALSE(lays_noise(none));
  const auto plain = std::make_shared<FunctionCell>(gates.map.section, [](Body& body) {
    return Passage{Fate::trapped, body.entry};
  });
  EXPECT_FALSE(lays_noise(CellField::uniform(plain)));
  gates.cells.push_back(plain);
  EXPECT_FALSE(lays_noise(gates));
}

}  // namespace
}  // namespace gatewalk::lattice
