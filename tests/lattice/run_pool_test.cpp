// SPDX-License-Identifier: MIT
#include "lattice/field/running_trial.h"
#include "lattice/pool/kernel.h"

#include <gtest/gtest.h>

#include <numbers>
#include <numeric>

#include "dynamics/base/random.h"
#include "dynamics/base/share.h"
#include "dynamics/disc/disc_section.h"
#include "lattice/pool/pool_answers.h"
#include "lattice/pool/pooled_prediction.h"
#include "lattice/pool/predict_pooled.h"
#include "lattice/pool/tree_chain.h"
#include "lattice/statistics/draws.h"
#include "lattice/statistics/group_spread.h"
#include "lattice/statistics/share_95.h"
#include "tests/support/disc_fields.h"
#include "tests/support/threads.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;
using markov::Ending;

constexpr BodyState kStart{4, 0, 5, 10};

Scene fast_scene() {
  Scene scene;
  scene.gate.run.method = "moreau";
  scene.gate.run.step = 0.02;
  scene.start = kStart;
  return scene;
}

OwnRuns some_trials(const Scene& scene, std::int64_t n, BodyState from = kStart) {
  OwnRuns s;
  s.start = entry_of(from);
  (void)run_field(scene.gate, scene.field, from, 9, {0, n}, &s.full);
  return s;
}

// With one run per leaf nothing is pooled: the chain repeats the trials.
TEST(RunPool, LeavesOfOneRunGiveTheTrialsThemselves) {
  Scene scene = fast_scene();
  scene.gate.beams.stiffness_left = 300.0;  // so that there are no mirror images
  RunPool pool;
  pool.starts.push_back(some_trials(scene, 200));
  const Kernel kernel = kernel_of(FieldGates(scene.gate).map(), pool, 1);
  const auto row = first_rows(kernel, FieldGates(scene.gate).map(), pool, {&pool.starts[0]}, 0);
  const auto p = markov::predict(chain_of(kernel, FieldGates(scene.gate).map(), scene.field, row),
                                 {9, 9}, {{4, 0, kernel.space.size()}}, {.max_cells = 13});
  const auto own = shares_of(pool.starts[0].full, scene.field);
  EXPECT_LT(total_variation(p[0].final_cells, own.final_cells), 1e-12);
  for (std::size_t e = 0; e < markov::kEndings; ++e)
    EXPECT_NEAR(p[0].endings[e], own.endings[e], 1e-12) << e;
}

// Rows and columns counted with index_of, run by run.
TEST(RunPool, CountsAreThoseOfTheRuns) {
  for (const double left : {400.0, 300.0}) {
    Scene scene = fast_scene();
    scene.gate.beams.stiffness_left = left;
    const bool mirror = symmetric(scene.gate);
    RunPool pool;
    pool.starts.push_back(some_trials(scene, 150));
    pool.scattered.starts = {{Boundary::enter, {1, 2, 12}}, {Boundary::enter, {-3, 0, 14}}};
    const Problem problem = problem_of(scene);
    (void)run_field(
        problem.cells, problem.field,
        [&](std::int64_t i, dynamics::Body& body) {
          begin_trial(problem.cells.at(problem.field.start_column(), 0),
                      pool.scattered.starts[static_cast<std::size_t>(i)], 9, i, body);
        },
        {0, 2}, &pool.scattered.each);
    for (const TrialGroup group : {TrialGroup{}, TrialGroup{1, 3}}) {
      const Kernel kernel = kernel_of(FieldGates(scene.gate).map(), pool, 7, group);
      Eigen::MatrixXd wanted = Eigen::MatrixXd::Zero(kernel.space.size(), kernel.space.size() + 1);
      const auto count = [&](const Entry& from, const CellPassage& to) {
        for (const bool image : {false, true}) {
          if (image && !mirror) continue;
          const auto turned = [&](const Entry& c) {
            return image ? mirrored(disc_section(), c) : c;
          };
          const int column = to.fate == dynamics::Fate::trapped
                                 ? kernel.space.trapped()
                                 : kernel.space.index_of(turned(to.entry)).state;
          wanted(kernel.space.index_of(turned(from)).state, column) += 1.0;
        }
      };
      const OwnRuns& s = pool.starts[0];
      for (auto i = static_cast<std::size_t>(group.group); i < 150;
           i += static_cast<std::size_t>(group.of)) {
        const auto runs = s.full.of_trial(i);
        for (std::size_t k = 1; k < runs.size(); ++k) count(runs[k - 1].entry, runs[k]);
      }
      for (auto i = static_cast<std::size_t>(group.group); i < 2;
           i += static_cast<std::size_t>(group.of)) {
        Entry entry = pool.scattered.starts[i];
        for (const CellPassage run : pool.scattered.each.of_trial(i)) {
          count(entry, run);
          entry = run.entry;
        }
      }
      EXPECT_TRUE(Eigen::MatrixXd(kernel.counts.front().cast<double>()) == wanted);
    }
  }
}

TEST(RunPool, AStartWithoutRunsHasThoseOfItsLeaf) {
  const Scene scene = fast_scene();
  const CellMap map = FieldGates(scene.gate).map();
  RunPool pool;
  pool.starts.push_back(some_trials(scene, 150));
  const Kernel kernel = kernel_of(map, pool, 7);
  const auto sums = cost_sums(kernel, map, pool);
  const markov::Counts& counts = kernel.counts.front();
  for (std::size_t i = 0; i < 20; ++i) {
    const CellPassage first = pool.starts[0].full.of_trial(i).front();
    if (first.fate != Fate::left) continue;
    const Entry entry = first.entry;
    const int leaf = kernel.space.index_of(entry).state;
    const auto begin = sums[0].begin();
    const std::vector<CostSums> costs(begin + counts.outerIndexPtr()[leaf],
                                      begin + counts.outerIndexPtr()[leaf + 1]);
    const markov::Counts row = first_rows(kernel, map, pool, {entry}, 0);
    ASSERT_EQ(row.rows(), 1);
    EXPECT_EQ((Eigen::MatrixXd(row.cast<double>())),
              (Eigen::MatrixXd(counts.row(leaf).cast<double>())));
    EXPECT_EQ(first_cost_sums(kernel, sums, map, pool, entry, 0), costs);
    EXPECT_GT(counts.row(leaf).sum(), 0);
  }
}

