// SPDX-License-Identifier: MIT
#include "markov/predict.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "chains.h"
#include "markov/solvers.h"
#include "markov/walk.h"
#include "tests/support/propagation.h"

namespace gatewalk::markov {
namespace {

using test::Entry;
using test::kBottomCentre;
using test::kNineByNine;
using test::lattice_counts;
using test::lattice_exits;
using test::matrix;
using test::nearly_closed;
using test::propagate;
using RowMethod = PredictOptions::RowMethod;
using Solver = PredictOptions::Solver;

constexpr double kEps = std::numeric_limits<double>::epsilon();
constexpr std::array kLimits = {1, 2, 3, 13};

FinalDistribution by_steps(const FieldChain& chain, const Field& field, const Start& start,
                           PredictOptions options = {}) {
  options.solver = Solver::steps;
  return predict(chain, field, {start}, options).front();
}

double ends(const FinalDistribution& d) {
  return d.trapped() + d.left_field() + d.cut_off() + d.unsampled();
}

void expect_whole(const FinalDistribution& d) {
  EXPECT_NEAR(d.final_cells.sum() + d.remainder, 1.0, 1e-12);
  EXPECT_NEAR(ends(d) + d.remainder, 1.0, 1e-12);
  EXPECT_GE(d.final_cells.minCoeff(), 0.0);
  test::expect_endings_add_up(d);
}

void expect_near(const FinalDistribution& a, const FinalDistribution& b, double bound) {
  EXPECT_LE((a.final_cells - b.final_cells).abs().maxCoeff(), bound);
  EXPECT_NEAR(a.trapped(), b.trapped(), bound);
  EXPECT_NEAR(a.left_field(), b.left_field(), bound);
  EXPECT_NEAR(a.cut_off(), b.cut_off(), bound);
  EXPECT_NEAR(a.unsampled(), b.unsampled(), bound);
}

// Bernstein: a binomial count deviates more than this with a probability below 2 e^-20 = 4e-9.
void expect_binomial(std::int64_t count, std::int64_t n, double p) {
  const double variance = static_cast<double>(n) * p * (1 - p);
  const double bound = std::sqrt(2 * 20 * variance) + 2 * 20 / 3.0;
  EXPECT_LE(std::abs(static_cast<double>(count) - static_cast<double>(n) * p), bound)
      << "of " << n << " with p " << p;
}

void expect_walks_agree(const Chain& chain, const Field& field, const Start& start, int max_cells,
                        const FinalDistribution& d, std::int64_t n) {
  const WalkTally tally = Walker(chain).walk(field, start, max_cells, 11, {0, n});
  expect_binomial(tally.trapped(), n, d.trapped());
  expect_binomial(tally.left_field(), n, d.left_field());
  expect_binomial(tally.cut_off(), n, d.cut_off());
  expect_binomial(tally.unsampled(), n, d.unsampled());
  for (int row = 0; row < field.rows; ++row) {
    for (int column = 0; column < field.columns; ++column) {
      expect_binomial(tally.final_cells(row, column), n, d.final_cells(row, column));
    }
  }
}

Chain lattice_chain(std::uint64_t seed, std::initializer_list<int> emptied = {}) {
  Counts counts = lattice_counts(seed);
  for (const int row : emptied) test::empty_row(counts, row);
  return Chain::from_counts(counts, lattice_exits());
}

// ---- Closed forms ----

// Knuth and Yao: a fair die from fair coins. Inputs 0 ... 6 are the flips, all in cell 0; face k is
// in cell k and is trapped there (input 7).
Chain knuths_die() {
  constexpr int kFace = 7;
  std::vector<Exit> exits;
  for (int state = 0; state < 7; ++state) exits.push_back({state, 0, 0});   // outputs 0 ... 6
  for (int face = 1; face <= 6; ++face) exits.push_back({kFace, face, 0});  // 7 ... 12
  exits.push_back({});                                                      // 13
  const auto face = [](int k) { return 6 + k; };
  const std::array<std::array<int, 2>, 7> flips = {
      {{1, 2}, {3, 4}, {5, 6}, {1, face(1)}, {face(2), face(3)}, {face(4), face(5)}, {2, face(6)}}};
  std::vector<Entry> entries = {{kFace, 13, 1.0}};
  for (int state = 0; state < 7; ++state) {
    for (const int output : flips[static_cast<std::size_t>(state)]) {
      entries.push_back({state, output, 0.5});
    }
  }
  return Chain::from_probabilities(matrix(8, 14, entries), exits);
}

TEST(Exact, KnuthsDieIsFair) {
  const Chain die = knuths_die();
  const Field table{7, 1};
  for (const FinalDistribution& d : {solve_absorption(die, table, {}), by_steps(die, table, {})}) {
    expect_whole(d);
    EXPECT_EQ(d.final_cells(0, 0), 0.0);
    for (int face = 1; face <= 6; ++face) {
      EXPECT_NEAR(d.final_cells(0, face), 1.0 / 6.0, d.remainder + 4 * kEps);
    }
    EXPECT_NEAR(d.mean_steps, 11.0 / 3.0 + 1.0, 1e-11);  // the flips, and the trap
    EXPECT_LE(d.remainder, 1e-13);
  }
  constexpr std::int64_t kWalks = 1'000'000;
  const WalkTally tally = Walker(die).walk(table, {}, 0, 5, {0, kWalks});
  for (int face = 1; face <= 6; ++face) {
    expect_binomial(tally.final_cells(0, face), kWalks, 1.0 / 6.0);
  }
  // Flips come in rounds: 3 with probability 3/4, else 2 more; the variance of their number is
  // 20/9.
  const double mean = static_cast<double>(tally.steps) / kWalks;
  EXPECT_NEAR(mean, 14.0 / 3.0, 6 * std::sqrt(20.0 / 9.0 / kWalks));
}

// A line of `length` cells: right with p, else left; both ends leave the field.
Chain ruin(double p) {
  return Chain::from_probabilities(matrix(1, 2, {{0, 0, p}, {0, 1, 1 - p}}),
                                   {{0, 1, 0}, {0, -1, 0}});
}

TEST(Exact, GamblersRuin) {
  const int length = 160;
  for (const double p : {0.5, 0.51, 0.4}) {
    const Chain chain = ruin(p);
    for (const int column : {0, 79, 80, 159}) {
      const Start start{column, 0, 0};
      const double i = column + 1, n = length + 1, q = (1 - p) / p;
      const double wins =
          p == 0.5 ? i / n : std::expm1(i * std::log(q)) / std::expm1(n * std::log(q));
      const FinalDistribution solved = solve_absorption(chain, {length, 1}, start);
      expect_whole(solved);
      // The condition of this matrix is about n^2 = 2.6e4.
      EXPECT_NEAR(solved.final_cells(0, length - 1), wins, 3e4 * kEps);
      EXPECT_NEAR(solved.final_cells(0, 0), 1 - wins, 3e4 * kEps);
      EXPECT_NEAR(solved.left_field(), 1.0, 3e4 * kEps);
      const double mean = p == 0.5 ? i * (n - i) : (i - n * wins) / (1 - 2 * p);
      EXPECT_NEAR(solved.mean_steps / mean, 1.0, 3e4 * kEps);

      // Whether stopped early or late, the truth lies between the sum and the sum plus the
      // remainder.
      if (column != 80) continue;
      for (const double tolerance : {0.5, 1e-6, 1e-13}) {
        const FinalDistribution d = by_steps(chain, {length, 1}, start, {.tolerance = tolerance});
        expect_whole(d);
        EXPECT_LE(d.remainder, tolerance);
        EXPECT_LE(d.final_cells(0, length - 1), wins + 1e-12);
        EXPECT_GE(d.final_cells(0, length - 1) + d.remainder, wins - 1e-12);
      }
    }
  }
}

// State a in cell 0 <-> b in cell 1: a goes on with pa, b with pb; otherwise the walk is trapped
// where it is.
TEST(Exact, TwoStateLoopIsGeometric) {
  const double pa = 0.75, pb = 0.5;
  const Chain chain = Chain::from_probabilities(
      matrix(2, 3, {{0, 0, pa}, {0, 2, 1 - pa}, {1, 1, pb}, {1, 2, 1 - pb}}),
      {{1, 1, 0}, {0, -1, 0}, {}});
  const Field field{2, 1};
  const auto rounds = [&](int n) { return (1 - std::pow(pa * pb, n)) / (1 - pa * pb); };
  const FinalDistribution solved = solve_absorption(chain, field, {});
  EXPECT_NEAR(solved.final_cells(0, 0), (1 - pa) / (1 - pa * pb), 4 * kEps);
  EXPECT_NEAR(solved.final_cells(0, 1), pa * (1 - pb) / (1 - pa * pb), 4 * kEps);
  EXPECT_NEAR(solved.mean_steps, (1 + pa) / (1 - pa * pb), 8 * kEps);
  for (int n = 1; n <= 20; ++n) {
    const FinalDistribution even = by_steps(chain, field, {}, {.max_cells = 2 * n});
    const double on = std::pow(pa * pb, n);
    EXPECT_NEAR(even.cut_off(), on, 4 * kEps);
    EXPECT_NEAR(even.final_cells(0, 0), (1 - pa) * rounds(n), 4 * kEps);
    EXPECT_NEAR(even.final_cells(0, 1), pa * (1 - pb) * rounds(n) + on, 4 * kEps);
    EXPECT_NEAR(even.mean_steps, (1 + pa) * rounds(n), 16 * kEps);
    EXPECT_EQ(even.steps, 2 * n);
    EXPECT_EQ(even.remainder, 0.0);
    const FinalDistribution odd = by_steps(chain, field, {}, {.max_cells = 2 * n - 1});
    EXPECT_NEAR(odd.cut_off(), on / pb, 4 * kEps);
  }
}

// ---- The rules of a single step ----

TEST(Exact, WhereAStepEnds) {
  // Input 0 always moves right, input 1 is unsampled, input 2 is trapped.
  const Probabilities p = matrix(3, 4, {{0, 0, 0.5}, {0, 1, 0.5}, {2, 3, 1.0}});
  const Chain chain = Chain::from_probabilities(p, {{0, 1, 0}, {1, 1, 0}, {2, 1, 0}, {}});
  const Field field{3, 1};
  const auto expect = [&](const Start& start, int max_cells, std::array<double, 3> cells,
                          double trapped, double left, double cut, double unsampled) {
    FinalDistribution wanted;
    wanted.final_cells = Eigen::Map<CellProbabilities>(cells.data(), 1, 3);
    const auto set = [&](Ending e, double share) {
      wanted.endings[static_cast<std::size_t>(e)] = share;
    };
    set(Ending::trapped, trapped);
    set(Ending::right_edge, left);
    set(Ending::cut_off, cut);
    set(Ending::unsampled, unsampled);
    expect_near(by_steps(chain, field, start, {.max_cells = max_cells}), wanted, 0.0);
    expect_near(propagate(chain, field, start, {.max_cells = max_cells}), wanted, 0.0);
    if (max_cells == 0) expect_near(solve_absorption(chain, field, start), wanted, 2 * kEps);
    expect_walks_agree(chain, field, start, max_cells, wanted, 1000);
  };
  // One cell: a walk that would go on is cut off where it is, for any state that it would enter.
  expect({0, 0, 0}, 1, {1, 0, 0}, 0, 0, 1, 0);
  // The last permitted cell: a walk that enters it in a sampled state is cut off there, in an
  // unsampled state it is unsampled.
  expect({0, 0, 0}, 2, {0, 1, 0}, 0, 0, 0.5, 0.5);
  // Outside the field nothing is cut off or unsampled.
  expect({2, 0, 0}, 1, {0, 0, 1}, 0, 1, 0, 0);
  expect({0, 0, 0}, 3, {0, 0.5, 0.5}, 0, 0.25, 0, 0.75);
  expect({0, 0, 0}, 0, {0, 0.5, 0.5}, 0, 0.25, 0, 0.75);
  for (const int max_cells : {0, 1, 5}) {
    expect({1, 0, 1}, max_cells, {0, 1, 0}, 0, 0, 0, 1);  // starts unsampled
    expect({1, 0, 2}, max_cells, {0, 1, 0}, 1, 0, 0, 0);  // trapped at once
  }
  EXPECT_EQ(by_steps(chain, field, {1, 0, 1}, {.max_cells = 5}).mean_steps, 0.0);
  EXPECT_EQ(by_steps(chain, field, {1, 0, 1}, {.max_cells = 5}).steps, 0);
}

// Up 1/2, left and right 1/8, trapped 1/4, from the middle of the first row of 3 x 3 cells. If a
// row is entered by (x, y, x), its middle is visited m = (y + x/4) 32/31 times and each side x +
// m/8 times.
TEST(Exact, EndingsOfThreeByThreeAreFractions) {
  const Chain chain = Chain::from_probabilities(
      matrix(1, 4, {{0, 0, 0.5}, {0, 1, 0.125}, {0, 2, 0.125}, {0, 3, 0.25}}),
      {{0, 0, 1}, {0, -1, 0}, {0, 1, 0}, {}});
  const Field field{3, 3};
  const Start start{1, 0, 0};
  const Predictor predictor(chain);
  const auto expect = [&](const FinalDistribution& d, double far, double side, double trapped,
                          double cut, double bound) {
    const std::array<double, kEndings> wanted{trapped, far, side, side, 0.0, cut, 0.0};
    for (std::size_t e = 0; e < kEndings; ++e)
      EXPECT_NEAR(d.endings[e], wanted[e], bound) << "ending " << e;
    expect_whole(d);
  };
  const auto expect_all = [&](int max_cells, double far, double side, double trapped, double cut) {
    constexpr double kBound = 1e-12;  // largest share still under way
    expect(propagate(chain, field, start, {.max_cells = max_cells}), far, side, trapped, cut,
           kBound);
    expect(predictor.predict(field, start, {.max_cells = max_cells, .solver = Solver::steps}), far,
           side, trapped, cut, kBound);
    expect(predictor.predict(field, start, {.max_cells = max_cells}), far, side, trapped, cut,
           kBound);
    for (const bool plainly : {false, true}) {
      constexpr std::int64_t kWalks = 100'000;
      const Walker walker(chain);
      const WalkTally t = plainly ? walker.walk_plainly(field, start, max_cells, 5, {0, kWalks})
                                  : walker.walk(field, start, max_cells, 6, {0, kWalks});
      const std::array<double, kEndings> shares{trapped, far, side, side, 0.0, cut, 0.0};
      for (std::size_t e = 0; e < kEndings; ++e) expect_binomial(t.endings[e], kWalks, shares[e]);
    }
  };
  const double whole = 29791.0;
  expect_all(0, 7584 / whole, 2729 / (2 * whole), 19478 / whole, 0.0);
  expect(solve_absorption(chain, field, start), 7584 / whole, 2729 / (2 * whole), 19478 / whole,
         0.0, 1e-14);
  for (const auto method : {RowMethod::elimination, RowMethod::sums})
    expect(predictor.predict(field, start,
                             {.solver = Solver::rows, .row_method = method, .tolerance = 1e-14}),
           7584 / whole, 2729 / (2 * whole), 19478 / whole, 0.0, 1e-13);
  expect_all(2, 0.0, 1 / 64.0, 7 / 16.0, 17 / 32.0);
  // Walks that leave are last in the edge cells: over the far edge from row 2, over the sides from
  // columns 0 and 2.
  const FinalDistribution d = by_steps(chain, field, start);
  const CellProbabilities departed = departed_cells(d), trapped = trapped_cells(d);
  EXPECT_EQ(departed(0, 1), 0.0);
  EXPECT_EQ(departed(1, 1), 0.0);
  EXPECT_NEAR(departed(2, 1), 0.5 * 8960 / whole, 1e-13);
  EXPECT_NEAR(departed(0, 0), 4 / 31.0 / 8, 1e-13);
  EXPECT_NEAR(departed(2, 2), (0.5 + 0.125) * 3104 / whole, 1e-13);
  EXPECT_NEAR(trapped(0, 1), 8 / 31.0, 1e-13);
  EXPECT_NEAR(trapped(1, 0), 32 / 961.0, 1e-13);
}

// ---- Second routes on chains of the paper's shape ----

TEST(Exact, PredictionIsThePlainPropagation) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Chain chain = lattice_chain(seed, {3, 30, 61});
    for (const int max_cells : kLimits) {
      for (const Start& start : {kBottomCentre, Start{0, 8, 40}, Start{8, 0, 86}}) {
        const FinalDistribution d = by_steps(chain, kNineByNine, start, {.max_cells = max_cells});
        expect_whole(d);
        EXPECT_EQ(d.remainder, 0.0);
        const FinalDistribution plain =
            propagate(chain, kNineByNine, start, {.max_cells = max_cells});
        // Positive numbers only: an eps or so for each of up to 13 steps.
        expect_near(d, plain, 8 * kEps);
        EXPECT_NEAR(d.mean_steps / plain.mean_steps, 1.0, 8 * kEps);
      }
    }
  }
}

