// SPDX-License-Identifier: MIT
#include "markov/first_passage.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "markov/committor.h"
#include "tests/markov/chains.h"
#include "tests/support/field_states.h"

namespace gatewalk::markov {
namespace {

using namespace test;

/// One state that moves ahead with p, else back.
Chain game(double p) {
  return Chain::from_probabilities(matrix(1, 2, {{0, 0, p}, {0, 1, 1 - p}}),
                                   {{0, 0, 1}, {0, 0, -1}});
}

/// A time for each nonzero of a chain.
Rewards times_of(const FieldChain& chain) {
  Words words(5);
  Rewards all;
  for (const Chain& c : chain.chains()) {
    Reward r;
    for (Eigen::Index i = 0; i < c.matrix().nonZeros(); ++i) {
      r.mean.push_back(0.5 + words.below(100));
      r.square.push_back(r.mean.back() * r.mean.back());
    }
    all.push_back({r});
  }
  return all;
}

/// The equations h = P h, m = P (t h + m) for all pairs while walks have `left` draws. In a field
/// without a limit `left` has no effect, and `next` and `now` are the same.
struct Equations {
  const FieldChain& chain;
  Field field;
  PassageTarget target;
  const Rewards& rewards;

  [[nodiscard]] std::size_t pairs() const {
    return static_cast<std::size_t>(field.columns * field.rows * chain.inputs());
  }
  /// Calls draw(pair, chance, time, reaches, next pair or -1) for all draws of pairs that are not
  /// in the target.
  template <class Draw>
  void each(bool last, Draw draw) const {
    std::size_t pair = 0;
    for (int row = 0; row < field.rows; ++row)
      for (int column = 0; column < field.columns; ++column)
        for (int input = 0; input < chain.inputs(); ++input, ++pair) {
          if (target.holds(row * field.columns + column, input)) continue;
          const Chain& c = chain.at(column, row);
          const double* const times =
              rewards[static_cast<std::size_t>(chain.type_of(column, row))][0].mean.data();
          const double* const values = c.matrix().valuePtr();
          for (Probabilities::InnerIterator it(c.matrix(), input); it; ++it) {
            std::int64_t x = column, y = row;
            const Exit& exit = c.exits()[static_cast<std::size_t>(it.col())];
            const double time = times[&it.value() - values];
            if (const auto ends = follow(field, exit, last, x, y))
              draw(pair, it.value(), time, target.ending == *ends, -1);
            else
              draw(pair, it.value(), time, target.holds(y * field.columns + x, exit.next_input),
                   static_cast<std::ptrdiff_t>((y * field.columns + x) * chain.inputs() +
                                               exit.next_input));
          }
        }
  }
};

struct Expected {
  Eigen::VectorXd chance, draws, time;  // over all walks, not only those that arrive
};

/// Without limit, by one dense LU.
Expected solved(const Equations& e) {
  const auto n = static_cast<Eigen::Index>(e.pairs());
  Eigen::MatrixXd a = Eigen::MatrixXd::Identity(n, n);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(n);
  for (Eigen::Index pair = 0; pair < n; ++pair)
    if (e.target.holds(pair / e.chain.inputs(), static_cast<int>(pair % e.chain.inputs())))
      b[pair] = 1.0;
  e.each(false, [&](std::size_t pair, double p, double, bool reaches, std::ptrdiff_t next) {
    const auto at = static_cast<Eigen::Index>(pair);
    if (reaches)
      b[at] += p;
    else if (next >= 0)
      a(at, next) -= p;
  });
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(a);
  Expected x{lu.solve(b), Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
  e.each(false, [&](std::size_t pair, double p, double time, bool reaches, std::ptrdiff_t next) {
    const auto at = static_cast<Eigen::Index>(pair);
    const double h = reaches ? 1.0 : next >= 0 ? x.chance[next] : 0.0;
    x.draws[at] += p * h;
    x.time[at] += p * time * h;
  });
  x.draws = lu.solve(x.draws).eval();
  x.time = lu.solve(x.time).eval();
  return x;
}

void expect_equal(const FirstPassages& f, const Expected& x, double relative) {
  for (std::size_t i = 0; i < f.chance.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    ASSERT_NEAR(f.chance[i], x.chance[at], relative * x.chance[at]) << i;
    if (f.chance[i] == 0.0) continue;
    ASSERT_NEAR(f.draws[i] * f.chance[i], x.draws[at], relative * x.draws[at]) << i;
    ASSERT_NEAR(f.totals[0][i] * f.chance[i], x.time[at], relative * x.time[at]) << i;
  }
}

std::vector<PassageTarget> some_targets() {
  return {{.ending = Ending::far_edge},
          {.ending = Ending::left_edge},
          {.ending = Ending::trapped},
          {.cell = 7},
          {.input = 2},
          {.cell = 5, .input = 3}};
}

// A field with moves back and two types of cells, compared with LU of all equations.
TEST(FirstPassage, SolvesItsEquations) {
  const Field field{4, 3};
  const std::vector<int> types{0, 1, 1, 0, 0, 0, 1, 0, 1, 0, 0, 1};
  const FieldChain chain =
      FieldChain::by_cell({Chain::from_counts(boundary_counts(3), boundary_exits_down()),
                           Chain::from_counts(boundary_counts(4), boundary_exits_down())},
                          field.columns, types);
  const Rewards times = times_of(chain);
  for (const PassageTarget& target : some_targets())
    expect_equal(first_passages(chain, field, target, 0, times),
                 solved({chain, field, target, times}), 1e-12);
}

// With a limit: draw by draw, directly by the equations.
TEST(FirstPassage, OfALimitIsThatOfEachDraw) {
  const Field field{4, 3};
  const FieldChain chain = Chain::from_counts(boundary_counts(3), boundary_exits_down());
  const Rewards times = times_of(chain);
  std::vector<PassageTarget> targets = some_targets();
  targets.push_back({.ending = Ending::cut_off});
  for (const PassageTarget& target : targets) {
    const Equations e{chain, field, target, times};
    const auto n = static_cast<Eigen::Index>(e.pairs());
    const auto reached = [&](Expected& x) {
      for (Eigen::Index pair = 0; pair < n; ++pair)
        if (target.holds(pair / chain.inputs(), static_cast<int>(pair % chain.inputs())))
          x.chance[pair] = 1.0;
    };
    const Expected none{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n),
                        Eigen::VectorXd::Zero(n)};
    Expected later = none;
    for (int draws = 1; draws <= 6; ++draws) {
      Expected now = none;
      reached(now);
      e.each(draws == 1,
             [&](std::size_t pair, double p, double t, bool reaches, std::ptrdiff_t next) {
               const auto at = static_cast<Eigen::Index>(pair);
               const bool on = !reaches && next >= 0;
               const double h = reaches ? 1.0 : on ? later.chance[next] : 0.0;
               now.chance[at] += p * h;
               now.draws[at] += p * (h + (on ? later.draws[next] : 0.0));
               now.time[at] += p * (t * h + (on ? later.time[next] : 0.0));
             });
      later = now;
      expect_equal(first_passages(chain, field, target, draws, times), now, 1e-14);
    }
  }
}

// A gambler who wins a game with probability p, ruined before the first row: (1 - r^n) / (1 - r^N)
// with r = (1 - p) / p, to some roundings of its own size, however small. For a fair game n / N,
// and (N^2 - n^2) / 3 games of the winners (Feller, An Introduction to Probability Theory, XIV).
TEST(FirstPassage, OfMovesBackIsTheGamblersRuin) {
  const int rows = 60, to = 40;  // the row to be reached
  for (const double p : {0.1, 0.5, 0.9}) {
    const FirstPassages f = first_passages(game(p), {1, rows}, {.cell = to}, 0);
    const double r = (1 - p) / p, all = to + 1;
    for (int row = 0; row < to; ++row) {
      const double n = row + 1, i = static_cast<double>(f.at({0, row, 0}));
      const double chance = p == 0.5 ? n / all : (std::pow(r, n) - 1) / (std::pow(r, all) - 1);
      const double v = f.chance[static_cast<std::size_t>(i)];
      EXPECT_NEAR(v, chance, 1e-13 * chance) << p << " " << row;
      if (p != 0.5) continue;
      EXPECT_NEAR(f.draws[static_cast<std::size_t>(i)], (all * all - n * n) / 3, 1e-10) << row;
    }
    EXPECT_EQ(f.chance[to], 1.0);
    EXPECT_EQ(f.draws[to], 0.0);
    // From beyond the target: the same game from the other side.
    const double back = rows - to, n = rows - 50;
    EXPECT_NEAR(f.chance[50],
                p == 0.5 ? n / back : (std::pow(1 / r, n) - 1) / (std::pow(1 / r, back) - 1),
                1e-13);
  }
}

// States that pass walks to each other 10^14 times: 1 / escape draws, where LU keeps two digits.
TEST(FirstPassage, KeepsItsDigitsWhereWalksHardlyEnd) {
  for (const double escape : {1e-6, 1e-14, 1e-200}) {
    const FirstPassages f =
        first_passages(test::nearly_closed(escape), {2, 1}, {.ending = Ending::trapped}, 0);
    EXPECT_NEAR(f.chance[0], 1.0, 1e-14);
    EXPECT_NEAR(f.draws[0] * escape, 1.0, 1e-13);
  }
}

// The expected visits of a state are the probability to reach it times the visits from itself.
TEST(FirstPassage, TimesReturnsIsTheVisits) {
  const Field field{3, 3};
  const Chain chain = Chain::from_counts(boundary_counts(8), boundary_exits_down());
  const FieldStates states = field_states(chain, field, {{1, 0, 0}});
  const auto a = absorption(absorbing_chain<double>(states));
  for (const std::ptrdiff_t to : {3, 11, 20}) {
    const Start& s = states.states[static_cast<std::size_t>(to)];
    const FirstPassages f = first_passages(
        chain, field, {.cell = s.row * field.columns + s.column, .input = s.input}, 0);
    for (std::ptrdiff_t from = 0; from < std::ssize(states.states); ++from)
      EXPECT_NEAR(f.chance[f.at(states.states[static_cast<std::size_t>(from)])],
                  a.visits(from, to) / a.visits(to, to), 1e-13);
  }
}

// 9 x 9 cells of 87 states, with and without a limit: the probability equals that of committor.h,
// and all endings sum to 1.
TEST(FirstPassage, OfEndingsIsTheCommittor) {
  const Chain chain = Chain::from_counts(lattice_counts(3), never_down());
  for (const int most : {0, 13}) {
    std::vector<double> all(9 * 9 * 87, 0.0);
    for (std::size_t e = 0; e + 1 < kEndings; ++e) {
      const auto ending = static_cast<Ending>(e);
      const FirstPassages f = first_passages(chain, kNineByNine, {.ending = ending}, most);
      const EndingChance h(chain, kNineByNine, ending, most);
      for (std::size_t i = 0; i < all.size(); ++i) {
        all[i] += f.chance[i];
        const double v = h(1, static_cast<std::int64_t>(i / 87), static_cast<std::int64_t>(i % 87));
        ASSERT_NEAR(f.chance[i], v, 1e-11 * v) << "ending " << e << " pair " << i;
      }
    }
    for (const double sum : all) ASSERT_NEAR(sum, 1.0, 1e-13);
  }
}

// Too many pairs to eliminate: sweeps, upwards and with ways back, satisfy the equations.
TEST(FirstPassage, OfLargeFieldsSolvesItsEquationsToo) {
  const Field field{16, 16};
  for (const bool back : {false, true}) {
    const FieldChain chain =
        Chain::from_counts(lattice_counts(3), back ? lattice_exits() : never_down());
    const Rewards times = times_of(chain);
    const PassageTarget target{.cell = 9 * 16 + 5};
    const FirstPassages f = first_passages(chain, field, target, 0, times);
    const auto n = static_cast<Eigen::Index>(f.chance.size());
    Expected x{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
    for (int input = 0; input < 87; ++input) x.chance[*target.cell * 87 + input] = 1.0;
    const auto of_all = [&](const std::vector<double>& mean, std::ptrdiff_t next) {
      const double h = f.chance[static_cast<std::size_t>(next)];
      return h > 0.0 ? h * mean[static_cast<std::size_t>(next)] : 0.0;
    };
    Equations{chain, field, target, times}.each(
        false, [&](std::size_t pair, double p, double t, bool reaches, std::ptrdiff_t next) {
          const auto at = static_cast<Eigen::Index>(pair);
          if (next < 0) return;
          const double h = reaches ? 1.0 : f.chance[static_cast<std::size_t>(next)];
          x.chance[at] += p * h;
          x.draws[at] += p * (h + of_all(f.draws, next));
          x.time[at] += p * (t * h + of_all(f.totals[0], next));
        });
    expect_equal(f, x, 3e-12);
    EXPECT_GT(f.chance[8 * 87], 0.0);
  }
}

TEST(FirstPassage, KnowsRowsNeverSampledAndWalksThatNeverEnd) {
  // State 0 goes on to 1 or to 2, which is unsampled; 1 circles for ever.
  const Chain chain = Chain::from_probabilities(
      matrix(3, 4, {{0, 1, 0.25}, {0, 2, 0.25}, {0, 3, 0.5}, {1, 1, 1.0}}),
      {{0, 0, 1}, {1, 0, 0}, {2, 0, 0}, {}});
  const FirstPassages trapped = first_passages(chain, {1, 1}, {.ending = Ending::trapped}, 0);
  EXPECT_EQ(trapped.chance, (std::vector<double>{0.5, 0.0, 0.0}));
  EXPECT_EQ(trapped.never_sampled, (std::vector<double>{0.25, 0.0, 1.0}));
  EXPECT_EQ(trapped.draws[0], 1.0);
  EXPECT_TRUE(std::isnan(trapped.draws[1]));
  const FirstPassages there = first_passages(chain, {1, 1}, {.input = 2}, 0);
  EXPECT_EQ(there.chance, (std::vector<double>{0.25, 0.0, 1.0}));
  EXPECT_EQ(there.never_sampled, (std::vector<double>{0.0, 0.0, 0.0}));
}

TEST(FirstPassage, RefusesWhatIsNoTarget) {
  const Chain chain = game(0.5);
  EXPECT_THROW((void)first_passages(chain, {1, 3}, {}, 0), std::invalid_argument);
  EXPECT_THROW((void)first_passages(chain, {1, 3}, {.cell = 3}, 0), std::invalid_argument);
  EXPECT_THROW((void)first_passages(chain, {1, 3}, {.input = 1}, 0), std::invalid_argument);
  EXPECT_THROW((void)first_passages(chain, {1, 3}, {.ending = Ending::trapped, .cell = 1}, 0),
               std::invalid_argument);
  EXPECT_THROW((void)first_passages(chain, {1, 3}, {.cell = 1}, 0, {{}, {}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace gatewalk::markov
