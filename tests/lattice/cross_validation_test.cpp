// SPDX-License-Identifier: MIT
// One half of the bodies against the other: no finding without a difference, however trials are
// observed; planted differences and memories are found.
#include "lattice/study/cross_validation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <vector>

#include "dynamics/base/random.h"
#include "lattice/recorded/recorded_pool.h"
#include "lattice/study/memory.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

const CellFile& cells() {
  static const CellFile file = parse_cell_file(R"(
cell = { width_m = 0.1, length_m = 0.1, symmetric = false, faces = [
  { name = "S", move = [0, 1] }, { name = "N", move = [0, -1] },
  { name = "W", move = [1, 0] }, { name = "E", move = [-1, 0] }
], coordinates = [{ name = "s", unit = "m", scale = 0.1 }] }
field = { columns = 5, rows = 4, max_gates = 8 }
)",
                                               "cell.toml");
  return file;
}
constexpr int kS = 0, kN = 1, kW = 2, kE = 3;

/// The next move of a body that entered so: the face by which it leaves, or -1: trapped.
struct Walker {
  std::int32_t body;
  Entry at;
  int came_by;  // the face of the entry before; -1: none
};
using Rule = std::function<int(const Walker&, Random&)>;

int plainly(const Walker& w, Random& random) {
  const double u = random.uniform();
  if (u < 0.08) return -1;
  const double ahead = w.at.face == kS ? 0.45 : 0.35, right = w.at.at[0] > 0.0 ? 0.25 : 0.12;
  if (u < 0.08 + ahead) return kS;
  if (u < 0.08 + ahead + right) return kW;
  return u < 0.9 ? kE : kN;
}

/// Trials observed within a view of these columns and rows, and lost in 3 of 100 cells. A body has
/// 1 to 4 trials, by its number.
RecordedRuns walked(int bodies, std::uint64_t seed, const Rule& rule, int columns = 3,
                    int rows = 3) {
  RecordedRuns runs;
  runs.passages.begin(cells().map.section);
  for (std::int32_t body = 0; body < bodies; ++body) {
    Random random(Purpose::field, {seed, 1, static_cast<std::uint64_t>(body)});
    const auto entry = [&](int face) { return Entry{face, {random.uniform() - 0.5, 0.0, 0.0}}; };
    runs.bodies.push_back(std::to_string(body));
    for (int trial = 0; trial <= body % 4; ++trial) {
      Walker w{body, entry(kS), -1};
      RecordedTrial made{w.at, body, std::ssize(runs.passages), 0};
      int column = columns / 2, row = 0;
      while (column >= 0 && column < columns && row >= 0 && row < rows) {
        ++made.count;
        if (random.uniform() < 0.03) {
          runs.passages.push_back({.fate = Fate::broken});
          break;
        }
        const int next = rule(w, random);
        if (next < 0) {
          runs.passages.push_back({.fate = Fate::trapped});
          break;
        }
        const int from = w.at.face;
        w = {body, entry(next), from};
        runs.passages.push_back({.fate = Fate::left, .entry = w.at, .costs = {1.0}});
        column += cells().map.section.faces[static_cast<std::size_t>(next)].di_x;
        row += cells().map.section.faces[static_cast<std::size_t>(next)].di_y;
      }
      runs.trials.push_back(made);
    }
  }
  return runs;
}

/// One half of the bodies turns left, the other half right.
int left_or_right_handed(const Walker& w, Random& random) {
  const double u = random.uniform();
  if (u < 0.4) return u < 0.06 ? -1 : kS;
  return (u < 0.92) == (w.body / 4 % 2 == 0) ? kW : kE;
}

/// Bodies mostly go straight on.
int straight_on(const Walker& w, Random& random) {
  const double u = random.uniform();
  if (u < 0.06) return -1;
  if (u < 0.5 && w.came_by >= 0) return w.came_by;
  return u < 0.7 ? kS : u < 0.85 ? kW : kE;
}

struct Found {
  CrossValidation validation;
  Independence memory;
};
Found found_in(const RecordedRuns& runs, std::uint64_t seed) {
  const RunPool pool = pool_of(runs);
  const Problem problem = problem_of(cells(), pool);
  return {cross_validate(problem, pool, {.null_draws = 999, .seed = seed}),
          body_memory(problem, pool, kEntriesPerLeaf, 499, seed)};
}

/// Range of 99.9 % of the counts with this share.
std::array<int, 2> expected_999(int of, double share) {
  const double mean = of * share, half = 3.29 * std::sqrt(mean * (1.0 - share));
  return {static_cast<int>(std::floor(mean - half)), static_cast<int>(std::ceil(mean + half))};
}

