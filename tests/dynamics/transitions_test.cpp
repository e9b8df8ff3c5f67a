// SPDX-License-Identifier: MIT
#include "dynamics/disc/row_trials.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <vector>

#include "dynamics/disc/disc_section.h"
#include "tests/support/numbers.h"
#include "tests/support/threads.h"

namespace gatewalk::dynamics {
namespace {

GateParams field_scene() { return {}; }  // Sec. III-C, F = 8, Rm = 40

Transitions built(std::uint64_t seed, TrialRange range) {
  const GateParams p = field_scene();
  Transitions t(table3_space(p));
  add_trials(t, p, seed, range);
  return t;
}

void expect_same(const Transitions& a, const Transitions& b) {
  EXPECT_EQ(a.rows, b.rows);
  EXPECT_EQ(a.trials, b.trials);
  EXPECT_EQ(a.clamped, b.clamped);
  EXPECT_EQ(a.health.runs, b.health.runs);
  EXPECT_EQ(a.health.impacts, b.health.impacts);
  EXPECT_TRUE(test::same_bits(a.health.worst_speed, b.health.worst_speed));
  EXPECT_TRUE(test::same_bits(a.health.worst_energy_created, b.health.worst_energy_created));
}

TEST(Transitions, StartEmpty) {
  const Transitions t(table3_space(field_scene()));
  EXPECT_EQ(t.counts().nonZeros(), 0);
  EXPECT_EQ(t.counts().rows(), 87);
  EXPECT_EQ(t.counts().cols(), 88);
  EXPECT_EQ(t.trials, std::vector<std::int64_t>(87, 0));
  EXPECT_EQ(t.clamped, std::vector<std::int64_t>(87, 0));
}

TEST(Transitions, EveryTrialIsCountedOnce) {
  const Transitions t = built(1, {0, 20});
  EXPECT_EQ(t.health.runs, 87 * 20);
  EXPECT_TRUE(t.health.clean());
  const auto counts = t.counts();
  ASSERT_EQ(counts.rows(), 87);
  ASSERT_EQ(counts.cols(), 88);
  EXPECT_EQ(counts.sum(), 87 * 20);
  for (int row = 0; row < 87; ++row) {
    EXPECT_EQ(t.trials[row], 20);
    EXPECT_GE(t.clamped[row], 0);
    EXPECT_LE(t.clamped[row], 20);
    std::int64_t sum = 0;
    for (int column = 0; column < 88; ++column) {
      const std::int64_t n = counts.coeff(row, column);
      EXPECT_GE(n, 0);
      const auto it = t.rows[row].find(column);
      EXPECT_EQ(n, it == t.rows[row].end() ? 0 : it->second);
      sum += n;
    }
    EXPECT_EQ(sum, 20);
  }
}

// A trial of a row, replayed step by step from its stream {seed, row, trial}: start, force, index.
TEST(Transitions, TrialsCanBeReplayedAlone) {
  const GateParams p = field_scene();
  const auto method = make_method(p);
  Transitions expected(table3_space(p));
  std::set<int> columns;
  for (int row = 0; row < 87; ++row) {
    for (std::uint64_t trial = 3; trial < 5; ++trial) {
      Random random(Purpose::row, {9, static_cast<std::uint64_t>(row), trial});
      const Entry start = expected.space.sample(row, random);
      EXPECT_EQ(expected.space.index_of(start).state, row);
      RandomForce force(p.forces, random);
      const GateRun run = run_gate(p, *method, entry_state(p, start), force);
      int column = expected.space.trapped();
      if (run.outcome != Outcome::trapped) {
        const auto index = expected.space.index_of(crossing_of(p, run.outcome, run.exit));
        column = index.state;
        expected.clamped[row] += index.clamped;
      }
      columns.insert(column);
      ++expected.rows[row][column];
      ++expected.trials[row];
      add_run(expected.health, p, run);
    }
  }
  expect_same(built(9, {3, 2}), expected);
  EXPECT_GT(columns.size(), 20u);
}

TEST(Transitions, SameCountsOnAnyNumberOfThreadsAndForAnySplit) {
  const auto on = [&](int threads) {
    return test::on_threads(threads, [] { return built(5, {0, 6}); });
  };
  const Transitions whole = on(1);
  expect_same(on(2), whole);
  expect_same(on(8), whole);
  const GateParams p = field_scene();
  Transitions split(table3_space(p));
  for (const TrialRange part : {TrialRange{0, 1}, {1, 0}, {1, 4}, {5, 1}})
    add_trials(split, p, 5, part);
  expect_same(split, whole);
}

// Rows with entries start only from these entries; other rows start uniformly, as without entries.
TEST(Transitions, StartFromTheEntriesOfTheirRow) {
  const GateParams p = field_scene();
  const auto method = make_method(p);
  const StateSpace space = table3_space(p);
  const Entry middle{Boundary::enter, {1.0, 2.0, 15.0}}, fast{Boundary::enter, {-3.0, -1.0, 40.0}};
  const Entries entries = entries_of(space, {middle, fast, middle});
  const int row = space.index_of(middle).state;
  ASSERT_EQ(space.index_of(fast).state, row);  // clamped, but a real entry
  ASSERT_EQ(entries.size(), 87u);
  ASSERT_EQ(entries[row].size(), 3u);
  Transitions t(space);
  add_trials(t, p, 3, {0, 4}, entries);
  const Transitions uniform = built(3, {0, 4});
  for (int other = 0; other < 87; ++other)
    if (other != row) {
      EXPECT_EQ(t.rows[other], uniform.rows[other]);
    }

  std::map<int, std::int64_t> replayed;
  std::set<double> speeds;
  for (std::uint64_t trial = 0; trial < 4; ++trial) {
    Random random(Purpose::row, {3, static_cast<std::uint64_t>(row), trial});
    const Entry start = entries[row][random.below(3)];
    speeds.insert(start.at[kEntryVy]);
    RandomForce force(p.forces, random);
    const GateRun run = run_gate(p, *method, entry_state(p, start), force);
    ++replayed[run.outcome == Outcome::trapped
                   ? space.trapped()
                   : space.index_of(crossing_of(p, run.outcome, run.exit)).state];
  }
  EXPECT_EQ(t.rows[row], replayed);
  EXPECT_EQ(speeds.size(), 2u);  // this seed draws both
  EXPECT_THROW(add_trials(t, p, 3, {0, 1}, Entries(86)), std::invalid_argument);
}

// A single entry that is a state: all its runs start there, and it gets more runs.
TEST(Transitions, GiveSingleEntriesMoreRuns) {
  const GateParams p = field_scene();
  const Entry point{Boundary::enter, {0.0, 0.0, 15.0}};
  const StateSpace space(disc_section(p), table3_space(p).bins(), true, {point});
  ASSERT_EQ(space.size(), 88);
  EXPECT_EQ(runs_per_trial(space, 0), 1);
  EXPECT_EQ(runs_per_trial(space, 87), 8);
  EXPECT_EQ(runs_per_trial(space), 87 + 8);
  Transitions whole(space), split(space);
  add_trials(whole, p, 5, {0, 5});
  for (const TrialRange part : {TrialRange{0, 2}, {2, 3}}) add_trials(split, p, 5, part);
  expect_same(whole, split);
  EXPECT_EQ(whole.trials[0], 5);
  EXPECT_EQ(whole.trials[87], 40);
  EXPECT_EQ(whole.totals().clamped, 0);
  const Transitions closed = built(5, {0, 5});  // the bins' rows are those without the point
  for (int row = 0; row < 87; ++row)
    EXPECT_EQ(whole.rows[row][88], closed.rows[row].count(87) ? closed.rows[row].at(87) : 0);

  const auto method = make_method(p);
  std::map<int, std::int64_t> replayed;
  for (std::uint64_t run = 0; run < 40; ++run) {
    Random random(Purpose::row, {5, 87, run});
    (void)space.sample(87, random);
    RandomForce force(p.forces, random);
    const GateRun r = run_gate(p, *method, {0, 0, 0, 15}, force);
    ++replayed[r.outcome == Outcome::trapped
                   ? space.trapped()
                   : space.index_of(crossing_of(p, r.outcome, r.exit)).state];
  }
  EXPECT_EQ(whole.rows[87], replayed);
}

TEST(Transitions, PartsAddUpToTheWhole) {
  Transitions sum = built(5, {4, 2});
  sum += built(5, {0, 4});
  expect_same(sum, built(5, {0, 6}));
  EXPECT_THROW(sum += Transitions(refined(sum.space, 2.0)), std::invalid_argument);
}

TEST(Transitions, OtherSeedOtherCounts) { EXPECT_NE(built(1, {0, 5}).rows, built(2, {0, 5}).rows); }

// Row 0: 3 to a neighbour, 2 trapped, 1 of the 3 clamped; row 86: all 5 trapped; others empty.
TEST(Transitions, TotalsAddUpTheRows) {
  Transitions t(table3_space(field_scene()));
  EXPECT_EQ(t.totals().runs, 0);
  EXPECT_EQ(t.totals().empty_rows, 87);
  EXPECT_EQ(t.totals().clamped_share(), 0.0);
  t.rows[0] = {{4, 1}, {30, 2}, {87, 2}};
  t.trials[0] = 5;
  t.clamped[0] = 1;
  t.rows[86] = {{87, 5}};
  t.trials[86] = 5;
  const auto total = t.totals();
  EXPECT_EQ(total.runs, 10);
  EXPECT_EQ(total.crossings, 3);
  EXPECT_EQ(total.clamped, 1);
  EXPECT_EQ(total.nonzeros, 4);
  EXPECT_EQ(total.empty_rows, 85);
  EXPECT_EQ(total.clamped_share(), 1.0 / 3);
}

// Without obstacles and forces: straight lines, whose exit is a division.
TEST(Transitions, StraightLinesLeaveWhereTheyMust) {
  GateParams p = field_scene();
  p.forces = {.propulsion = 0.0, .random = 0.0, .random_rate = 50.0, .drag = 0.0};
  p.beams = {
      .length = 1e-3, .mass = 0.1, .stiffness_left = 0.0, .stiffness_right = 0.0, .damping = 0.0};
  p.body.radius = 1e-3;
  p.run.method = "moreau";  // nothing is hit; `stable` would look for hits every half radius
  p.run.step = kPaperStep;
  // Its own units are as small; the speeds are those of the paper's scene.
  auto bins = table3_space(p).bins();
  for (Bins& b : bins)
    for (auto* edges : {&b.edges[kEntryVx], &b.edges[kEntryVy]})
      for (double& edge : *edges) edge /= scale_of(p).speed();
  int predicted = 0;
  for (std::int64_t trial = 0; trial < 10; ++trial) {
    Transitions t{StateSpace(disc_section(p), bins)};
    add_trials(t, p, 1, {trial, 1});
    for (int row = 0; row < t.space.size(); ++row) {
      Random random(Purpose::row,
                    {1, static_cast<std::uint64_t>(row), static_cast<std::uint64_t>(trial)});
      const BodyState b = entry_state(p, t.space.sample(row, random));
      const double border = b.vx > 0 ? 25.0 : -25.0;
      const double to_side = (border - b.x) / b.vx, to_top = b.vy > 0 ? (60 - b.y) / b.vy : 1e9;
      const double y = b.y + b.vy * to_side;
      // Not too close to a corner, the joint or the time limit: a step is up to 0.12 m long.
      if (std::abs(to_side - to_top) < 0.02 || std::abs(to_side - 12) < 0.02) continue;
      if (std::abs(y - 30) < 0.2) continue;
      ++predicted;
      ASSERT_EQ(t.rows[row].size(), 1u);
      const int column = t.rows[row].begin()->first;
      if (std::min(to_side, to_top) > 12) {
        EXPECT_EQ(column, t.space.trapped());
        continue;
      }
      Boundary expected = Boundary::enter;
      if (to_side < to_top && b.vx > 0)
        expected = y < 30 ? Boundary::left_deflect : Boundary::left_traverse;
      else if (to_side < to_top)
        expected = y < 30 ? Boundary::right_deflect : Boundary::right_traverse;
      EXPECT_EQ(t.space.face(column), expected) << row << ' ' << trial;
      const StateRange range = t.space.range(column);
      const auto outside_bin = [](double v, const std::array<double, 2>& bin) {
        return v < bin[0] || v > bin[1];
      };
      if (outside_bin(b.vx, range.at[kEntryVx]) || outside_bin(b.vy, range.at[kEntryVy])) {
        EXPECT_EQ(t.clamped[row], 1);
      }
    }
  }
  EXPECT_GT(predicted, 800);
}

}  // namespace
}  // namespace gatewalk::dynamics
