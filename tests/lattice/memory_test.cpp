// Is it Markov? Tests of independence and of gates ahead on synthetic chains: by hand, how often
// they raise a false alarm, and how small a memory they find.
#include "lattice/study/memory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <stdexcept>

#include "dynamics/random.h"
#include "lattice/scene/scene.h"
#include "tests/support/long.h"
#include "tests/support/threads.h"

namespace gatewalk::lattice {
namespace {

// ---- Synthetic chains ----

/// A chain like a gate's: five ways of entering, `per_way` states each, walks of some five gates
/// through a field of 9 x 9, at most 13. With `memory`, what follows the one half of coarse states
/// before differs from what follows the other by this total variation.
struct Synthetic {
  int per_way = 6;
  double memory = 0.0;
  std::uint64_t number = 1;  // other chains

  static constexpr int kWays = 5, kTrapped = 5;
  [[nodiscard]] int states() const { return kWays * per_way; }
  [[nodiscard]] int way(int state) const { return state / per_way; }
  /// Of four: from below in one half or the other, from either side.
  [[nodiscard]] int origin(int state) const {
    const int w = way(state);
    return w == 0 ? state % 2 : w % 2 == 1 ? 2 : 3;
  }
  /// Chances of the outcomes in a state, (ways + trapped).
  [[nodiscard]] std::array<double, 6> row(int state) const {
    dynamics::Random random(dynamics::Purpose::row, {number, static_cast<std::uint64_t>(state), 0});
    constexpr std::array<double, 6> kUsual{0.35, 0.17, 0.17, 0.06, 0.06, 0.19};
    std::array<double, 6> p{};
    double sum = 0.0;
    for (std::size_t o = 0; o < p.size(); ++o) sum += p[o] = kUsual[o] * (0.5 + random.uniform());
    for (double& x : p) x /= sum;
    return p;
  }
  /// Moves chances of a row as what came before says; -1: nothing came.
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

/// Shares of data sets in which each was found.
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

// Five in a hundred, within what so many data sets can tell: 4 to 6 % of 1000 and more.
TEST(Memory, RaisesFalseAlarmsAsOftenAsItSays) {
  const int sets = test::usual_or_full(100, 2000);
  for (const int per_way :
       test::usual_or_full(0, 1) == 1 ? std::vector{6, 100} : std::vector{6, 30}) {
    const Found f = found({.per_way = per_way}, test::usual_or_full(150, 1000), sets,
                          test::usual_or_full(99, 399), true);
    std::cout << per_way << " states a way, " << sets << " sets: " << f << "\n";
    const double slack = test::usual_or_full(1, 0) == 1 ? 0.065 : 0.01;
    for (const double share : {f.together, f.visit, f.ahead}) EXPECT_NEAR(share, 0.05, slack);
    EXPECT_GE(f.covered, 0.95 - slack);
  }
}

TEST(Memory, FindsAsSmallAMemoryAsItSays) {
  const bool full = test::usual_or_full(0, 1) == 1;
  // 1000: some ten runs in a state, as a fine tree has.
  for (const int per_way : full ? std::vector{6, 60, 1000} : std::vector{6, 120}) {
    const double memory = full ? 0.02 : 0.07;
    const Found f = found({.per_way = per_way, .memory = memory}, full ? 10'000 : 1200,
                          full ? 200 : 20, full ? 399 : 99, false);
    std::cout << per_way << " states a way, a memory of " << memory << ": " << f << "\n";
    EXPECT_GE(f.together, 0.9);
    EXPECT_LE(f.bar, memory);
    EXPECT_GE(f.covered, full ? 0.92 : 0.8);
  }
}

}  // namespace
}  // namespace gatewalk::lattice