// Most of these trials leave the view, or are lost, before they end.
TEST(CrossValidation, ChanceIsFoundAsOftenAsItIsAskedFor) {
  constexpr int kSeeds = 300;
  std::array<int, 4> halves{}, memory{};  // p in each quarter
  int differ = 0, remember = 0, held = 0, seen_to_end = 0, trials = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Found f = found_in(walked(80, seed, plainly), seed);
    ++halves[static_cast<std::size_t>(std::min(3.0, 4.0 * f.validation.p))];
    ++memory[static_cast<std::size_t>(std::min(3.0, 4.0 * f.memory.p))];
    differ += f.validation.differs();
    remember += f.memory.p <= MemoryStudy::kLevel;
    for (const Fold& fold : f.validation.folds) {
      seen_to_end += static_cast<int>(fold.watched.to_end);
      trials += static_cast<int>(fold.watched.trials);
      held += fold.total_variation.seen <= fold.chance_total_variation_95;
    }
  }
  EXPECT_LT(seen_to_end, trials / 2);
  for (const int count : {differ, remember}) {
    const auto [least, most] = expected_999(kSeeds, 0.05);
    EXPECT_TRUE(least <= count && count <= most) << count;
  }
  for (std::size_t quarter = 0; quarter < 4; ++quarter)
    for (const int count : {halves[quarter], memory[quarter]}) {
      const auto [least, most] = expected_999(kSeeds, 0.25);
      EXPECT_TRUE(least <= count && count <= most) << quarter << ": " << count;
    }
  EXPECT_GE(held, 2 * kSeeds * 93 / 100);
  EXPECT_LE(held, 2 * kSeeds * 97 / 100);
}

/// Nearly all bodies are trapped: half of the bodies shows the other endings once or not at all.
int hardly_on(const Walker&, Random& random) {
  const double u = random.uniform();
  if (u < 0.75) return -1;
  return u < 0.9 ? kS : u < 0.95 ? kW : kE;
}

TEST(CrossValidation, RareEndingsRaiseNoAlarm) {
  constexpr int kSeeds = 100;
  int differ = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const RunPool pool = pool_of(walked(80, seed, hardly_on, 5, 4));
    const Problem problem = problem_of(cells(), pool);
    differ += cross_validate(problem, pool, {.null_draws = 499, .seed = seed}).differs();
  }
  EXPECT_LE(differ, expected_999(kSeeds, 0.05)[1]);
}

TEST(CrossValidation, ADifferenceBetweenBodiesIsFound) {
  int differ = 0, remember = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Found f = found_in(walked(200, seed, left_or_right_handed, 5, 4), seed);
    differ += f.validation.differs();
    remember += f.memory.p <= MemoryStudy::kLevel;
  }
  EXPECT_GE(differ, 16);
  EXPECT_GE(remember, 18);
}

TEST(CrossValidation, AMemoryIsFound) {
  int remember = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const RunPool pool = pool_of(walked(200, seed, straight_on, 5, 4));
    const Independence memory =
        body_memory(problem_of(cells(), pool), pool, kEntriesPerLeaf, 499, seed);
    remember +=
        memory.p <= MemoryStudy::kLevel && memory.more > 0.05 && memory.label == memory.outcome;
  }
  EXPECT_GE(remember, 19);
}

// Unobserved parts are not guessed: trials without a finished passage cannot differ.
TEST(CrossValidation, WhatWasNotSeenDoesNotDiffer) {
  RecordedRuns runs;
  runs.passages.begin(cells().map.section);
  for (std::int32_t body = 0; body < 40; ++body) {
    runs.bodies.push_back(std::to_string(body));
    const auto begin = std::ssize(runs.passages);
    // One passage each, all equal; nobody observed the next cell.
    runs.passages.push_back({.fate = Fate::left, .entry = {kS, {0.01 * body, 0.0, 0.0}}});
    runs.trials.push_back({{kS, {0.01 * body, 0.0, 0.0}}, body, begin, 1});
    runs.passages.push_back({.fate = Fate::broken});
    runs.trials.push_back({{kS, {0.1, 0.0, 0.0}}, body, begin + 1, 1});
  }
  const Found f = found_in(runs, 1);
  EXPECT_EQ(f.validation.p, 1.0);
  for (const Fold& fold : f.validation.folds) {
    EXPECT_EQ(fold.bodies, 20);
    EXPECT_EQ(fold.watched.trials, 20);
    EXPECT_EQ(fold.watched.left_out, 20);
    EXPECT_EQ(fold.watched.unwatched, 20);
    EXPECT_EQ(fold.total_variation.seen, 0.0);
    EXPECT_NEAR(fold.chain.endings[static_cast<std::size_t>(markov::Ending::far_edge)], 1.0, 1e-12);
  }
  EXPECT_EQ(f.memory.label, -1);
  EXPECT_EQ(f.memory.p, 1.0);
}

TEST(CrossValidation, AreThoseOfTheSeed) {
  const RecordedRuns runs = walked(60, 5, plainly);
  const CrossValidation a = found_in(runs, 3).validation, b = found_in(runs, 3).validation,
                        c = found_in(runs, 4).validation;
  EXPECT_EQ(a.p, b.p);
  EXPECT_EQ(a.folds[0].total_variation.seen, b.folds[0].total_variation.seen);
  EXPECT_NE(a.folds[0].total_variation.seen, c.folds[0].total_variation.seen);
  EXPECT_NEAR(a.folds[1].seen_gates.sum(), 1.0, 1e-12);
  EXPECT_NEAR(a.folds[1].chain.final_cells.sum(), 1.0, 1e-12);
}

TEST(CrossValidation, TooFewBodiesAreRefused) {
  const RunPool pool = pool_of(walked(31, 1, plainly));
  EXPECT_THROW((void)cross_validate(problem_of(cells(), pool), pool, {}), std::invalid_argument);
}

}  // namespace
}  // namespace gatewalk::lattice