TEST(RunPool, CostsOfRunsThatTheKernelHasNotAreRefused) {
  Scene scene = fast_scene();
  scene.gate.beams.stiffness_left = 300.0;  // so that there are no mirror images
  const CellMap map = FieldGates(scene.gate).map();
  RunPool few, more;
  few.starts.push_back(some_trials(scene, 3));
  more.starts.push_back(some_trials(scene, 30));
  const Kernel kernel = kernel_of(map, few, 1);
  EXPECT_NO_THROW((void)cost_sums(kernel, map, few));
  EXPECT_THROW((void)cost_sums(kernel, map, more), std::invalid_argument);
  // Trial by trial: each trial's contribution must be somewhere in its row.
  const auto is_there = [&](const Entry& from, const CellPassage& to) {
    const int column =
        to.fate == Fate::trapped ? kernel.space.trapped() : kernel.space.index_of(to.entry).state;
    return kernel.counts.front().coeff(kernel.space.index_of(from).state, column) > 0;
  };
  int refused = 0;
  for (std::size_t trial = 0; trial < 30; ++trial) {
    RunPool one;
    one.starts.push_back({.start = more.starts[0].start});
    one.starts[0].full.append(more.starts[0].full, trial);
    const auto runs = more.starts[0].full.of_trial(trial);
    bool known = true;
    for (std::size_t k = 1; k < runs.size(); ++k) known &= is_there(runs[k - 1].entry, runs[k]);
    refused += !known;
    if (known)
      EXPECT_NO_THROW((void)cost_sums(kernel, map, one)) << trial;
    else
      EXPECT_THROW((void)cost_sums(kernel, map, one), std::invalid_argument) << trial;
  }
  EXPECT_GT(refused, 10);
}

TEST(RunPool, OnlyGatesInWhichNotAllAreTrappedListTheirEndings) {
  const Scene scene = fast_scene();
  const markov::FinalDistribution own = shares_of(some_trials(scene, 300).full, scene.field);
  Eigen::Index listed = 0;
  for (const auto& c : own.mixed_cells) {
    const auto& e = c.by_ending;
    EXPECT_NEAR(std::accumulate(e.begin(), e.end(), 0.0), own.final_cells.data()[c.cell], 1e-12);
    EXPECT_LT(e.front(), own.final_cells.data()[c.cell]) << c.cell;
    ++listed;
  }
  EXPECT_GT(listed, 0);
  EXPECT_LT(listed, (own.final_cells > 0.0).count());
}

// Row by row, the counts that chain_of divides, trapped bodies included.
TEST(RunPool, TransitionsAreTheCounts) {
  const Scene scene = fast_scene();
  const CellMap map = FieldGates(scene.gate).map();
  RunPool pool;
  pool.starts.push_back(some_trials(scene, 50));
  const Kernel kernel = kernel_of(map, pool, 7);
  const int n = kernel.space.size();
  markov::Counts first(1, n + 1);
  first.insert(0, 1) = 4;
  first.insert(0, kernel.space.trapped()) = 3;
  first.makeCompressed();
  const auto all = transitions_of(kernel, map, scene.field, {entry_of(kStart)}, first);
  ASSERT_EQ(all.size(), 1U);
  const Transitions& t = all[0];
  ASSERT_EQ(t.space.size(), n + 1);
  EXPECT_EQ(t.trials.back(), 7);
  EXPECT_EQ(t.rows.back(), (std::map<int, std::int64_t>{{1, 4}, {t.space.trapped(), 3}}));
  for (int row = 0; row < n; ++row) {
    std::map<int, std::int64_t> counts;
    std::int64_t sum = 0;
    for (markov::Counts::InnerIterator it(kernel.counts[0], row); it; ++it) {
      counts[it.col() == n ? t.space.trapped() : static_cast<int>(it.col())] = it.value();
      sum += it.value();
    }
    EXPECT_EQ(t.rows[static_cast<std::size_t>(row)], counts) << row;
    EXPECT_EQ(t.trials[static_cast<std::size_t>(row)], sum) << row;
  }
}

TEST(RunPool, AStartInTheMiddleHasMirrorImagesInItsRow) {
  const Scene scene = fast_scene();
  RunPool pool;
  pool.starts.push_back(some_trials(scene, 100, {0, 0, 0, 15}));
  const Kernel kernel = kernel_of(FieldGates(scene.gate).map(), pool);
  const auto row = first_rows(kernel, FieldGates(scene.gate).map(), pool, {&pool.starts[0]}, 0);
  EXPECT_EQ(row.sum(), 200);
  EXPECT_EQ(pool.gate_runs(), std::ssize(pool.starts[0].full.passages));
}

// ---- Error bars ----

markov::FinalDistribution of_shares(double left, double right) {
  markov::FinalDistribution d;
  d.final_cells = CellProbabilities::Zero(1, 2);
  d.final_cells << left, right;
  d.endings[0] = left;
  d.endings[1] = right;
  d.mean_steps = 5.0;
  return d;
}

