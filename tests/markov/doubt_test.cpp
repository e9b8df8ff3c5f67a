// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "markov/decide.h"
#include "markov/predict.h"
#include "markov/solvers.h"
#include "tests/markov/chains.h"

namespace gatewalk::markov {
namespace {

using test::crossing;
using test::few;
using test::kFar;
using test::matrix;
using test::random_chain;

using Values = std::vector<double>;

double uniform(test::Words& words) { return (words.below(1'000'000) + 0.5) / 1e6; }

/// One cell and one draw: over four edges or trapped, in this order.
const std::vector<Ending> kWays{Ending::far_edge, Ending::right_edge, Ending::left_edge,
                                Ending::near_edge, Ending::trapped};
double least_mean(const Values& p, const Values& v, double deviations, double runs) {
  std::vector<test::Entry> entries;
  Gains gains;
  for (std::size_t k = 0; k < p.size(); ++k) {
    entries.push_back({0, static_cast<int>(k), p[k]});
    gains.ending[static_cast<std::size_t>(kWays[k])] = v[k];
  }
  const Chain chain = Chain::from_probabilities(matrix(1, 5, entries),
                                                {{0, 0, 1}, {0, 1, 0}, {0, -1, 0}, {0, 0, -1}, {}});
  return decide({chain}, {1, 1}, gains, {.max_cells = 1, .doubt = {deviations, {{{runs}}}}})
      .value[0];
}

Values random_row(test::Words& words, std::size_t outputs) {
  Values p(outputs);
  double sum = 0.0;
  for (double& x : p) sum += x = std::pow(uniform(words), 3.0);
  for (double& x : p) x /= sum;
  p.back() = 1.0;
  for (std::size_t k = 0; k + 1 < outputs; ++k) p.back() -= p[k];
  return p;
}
Values random_values(test::Words& words, std::size_t outputs) {
  Values v(outputs);
  for (double& x : v) x = words.below(3) == 0 ? words.below(2) : 2.0 * uniform(words) - 0.5;
  return v;
}

// Three outputs: q in all directions from p, up to the border of the set.
TEST(Decide, TheWorstRowIsTheLeastOfAllOfItsSet) {
  test::Words words(5);
  for (int row = 0; row < 300; ++row) {
    const Values p = random_row(words, 3), v = random_values(words, 3);
    const double deviations = 3.0 * uniform(words), runs = 1 + words.below(row % 2 == 0 ? 8 : 200);
    const double radius = deviations * deviations / runs;
    const auto mean = [&](double angle) {
      double d[] = {std::cos(angle), std::sin(angle), 0.0};
      d[2] = -d[0] - d[1];
      double squares = 0.0, far = std::numeric_limits<double>::infinity(), sum = 0.0;
      for (std::size_t k = 0; k < 3; ++k) squares += d[k] * d[k] / p[k];
      far = std::sqrt(radius / squares);
      for (std::size_t k = 0; k < 3; ++k)
        if (d[k] < 0.0) far = std::min(far, -p[k] / d[k]);
      for (std::size_t k = 0; k < 3; ++k) sum += (p[k] + far * d[k]) * v[k];
      return sum;
    };
    // Ever finer steps around the best.
    double best = 0.0, width = std::acos(-1.0), least = mean(0.0);
    for (; width > 1e-13; width /= 50.0)
      for (int i = -200; i <= 200; ++i)
        if (const double at = best + width * i / 200.0; mean(at) < least) {
          least = mean(at);
          best = at;
        }
    EXPECT_NEAR(least_mean(p, v, deviations, runs), least, 1e-9) << row;
  }
}

/// An independent method: over all subsets of outputs that may keep probability, the least mean of
/// the q that Lagrange's rule gives without regard to signs, if no q is negative.
double least_by_supports(const Values& p, const Values& v, double radius) {
  constexpr double kAlike = 1e-25;  // variance of values that differ by rounding
  double least = std::numeric_limits<double>::infinity();
  for (int set = 1; set < 1 << p.size(); ++set) {
    double mass = 0.0, mean = 0.0, variance = 0.0;
    const auto has = [&](std::size_t k) { return (set >> k & 1) != 0; };
    for (std::size_t k = 0; k < p.size(); ++k)
      if (has(k)) {
        mass += p[k];
        mean += p[k] * v[k];
      }
    mean /= mass;
    for (std::size_t k = 0; k < p.size(); ++k)
      if (has(k)) variance += p[k] * (v[k] - mean) * (v[k] - mean) / mass;
    const double room = radius - (1.0 - mass) / mass;  // for p * (v - mean)
    if (room < -1e-15) continue;
    const double tilt =
        variance > kAlike ? std::sqrt(std::max(0.0, room) / (mass * variance)) : 0.0;
    double sum = 0.0;
    bool fits = true;
    for (std::size_t k = 0; k < p.size(); ++k)
      if (has(k)) {
        const double q = p[k] * (1.0 / mass - tilt * (v[k] - mean));
        fits = fits && q >= -1e-12;
        sum += q * v[k];
      }
    if (fits) least = std::min(least, sum);
  }
  return least;
}

TEST(Decide, TheWorstRowOfManyOutputsIsThatOfLagrange) {
  test::Words words(6);
  int below_mean = 0;
  for (int row = 0; row < 2000; ++row) {
    const Values p = random_row(words, 5), v = random_values(words, 5);
    const double runs = 1 + words.below(row % 2 == 0 ? 8 : 200);
    const double found = least_mean(p, v, 1.96, runs);
    EXPECT_NEAR(found, least_by_supports(p, v, 1.96 * 1.96 / runs), 1e-9) << row;
    double mean = 0.0, squares = 0.0;
    for (std::size_t k = 0; k < 5; ++k) {
      mean += p[k] * v[k];
      squares += p[k] * v[k] * v[k];
    }
    // The end of the normal interval if no q would be negative, else above it.
    const double end = mean - 1.96 * std::sqrt((squares - mean * mean) / runs);
    EXPECT_GE(found, end - 1e-12);
    EXPECT_GE(found, *std::min_element(v.begin(), v.end()));
    below_mean += std::abs(found - end) < 1e-12;
  }
  EXPECT_GT(below_mean, 300);
  EXPECT_LT(below_mean, 1700);
}

Doubt doubt(double deviations, std::size_t actions, const Values& runs) {
  return {deviations, std::vector(actions, std::vector(1, runs))};
}

/// The worst-case value of a draw by `action`, in a field of two states per cell.
double worst_draw(const Chain& chain, const Field& field, const Gains& gains, int cell, int input,
                  double radius, const Values& of_state, bool last_draw = false) {
  Values p, v;
  for (Probabilities::InnerIterator it(chain.matrix(), input); it; ++it) {
    std::int64_t column = cell % field.columns, row = cell / field.columns;
    const Exit& exit = chain.exits()[static_cast<std::size_t>(it.col())];
    const auto end = follow(field, exit, last_draw, column, row);
    p.push_back(it.value());
    v.push_back(end ? gains.ending[static_cast<std::size_t>(*end)]
                    : of_state[static_cast<std::size_t>((row * field.columns + column) * 2 +
                                                        exit.next_input)]);
  }
  return least_by_supports(p, v, radius);
}

TEST(Decide, IsTheBestInTheWorstCaseOfAllPoliciesOfASmallField) {
  constexpr int kStates = 2 * 2 * 2;
  const Field field{2, 2};
  test::Words words(9);
  for (const double runs : {6.0, 25.0, 400.0}) {
    const std::vector<FieldChain> actions{random_chain(words), random_chain(words)};
    const double radius = 1.5 * 1.5 / runs;
    const auto worst = [&](const std::uint16_t* action) {
      Values value(kStates, 0.0);
      for (double change = 1.0; change > 1e-14;) {
        change = 0.0;
        for (int s = 0; s < kStates; ++s) {
          const auto at = static_cast<std::size_t>(s);
          const double now = worst_draw(actions[action[s]].at(s / 2 % 2, s / 4), field, crossing(),
                                        s / 2, s % 2, radius, value);
          change = std::max(change, std::abs(now - value[at]));
          value[at] = now;
        }
      }
      return value;
    };
    const Decisions best =
        decide(actions, field, crossing(), {.doubt = doubt(1.5, 2, {runs, runs})});
    Values most(kStates, -1.0);
    for (int policy = 0; policy < 1 << kStates; ++policy) {
      std::uint16_t action[kStates];
      for (int s = 0; s < kStates; ++s) action[s] = static_cast<std::uint16_t>(policy >> s & 1);
      const Values value = worst(action);
      for (std::size_t s = 0; s < kStates; ++s) most[s] = std::max(most[s], value[s]);
    }
    const Values own = worst(best.action.data());
    for (std::size_t s = 0; s < kStates; ++s) {
      EXPECT_NEAR(best.value[s], most[s], 1e-9) << runs;
      EXPECT_NEAR(own[s], most[s], 1e-9) << runs;
      EXPECT_GT(most[s], 0.0);
    }
  }
}

TEST(Decide, InDoubtWithALimitNatureKnowsTheDrawsToo) {
  const Field field{3, 2};
  test::Words words(12);
  const std::vector<FieldChain> actions{random_chain(words), random_chain(words)};
  Gains gains = crossing();
  gains.ending[static_cast<std::size_t>(Ending::trapped)] = -0.3;
  gains.ending[static_cast<std::size_t>(Ending::cut_off)] = 0.1;
  gains.draw = {{{0.01, -0.02}}, {{0.03, 0.0}}};
  const Values runs{12.0, 40.0};
  Values next(3 * 2 * 2, 0.0);
  for (int limit = 1; limit <= 4; ++limit) {
    Values now(next.size());
    for (std::size_t s = 0; s < now.size(); ++s) {
      now[s] = -1e300;
      for (std::size_t a = 0; a < 2; ++a)
        now[s] = std::max(
            now[s], gains.draw[a][0][s % 2] +
                        worst_draw(actions[a].chains()[0], field, gains, static_cast<int>(s / 2),
                                   static_cast<int>(s % 2), 4.0 / runs[s % 2], next, limit == 1));
    }
    next = now;
    const Decisions best =
        decide(actions, field, gains, {.max_cells = limit, .doubt = doubt(2.0, 2, runs)});
    for (std::size_t s = 0; s < now.size(); ++s) EXPECT_NEAR(best.value[s], now[s], 1e-9) << limit;
  }
}

/// Chains of the paper's size with the runs of their rows.
struct Sampled {
  std::vector<FieldChain> actions;
  Doubt doubt;
};
Sampled sampled(double deviations) {
  Sampled all;
  all.doubt.deviations = deviations;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Counts counts = test::lattice_counts(seed);
    if (seed == 2) test::empty_row(counts, 17);
    Values runs(static_cast<std::size_t>(counts.rows()), 0.0);
    for (int row = 0; row < counts.rows(); ++row)
      for (Counts::InnerIterator it(counts, row); it; ++it)
        runs[static_cast<std::size_t>(row)] += static_cast<double>(it.value());
    all.doubt.runs.push_back({runs});
    all.actions.emplace_back(Chain::from_counts(counts, test::lattice_exits()));
  }
  return all;
}

TEST(Decide, WithoutDeviationsDoubtChangesNothing) {
  for (const int limit : {0, 13}) {
    const Sampled s = sampled(0.0);
    const Decisions plain = decide(s.actions, {}, crossing(), {.max_cells = limit});
    const Decisions none =
        decide(s.actions, {}, crossing(), {.max_cells = limit, .doubt = s.doubt});
    EXPECT_EQ(plain.value, none.value);
    EXPECT_EQ(plain.action, none.action);
  }
}

TEST(Decide, WhatIsSureFallsWithDoubt) {
  for (const int limit : {0, 13}) {
    const Sampled plain = sampled(0.0);
    Values before = decide(plain.actions, {}, crossing(), {.max_cells = limit}).value;
    for (const double deviations : {1e-6, 0.5, 1.96, 4.0, 100.0}) {
      const Sampled s = sampled(deviations);
      const Values now =
          decide(s.actions, {}, crossing(), {.max_cells = limit, .doubt = s.doubt}).value;
      for (std::size_t i = 0; i < now.size(); ++i) {
        EXPECT_GE(now[i], 0.0);
        EXPECT_LE(now[i], before[i]);
        if (deviations == 1e-6) {
          EXPECT_NEAR(now[i], before[i], 1e-4);
        }
        if (deviations == 100.0) {
          EXPECT_EQ(now[i], 0.0);  // all are trapped
        }
      }
      if (deviations == 1.96) {
        EXPECT_LT(now[0], 0.9 * before[0]);
      }
      before = now;
    }
  }
}

// A row that may keep a walk in the field for ever has the value 0, and another is chosen.
TEST(Decide, InDoubtLeavesWhatMayCircle) {
  const FieldChain circle(few({{0, 1, 0.97}, {0, 0, 0.03}, {1, 2, 0.97}, {1, 0, 0.03}}));
  const FieldChain ahead(few({{0, 0, 0.5}, {0, 4, 0.5}, {1, 0, 0.5}, {1, 4, 0.5}}));
  const Field field{2, 1};
  const Values runs{50.0, 50.0};
  const Decisions best = decide({circle, ahead}, field, crossing(), {.doubt = doubt(2.0, 2, runs)});
  EXPECT_NEAR(best.value[best.at(0, 0, 0)], 0.5 - 2.0 * std::sqrt(0.25 / 50.0), 1e-12);
  EXPECT_EQ(best.action[best.at(0, 0, 0)], 1);
  const Decisions alone = decide({circle}, field, crossing(), {.doubt = doubt(2.0, 1, runs)});
  EXPECT_EQ(*std::max_element(alone.value.begin(), alone.value.end()), 0.0);
}

// By simulation: the sure value of decisions from few runs is nearly always below their true value;
// the value that the counts give to the best decisions is often above it.
TEST(Decide, WhatIsSureIsBelowTheTruth) {
  constexpr int kSets = 300, kRuns = 40;
  const Field field{4, 4};
  test::Words words(77);
  int sure = 0, plain = 0;
  for (int set = 0; set < kSets; ++set) {
    std::vector<FieldChain> truth, seen;
    for (int a = 0; a < 3; ++a) {
      truth.emplace_back(random_chain(words));
      const Chain& chain = truth.back().chains()[0];
      Counts counts(2, 5);
      for (int run = 0; run < 2 * kRuns; ++run) {
        double left = uniform(words);
        int output = -1;
        for (Probabilities::InnerIterator it(chain.matrix(), run % 2); it && left > 0.0; ++it) {
          left -= it.value();
          output = static_cast<int>(it.col());
        }
        ++counts.coeffRef(run % 2, output);
      }
      seen.emplace_back(Chain::from_counts(counts, test::few_exits()));
    }
    const auto is_below_truth = [&](const Doubt& with) {
      const Decisions best = decide(seen, field, crossing(), {.doubt = with});
      const double true_value =
          solve_absorption(decided(truth, best), field, {1, 0, 0}).endings[kFar];
      return best.value[best.at(1, 0, 0)] <= true_value;
    };
    sure += is_below_truth(doubt(1.96, 3, {kRuns, kRuns}));
    plain += is_below_truth({});
  }
  RecordProperty("sure", sure);
  RecordProperty("plain", plain);
  EXPECT_GE(sure, kSets * 99 / 100);
  EXPECT_LE(plain, kSets * 45 / 100);
}

TEST(Decide, RefusesDoubtThatDoesNotFit) {
  test::Words words(1);
  const std::vector<FieldChain> actions{random_chain(words), random_chain(words)};
  const auto refused = [&](const Doubt& d, const Gains& gains = crossing()) {
    EXPECT_THROW((void)decide(actions, {3, 3}, gains, {.doubt = d}), std::invalid_argument);
  };
  const double none = std::nan("");
  refused({-1.0, {}});
  refused({none, {}});
  refused({1.0, {}});
  refused(doubt(1.0, 1, {5.0, 5.0}));
  refused(doubt(1.0, 2, {5.0}));
  refused({1.0, {{{5.0, 5.0}}, {{5.0, 5.0}, {5.0, 5.0}}}});
  for (const double runs : {0.0, -1.0, none, 1.0 / 0.0}) refused(doubt(1.0, 2, {5.0, runs}));
  Gains slow = crossing();
  slow.draw = {{{-0.1, -0.1}}, {{-0.1, -0.1}}};
  refused(doubt(1.0, 2, {5.0, 5.0}), slow);
  EXPECT_NO_THROW(
      (void)decide(actions, {3, 3}, slow, {.max_cells = 3, .doubt = doubt(1.0, 2, {5.0, 5.0})}));
  EXPECT_NO_THROW((void)decide({Chain::from_counts(Counts(1, 1), {{0, 0, 1}})}, {1, 1}, crossing(),
                               {.doubt = doubt(1.0, 1, {0.0})}));
}

}  // namespace
}  // namespace gatewalk::markov
