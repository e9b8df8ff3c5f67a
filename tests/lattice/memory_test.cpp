// SPDX-License-Identifier: MIT
// Is the chain Markov? Tests of independence and of gates ahead on synthetic chains: by hand, their
// rate of false alarms, and the smallest memory that they detect.
#include "lattice/study/memory.h"
#include "lattice/field/running_trial.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <stdexcept>

#include "dynamics/base/random.h"
#include "lattice/scene/scene.h"
#include "tests/support/disc_fields.h"
#include "tests/support/long.h"
#include "tests/support/threads.h"

namespace gatewalk::lattice {
namespace {

// ---- Synthetic chains ----

/// A chain like that of a gate: five ways of entering, `per_way` states each, walks of about five
/// gates through a field of 9 x 9, at most 13. With `memory`, the outcomes after one half of the
/// coarse states before differ from those after the other half by this total variation.
struct Synthetic {
  int per_way = 6;
  double memory = 0.0;
  std::uint64_t number = 1;  // different numbers give different chains

  static constexpr int kWays = 5, kTrapped = 5;
  [[nodiscard]] int states() const { return kWays * per_way; }
  [[nodiscard]] int way(int state) const { return state / per_way; }
  /// One of four origins: from below in either half, or from either side.
  [[nodiscard]] int origin(int state) const {
    const int w = way(state);
    return w == 0 ? state % 2 : w % 2 == 1 ? 2 : 3;
  }
  /// Probabilities of the outcomes in a state, (ways + trapped).
  [[nodiscard]] std::array<double, 6> row(int state) const {
    dynamics::Random random(dynamics::Purpose::row, {number, static_cast<std::uint64_t>(state), 0});
    constexpr std::array<double, 6> kUsual{0.35, 0.17, 0.17, 0.06, 0.06, 0.19};
    std::array<double, 6> p{};
    double sum = 0.0;
    for (std::size_t o = 0; o < p.size(); ++o) sum += p[o] = kUsual[o] * (0.5 + random.uniform());
    for (double& x : p) x /= sum;
    return p;
  }
  /// Shifts the probabilities of a row by the state before; -1: there was none.
  void remember(std::array<double, 6>& row, int before) const {
    if (before < 0) return;
    const double shift = (origin(before) % 2 == 0 ? 0.5 : -0.5) * memory;
    row[0] += shift;
    row[5] -= shift;
  }
};

std::int32_t drawn(const std::array<double, 6>& p, dynamics::Random& random) {
  double u = random.uniform();
  for (std::int32_t o = 0; o < 5; ++o)
    if ((u -= p[static_cast<std::size_t>(o)]) < 0.0) return o;
  return 5;
}

/// Walks number 0 .. count - 1 of data set `set`, from state 0.
StateWalks walks_of(const Synthetic& chain, std::int64_t count, std::uint64_t set) {
  StateWalks w;
  w.ways = Synthetic::kWays;
  for (int s = 0; s < chain.states(); ++s) w.way.push_back(chain.way(s));
  std::vector<std::array<double, 6>> rows;
  for (int s = 0; s < chain.states(); ++s) rows.push_back(chain.row(s));
  for (std::int64_t i = 0; i < count; ++i) {
    dynamics::Random random(dynamics::Purpose::field, {chain.number, set, std::uint64_t(i)});
    std::vector<std::int32_t> states;
    int at = 0, before = -1, column = 4, row = 0;
    while (states.size() < 13 && row < 9 && column >= 0 && column < 9 && at >= 0) {
      states.push_back(at);
      auto chances = rows[static_cast<std::size_t>(at)];
      chain.remember(chances, before);
      const auto o = drawn(chances, random);
      before = at;
      at = o == Synthetic::kTrapped
               ? StateWalks::kTrapped
               : o * chain.per_way + static_cast<int>(random.below(chain.per_way));
      row += o == 0;
      column += (o == 2 || o == 4) - (o == 1 || o == 3);
    }
    w.add(states, at);
  }
  return w;
}

std::vector<LabelledRun> by_gate_before(const Synthetic& chain, const StateWalks& w) {
  std::vector<LabelledRun> runs;
  for (std::int64_t walk = 0; walk < w.walks(); ++walk)
    for (std::int64_t i = w.begin(walk) + 1; i < w.passed[walk]; ++i)
      runs.push_back({w.state[i], chain.origin(w.state[i - 1]),
                      w.next[i] < 0 ? Synthetic::kTrapped : chain.way(w.next[i])});
  return runs;
}

std::vector<LabelledRun> by_visit(const Synthetic& chain, const StateWalks& w) {
  std::vector<LabelledRun> runs;
  for (std::int64_t walk = 0; walk < w.walks(); ++walk)
    for (std::int64_t i = w.begin(walk); i < w.passed[walk]; ++i)
      runs.push_back({w.state[i],
                      static_cast<std::int32_t>(std::min<std::int64_t>(5, i - w.begin(walk))),
                      w.next[i] < 0 ? Synthetic::kTrapped : chain.way(w.next[i])});
  return runs;
}

/// Shares of data sets in which each test found something.
struct Found {
  double together = 0.0, pooled = 0.0, chi_squared = 0.0, strongest = 0.0, state_by_state = 0.0,
         visit = 0.0, ahead = 0.0, covered = 0.0, bar = 0.0;
};

Found found(const Synthetic& chain, std::int64_t walks, int sets, std::int64_t draws, bool all) {
  Found f;
  for (int set = 0; set < sets; ++set) {
    const auto w = walks_of(chain, walks, std::uint64_t(set));
    const auto test = [&](const std::vector<LabelledRun>& runs) {
      return test_independence(runs, {.null_draws = draws, .seed = std::uint64_t(set)});
    };
    const Independence i = test(by_gate_before(chain, w));
    f.together += i.p <= 0.05;
    f.pooled += i.pooled.p <= 0.05;
    f.chi_squared += i.p_chi_squared <= 0.05;
    f.strongest += i.strongest.p <= 0.05;
    f.state_by_state += i.state_by_state.p <= 0.05;
    f.covered += i.memory_low <= chain.memory && chain.memory <= i.memory_high;
    f.bar += i.seen_at_90;
    if (!all) continue;
    f.visit += test(by_visit(chain, w)).p <= 0.05;
    f.ahead += gates_ahead(w, kMostGatesAhead, draws, std::uint64_t(set)).p <= 0.05;
  }
  for (double* x : {&f.together, &f.pooled, &f.chi_squared, &f.strongest, &f.state_by_state,
                    &f.visit, &f.ahead, &f.covered, &f.bar})
    *x /= sets;
  return f;
}

std::ostream& operator<<(std::ostream& out, const Found& f) {
  return out << "found: together " << f.together << ", pooled " << f.pooled << " (chi-squared "
             << f.chi_squared << "), strongest " << f.strongest << ", state by state "
             << f.state_by_state << "; visit " << f.visit << ", ahead " << f.ahead
             << "; interval covers " << f.covered << "; seen at 90 % " << f.bar;
}

// ---- By hand ----

// One state, 2 labels x 2 outcomes, counts 3 1 / 1 3: Cochran-Mantel-Haenszel is (3 - 2)^2 / var,
// var = 4 * 4 * 4 * 4 / (8^2 * 7) = 4/7.
TEST(Memory, PooledStatisticByHand) {
  std::vector<LabelledRun> runs;
  for (int i = 0; i < 4; ++i) {
    runs.push_back({7, 0, i < 3 ? 0 : 1});
    runs.push_back({7, 1, i < 3 ? 1 : 0});
  }
  runs.push_back({2, 0, 0});  // a state without information
  const Independence i = test_independence(runs, {.null_draws = 9999});
  EXPECT_EQ(i.runs, 8);
  EXPECT_EQ(i.states, 1);
  EXPECT_EQ(i.degrees, 1);
  EXPECT_NEAR(i.pooled.seen, 7.0 / 4.0, 1e-12);
  // Fisher's exact test: of 70 tables, 2 * (1 + 16) are at least as far off.
  EXPECT_NEAR(i.pooled.p, 34.0 / 70.0, 0.02);
  EXPECT_EQ(i.label, -1);  // too few counts for a strongest one
}

// The same table with clusters: each run contributes 1/4 or -1/4 to a count, six contributions have
// one sign and two the other. With 8 clusters the variance of their sum is 8 / 16 * 8 / 7, and 74
// of 256 sign patterns give at least as much; with 4 clusters of two equal runs 10 of 16; with one
// cluster all.
TEST(Memory, SignsOfClustersByHand) {
  for (const int clusters : {8, 4, 1}) {
    std::vector<LabelledRun> runs;
    for (int i = 0; i < 8; ++i)
      runs.push_back({7, i % 2, i < 6 ? i % 2 : 1 - i % 2, i * clusters / 8});
    runs.push_back({2, 0, 0, 0});  // a state without information
    const Independence i = test_independence(
        runs, {.null_draws = 9999, .clusters = clusters, .labels = 3, .outcomes = 4});
    EXPECT_EQ(i.runs, 8);
    EXPECT_EQ(i.label, 0);
    EXPECT_EQ(i.outcome, 0);
    EXPECT_NEAR(i.more, 0.25, 1e-12);
    const double variance = (clusters == 8 ? 4.0 : 8.0) / 7.0;
    EXPECT_NEAR(i.pooled.seen, 4.0 / variance, 1e-12);
    EXPECT_NEAR(i.strongest.seen, 1.0 / std::sqrt(variance), 1e-12);
    const double p = clusters == 8 ? 74.0 / 256.0 : clusters == 4 ? 10.0 / 16.0 : 1.0;
    EXPECT_NEAR(i.pooled.p, p, 0.02);
    EXPECT_EQ(i.p, i.pooled.p);
    EXPECT_TRUE(std::isnan(i.memory));
  }
}

TEST(Memory, NothingToTellIsNoMemory) {
  const Independence i = test_independence(std::vector<LabelledRun>{{0, 1, 0}, {0, 1, 2}}, {});
  EXPECT_EQ(i.runs, 0);
  EXPECT_EQ(i.p, 1.0);
  EXPECT_TRUE(std::isinf(i.seen_at_90));
}

// After state 1, walks that came from 0 are trapped, and walks that came from 2 enter 0: two gates
// ahead the kernel is off by 1/2.
TEST(Memory, GatesAheadByHand) {
  StateWalks w;
  w.ways = 3;
  w.way = {0, 1, 2};
  for (int i = 0; i < 100; ++i) {
    w.add(std::vector<std::int32_t>{0, 1}, StateWalks::kTrapped);
    w.add(std::vector<std::int32_t>{2, 1}, 0);
  }
  const GatesAhead g = gates_ahead(w, 2, 199, 1);
  ASSERT_EQ(g.steps.size(), 1u);
  const GatesAhead::Step& s = g.steps[0];
  EXPECT_EQ(g.runs, 400);
  // From way 0 all walks are trapped, by the kernel half of them; from way 2 none; as shares of all
  // 400 runs. Walks that were stopped in 0 continue to 1.
  EXPECT_DOUBLE_EQ(s.seen[3], 0.25);
  EXPECT_DOUBLE_EQ(s.predicted[3], 0.125);
  EXPECT_DOUBLE_EQ(s.seen[2 * 4 + 0], 0.25);
  EXPECT_DOUBLE_EQ(s.predicted[2 * 4 + 0], 0.125);
  EXPECT_DOUBLE_EQ(s.total_variation.seen, 0.25);
  EXPECT_EQ(g.p, 1.0 / 200.0);
  EXPECT_GT(s.excess_95[3][0], 0.0);
}

// Two ways, each left for the other by 1 of 4 walks, with 1 of 10 trapped: eigenvalues 0.9 and 0.9
// (1 - 2/4). For k gates these are their k-th powers, so that time scales are the same at every
// lag. The data are those of a memoryless chain with exactly its probabilities: walks of one run
// each.
TEST(Memory, TimeScalesOfTwoWaysByHand) {
  StateWalks w;
  w.ways = 2;
  w.way = {0, 1};
  for (std::int32_t from = 0; from < 2; ++from) {
    for (int i = 0; i < 675; ++i) w.add(std::vector<std::int32_t>{from}, from);
    for (int i = 0; i < 225; ++i) w.add(std::vector<std::int32_t>{from}, 1 - from);
    for (int i = 0; i < 100; ++i) w.add(std::vector<std::int32_t>{from}, StateWalks::kTrapped);
  }
  const GatesAhead g = gates_ahead(w, 5, 99, 1);
  for (const GatesAhead::Step& s : g.steps) {
    ASSERT_EQ(s.predicted_scales.size(), 2u);
    EXPECT_NEAR(s.predicted_scales[0], -1.0 / std::log(0.9), 1e-10);
    EXPECT_NEAR(s.predicted_scales[1], -1.0 / std::log(0.45), 1e-10);
    // Every walk continues by the kernel after its only run.
    for (const int k : {0, 1}) {
      EXPECT_NEAR(s.seen_scales[k], s.predicted_scales[k], 1e-10);
      EXPECT_LE(s.scales_95[k][0], s.predicted_scales[k] + 1e-10);
      EXPECT_GE(s.scales_95[k][1], s.predicted_scales[k] - 1e-10);
    }
  }
}

// Bodies always return to where they were two gates before: the kernel says 1/2, and its second
// time scale is 0; the observed one is infinite.
TEST(Memory, TimeScalesShowMemory) {
  StateWalks w;
  w.ways = 2;
  w.way = {0, 1};
  for (int i = 0; i < 100; ++i)
    for (std::int32_t a = 0; a < 2; ++a)
      for (std::int32_t b = 0; b < 2; ++b)
        w.add(std::vector<std::int32_t>{a, b, a, b, a, b, a, b}, a);
  const GatesAhead::Step& s = gates_ahead(w, 2, 99, 1).steps[0];
  EXPECT_NEAR(s.predicted_scales[1], 0.0, 0.1);
  EXPECT_GT(s.seen_scales[1], 2.0);
  EXPECT_GT(s.seen_scales[1], s.scales_95[1][1]);
}

TEST(Memory, HolmCountsTheQuestions) {
  MemoryStudy s;
  s.ahead.p = 0.04;
  s.gate_before.p = 0.01;
  s.visit.p = 0.03;
  s.row.p = 0.5;
  EXPECT_DOUBLE_EQ(s.p_adjusted(Question::gate_before), 0.04);
  EXPECT_DOUBLE_EQ(s.p_adjusted(Question::visit), 0.09);
  EXPECT_DOUBLE_EQ(s.p_adjusted(Question::gates_ahead), 0.09);
  EXPECT_DOUBLE_EQ(s.p_adjusted(Question::row), 0.5);
  EXPECT_TRUE(s.remembers());
}

TEST(Memory, PairedDifferenceByHand) {
  const PairedDifference d = paired_difference(10, 20, 98);
  EXPECT_DOUBLE_EQ(d.difference, 10.0 / 98.0);
  EXPECT_NEAR(d.high - d.low, 2 * 1.96 * std::sqrt(31.0 - 1.0) / 100.0, 1e-4);
}

TEST(Memory, SameBitsForAnyThreadsAndRefusals) {
  const Synthetic chain{.memory = 0.1};
  const StateWalks w = walks_of(chain, 300, 1);
  const auto run = [&](int threads) {
    return test::on_threads(threads, [&] {
      const Independence i = test_independence(by_gate_before(chain, w), {.null_draws = 49});
      const GatesAhead g = gates_ahead(w, 4, 49, 1);
      return std::vector{i.p,
                         i.pooled.p,
                         i.state_by_state.p,
                         i.memory,
                         i.seen_at_90,
                         g.p,
                         g.steps[0].chance,
                         g.steps[2].chance_95,
                         g.steps[1].excess_95[3][0]};
    });
  };
  EXPECT_EQ(run(1), run(4));
  const std::vector<LabelledRun> negative{{0, -1, 0}}, many{{0, 64, 1}};
  EXPECT_THROW((void)test_independence(negative, {}), std::invalid_argument);
  EXPECT_THROW((void)test_independence(many, {}), std::invalid_argument);
  EXPECT_THROW((void)test_independence({{{0, 0, 0, 2}}}, {.clusters = 2}), std::invalid_argument);
  EXPECT_THROW((void)test_independence({}, {.null_draws = 0}), std::invalid_argument);
  EXPECT_THROW((void)test_independence({}, {.level = 1.0}), std::invalid_argument);
  EXPECT_THROW((void)gates_ahead(w, 9, 9, 1), std::invalid_argument);
  EXPECT_THROW((void)gates_ahead(StateWalks{}, 2, 9, 1), std::invalid_argument);
  StateWalks broken = w;
  broken.next[0] = broken.state[1] + 1;
  EXPECT_THROW(broken.validate(), std::invalid_argument);
}

// ---- Of a field ----

const dynamics::BodyState kStart{0.0, 0.0, 0.0, 15.0};

TEST(Memory, OriginsAreWhereBodiesComeFrom) {
  EXPECT_EQ(origins_of(dynamics::disc_section()),
            (std::vector<std::string>{"from below in the left half", "from below in the right half",
                                      "from the right", "from the left"}));
}

TEST(Memory, WalksAreTheTrialsInStates) {
  const Scene scene = parse_scene("", "scene");
  const auto space = dynamics::table3_space(scene.gate);
  FieldTrials each;
  each.keep_passages = true;
  const FieldTally tally = run_field(scene.gate, scene.field, kStart, 1, {0, 50}, &each, &space);
  const int first = space.index_of({dynamics::Boundary::enter, {0.0, 0.0, 15.0}}).state;
  StateWalks w = no_walks(space);
  add_walks(w, space, first, each);
  w.validate();
  EXPECT_EQ(w.walks(), 50);
  EXPECT_EQ(std::ssize(w.state), tally.health.runs);
  EXPECT_EQ(std::count(w.next.begin(), w.next.end(), StateWalks::kTrapped), tally.trapped());
  for (std::int64_t walk = 0; walk < 50; ++walk) EXPECT_EQ(w.state[w.begin(walk)], first);
  // A run that broke is left out, and so is what would come after it.
  PassageTable broken(space.section());
  for (CellPassage passage : each.passages.rows()) {
    if (broken.empty()) passage.fate = dynamics::Fate::broken;
    broken.push_back(passage);
  }
  each.passages = broken;
  StateWalks fewer = no_walks(space);
  add_walks(fewer, space, first, each);
  fewer.validate();
  EXPECT_EQ(fewer.walks(), 49);
  const MemoryStudy study = study_memory(w, space, {.null_draws = 19});
  EXPECT_EQ(study.runs, tally.health.runs);
  EXPECT_LT(study.gate_before.runs, study.visit.runs);
  EXPECT_THROW((void)study_memory(no_walks(space), space, {}), std::invalid_argument);
}

// Without a hold, both sets are the same trials; a force that is held for long makes a difference.
TEST(Memory, OfTheForceIsWhatItsHoldDoes) {
  const auto memory_of = [&](const std::string& text) {
    const Scene scene = parse_scene(text, "scene");
    const auto space = dynamics::table3_space(scene.gate);
    const auto trials = [&](Memory held) {
      RunTrials t{FieldTally(scene.field), {}};
      t.tally = run_field(scene.gate, scene.field, kStart, 1, {0, 300}, &t.each, &space, held);
      return t;
    };
    return force_memory(trials(Memory::kept), trials(Memory::dropped), 1);
  };
  const ForceMemory quiet = memory_of("forces.random_N = 0.0");
  EXPECT_EQ(quiet.change.changed, 0.0);
  EXPECT_FALSE(quiet.matters());
  EXPECT_EQ(quiet.endings[0].difference, 0.0);
  const ForceMemory held = memory_of("forces = { random_N = 20.0, random_rate_Hz = 0.5 }");
  EXPECT_GT(held.change.changed, 0.1);
  EXPECT_TRUE(held.matters());
}

// ---- On many data sets ----

// Five in a hundred, within the precision of this many data sets: 4 to 6 % of 1000 and more.
TEST(Memory, RaisesFalseAlarmsAsOftenAsItSays) {
  const int sets = test::usual_or_full(100, 2000);
  for (const int per_way :
       test::usual_or_full(0, 1) == 1 ? std::vector{6, 100} : std::vector{6, 30}) {
    const Found f = found({.per_way = per_way}, test::usual_or_full(150, 1000), sets,
                          test::usual_or_full(99, 399), true);
    std::cout << per_way << " states a way, " << sets << " sets: " << f << "\n";
    const double slack = test::usual_or_full(1, 0) == 1 ? 0.065 : 0.01;
    for (const double share : {f.together, f.visit}) EXPECT_NEAR(share, 0.05, slack);
    // Slightly fewer with gates ahead: where the field stops walks, permuted walks get less far
    // apart.
    EXPECT_NEAR(f.ahead, 0.045, 1.5 * slack);
    EXPECT_GE(f.covered, 0.95 - slack);
  }
}

TEST(Memory, FindsAsSmallAMemoryAsItSays) {
  const bool full = test::usual_or_full(0, 1) == 1;
  // 1000: about ten runs per state, as in a fine tree.
  for (const int per_way : full ? std::vector{6, 60, 1000} : std::vector{6, 120}) {
    const double memory = full ? 0.02 : 0.07;
    const Found f = found({.per_way = per_way, .memory = memory}, full ? 10'000 : 1200,
                          full ? 200 : 20, full ? 399 : 99, full);
    std::cout << per_way << " states a way, a memory of " << memory << ": " << f << "\n";
    EXPECT_GE(f.together, 0.9);
    EXPECT_LE(f.bar, memory);
    EXPECT_GE(f.covered, full ? 0.92 : 0.8);
  }
}

}  // namespace
}  // namespace gatewalk::lattice