TEST(GroupSpread, SamplingAndBiasByHand) {
  const auto whole = of_shares(0.5, 0.5);
  const std::vector<markov::FinalDistribution> same(8, whole);
  EXPECT_NEAR(GroupSpread(whole, same, 3).error(1'000'000, 1).total_variation, 3e-6, 1e-8);
  // All groups agree but are off: a pure bias, of which the whole prediction is taken to have three
  // quarters.
  const std::vector<markov::FinalDistribution> biased(8, of_shares(0.4, 0.6));
  EXPECT_NEAR(GroupSpread(whole, biased, 3).error(1000, 1).total_variation, 0.075, 1e-12);
  // States of more coordinates shrink more slowly with the number of trials: x of 8^x is halved in
  // twice as many coordinates.
  EXPECT_NEAR(GroupSpread(whole, biased, 6).error(1000, 1).total_variation,
              0.1 / (std::sqrt(7.0 / 3.0) - 1.0), 1e-12);
  EXPECT_NEAR(GroupSpread(whole, biased, 1).error(1000, 1).total_variation, 0.075, 1e-12);
  EXPECT_NEAR(GroupSpread(whole, biased, 3).endings_95(100).interval[0][0], 0.425, 0.002);
  EXPECT_NEAR(GroupSpread(whole, biased, 6).endings_95(100'000).interval[0][0],
              0.5 - 0.1 / (std::sqrt(7.0 / 3.0) - 1.0), 0.01);
  // +-0.1 alternating: a standard error of 0.1 / sqrt(7), estimated from eight groups of two gates
  // that vary together: Student's t with 7 degrees of freedom.
  std::vector<markov::FinalDistribution> spread;
  for (int k = 0; k < 8; ++k) spread.push_back(of_shares(k % 2 ? 0.4 : 0.6, k % 2 ? 0.6 : 0.4));
  double mean = 0.0;
  for (std::uint64_t seed = 0; seed < 100; ++seed)
    mean += GroupSpread(whole, spread, 3).error(1000, seed).total_variation / 100.0;
  EXPECT_NEAR(mean, 2.365 * 0.1 / std::sqrt(7.0), 0.02 * mean);
  EXPECT_THROW(GroupSpread(whole, {whole}, 3), std::invalid_argument);
}

// Many gates that vary independently show together how much: as if the variance were known.
TEST(GroupSpread, ManyGatesMakeManyDegreesOfFreedom) {
  constexpr Eigen::Index kGates = 400;
  markov::FinalDistribution whole;
  whole.final_cells = CellProbabilities::Constant(1, kGates, 1.0 / kGates);
  whole.mean_steps = 5.0;
  std::vector<double> told;
  for (std::uint64_t k = 0; k < 40; ++k) {
    Random random(Purpose::resampling, {5, 6, k});
    std::vector<markov::FinalDistribution> groups(8, whole);
    for (auto& g : groups)
      for (Eigen::Index i = 0; i < kGates; ++i) g.final_cells.data()[i] += 1e-4 * random.normal();
    const double spread = 1e-4 / std::sqrt(8.0);  // of the mean of eight groups
    told.push_back(GroupSpread(whole, groups, 3).error(1'000'000, k).total_variation /
                   (0.5 * kGates * spread * std::sqrt(2.0 / std::numbers::pi)));
  }
  // The groups' mean is off by as much again, of which the bar includes three quarters.
  const double all = std::hypot(1.0, 0.75);
  for (const double t : told) EXPECT_NEAR(t, all, 0.2 * all);
}

// 1.0 minus rounding counts as all trials: 160 trials cannot distinguish 100 % from 99 %.
TEST(GroupSpread, NoneAndAllSeenAreAsManyTrialsSay) {
  const auto whole = of_shares(0.0, 1.0 - 1e-16);
  std::vector<markov::FinalDistribution> groups(8, of_shares(0.0, 1.0));
  groups[3] = whole;
  const GroupSpread spread(whole, groups, 3);
  const EndingShares endings = spread.endings_95(160);
  EXPECT_EQ(endings.interval[0], dynamics::share_interval(0, 160));
  EXPECT_NEAR(endings.interval[1][0], dynamics::share_interval(160, 160)[0], 1e-12);
  EXPECT_EQ(endings.interval[1][1], 1.0);
  const auto gates = spread.gates_95(160);
  EXPECT_LT(gates[0](0, 1), 0.99);
  EXPECT_GT(gates[1](0, 0), 0.01);
  // 1.9 % may be in another gate.
  const double unseen = 1.0 - std::pow(0.05, 1.0 / 160);
  const Error95 e = spread.error(160, 1);
  EXPECT_NEAR(e.total_variation, unseen, 1e-12);
  EXPECT_NEAR(e.rmse_per_100, 100.0 * unseen, 1e-12);
  EXPECT_NEAR(e.corrcoef, std::sqrt(1.0 - std::pow(unseen / 0.5, 2)), 1e-12);
  EXPECT_TRUE(std::isnan(spread.error(3, 1).corrcoef)) << "three trials say nothing of it";
}

TEST(GroupSpread, RmseAndCorrcoefHoldForAnyGateThatWasMissed) {
  CellProbabilities p = CellProbabilities::Zero(3, 3);
  p << 0.7, 0.1, 0, 0, 0.2, 0, 0, 0, 0;
  CellCounts counts = (1000 * p).cast<std::int64_t>();
  const Error95 e = error_of_shares(counts, 1);
  for (const auto& [trials, least] : {std::pair{60, 0.0}, {1000, 0.9}}) {
    const double unseen = 1.0 - std::pow(0.05, 1.0 / trials);
    markov::FinalDistribution whole;
    whole.final_cells = p;
    const Error95 bound =
        GroupSpread(whole, std::vector<markov::FinalDistribution>(8, whole), 3).error(trials, 1);
    EXPECT_GT(bound.corrcoef, least);
    for (Eigen::Index from : {0, 1, 4})
      for (Eigen::Index to = 0; to < p.size(); ++to) {
        CellProbabilities other = p;
        other.data()[from] -= unseen;
        other.data()[to] += unseen;
        EXPECT_GE(corrcoef(p, other), bound.corrcoef - 1e-12);
        EXPECT_LE(rmse_per_100(p, other), bound.rmse_per_100 + 1e-12);
      }
  }
  EXPECT_LT(e.corrcoef, 1.0);
}

// One trial of 160 in one of the groups, which pooling doubles: it may be chance.
TEST(GroupSpread, OneTrialSeenLeavesAWideInterval) {
  std::vector<markov::FinalDistribution> groups(8, of_shares(0.0, 1.0));
  groups[2] = of_shares(0.05, 0.95);
  const auto [low, high] =
      GroupSpread(of_shares(0.0125, 0.9875), groups, 3).endings_95(160).interval[0];
  EXPECT_LT(low, 0.0008);
  EXPECT_GT(high, 0.04);
  const auto all = GroupSpread(of_shares(0.0125, 0.9875), groups, 3).endings_95(160).interval[1];
  EXPECT_NEAR(all[0], 1.0 - high, 1e-9);
  EXPECT_NEAR(all[1], 1.0 - low, 1e-9);
}

// However alike the groups are, a rare share is not known better than this number of gate runs
// permits.
TEST(GroupSpread, NoNarrowerThanTheGateRuns) {
  const auto whole = of_shares(1e-4, 1.0 - 1e-4);
  std::vector<markov::FinalDistribution> groups;
  for (int k = 0; k < 8; ++k) groups.push_back(of_shares(1e-4 * (1 + 0.01 * k), 0.9999));
  const auto [low, high] = GroupSpread(whole, groups, 3).endings_95(200).interval[0];
  EXPECT_GT(high, dynamics::share_interval(0, 1000)[1]);
  EXPECT_LT(low, 2e-6);
}

// Trials that are not pooled: 95 % of the intervals hold, at least 93 of 100 (minus two standard
// errors), even if most of the eight groups see no such trial.
TEST(GroupSpread, IntervalsOfSharesHold) {
  constexpr int kRepeats = 500;
  for (const double p : {0.0008, 0.006, 0.02, 0.1, 0.4, 0.985}) {
    int held = 0;
    for (std::uint64_t i = 0; i < kRepeats; ++i) {
      dynamics::Random random(dynamics::Purpose::resampling, {5, 0, i});
      std::vector<double> groups;
      double whole = 0.0;
      for (int g = 0; g < kTrialGroups; ++g) {
        groups.push_back(static_cast<double>(binomial(20, p, random)) / 20);
        whole += groups.back() / kTrialGroups;
      }
      const auto [low, high] = share_95(whole, groups, {160, 800});
      held += low <= p && p <= high;
    }
    EXPECT_GE(held, 0.93 * kRepeats - 2 * std::sqrt(0.93 * 0.07 * kRepeats)) << p;
  }
}

TEST(GroupSpread, AMeanOfWhatIsAlwaysAlikeHasNoInterval) {
  EXPECT_TRUE(std::isnan(mean_95(5.0, std::vector<double>(8, 5.0)).interval[0]));
  EXPECT_TRUE(std::isnan(mean_95(5.0, {}).interval[0]));
  const Mean95 m = mean_95(5.0, {4, 6, 4, 6, 4, 6, 4, 6});
  EXPECT_NEAR(m.interval[1] - 5.0, 2.3646 / std::sqrt(7.0), 1e-9);
}

// A mean of few runs has no interval: groups without the rare long runs agree by chance.
TEST(Means, OfFewRunsHaveNoInterval) {
  const std::vector<double> groups{4, 6, 4, 6, 4, 6, 4, 6};
  const std::vector<double> some(8, 12.5);
  EXPECT_EQ(mean_95(5.0, groups, {100.0, some}).interval, mean_95(5.0, groups).interval);
  EXPECT_TRUE(mean_95(5.0, groups, {100.0, some}).why_none.empty());
  const Mean95OfRuns few = mean_95(5.0, groups, {99.9, some});
  EXPECT_TRUE(std::isnan(few.interval[0]) && std::isnan(few.interval[1]));
  EXPECT_EQ(few.mean, 5.0);
  EXPECT_EQ(few.why_none, "99 runs, fewer than 100");
  std::vector<double> uneven = some;
  uneven[3] = 7.9;
  const Mean95OfRuns group = mean_95(5.0, groups, {100.0, uneven});
  EXPECT_TRUE(std::isnan(group.interval[0]));
  EXPECT_EQ(group.why_none, "7 runs in a group of the trials, fewer than 8");
}

TEST(GroupSpread, OfSharesIsBinomialNoise) {
  CellCounts counts(1, 2);
  counts << 5000, 5000;
  EXPECT_NEAR(error_of_shares(counts, 3).total_variation, 1.96 * 0.005, 0.001);
}

// ---- Until the bar says enough ----

TEST(PooledPrediction, IsAsAccurateAsItSaysAndTheSameOnAnyThreads) {
  const Scene scene = fast_scene();
  const auto run = [&] {
    RunPool pool;
    return predict_pooled(problem_of(scene), pool, {entry_of(kStart)},
                          {.accuracy = 0.05, .seed = 4});
  };
  const PooledPrediction one = test::on_threads(1, run), three = test::on_threads(3, run);
  EXPECT_TRUE((one.starts[0].final.final_cells == three.starts[0].final.final_cells).all());
  EXPECT_EQ(one.starts[0].error.total_variation, three.starts[0].error.total_variation);
  EXPECT_EQ(one.gate_runs, three.gate_runs);
  EXPECT_TRUE(one.reached);
  EXPECT_LE(one.starts[0].error.total_variation, 0.05);
  const FieldTally truth = run_field(scene.gate, scene.field, kStart, 77, {0, 20'000});
  EXPECT_LE(total_variation(one.starts[0].final.final_cells, shares(truth.final_cells)), 0.055);
  EXPECT_LT(one.gate_runs, 20'000);
}

// All trials end in the same gate, which is likely but not certain.
TEST(PooledPrediction, WhatWasNeverSeenIsInTheBar) {
  Scene scene = fast_scene();
  scene.gate.forces.random = 0.0;
  RunPool pool;
  const auto p = predict_pooled(problem_of(scene), pool, {entry_of(kStart)}, {.accuracy = 0.01});
  EXPECT_EQ(p.starts[0].final.final_cells.maxCoeff(), 1.0);
  EXPECT_NEAR(p.starts[0].error.total_variation, 3.0 / static_cast<double>(p.starts[0].trials),
              1e-4);
  EXPECT_LE(p.starts[0].error.total_variation, 0.01);
  EXPECT_LT(p.starts[0].gates_95[0].maxCoeff(), 1.0);
  EXPECT_GT(p.starts[0].error.rmse_per_100, 0.0);
  EXPECT_LT(p.starts[0].error.corrcoef, 1.0);
  for (const auto& [low, high] : p.starts[0].endings.interval) EXPECT_GT(high - low, 1e-3);
}

// The pool has slow bodies only: it cannot tell how a fast body continues.
TEST(PooledPrediction, EntriesWhereNoRunEnteredAreInTheBar) {
  const Scene scene = fast_scene();
  const BodyState fast{0, 0, 0, 45};
  RunPool pool;
  pool.starts.push_back(some_trials(scene, 2000));
  RunPool other = pool;
  const auto guess = predict_pooled(problem_of(scene), pool, {entry_of(fast)},
                                    {.accuracy = 0.1, .first_runs = 400});
  EXPECT_GT(guess.starts[0].unseen, 0.3);
  EXPECT_GE(guess.starts[0].error.total_variation, guess.starts[0].unseen);
  EXPECT_FALSE(guess.reached);
  const auto known = predict_pooled(problem_of(scene), other, {entry_of(fast)}, {.accuracy = 0.1});
  EXPECT_TRUE(known.reached);
  EXPECT_GT(known.starts[0].trials, 100);
  const FieldTally truth = run_field(scene.gate, scene.field, fast, 77, {0, 5000});
  EXPECT_LE(total_variation(known.starts[0].final.final_cells, shares(truth.final_cells)), 0.11);
  EXPECT_LE(total_variation(guess.starts[0].final.final_cells, shares(truth.final_cells)),
            guess.starts[0].error.total_variation);
}

TEST(PassageTable, KeepsWhatWasPutThere) {
  const std::vector<CellPassage> passages{
      {dynamics::Fate::left, 0, {Boundary::enter, {1, 2, 3}}, {4, 5, 6, 7, 8}},
      {dynamics::Fate::left, 255, {Boundary::right_traverse, {-1, 0, 0.5}}, {1}},
      {dynamics::Fate::trapped, 3, {}, {9}}};
  PassageTable table(disc_section());
  EXPECT_TRUE(table.empty());
  for (const CellPassage& p : passages) table.push_back(p);
  ASSERT_EQ(table.size(), passages.size());
  std::size_t i = 0;
  for (const CellPassage back : table.rows()) {
    EXPECT_EQ(back.fate, passages[i].fate);
    EXPECT_EQ(back.type, passages[i].type);
    EXPECT_EQ(back.entry, passages[i].entry);
    EXPECT_EQ(back.costs, passages[i].costs);
    ++i;
  }
  EXPECT_EQ(i, passages.size());
  EXPECT_EQ(table.rows(1, 3).size(), 2u);
  EXPECT_EQ(table.rows(1, 3).front().type, 255);
  EXPECT_EQ(table.rows(1, 3).back().type, 3);
}

TEST(PassageTable, HasAsManyColumnsAsItsSection) {
  dynamics::Section two = disc_section();
  two.coordinates.pop_back();
  two.costs.resize(1);
  PassageTable table(two);
  for (double x : {1.0, 2.0})
    table.push_back({dynamics::Fate::left, 0, {Boundary::enter, {x, -x, 9}}, {x, 9}});
  EXPECT_EQ(table[1].entry, (Entry{Boundary::enter, {2, -2, 0}}));
  EXPECT_EQ(table[1].costs, (dynamics::Costs{2}));
  table.begin(disc_section());  // the table has passages, so that it keeps its section
  EXPECT_EQ(table[0].entry, (Entry{Boundary::enter, {1, -1, 0}}));
  EXPECT_THROW(PassageTable().push_back({}), std::logic_error);
}

TEST(RunPool, EntriesLikeThoseOfOthersAreSeen) {
  const Scene scene = fast_scene();
  RunPool pool;
  pool.starts.push_back(some_trials(scene, 4000));
  const Kernel kernel = kernel_of(FieldGates(scene.gate).map(), pool);
  // Other trials from the same start, through the first gate only.
  FieldParams one_gate = scene.field;
  one_gate.max_gates = 1;
  OwnRuns again;
  again.start = pool.starts[0].start;
  (void)run_field(scene.gate, one_gate, kStart, 10, {0, 1000}, &again.first);
  EXPECT_LT(missing_mass(kernel, FieldGates(scene.gate).map(), scene.field, again), 0.01);
  std::int64_t go_on = 0;
  PassageTable elsewhere(disc_section());
  for (CellPassage p : again.first.passages.rows()) {
    if (p.fate != dynamics::Fate::trapped) {
      p.entry = {Boundary::enter, {1e3, 0.0, 1e3}};
      ++go_on;
    }
    elsewhere.push_back(p);
  }
  again.first.passages = elsewhere;
  ASSERT_GT(go_on, 200);
  EXPECT_NEAR(missing_mass(kernel, FieldGates(scene.gate).map(), scene.field, again),
              static_cast<double>(go_on) / 1000, 0.1);
  FieldParams last_row = scene.field;
  last_row.rows = 1;  // bodies that leave upwards have crossed, and nothing more is needed
  EXPECT_EQ(missing_mass(kernel, FieldGates(scene.gate).map(), last_row, again), 0.0);
}

TEST(PooledPrediction, StopsAtTheLimitOfRunsAndSaysSo) {
  const Scene scene = fast_scene();
  RunPool pool;
  const auto p = predict_pooled(problem_of(scene), pool, {entry_of(kStart)},
                                {.accuracy = 1e-4, .most_runs = 3000});
  EXPECT_FALSE(p.reached);
  EXPECT_GT(p.starts[0].error.total_variation, 1e-4);
  EXPECT_LT(p.gate_runs, 6000);
  EXPECT_EQ(p.gate_runs, pool.gate_runs());
}

std::vector<Entry> many_starts() {
  std::vector<Entry> starts;
  for (int k = 0; k < 24; ++k) starts.push_back({0, {-20.0 + k, 8.0 - 0.5 * k, 11.0 + 0.3 * k}});
  return starts;
}

void expect_alike(const PooledPrediction& p) {
  EXPECT_FALSE(p.reached);
  double least = 1.0, largest = 0.0;
  for (const StartAnswer& a : p.starts) {
    least = std::min(least, a.error.total_variation);
    largest = std::max(largest, a.error.total_variation);
  }
  EXPECT_LT(largest, 3.0 * least);
}

TEST(PooledPrediction, StartsShareTheLimitOfRuns) {
  const Scene scene = fast_scene();
  RunPool pool;
  const auto p = predict_pooled(problem_of(scene), pool, many_starts(),
                                {.accuracy = 0.005, .most_runs = 20'000});
  EXPECT_LT(p.gate_runs, 22'000);
  expect_alike(p);
}

TEST(PooledPrediction, StartsThatMeetAPoolShareTheLimitOfRuns) {
  const Scene scene = fast_scene();
  RunPool pool;
  (void)predict_pooled(problem_of(scene), pool, {entry_of(kStart)}, {.accuracy = 0.05});
  const auto p = predict_pooled(problem_of(scene), pool, many_starts(),
                                {.accuracy = 0.005, .most_runs = 3000});
  EXPECT_LT(p.gate_runs, 3500);
  expect_alike(p);
}

TEST(PooledPrediction, UsesWhatThePoolHolds) {
  const Scene scene = fast_scene();
  RunPool pool;
  const auto first =
      predict_pooled(problem_of(scene), pool, {entry_of(kStart)}, {.accuracy = 0.05});
  const auto again =
      predict_pooled(problem_of(scene), pool, {entry_of(kStart)}, {.accuracy = 0.05});
  EXPECT_GT(first.gate_runs, 0);
  EXPECT_EQ(again.gate_runs, 0);
  EXPECT_TRUE((first.starts[0].final.final_cells == again.starts[0].final.final_cells).all());
}

TEST(PoolChains, ManyStartsByTheAdjointAreAnsweredAsOneByOne) {
  const Scene scene = fast_scene();
  RunPool pool;
  std::vector<std::size_t> all, few{3, 17};
  for (const Entry& start : many_starts()) {
    all.push_back(pool.starts.size());
    pool.starts.push_back(some_trials(scene, 64, entry_state(scene.gate, start)));
  }
  const auto asked = [&](const std::vector<std::size_t>& places) {
    std::vector<FirstRow> starts;
    for (const std::size_t place : places) starts.emplace_back(&pool.starts[place]);
    return starts;
  };
  PoolChains chains(FieldGates(scene.gate).map(), scene.field, 5, all.size(), 1);
  ASSERT_TRUE(chains.by_adjoint(pool, all.size()));
  ASSERT_FALSE(chains.by_adjoint(pool, few.size()));
  const PoolAnswers many = chains.ask(pool, asked(all));
  // Few starts are asked one by one; with many starts, leaves are twice as large.
  const PoolAnswers two = PoolChains(FieldGates(scene.gate).map(), scene.field, 10, few.size(), 1)
                              .ask(pool, asked(few));
  EXPECT_EQ(many.states, two.states);
  for (std::size_t i = 0; i < few.size(); ++i) {
    const auto near = [&](const markov::FinalDistribution& a, const markov::FinalDistribution& b) {
      EXPECT_LE((a.final_cells - b.final_cells).abs().maxCoeff(), 1e-13);
      EXPECT_LE((markov::departed_cells(a) - markov::departed_cells(b)).abs().maxCoeff(), 1e-13);
      EXPECT_NEAR(a.mean_steps, b.mean_steps, 1e-11);
    };
    const PoolAnswer &one_of_many = many.starts[few[i]], &one_of_two = two.starts[i];
    near(one_of_many.whole, one_of_two.whole);
    for (std::size_t g = 0; g < kTrialGroups; ++g) {
      near(one_of_many.groups[g], one_of_two.groups[g]);
      near(one_of_many.kernels[g], one_of_two.kernels[g]);
    }
  }
}

TEST(PoolChains, EndingsScaleTheirMaps) {
  markov::FinalDistribution d;
  d.final_cells = CellProbabilities::Zero(1, 3);
  d.final_cells << 0.3, 0.7, 0.0;
  d.mixed_cells.push_back({1, {0.2, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0}});
  d.endings = {0.5, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0};
  const auto scaled = with_endings(d, {0.6, 0.4, 0.0, 0.0, 0.0, 0.0, 0.0});
  EXPECT_NEAR(scaled.trapped(), 0.6, 1e-15);
  EXPECT_NEAR(scaled[Ending::far_edge], 0.4, 1e-15);
  EXPECT_NEAR(scaled.final_cells(0, 0), 0.36, 1e-15);
  EXPECT_NEAR(scaled.final_cells(0, 1), 0.24 + 0.4, 1e-15);
  EXPECT_EQ(scaled.final_cells(0, 2), 0.0);
  EXPECT_NEAR(scaled.mixed_cells[0][Ending::far_edge], 0.4, 1e-15);
  // An ending that no map has: nothing is scaled, so that nothing is lost.
  const auto none = with_endings(d, {0.5, 0.49, 0.01, 0.0, 0.0, 0.0, 0.0});
  EXPECT_EQ(none.endings, d.endings);
  EXPECT_EQ(none.final_cells(0, 1), 0.7);
}

// The shares of endings are those of the chain with leaves of two entries, from few starts and, by
// the adjoint, from many.
TEST(PooledPrediction, EndingsComeFromSmallLeaves) {
  const Scene scene = fast_scene();
  const Problem problem = problem_of(scene);
  for (const std::size_t starts : {std::size_t{2}, many_starts().size()}) {
    const std::vector<Entry> all = many_starts();
    const std::vector<Entry> some(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(starts));
    RunPool pool;
    const PooledPrediction p = predict_pooled(problem, pool, some, {.accuracy = 0.2, .seed = 3});
    const Kernel kernel = kernel_of(problem.map(), pool, ending_leaf(pool));
    for (std::size_t i = 0; i < starts; i += 7) {
      const StartAnswer& a = p.starts[i];
      if (a.from_trials) continue;
      const markov::Counts row =
          first_rows(kernel, problem.map(), pool, {&pool.starts[i]}, problem.start_type());
      const auto small = answers_of(kernel, problem.map(), row, scene.field, 1).final[0];
      for (std::size_t e = 0; e < markov::kEndings; ++e) {
        EXPECT_NEAR(a.endings.share[e], small.endings[e], 1e-12) << e;
        EXPECT_LE(a.endings.interval[e][0], a.endings.share[e]);
        EXPECT_GE(a.endings.interval[e][1], a.endings.share[e]);
      }
      EXPECT_NEAR(a.final.final_cells.sum() + a.final.remainder, 1.0, 1e-12);
      EXPECT_GT((a.final.final_cells - small.final_cells).abs().maxCoeff(), 1e-6);
    }
  }
}

TEST(PooledPrediction, OfManyStartsSharesTheirRuns) {
  const Scene scene = fast_scene();
  const auto run = [&] {
    RunPool pool;
    return predict_pooled(problem_of(scene), pool, many_starts(), {.accuracy = 0.2, .seed = 2});
  };
  const PooledPrediction one = test::on_threads(1, run), three = test::on_threads(3, run);
  EXPECT_TRUE(one.reached);
  std::int64_t alone = 0;
  for (std::size_t k = 0; k < one.starts.size(); ++k) {
    EXPECT_LE(one.starts[k].error.total_variation, 0.2);
    EXPECT_TRUE((one.starts[k].final.final_cells == three.starts[k].final.final_cells).all());
    EXPECT_EQ(one.starts[k].error.total_variation, three.starts[k].error.total_variation);
    if (k % 6 != 0) continue;
    RunPool pool;
    alone +=
        predict_pooled(problem_of(scene), pool, {many_starts()[k]}, {.accuracy = 0.2, .seed = 2})
            .gate_runs;
  }
  EXPECT_LT(one.gate_runs, 6 * alone);  // four starts together take less
}

TEST(PooledPrediction, OfARangeHasTheTrialsThatWereAsked) {
  const Scene scene = fast_scene();
  RunPool pool;
  const StartRange range{0, {{{0, 1}, {-1, 1}, {10, 12}}}};
  const auto p =
      pool_range(problem_of(scene), pool, range, {.accuracy = 1e-3, .trials = 40, .seed = 2});
  EXPECT_FALSE(p.reached);
  EXPECT_EQ(pool.scattered.starts.size(), 40U);
  EXPECT_LE(p.kernel_error_95, p.worst_kernel_error_95);
}

// Answers come from Monte Carlo walks here: the groups show the kernel's error with that of first
// runs.
TEST(PooledPrediction, OfARangeInALargeField) {
  Scene scene = fast_scene();
  scene.field.columns = scene.field.rows = scene.field.max_gates = 200;
  RunPool pool;
  const auto p = pool_range(problem_of(scene), pool, {0, {{{0, 1}, {-1, 1}, {10, 12}}}},
                            {.accuracy = 0.9, .trials = 100});
  EXPECT_GT(p.kernel_error_95, 0.0);
  EXPECT_LT(p.kernel_error_95, 0.9);
}

TEST(PooledPrediction, RefusesNonsense) {
  const Scene scene = fast_scene();
  RunPool pool;
  for (const double accuracy : {0.0, 1.0, -1.0, std::nan("")})
    EXPECT_THROW(
        (void)predict_pooled(problem_of(scene), pool, {entry_of(kStart)}, {.accuracy = accuracy}),
        std::invalid_argument);
  EXPECT_THROW((void)problem_of([&] {
                 Scene inside = scene;
                 inside.start = {0, 1, 0, 15};
                 return inside;
               }()),
               std::invalid_argument);
  EXPECT_THROW((void)pool_range(problem_of(scene), pool, {0, {{{1, 0}, {0, 0}, {10, 20}}}}, {}),
               std::invalid_argument);
}

// ---- Chains in files ----

TEST(TreeChain, AFileGivesBackMatrixRunsAndAnswer) {
  const Scene scene = fast_scene();
  const TreeChain chain = make_tree_chain(
      problem_of(scene),
      {.accuracy = {.accuracy = 0.05}, .starts = {entry_of(kStart), entry_of({0, 0, 0, 15})}});
  const std::string path = testing::TempDir() + "tree_chain.nc";
  write_matrix(path, {chain.transitions.front(),
                      {{"scene", to_toml(scene)}},
                      arrays_of(chain.pool, dynamics::disc_section())});
  const MatrixFile file = read_matrix(path);
  EXPECT_EQ(file.transitions.space, chain.transitions.front().space);
  EXPECT_EQ(file.transitions.rows, chain.transitions.front().rows);
  ASSERT_TRUE(has_runs(file));
  RunPool pool = pool_of(file, problem_of(scene), path);
  EXPECT_EQ(pool.gate_runs(), chain.pool.gate_runs());
  // Extending a pool from a file equals extending the pool in memory.
  RunPool here = chain.pool;
  const auto more = predict_pooled(problem_of(scene), here, {entry_of(kStart)}, {.accuracy = 0.03});
  RunPool there = pool;
  const auto also =
      predict_pooled(problem_of(scene), there, {entry_of(kStart)}, {.accuracy = 0.03});
  EXPECT_GT(more.gate_runs, 0);
  EXPECT_EQ(more.gate_runs, also.gate_runs);
  EXPECT_TRUE((more.starts[0].final.final_cells == also.starts[0].final.final_cells).all());
  EXPECT_EQ(more.starts[0].error.total_variation, also.starts[0].error.total_variation);
  EXPECT_EQ(pool.starts[0].full.final_gates, chain.pool.starts[0].full.final_gates);
  EXPECT_EQ(pool.starts[0].full.endings, chain.pool.starts[0].full.endings);
  Scene wider = scene;
  wider.field.max_gates = 0;
  EXPECT_TRUE(pool_of(file, problem_of(wider), path).starts[0].full.endings.empty());
  EXPECT_EQ(matrices_of(problem_of(scene), pool, {entry_of(kStart), entry_of({0, 0, 0, 15})},
                        chain.per_leaf)
                .front()
                .rows,
            chain.transitions.front().rows);
  const auto answer =
      predict_pooled(problem_of(scene), pool, {entry_of(kStart)}, {.accuracy = 0.05});
  EXPECT_EQ(answer.gate_runs, 0);
  EXPECT_LT(total_variation(answer.starts[0].final.final_cells,
                            chain.prediction->starts[0].final.final_cells),
            1e-12);
  // A start that the file does not know gets runs of its own.
  const auto other =
      predict_pooled(problem_of(scene), pool, {{0, {-17, 13, 12}}}, {.accuracy = 0.06});
  EXPECT_GT(other.gate_runs, 0);
  EXPECT_TRUE(other.reached);
}

TEST(TreeChain, LimitOfStatesSaysWhatItCosts) {
  const Scene scene = fast_scene();
  const TreeChain all = make_tree_chain(
      problem_of(scene), {.accuracy = {.accuracy = 0.05}, .starts = {entry_of(kStart)}});
  const TreeChain few = make_tree_chain(
      problem_of(scene),
      {.accuracy = {.accuracy = 0.05}, .starts = {entry_of(kStart)}, .most_states = 60});
  EXPECT_GT(all.kernel.space.size(), 200);
  EXPECT_LE(few.kernel.space.size(), 60);
  EXPECT_GT(few.kernel.space.size(),
            30);  // no fewer than the limit asks for, but for the last step
  EXPECT_EQ(all.states_bias, 0.0);
  EXPECT_GT(few.states_bias, 0.0);
  EXPECT_THROW(
      (void)make_tree_chain(problem_of(scene), {.starts = {entry_of(kStart)}, .most_states = 4}),
      std::invalid_argument);
  EXPECT_THROW((void)make_tree_chain(problem_of(scene), {}), std::invalid_argument);
}

TEST(TreeChain, DamagedRunsAreRefused) {
  const Scene scene = fast_scene();
  const TreeChain chain = make_tree_chain(
      problem_of(scene), {.accuracy = {.accuracy = 0.2}, .starts = {entry_of(kStart)}});
  MatrixFile file{chain.transitions.front(), {}, arrays_of(chain.pool, dynamics::disc_section())};
  EXPECT_NO_THROW((void)pool_of(file, problem_of(scene), "x.nc"));
  for (markov::NamedArray& array : file.arrays) {
    MatrixFile bad = file;
    for (markov::NamedArray& other : bad.arrays)
      if (other.name == array.name) other.values.pop_back();
    EXPECT_THROW((void)pool_of(bad, problem_of(scene), "x.nc"), markov::BadFile) << array.name;
  }
  const auto refused = [&](const std::string& name, auto damage) -> std::string {
    MatrixFile bad = file;
    for (markov::NamedArray& array : bad.arrays)
      if (array.name == name) damage(array.values);
    try {
      (void)pool_of(bad, problem_of(scene), "x.nc");
    } catch (const markov::BadFile& e) {
      return e.what();
    }
    ADD_FAILURE() << name;
    return "";
  };
  for (const char* name : {"trial_kind", "trial_runs", "run_ending", "run_boundary"})
    for (const double x : {0.5, -1.0, 1e6})
      refused(name, [x](std::vector<double>& values) { values[0] = x; });
  refused("run_boundary", [](std::vector<double>& values) { values[0] = 7.0; });
  EXPECT_EQ(refused("run_ending", [](std::vector<double>& values) { values[0] = 0.5; }),
            "x.nc: its gate runs do not add up: run 1");  // counted from 1
  // More runs than the file has: detected before any run is read.
  std::size_t trials = 0;
  const std::string said = refused("trial_runs", [&](std::vector<double>& values) {
    values.back() += 1.0;
    trials = values.size();
  });
  EXPECT_EQ(said, "x.nc: its gate runs do not add up: trial " + std::to_string(trials));
}

TEST(RunPool, RowsOfStarts) {
  RunPool pool;
  pool.starts.emplace_back().start = {0, {0.1}};
  EXPECT_TRUE(std::holds_alternative<std::monostate>(pool.first_row(std::nullopt)));
  EXPECT_EQ(std::get<const OwnRuns*>(pool.first_row(Entry{0, {0.1}})), &pool.starts[0]);
  EXPECT_EQ(std::get<Entry>(pool.first_row(Entry{0, {0.2}})), (Entry{0, {0.2}}));
}

// Runs of a range do not replace those of other starts: bodies from this start enter as no others
// do.
TEST(TreeChain, StartsBesideARangeGetTrialsOfTheirOwn) {
  const Problem problem = problem_of(fast_scene());
  const TreeChain chain = make_tree_chain(problem, {.accuracy = {.accuracy = 0.1},
                                                    .starts = {entry_of({0, 0, 0, 45})},
                                                    .range = usual_range(problem)});
  EXPECT_TRUE(chain.prediction->reached);
  EXPECT_GT(chain.prediction->starts[0].trials, 100);
}

}  // namespace
}  // namespace gatewalk::lattice