TEST(Exact, PropagationSolveAndWalksAgree) {
  const Chain chain = lattice_chain(7, {20, 70});
  const FinalDistribution far = by_steps(chain, kNineByNine, kBottomCentre);
  const FinalDistribution solved = solve_absorption(chain, kNineByNine, kBottomCentre);
  expect_whole(far);
  expect_whole(solved);
  EXPECT_LE(far.remainder, 1e-13);
  EXPECT_GT(far.steps, 13);
  EXPECT_GT(solved.unsampled(), 0.0);
  EXPECT_EQ(solved.cut_off(), 0.0);
  expect_near(far, solved, far.remainder + 64 * kEps);
  // The remainder would go on for some 30 draws.
  EXPECT_NEAR(far.mean_steps, solved.mean_steps, 1e-11);
  expect_walks_agree(chain, kNineByNine, kBottomCentre, 0, solved, 1'000'000);
  for (const int max_cells : kLimits) {
    expect_walks_agree(chain, kNineByNine, kBottomCentre, max_cells,
                       by_steps(chain, kNineByNine, kBottomCentre, {.max_cells = max_cells}),
                       300'000);
  }
}

TEST(Exact, EachEmptiedRowIsReportedWithItsMass) {
  const Field field{5, 5};
  const Start start{2, 0, 12};
  double mass_of_all = 0.0;
  for (int row = 0; row < 87; ++row) {
    const Chain chain = lattice_chain(1, {row});
    EXPECT_EQ(chain.unsampled_rows(), 1);
    const FinalDistribution d = by_steps(chain, field, start, {.max_cells = 13});
    expect_whole(d);
    expect_near(d, propagate(chain, field, start, {.max_cells = 13}), 8 * kEps);
    // Some mass enters every row that some output leads to.
    EXPECT_GT(d.unsampled(), 0.0) << "row " << row;
    mass_of_all += d.unsampled();
    const WalkTally tally = Walker(chain).walk(field, start, 13, 9, {0, 20'000});
    expect_binomial(tally.unsampled(), 20'000, d.unsampled());
  }
  EXPECT_GT(mass_of_all, 1.0);  // a walk enters several rows
}

TEST(Exact, PartlyEmptyFieldsAndLongMoves) {
  // A knight on a 4 x 3 board: moves by two, most of them lead out.
  Counts counts(1, 5);
  const std::vector<Exit> exits = {{0, 2, 1}, {0, -1, 2}, {0, -2, -1}, {0, 1, -2}, {}};
  for (int j = 0; j < 5; ++j) counts.coeffRef(0, j) = j + 1;
  const Chain chain = Chain::from_counts(counts, exits);
  for (const int max_cells : kLimits) {
    expect_near(by_steps(chain, {4, 3}, {1, 1, 0}, {.max_cells = max_cells}),
                propagate(chain, {4, 3}, {1, 1, 0}, {.max_cells = max_cells}), 8 * kEps);
  }
}

// ---- Rows that differ ----

// Brute force: all (cell, input) pairs in one dense matrix; visits by its inverse or (with a limit)
// by its powers; then each output of each visit is evaluated once.
FinalDistribution densely(const std::vector<Chain>& chain_of_row, const Field& field,
                          const Start& start, int max_cells) {
  const int n = chain_of_row.front().inputs(), cells = field.columns * field.rows;
  const auto state = [&](int column, int row, int input) {
    return (row * field.columns + column) * n + input;
  };
  struct Draw {
    double p;
    int next;  // a state, or an ending (below)
  };
  enum : int { kTrapped = -1, kLeft = -2 };
  const auto draws = [&](int s) {
    const int column = s / n % field.columns, row = s / n / field.columns;
    std::vector<Draw> all;
    const Chain& chain = chain_of_row[static_cast<std::size_t>(row)];
    for (int j = 0; j < chain.outputs(); ++j) {
      const Exit& exit = chain.exits()[static_cast<std::size_t>(j)];
      const int c = column + exit.di_x, r = row + exit.di_y;
      const bool inside = c >= 0 && c < field.columns && r >= 0 && r < field.rows;
      all.push_back({chain.matrix().coeff(s % n, j), exit.next_input == Exit::kTrapped ? kTrapped
                                                     : inside ? state(c, r, exit.next_input)
                                                              : kLeft});
    }
    return all;
  };
  const auto sampled = [&](int s) {
    return chain_of_row[static_cast<std::size_t>(s / n / field.columns)].is_sampled(s % n);
  };
  Eigen::MatrixXd q = Eigen::MatrixXd::Zero(n * cells, n * cells);
  for (int s = 0; s < n * cells; ++s)
    for (const Draw& d : draws(s))
      if (d.next >= 0) q(d.next, s) += d.p;
  Eigen::VectorXd now = Eigen::VectorXd::Zero(n * cells), visits = now, last = now;
  now(state(start.column, start.row, start.input)) = 1.0;
  if (max_cells == 0) {
    visits = (Eigen::MatrixXd::Identity(n * cells, n * cells) - q).partialPivLu().solve(now);
  } else {
    for (int k = 1; k < max_cells; ++k) {
      visits += now;
      now = q * now;
    }
    last = now;
  }
  FinalDistribution d;
  d.final_cells = CellProbabilities::Zero(field.rows, field.columns);
  for (int s = 0; s < n * cells; ++s) {
    const auto end = [&](Ending why, double mass) {
      d.endings[static_cast<std::size_t>(why)] += mass;
      d.final_cells.data()[s / n] += mass;
    };
    if (!sampled(s)) end(Ending::unsampled, visits(s) + last(s));
    for (const Draw& draw : draws(s)) {
      if (draw.next == kTrapped) end(Ending::trapped, draw.p * (visits(s) + last(s)));
      if (draw.next == kLeft) end(Ending::left_edge, draw.p * (visits(s) + last(s)));
      if (draw.next >= 0) end(Ending::cut_off, draw.p * last(s));
    }
  }
  return d;
}

TEST(Exact, RowsThatDifferAreTheDenseSolution) {
  // Another chain in each row, some inputs sampled in only one of them.
  std::vector<Chain> chains;
  for (const std::uint64_t seed : {1, 2, 3}) {
    Counts counts = lattice_counts(seed);
    for (int row = 0; row < 87; ++row)
      if ((row + static_cast<int>(seed)) % 5 == 0) test::empty_row(counts, row);
    chains.push_back(Chain::from_counts(counts, lattice_exits()));
  }
  for (const std::vector<int>& of_row : {std::vector{0, 1, 2}, {2, 0, 0}, {1, 1, 1}}) {
    const FieldChain rows = FieldChain::by_row(chains, of_row);
    std::vector<Chain> each;
    for (const int k : of_row) each.push_back(chains[static_cast<std::size_t>(k)]);
    for (const Start start : {Start{1, 0, 11}, {0, 1, 30}, {2, 2, 86}}) {
      const Field field{3, 3};
      for (const int max_cells : {1, 2, 5, 0}) {
        const FinalDistribution brute = densely(each, field, start, max_cells);
        const FinalDistribution d = by_steps(rows, field, start, {.max_cells = max_cells});
        expect_whole(d);
        expect_near(d, brute, d.remainder + 1e-13);
        if (max_cells == 0) expect_near(solve_absorption(rows, field, start), brute, 1e-13);
        if (of_row == std::vector{1, 1, 1})
          expect_near(by_steps(chains[1], field, start, {.max_cells = max_cells}), d, 0.0);
      }
    }
  }
}

TEST(Exact, RefusesRowsThatDoNotFit) {
  const Chain one = ruin(0.5), two = nearly_closed(0.5);
  EXPECT_THROW((void)FieldChain::by_row({}, {}), std::invalid_argument);
  EXPECT_THROW((void)FieldChain::by_row({one, two}, {0, 1}), std::invalid_argument);
  EXPECT_THROW((void)FieldChain::by_row({one}, {0, 1}), std::invalid_argument);
  EXPECT_THROW((void)FieldChain::by_row({one}, {-1}), std::invalid_argument);
  const FieldChain rows = FieldChain::by_row({one, one}, {0, 1});
  EXPECT_NO_THROW((void)by_steps(rows, {3, 2}, {}, {.max_cells = 1}));
  EXPECT_THROW((void)by_steps(rows, {3, 1}, {}, {.max_cells = 1}), std::invalid_argument);
  EXPECT_THROW((void)solve_absorption(rows, {3, 3}, {}), std::invalid_argument);
}

// ---- Chains that (almost) never end ----

TEST(Exact, AClosedLoopHasNoSolution) {
  // Three states of 1/3 each that never leave, entered with probability 1/2.
  std::vector<Entry> entries = {{0, 1, 0.5}, {0, 4, 0.5}};
  for (int from = 1; from <= 3; ++from) {
    for (int to = 1; to <= 3; ++to) entries.push_back({from, to, 1.0 / 3.0});
  }
  const Chain chain = Chain::from_probabilities(matrix(4, 5, entries),
                                                {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {}});
  EXPECT_THROW((void)solve_absorption(chain, {1, 1}, {}), std::runtime_error);
  const FinalDistribution d = by_steps(chain, {1, 1}, {}, {.tolerance = 1e-13, .max_steps = 100});
  EXPECT_EQ(d.steps, 100);
  EXPECT_EQ(d.trapped(), 0.5);
  EXPECT_NEAR(d.remainder, 0.5, 100 * kEps);
  // From inside the loop the result is the same, also for a loop of one state.
  EXPECT_THROW((void)solve_absorption(chain, {1, 1}, {0, 0, 1}), std::runtime_error);
  const Chain one = Chain::from_probabilities(matrix(1, 1, {{0, 0, 1.0}}), {{0, 0, 0}});
  EXPECT_THROW((void)solve_absorption(one, {1, 1}, {}), std::runtime_error);
  EXPECT_EQ(by_steps(one, {1, 1}, {}, {.tolerance = 0.0, .max_steps = 7}).remainder, 1.0);
  // Rounding may make the row's sum 1 +- 1e-16: still a loop.
  for (const double p : {1.0 / 6, 0.1, 0.3, 1.0 / 7}) {
    const Chain parts =
        Chain::from_probabilities(matrix(1, 3, {{0, 0, p}, {0, 1, p}, {0, 2, 1.0 - 2 * p}}),
                                  {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
    EXPECT_THROW((void)solve_absorption(parts, {1, 1}, {}), std::runtime_error) << p;
  }
}

TEST(Exact, TheConditionGateKeepsSixDigits) {
  for (const double escape : {1e-3, 1e-6, 1e-9}) {
    const FinalDistribution d = solve_absorption(nearly_closed(escape), {2, 1}, {});
    EXPECT_NEAR(d.final_cells(0, 0), 1 / (2 - escape), 1e-6);
    EXPECT_NEAR(d.mean_steps * escape, 1.0, 1e-6);
  }
  for (const double escape : {1e-10, 1e-13, 1e-16, 1e-300}) {
    EXPECT_THROW((void)solve_absorption(nearly_closed(escape), {2, 1}, {}), std::runtime_error);
  }
}

TEST(Exact, AnEscapeOf1e300IsNotLost) {
  EXPECT_NEAR(by_steps(nearly_closed(1e-300), {2, 1}, {}, {.max_cells = 13}).trapped() / 13e-300,
              1.0, 16 * kEps);
}

TEST(Exact, RefusesWhatMakesNoSense) {
  const Chain chain = ruin(0.5);
  EXPECT_THROW((void)by_steps(chain, {3, 1}, {3, 0, 0}, {.max_cells = 1}), std::invalid_argument);
  EXPECT_THROW((void)by_steps(chain, {3, 1}, {}, {.max_cells = -1}), std::invalid_argument);
  EXPECT_THROW((void)by_steps(chain, {3, 1}, {}, {.tolerance = -1e-9}), std::invalid_argument);
  EXPECT_THROW((void)by_steps(chain, {3, 1}, {}, {.tolerance = std::nan("")}),
               std::invalid_argument);
  EXPECT_THROW((void)by_steps(chain, {3, 1}, {}, {.tolerance = 1e-9, .max_steps = -1}),
               std::invalid_argument);
  EXPECT_THROW((void)solve_absorption(chain, {3, 1}, {0, 1, 0}), std::invalid_argument);
}

}  // namespace
}  // namespace gatewalk::markov
