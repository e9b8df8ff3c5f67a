// SPDX-License-Identifier: MIT
// The sampling error of a matrix: coverage of intervals, and the joint test of trials and matrix.
#include "lattice/statistics/matrix_noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <vector>

#include "dynamics/base/share.h"
#include "dynamics/disc/disc_section.h"
#include "lattice/field/gate_chain.h"
#include "lattice/statistics/compare.h"
#include "lattice/statistics/draws.h"
#include "lattice/statistics/ending_shares.h"
#include "markov/predict.h"
#include "tests/support/threads.h"

namespace gatewalk::lattice {
namespace {

using dynamics::Purpose;
using dynamics::Random;
using dynamics::StateSpace;
using dynamics::Transitions;
using markov::Ending;
using markov::FinalDistribution;

constexpr markov::Field kField{5, 4};
constexpr int kMaxGates = 8;
constexpr markov::Start kStart{2, 0, 0};

/// One state per face: EN, RD, LD, RT, LT; and trapped.
StateSpace five_states() { return dynamics::refined(dynamics::table3_space({}), 0.01); }

/// The true chain, in thousandths, row by row.
constexpr std::array<std::array<double, 6>, 5> kTruth{{{250, 150, 200, 30, 20, 350},
                                                       {300, 100, 150, 10, 40, 400},
                                                       {200, 200, 150, 20, 30, 400},
                                                       {350, 100, 100, 50, 50, 350},
                                                       {450, 50, 100, 20, 80, 300}}};

Transitions truth() {
  Transitions t(five_states());
  for (int row = 0; row < 5; ++row) {
    for (int j = 0; j < 6; ++j) t.rows[row][j] = static_cast<std::int64_t>(kTruth[row][j]);
    t.trials[row] = 1000;
  }
  return t;
}

/// A matrix with `trials` runs of the true chain per row.
Transitions simulated(std::int64_t trials, std::uint64_t number) {
  Transitions t(five_states());
  for (int row = 0; row < 5; ++row) {
    Random random(Purpose::row, {99, static_cast<std::uint64_t>(row), number});
    std::array<std::int64_t, 6> counts{};
    multinomial(trials, kTruth[row], counts, random);
    for (int j = 0; j < 6; ++j)
      if (counts[j] > 0) t.rows[row][j] = counts[j];
    t.trials[row] = trials;
  }
  return t;
}

FinalDistribution predicted(const Transitions& t) {
  return markov::Predictor(make_chain(t)).predict(kField, kStart, {.max_cells = kMaxGates});
}

std::vector<FinalDistribution> replicates(const Transitions& t, std::uint64_t seed,
                                          std::int64_t count) {
  return replicate_predictions(counted_field(t), kField, {kStart}, kMaxGates, seed, 0, count)
      .predictions.front();
}

constexpr std::array<Ending, 5> kAll{Ending::far_edge, Ending::left_edge, Ending::right_edge,
                                     Ending::trapped, Ending::cut_off};

// 400 matrices with 100 runs per row: for each ending, 92 to 98 % of the intervals contain the
// truth (95 %, with a standard error of 1.1 %).
TEST(MatrixNoise, IntervalsCoverTheTruth) {
  constexpr int kMatrices = 400;
  const FinalDistribution right = predicted(truth());
  std::array<int, 5> covered{};
  for (int i = 0; i < kMatrices; ++i) {
    const Transitions t = simulated(100, static_cast<std::uint64_t>(i));
    const FinalDistribution p = predicted(t);
    MatrixNoise noise(p, {100, 0});
    for (const FinalDistribution& r : replicates(t, 5, 200)) noise.add(r);
    for (std::size_t k = 0; k < kAll.size(); ++k) {
      const auto e = static_cast<std::size_t>(kAll[k]);
      const auto [low, high] = noise.interval_95(kAll[k]);
      covered[k] += low <= right.endings[e] && right.endings[e] <= high;
    }
  }
  for (std::size_t k = 0; k < kAll.size(); ++k) {
    EXPECT_GE(covered[k], 0.92 * kMatrices) << "ending " << static_cast<int>(kAll[k]);
    EXPECT_LE(covered[k], 0.98 * kMatrices) << "ending " << static_cast<int>(kAll[k]);
  }
}

// Resampled rows contain no new outcomes, but intervals allow for them.
TEST(MatrixNoise, RowsLeaveOpenWhatTheirRunsMayHaveMissed) {
  FinalDistribution p = predicted(truth());
  const auto trapped = static_cast<std::size_t>(Ending::trapped),
             crossed = static_cast<std::size_t>(Ending::far_edge);
  p.endings[trapped] = 0.8;
  p.endings[crossed] = 1e-6;
  MatrixNoise bins(p, {100, 0}), trees(p, {100, 10'000});  // without and with a number of gate runs
  for (const double factor : {0.9, 1.1}) {
    FinalDistribution other = p;
    for (double& e : other.endings) e *= factor;
    bins.add(other);
    trees.add(other);
  }
  const EndingShares of_bins(p, bins, 5), of_trees(p, trees, 5);
  // The interval of `trapped` is wider than that of all gate runs, which therefore do not matter.
  EXPECT_EQ(of_trees.interval[trapped], of_bins.interval[trapped]);
  EXPECT_LT(of_bins.interval[crossed][1], 2e-6);
  EXPECT_EQ(of_trees.interval[crossed], dynamics::interval_of_share(1e-6, 10'000));

  const CountedField field = counted_field(truth());
  const Evidence from = field.evidence_at(kStart, kField, kMaxGates);
  EXPECT_EQ(from.trials, 1000);
  EXPECT_EQ(from.gate_runs, 5000);  // 1000 per row
  EXPECT_EQ(from.hidden, 0.0);      // each row has several outcomes
}

// Half of the walks pass a row of few runs, which all had one outcome: these runs exclude no other
// outcome, however many runs other rows have. The row's interval is that of `runs` trials without a
// success.
TEST(MatrixNoise, KnowsWhatARowOfOneOutcomeHides) {
  for (const std::int64_t runs : {1, 5, 1'000'000}) {
    markov::Counts counts(3, 4);
    const std::vector<Eigen::Triplet<std::int64_t>> entries{
        {0, 1, 50'000}, {0, 3, 50'000}, {1, 0, runs}, {2, 0, 1'000'000}};  // no walk enters row 2
    counts.setFromTriplets(entries.begin(), entries.end());
    const std::vector<markov::Exit> exits{{0, 0, 1}, {1, 1, 0}, {2, -1, 0}, {}};
    const CountedField field{markov::Chain::from_counts(counts, exits), {counts}};
    const markov::Start start{1, 0, 0};
    const double missed = dynamics::interval_of_share(0.0, static_cast<double>(runs))[1];
    for (const int limit : {0, 5})
      EXPECT_NEAR(field.evidence_at(start, {3, 1}, limit).hidden, 0.5 * missed, 1e-12);
    const auto [low, high] =
        resampled_95({0.499, 0.5, 0.501}, 0.5, field.evidence_at(start, {3, 1}, 0));
    EXPECT_LE(low, 0.5 - 0.5 * missed);
    EXPECT_GE(high, 0.5 + 0.5 * missed);
    EXPECT_LT(high - low, missed + 0.01);
  }
}

// The spread equals that of matrices counted from new runs.
TEST(MatrixNoise, IsTheSpreadOfOtherMatrices) {
  const Transitions t = truth();
  const FinalDistribution p = predicted(t);
  MatrixNoise noise(p, {1000, 0}), drawn(p, {1000, 0});
  const auto sd = [&](const std::vector<FinalDistribution>& all, Ending e) {
    double squares = 0.0;
    for (const FinalDistribution& f : all)
      squares += std::pow(
          f.endings[static_cast<std::size_t>(e)] - p.endings[static_cast<std::size_t>(e)], 2);
    return std::sqrt(squares / static_cast<double>(all.size()));
  };
  const auto made = replicates(t, 5, 400);
  std::vector<FinalDistribution> others;
  for (std::uint64_t i = 0; i < 400; ++i) others.push_back(predicted(simulated(1000, 1000 + i)));
  for (std::size_t i = 0; i < 400; ++i) {
    noise.add(made[i]);
    drawn.add(others[i]);
  }
  // Two estimates of a standard deviation from 400 values: 5 standard errors of their ratio.
  for (const Ending e : kAll)
    EXPECT_NEAR(sd(made, e) / sd(others, e), 1.0, 5 * std::sqrt(1.0 / 400));
  EXPECT_NEAR(noise.mean_total_variation() / drawn.mean_total_variation(), 1.0, 0.1);
  EXPECT_GT(noise.total_variation_95(), noise.mean_total_variation());
  EXPECT_EQ(noise.replicates(), 400);
  for (const Ending e : kAll) {
    const auto [low, high] = noise.interval_95(e);
    EXPECT_LT(low, p.endings[static_cast<std::size_t>(e)]);
    EXPECT_GT(high, p.endings[static_cast<std::size_t>(e)]);
  }
  EXPECT_EQ(noise.interval_95(Ending::unsampled), dynamics::interval_of_share(0.0, 1000));
}

/// Mean of the replicates' shares minus the prediction's, in standard errors.
double off_centre(const std::vector<FinalDistribution>& all, const FinalDistribution& own,
                  Ending e) {
  const auto at = static_cast<std::size_t>(e);
  double mean = 0.0, squares = 0.0;
  const auto n = static_cast<double>(all.size());
  for (const FinalDistribution& f : all) mean += f.endings[at] / n;
  for (const FinalDistribution& f : all) squares += std::pow(f.endings[at] - mean, 2);
  return (mean - own.endings[at]) / std::sqrt(squares / (n * (n - 1.0)));
}

// Bins have many runs; trees have rows of few runs, share runs with neighbours, and count mirror
// images.
TEST(Replicates, AverageToThePrediction) {
  const Transitions t = simulated(1000, 7);
  CountedField bins = counted_field(t), trees = bins;
  trees.small_rows = true;
  trees.images = {{2, 2, 2, 2, 2}};
  const FinalDistribution own = predicted(t);
  for (const CountedField& field : {bins, trees}) {
    const auto all =
        replicate_predictions(field, kField, {kStart}, kMaxGates, 3, 0, 400).predictions.front();
    for (const Ending e : kAll) EXPECT_LT(std::abs(off_centre(all, own, e)), 4.0);
  }
}

// ---- Rows of few runs, as trajectories through many states have them ----

/// A chain of 300 states, entered from below, from the left and from the right in turn.
class ManyStates {
 public:
  static constexpr int kStates = 300;

  ManyStates() {
    for (int s = 0; s < kStates; ++s)
      exits_.push_back({s, s % 3 == 1 ? 1 : s % 3 == 2 ? -1 : 0, s % 3 == 0 ? 1 : 0});
    exits_.emplace_back();
    Random random(Purpose::row, {5, 0, 0});
    for (int s = 0; s < kStates; ++s) {
      auto& row = rows_.emplace_back();
      for (int k = 0; k < 15; ++k)
        row[static_cast<int>(random.below(kStates))] += random.below(50) + 1;
      row[kStates] = random.below(200);
    }
  }
  [[nodiscard]] const std::vector<markov::Exit>& exits() const { return exits_; }
  [[nodiscard]] markov::Counts truth() const { return table(rows_); }

  /// Counts the steps of this many walks.
  [[nodiscard]] markov::Counts walked(int walks, std::uint64_t number) const {
    std::vector<std::map<int, std::int64_t>> seen(kStates);
    for (int w = 0; w < walks; ++w) {
      Random random(Purpose::row, {6, static_cast<std::uint64_t>(w), number});
      int column = kStart.column, row = kStart.row, state = 0;
      for (int gate = 0; gate < kMaxGates; ++gate) {
        const auto& ways = rows_[static_cast<std::size_t>(state)];
        std::int64_t all = 0;
        for (const auto& [to, weight] : ways) all += weight;
        std::int64_t drawn = random.below(all);
        auto way = ways.begin();
        while (drawn >= way->second) drawn -= (way++)->second;
        ++seen[static_cast<std::size_t>(state)][way->first];
        const markov::Exit& exit = exits_[static_cast<std::size_t>(way->first)];
        column += exit.di_x, row += exit.di_y;
        if (way->first == kStates || column < 0 || column >= kField.columns || row >= kField.rows)
          break;
        state = way->first;
      }
    }
    return table(seen);
  }

 private:
  static markov::Counts table(const std::vector<std::map<int, std::int64_t>>& rows) {
    markov::Counts counts(kStates, kStates + 1);
    for (int s = 0; s < kStates; ++s)
      for (const auto& [to, n] : rows[static_cast<std::size_t>(s)])
        if (n > 0) counts.insert(s, to) = n;
    return counts;
  }
  std::vector<markov::Exit> exits_;
  std::vector<std::map<int, std::int64_t>> rows_;
};

// 400 walks give about five runs per row, most rows fewer. Over 100 sets of walks, 95 % of the
// intervals of an ending contain the truth (one standard error: 2.2 %), and replicates average to
// the prediction.
TEST(Replicates, OfFewRunsARowHoldTheirCoverage) {
  constexpr int kSets = 100, kReplicates = 99;
  const ManyStates chain;
  const auto predict_by = [&](const markov::Counts& counts) {
    return markov::Predictor(markov::Chain::from_counts(counts, chain.exits()))
        .predict(kField, kStart, {.max_cells = kMaxGates});
  };
  const FinalDistribution right = predict_by(chain.truth());
  std::array<int, 5> covered{};
  std::array<double, 5> off{};
  for (int i = 0; i < kSets; ++i) {
    const markov::Counts counts = chain.walked(400, static_cast<std::uint64_t>(i));
    const FinalDistribution own = predict_by(counts);
    const CountedField field{markov::Chain::from_counts(counts, chain.exits()), {counts}};
    const auto all = replicate_predictions(field, kField, {kStart}, kMaxGates,
                                           static_cast<std::uint64_t>(i), 0, kReplicates)
                         .predictions.front();
    MatrixNoise noise(own, field.evidence_at(kStart, kField, kMaxGates));
    for (const FinalDistribution& f : all) noise.add(f);
    for (std::size_t k = 0; k < kAll.size(); ++k) {
      const auto [low, high] = noise.interval_95(kAll[k]);
      const double truth = right.endings[static_cast<std::size_t>(kAll[k])];
      covered[k] += low <= truth && truth <= high;
      off[k] += off_centre(all, own, kAll[k]) / kSets;
    }
  }
  int together = 0;
  for (std::size_t k = 0; k < kAll.size(); ++k) {
    EXPECT_GE(covered[k], 0.88 * kSets) << "ending " << static_cast<int>(kAll[k]);
    together += covered[k];
    EXPECT_LT(std::abs(off[k]), 0.5) << "ending " << static_cast<int>(kAll[k]);
  }
  EXPECT_GE(together, 0.92 * 5 * kSets);
}

TEST(Replicates, SameBitsForAnyThreadsAndAnySplit) {
  const Transitions t = simulated(50, 3), other = simulated(50, 4);
  CountedField rows{markov::FieldChain::by_row({make_chain(t), make_chain(other)}, {0, 1, 1, 0}),
                    {t.counts(), other.counts()}};
  const std::vector<markov::Start> starts{kStart, {1, 2, 3}};
  const auto on = [&](int threads, std::int64_t first, std::int64_t count) {
    return test::on_threads(threads, [&] {
      return replicate_predictions(rows, kField, starts, kMaxGates, 8, first, count).predictions;
    });
  };
  const auto whole = on(1, 0, 10), again = on(3, 0, 10), part = on(2, 4, 3);
  for (std::size_t s = 0; s < starts.size(); ++s) {
    for (std::size_t k = 0; k < 10; ++k)
      EXPECT_TRUE((whole[s][k].final_cells == again[s][k].final_cells).all());
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(whole[s][4 + k].endings, part[s][k].endings);
    EXPECT_NE(whole[s][0].endings, whole[s][1].endings);
  }
  // A second matrix has its own draws, even if it holds the same counts.
  rows = {markov::FieldChain::by_row({make_chain(t), make_chain(t)}, {0, 1, 1, 0}),
          {t.counts(), t.counts()}};
  const auto first_of = [](const CountedField& gates) {
    return replicate_predictions(gates, kField, {kStart}, kMaxGates, 8, 0, 1).predictions[0][0];
  };
  EXPECT_NE(first_of(rows).endings, first_of(counted_field(t)).endings);
}

TEST(Replicates, FewerInLargeFields) {
  EXPECT_EQ(affordable_replicates({9, 9}, 13, 2000, 200), 200);
  EXPECT_EQ(affordable_replicates({9, 9}, 0, 2000, 999), 999);
  EXPECT_EQ(affordable_replicates({301, 301}, 0, 300, 200), 200);
  EXPECT_EQ(affordable_replicates({1001, 1001}, 0, 300, 200), 99);
  EXPECT_EQ(affordable_replicates({1001, 1001}, 1446, 300, 200), 0);
  EXPECT_EQ(affordable_replicates({9, 9}, 13, 2000, 49), 0);
  EXPECT_LT(affordable_replicates({9, 9}, 13, 60'000, 999), 999);  // too few for an interval
}

// ---- One test of trials and matrix ----

/// `trials` complete trials of the true chain.
SeenEndings trials_of(const FinalDistribution& p, std::int64_t trials, std::uint64_t number) {
  std::vector<double> weights;
  std::vector<std::pair<std::int64_t, std::size_t>> what;
  std::vector<bool> is_mixed(static_cast<std::size_t>(p.final_cells.size()));
  for (const auto& c : p.mixed_cells) {
    is_mixed[static_cast<std::size_t>(c.cell)] = true;
    for (std::size_t e = 0; e < markov::kEndings; ++e) {
      weights.push_back(c.by_ending[e]);
      what.emplace_back(c.cell, e);
    }
  }
  for (std::int64_t cell = 0; cell < p.final_cells.size(); ++cell) {
    if (is_mixed[static_cast<std::size_t>(cell)]) continue;
    weights.push_back(p.final_cells.data()[cell]);
    what.emplace_back(cell, 0);
  }
  std::vector<std::int64_t> counts(weights.size());
  Random random(Purpose::field, {77, 0, number});
  multinomial(trials, weights, counts, random);
  SeenEndings seen{CellCounts::Zero(p.final_cells.rows(), p.final_cells.cols()), {}};
  for (std::size_t i = 0; i < what.size(); ++i) {
    seen.final_gates.data()[what[i].first] += counts[i];
    seen.endings[what[i].second] += counts[i];
  }
  return seen;
}

// Under the null (the dynamics is the chain, the matrix a sample of it) the joint p-value is
// uniform, whether the sampling error lies in the trials, in the matrix or in both: 400 repeats
// each, at most 9 % below 0.05. The bootstrap of a matrix is exact only for many runs per row. With
// 100 runs, where matrix noise dominates, 7.4 % of 2000 repeats were below 0.05, and the excess of
// small values in the distribution was 0.06 (Kolmogorov's 1 % point is 0.08 for 400 repeats, 0.04
// for 2000); for each single statistic at most 0.033.
TEST(Judge, PValuesAreUniformUnderTheNull) {
  struct Case {
    std::int64_t runs, trials;
  };
  constexpr int kRepeats = 400, kDraws = 399, kMatrices = 133;  // each matrix serves three draws
  const FinalDistribution right = predicted(truth());
  for (const auto& [runs, trials] : {Case{100, 100}, {100, 10'000}, {1000, 500}}) {
    SCOPED_TRACE(testing::Message() << runs << " runs a row, " << trials << " trials");
    std::vector<double> all, tv, energy, crossed;
    for (int i = 0; i < kRepeats; ++i) {
      const auto number = static_cast<std::uint64_t>(i);
      const Transitions t = simulated(runs, 5000 + number);
      const JointTest j = joint_test(trials_of(right, trials, number), predicted(t),
                                     replicates(t, number, kMatrices), 0, kDraws, number);
      all.push_back(j.p);
      tv.push_back(j.total_variation.p);
      energy.push_back(j.energy.p);
      crossed.push_back(j.endings[static_cast<std::size_t>(Ending::far_edge)].p);
    }
    const std::array<std::pair<const char*, std::vector<double>*>, 4> sets{
        {{"all", &all}, {"total variation", &tv}, {"energy", &energy}, {"crossed", &crossed}}};
    for (const auto& [name, p] : sets) {
      SCOPED_TRACE(name);
      std::sort(p->begin(), p->end());
      double excess = 0.0;  // of small p-values
      for (int i = 0; i < kRepeats; ++i) excess = std::max(excess, (i + 1.0) / kRepeats - (*p)[i]);
      constexpr double kBootstrap = 0.03;
      EXPECT_LT(excess, 1.63 / std::sqrt(kRepeats) + 1.0 / kDraws + kBootstrap);
      EXPECT_LE(std::count_if(p->begin(), p->end(), [](double x) { return x <= 0.05; }),
                0.09 * kRepeats);
    }
    EXPECT_GE(std::count_if(all.begin(), all.end(), [](double x) { return x <= 0.05; }),
              0.02 * kRepeats);
  }
}

// Trials of a chain whose walks cross more often: the test detects the difference and the ending,
// but not with too coarse a matrix.
TEST(Judge, NamesTheEndingThatDiffers) {
  Transitions other = truth();
  for (int row = 0; row < 5; ++row) {
    other.rows[row][0] += 60;  // up
    other.rows[row][5] -= 60;  // trapped
  }
  const SeenEndings seen = trials_of(predicted(other), 20'000, 1);
  const Transitions fine = simulated(100'000, 1), coarse = simulated(20, 1);
  const JointTest j = joint_test(seen, predicted(fine), replicates(fine, 1, 199), 0, 199, 1);
  EXPECT_TRUE(j.differs());
  EXPECT_TRUE(j.differs(Ending::far_edge));
  EXPECT_TRUE(j.differs(Ending::trapped));
  EXPECT_FALSE(j.differs(Ending::unsampled));
  EXPECT_EQ(j.total_variation.p, 1.0 / 200);
  EXPECT_GT(j.total_variation.seen, j.chance_total_variation_95);
  EXPECT_GT(j.chance_total_variation_95, j.chance_total_variation);
  const JointTest with_coarse =
      joint_test(seen, predicted(coarse), replicates(coarse, 1, 199), 0, 199, 1);
  EXPECT_GT(with_coarse.chance_total_variation, 5 * j.chance_total_variation);
  EXPECT_GT(with_coarse.p, j.p);
}

// The verdict agrees with the smallest adjusted p-value.
TEST(Judge, IsTheSmallestAdjustedPValue) {
  const FinalDistribution right = predicted(truth());
  for (std::uint64_t i = 0; i < 40; ++i) {
    const Transitions t = simulated(200, 9000 + i);
    const JointTest j =
        joint_test(trials_of(right, 400, 100 + i), predicted(t), replicates(t, i, 60), 0, 99, i);
    double least =
        std::min({j.total_variation.p_adjusted, j.energy.p_adjusted, j.chi_squared.p_adjusted});
    for (const auto& e : j.endings) {
      EXPECT_GE(e.p_adjusted, e.p);
      least = std::min(least, e.p_adjusted);
    }
    EXPECT_EQ(j.p, least);
    EXPECT_EQ(j.differs(), j.p <= 0.05);
  }
}

/// Trials from the shares of three gates; in the last gate, bodies have left by the right side.
FinalDistribution shares_of_trials(const CellProbabilities& p, std::int64_t trials,
                                   std::uint64_t seed, std::uint64_t number) {
  FinalDistribution d;
  d.final_cells = shares(sampled(p, trials, seed, number));
  const double right = d.final_cells(0, 2);
  d.endings[static_cast<std::size_t>(Ending::trapped)] = 1.0 - right;
  d.endings[static_cast<std::size_t>(Ending::right_edge)] = right;
  d.mixed_cells.push_back({2});
  d.mixed_cells.back().by_ending[static_cast<std::size_t>(Ending::right_edge)] = right;
  return d;
}

// The chain has 160 trials, the experiment 60 more of the same kind. The first miss an ending of
// 0.5 % in 45 of 100 cases; it is then new in 26 of 100 experiments, but not a difference.
TEST(Judge, WhatNoRunShowedIsNoDifferenceByItself) {
  constexpr std::int64_t kRuns = 160, kTrials = 60;
  constexpr std::uint64_t kRepeats = 300, kMatrices = 50;
  CellProbabilities truth(1, 3);
  truth << 0.6, 0.395, 0.005;
  std::vector<double> p;
  for (std::uint64_t i = 0; i < kRepeats; ++i) {
    const FinalDistribution chain = shares_of_trials(truth, kRuns, 1, i);
    std::vector<FinalDistribution> others;
    for (std::uint64_t k = 0; k < kMatrices; ++k)
      others.push_back(shares_of_trials(chain.final_cells, kRuns, 2 + i, k));
    SeenEndings seen{sampled(truth, kTrials, 1000, i), {}};
    seen.endings[static_cast<std::size_t>(Ending::right_edge)] = seen.final_gates(0, 2);
    seen.endings[static_cast<std::size_t>(Ending::trapped)] = kTrials - seen.final_gates(0, 2);
    p.push_back(joint_test(seen, chain, others, kRuns, 199, i).p);
  }
  const auto at_most = [&](double level) {
    return std::count_if(p.begin(), p.end(), [&](double x) { return x <= level; });
  };
  EXPECT_LE(at_most(0.05), 0.09 * kRepeats);  // 5 % and three standard errors
  EXPECT_LE(at_most(0.01), 0.027 * kRepeats);
  EXPECT_GE(at_most(0.2), 0.05 * kRepeats);  // the test still detects something
}

TEST(Judge, SameBitsForAnyThreadsAndRefusals) {
  const Transitions t = simulated(50, 3);
  const FinalDistribution p = predicted(t);
  const auto others = replicates(t, 2, 20);
  const SeenEndings seen = trials_of(p, 300, 3);
  const auto on = [&](int threads) {
    return test::on_threads(threads, [&] { return joint_test(seen, p, others, 0, 99, 4); });
  };
  const JointTest a = on(1), b = on(3);
  EXPECT_EQ(a.p, b.p);
  EXPECT_EQ(a.energy.p, b.energy.p);
  EXPECT_EQ(a.chance_total_variation, b.chance_total_variation);
  EXPECT_THROW((void)joint_test(seen, p, others, 0, 0, 4), std::invalid_argument);
  EXPECT_THROW((void)joint_test(seen, p, {}, 0, 9, 4), std::invalid_argument);
  EXPECT_THROW((void)joint_test({CellCounts::Zero(4, 5), {}}, p, others, 0, 9, 4),
               std::invalid_argument);
  EXPECT_THROW((void)joint_test({CellCounts::Ones(5, 4), {}}, p, others, 0, 9, 4),
               std::invalid_argument);
}

}  // namespace
}  // namespace gatewalk::lattice
