// SPDX-License-Identifier: MIT
#include "markov/predict.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>

#include "chains.h"
#include "markov/solvers.h"
#include "tests/support/instruction_sets.h"
#include "tests/support/propagation.h"

namespace gatewalk::markov {
namespace {

using test::Entry;
using test::kBottomCentre;
using test::kNineByNine;
using test::lattice_counts;
using test::lattice_exits;
using test::leaps;
using test::matrix;
using test::never_down;
using test::propagate;

using RowMethod = PredictOptions::RowMethod;
using Solver = PredictOptions::Solver;
constexpr std::array kMethods = {RowMethod::elimination, RowMethod::sweeps, RowMethod::sums};

void expect_near(const FinalDistribution& a, const FinalDistribution& b, double bound) {
  EXPECT_LE((a.final_cells - b.final_cells).abs().maxCoeff(), bound);
  EXPECT_NEAR(a.trapped(), b.trapped(), bound);
  EXPECT_NEAR(a.left_field(), b.left_field(), bound);
  EXPECT_NEAR(a.cut_off(), b.cut_off(), bound);
  EXPECT_NEAR(a.unsampled(), b.unsampled(), bound);
  test::expect_same_endings(a, b, bound);
}

void expect_whole(const FinalDistribution& d) {
  EXPECT_NEAR(d.final_cells.sum() + d.remainder, 1.0, 1e-12);
  EXPECT_NEAR(d.trapped() + d.left_field() + d.cut_off() + d.unsampled() + d.remainder, 1.0, 1e-12);
  EXPECT_GE(d.final_cells.minCoeff(), 0.0);
  test::expect_endings_add_up(d);
}

bool same_bits(const FinalDistribution& a, const FinalDistribution& b) {
  const auto bytes = sizeof(double) * static_cast<std::size_t>(a.final_cells.size());
  return a.final_cells.size() == b.final_cells.size() &&
         std::memcmp(a.final_cells.data(), b.final_cells.data(), bytes) == 0 &&
         a.remainder == b.remainder && a.mean_steps == b.mean_steps && a.rounding == b.rounding &&
         a.steps == b.steps && a.endings == b.endings && a.mixed_cells == b.mixed_cells;
}

Chain with_gaps(std::uint64_t seed, std::vector<Exit> exits) {
  Counts counts = lattice_counts(seed);
  for (const int row : {3, 40, 60}) test::empty_row(counts, row);
  return Chain::from_counts(counts, std::move(exits));
}

/// One output per row, and few rows are ever entered: no walk returns to some of the rows with
/// mass.
Chain thin(std::uint64_t seed, std::vector<Exit> exits) {
  test::Words words(seed);
  Counts counts(87, 88);
  for (int row = 0; row < 87; ++row) {
    if (row % 10 != 3) counts.coeffRef(row, row % 7 == 0 ? 87 : words.below(87)) = 1;
    if (row % 9 == 0) counts.coeffRef(row, words.below(88)) += 1;
  }
  return Chain::from_counts(counts, std::move(exits));
}

TEST(Predictor, PropagatesAsThePlainReferenceWhereFewRowsAreEntered) {
  for (const auto& exits : {lattice_exits(), never_down(), leaps()}) {
    for (const std::uint64_t seed : {1, 2, 3}) {
      const Chain chain = thin(seed, exits);
      const Predictor predictor(chain);
      for (int input = 0; input < 87; ++input) {
        for (const int limit : {1, 2, 3, 4, 5, 13}) {
          const Start start{2, 1, input};
          const auto plain = propagate(chain, {6, 5}, start, {.max_cells = limit});
          const auto fast =
              predictor.predict({6, 5}, start, {.max_cells = limit, .solver = Solver::steps});
          SCOPED_TRACE(std::to_string(input) + ", limit " + std::to_string(limit));
          expect_near(plain, fast, 1e-15);
          EXPECT_EQ(plain.steps, fast.steps);
        }
        if (!predictor.can_go_by_rows()) continue;
        try {
          const auto by_rows =
              predictor.predict({6, 5}, {2, 1, input},
                                {.solver = Solver::rows, .tolerance = 1e-13, .max_steps = 1000});
          expect_near(
              by_rows,
              propagate(chain, {6, 5}, {2, 1, input}, {.tolerance = 1e-13, .max_steps = 1000}),
              1e-12);
        } catch (const std::runtime_error&) {  // walks go left and right for ever
          EXPECT_GT(propagate(chain, {6, 5}, {2, 1, input}, {.tolerance = 1e-13, .max_steps = 1000})
                        .remainder,
                    0.1);
        }
      }
    }
  }
}

/// A random chain of up to 9 inputs, moves of up to 2 cells (with `up`: none down), rows of any
/// number of outputs.
Chain random_chain(test::Words& words, bool chequered, bool up) {
  const int inputs = 1 + words.below(9), outputs = 1 + words.below(14);
  std::vector<Exit> exits;
  Counts counts(inputs, outputs);
  for (int j = 0; j < outputs; ++j) {
    Exit exit{words.below(inputs), words.below(5) - 2, words.below(5) - 2};
    if (up) exit.di_y = std::abs(exit.di_y);
    if (chequered && (exit.di_x + exit.di_y) % 2 == 0) exit.di_x += 1;
    if (words.below(5) == 0) exit = {};
    exits.push_back(exit);
    for (int row = 0; row < inputs; ++row)
      if (words.below(3) == 0) counts.coeffRef(row, j) = 1 + words.below(9);
  }
  return Chain::from_counts(counts, exits);
}

TEST(Predictor, RandomChains) {
  test::Words words(1);
  for (int k = 0; k < 600; ++k) {
    SCOPED_TRACE(k);
    const Chain chain = random_chain(words, k % 2 == 0, k % 3 == 0);
    const Predictor predictor(chain);
    const Field field{1 + words.below(12), 1 + words.below(12)};
    std::vector<Start> starts;
    for (int j = 0; j < 1 + k % 5; ++j)
      starts.push_back(
          {words.below(field.columns), words.below(field.rows), words.below(chain.inputs())});
    const int limit = 1 + words.below(15);
    const auto fast =
        predictor.predict_all(field, starts, {.max_cells = limit, .solver = Solver::steps});
    const auto free = predictor.predict_all(
        field, starts, {.solver = Solver::steps, .tolerance = 1e-13, .max_steps = 60});
    for (std::size_t j = 0; j < starts.size(); ++j) {
      const auto plain = propagate(chain, field, starts[j], {.max_cells = limit});
      expect_near(plain, fast[j], 1e-14);
      EXPECT_EQ(plain.steps, fast[j].steps);
      const auto plainly_free =
          propagate(chain, field, starts[j], {.tolerance = 1e-13, .max_steps = 60});
      expect_near(plainly_free, free[j], 1e-14);
      EXPECT_NEAR(plainly_free.remainder, free[j].remainder, 1e-14);
      EXPECT_EQ(plainly_free.steps, free[j].steps);
      if (!predictor.can_go_by_rows()) continue;
      const auto far = propagate(chain, field, starts[j], {.tolerance = 1e-13, .max_steps = 2000});
      if (far.remainder > 1e-12) continue;  // walks circle
      for (const auto method : kMethods)
        expect_near(
            far,
            predictor.predict(field, starts[j],
                              {.solver = Solver::rows, .row_method = method, .tolerance = 1e-13}),
            1e-11);
    }
  }
}

TEST(Predictor, RowsThatDifferAreThePlainReference) {
  for (const auto& exits : {lattice_exits(), never_down(), leaps()}) {
    const std::vector<Chain> chains{with_gaps(1, exits), thin(2, exits),
                                    Chain::from_counts(lattice_counts(3), exits)};
    for (const std::vector<int>& of_row : {std::vector{0, 1, 2, 0, 1, 2, 2, 0},
                                           {2, 2, 2, 0, 0, 2, 2, 2},
                                           {1, 1, 1, 1, 1, 1, 1, 1},
                                           {0, 0, 0, 0, 0, 0, 0, 2}}) {
      const FieldChain rows = FieldChain::by_row(chains, of_row);
      const Predictor predictor(rows);
      for (const int columns : {1, 5, 9, 40}) {
        const Field field{columns, 8};
        const std::vector<Start> starts{
            {columns / 2, 0, 12}, {0, 3, 40}, {columns - 1, 7, 60}, {columns / 3, 2, 85}};
        for (const int limit : {1, 2, 13, 0}) {
          const auto fast = predictor.predict_all(
              field, starts,
              {.max_cells = limit, .solver = Solver::steps, .tolerance = 1e-13, .max_steps = 300});
          for (std::size_t k = 0; k < starts.size(); ++k) {
            const auto plain = propagate(
                rows, field, starts[k], {.max_cells = limit, .tolerance = 1e-13, .max_steps = 300});
            expect_near(plain, fast[k], 1e-14);
            EXPECT_NEAR(plain.remainder, fast[k].remainder, 1e-14);
            EXPECT_EQ(plain.steps, fast[k].steps);
          }
        }
        if (!predictor.can_go_by_rows()) continue;
        for (std::size_t k = 0; k < starts.size(); ++k) {
          const auto plain =
              propagate(rows, field, starts[k], {.tolerance = 1e-13, .max_steps = 300});
          if (plain.remainder > 1e-12) continue;  // walks circle in a row of few outputs
          for (const auto method : kMethods)
            expect_near(plain,
                        predictor.predict(
                            field, starts[k],
                            {.solver = Solver::rows, .row_method = method, .tolerance = 1e-13}),
                        1e-12);
        }
      }
    }
  }
}

TEST(Predictor, CellsThatDifferAreThePlainReference) {
  test::Words words(9);
  for (const auto& exits : {lattice_exits(), never_down(), leaps()}) {
    const std::vector<Chain> chains{with_gaps(1, exits), thin(2, exits),
                                    Chain::from_counts(lattice_counts(3), exits)};
    for (const int columns : {1, 5, 9, 40}) {
      const Field field{columns, 8};
      std::vector<int> types;
      for (int cell = 0; cell < columns * field.rows; ++cell) types.push_back(words.below(3));
      const FieldChain cells = FieldChain::by_cell(chains, columns, types);
      const Predictor predictor(cells);
      const std::vector<Start> starts{
          {columns / 2, 0, 12}, {0, 3, 40}, {columns - 1, 7, 60}, {columns / 3, 2, 85}};
      for (const int limit : {1, 2, 13, 0}) {
        const PredictOptions options{
            .max_cells = limit, .solver = Solver::steps, .tolerance = 1e-13, .max_steps = 300};
        const auto fast = predictor.predict_all(field, starts, options);
        for (std::size_t k = 0; k < starts.size(); ++k) {
          const auto plain = propagate(cells, field, starts[k], options);
          expect_near(plain, fast[k], 1e-14);
          EXPECT_NEAR(plain.remainder, fast[k].remainder, 1e-14);
        }
      }
    }
  }
}

// Rows longer than a register, so that whole registers have one type, or none of a type.
TEST(Predictor, LongStretchesOfATypeAreThePlainReference) {
  constexpr int kColumns = 45;
  std::vector<Chain> chains;
  for (const std::uint64_t seed : {1, 2})
    chains.push_back(Chain::from_counts(lattice_counts(seed), never_down()));
  std::vector<int> types;
  for (int cell = 0; cell < 4 * kColumns; ++cell)
    types.push_back(cell % kColumns < 20 + 3 * (cell / kColumns) ? 0 : 1);
  const FieldChain chain = FieldChain::by_cell(chains, kColumns, types);
  const Field field{kColumns, 4};
  for (const Start& start : {Start{4, 0, 12}, Start{22, 0, 12}, Start{40, 1, 30}}) {
    const FinalDistribution plain = propagate(chain, field, start);
    for (const RowMethod method : kMethods)
      expect_near(predict(chain, field, {start}, {.solver = Solver::rows, .row_method = method})[0],
                  plain, 1e-11);
    expect_near(predict(chain, field, {start}, {.solver = Solver::steps})[0], plain, 1e-11);
  }
}

// Equal chains are prepared twice and used in turn: not a bit changes.
TEST(Predictor, EqualChainsInTurnHaveTheBitsOfOne) {
  for (const auto& exits : {never_down(), leaps()}) {
    const Chain chain = with_gaps(5, exits);
    const Predictor one(chain),
        two(FieldChain::by_row({chain, chain}, {0, 1, 1, 0, 1, 0, 0, 0, 1}));
    const std::vector<Start> starts{{4, 0, 12}, {1, 5, 33}};
    for (const int limit : {2, 13, 0}) {
      const auto a = one.predict_all(kNineByNine, starts, {.max_cells = limit}),
                 b = two.predict_all(kNineByNine, starts, {.max_cells = limit});
      for (std::size_t k = 0; k < starts.size(); ++k) EXPECT_TRUE(same_bits(a[k], b[k])) << limit;
    }
    EXPECT_THROW((void)two.predict({9, 8}, kBottomCentre, {.max_cells = 13}),
                 std::invalid_argument);
    EXPECT_THROW((void)two.predict({9, 10}, kBottomCentre), std::invalid_argument);
  }
}

TEST(Predictor, PropagatesAsThePlainReference) {
  const std::vector<std::pair<Field, Start>> places{
      {kNineByNine, kBottomCentre}, {{1, 1}, {0, 0, 5}},  {{3, 5}, {2, 4, 80}},
      {{20, 2}, {0, 1, 30}},        {{2, 20}, {1, 7, 0}}, {{64, 8}, {63, 7, 9}}};
  for (const auto& exits : {lattice_exits(), never_down(), leaps()}) {
    for (const std::uint64_t seed : {1, 2}) {
      const Chain chain = with_gaps(seed, exits);
      const Predictor predictor(chain);
      for (const auto& [field, start] : places) {
        for (const int limit : {1, 2, 3, 13, 0}) {
          SCOPED_TRACE(std::to_string(field.columns) + " x " + std::to_string(field.rows) +
                       ", limit " + std::to_string(limit));
          const auto plain = propagate(chain, field, start, {.max_cells = limit});
          const auto fast =
              predictor.predict(field, start, {.max_cells = limit, .solver = Solver::steps});
          expect_near(plain, fast, 1e-14);
          expect_whole(fast);
          EXPECT_EQ(plain.steps, fast.steps);
          EXPECT_NEAR(plain.mean_steps, fast.mean_steps, 1e-12);
          EXPECT_NEAR(plain.remainder, fast.remainder, 1e-15);
        }
      }
    }
  }
}

// Mass that goes up by two rows and out of the field has left, and must not also remain; a loose
// tolerance would show it.
TEST(Predictor, LeapsOutOfTheTopAreCountedOnce) {
  const Chain chain = Chain::from_probabilities(
      matrix(2, 4, {{0, 2, 1.0}, {1, 0, 0.05}, {1, 1, 0.01}, {1, 3, 0.94}}),
      {{0, 0, 1}, {1, 0, 2}, {1, 0, 1}, {}});
  for (const RowMethod method : kMethods)
    expect_whole(Predictor(chain).predict(
        {1, 3}, {0, 0, 0}, {.solver = Solver::rows, .row_method = method, .tolerance = 0.3}));
}

// Two states that rarely leave each other, among many states that leave at once.
TEST(Predictor, FindsAFewThatCircleForLong) {
  constexpr int n = 40;
  std::vector<Entry> entries;
  std::vector<Exit> exits;
  for (int i = 0; i < n; ++i) {
    entries.push_back({i, i, i < 2 ? 1.0 - 1e-6 : 0.1});
    entries.push_back({i, n, i < 2 ? 1e-6 : 0.9});
    exits.push_back({i < 2 ? 1 - i : i, i % 2 == 0 ? 1 : -1, 0});
  }
  exits.push_back({});
  const Chain chain = Chain::from_probabilities(matrix(n, n + 1, entries), exits);
  const auto d = Predictor(chain).predict({5, 1}, {2, 0, 0});
  EXPECT_NEAR(d.final_cells.sum() + d.remainder, 1.0,
              d.rounding + 1e-13);  // some 10^6 moves are rounded
  EXPECT_LT(d.rounding, 1e-6);
  expect_near(d, solve_absorption(chain, {5, 1}, {2, 0, 0}), 1e-9);
}

// With few runs a state often has none that leaves the row; only how long walks stay in the row
// matters. Sweeps are then cheaper than dense elimination of many states.
TEST(Predictor, TakesSweepsWhereWalksSoonLeaveTheRow) {
  constexpr int n = 400;
  std::vector<Entry> entries;
  std::vector<Exit> exits;
  for (int i = 0; i < n; ++i) {
    const int next = (7 * i + 3) % n;
    entries.push_back({i, next, i % 10 == 0 ? 1.0 : 0.2});
    if (i % 10 != 0) entries.push_back({i, n, 0.8});
    exits.push_back({i, i % 2 == 0 ? 1 : -1, 0});
  }
  exits.push_back({});
  const Chain chain = Chain::from_probabilities(matrix(n, n + 1, entries), exits);
  const auto d = Predictor(chain).predict({9, 1}, {4, 0, 0});
  expect_near(d, solve_absorption(chain, {9, 1}, {4, 0, 0}), 1e-12);
  const auto by = [&](RowMethod method) {
    return Predictor(chain).predict({9, 1}, {4, 0, 0},
                                    {.solver = Solver::rows, .row_method = method});
  };
  EXPECT_EQ(d.remainder, by(RowMethod::sweeps).remainder);
  EXPECT_EQ(d.endings, by(RowMethod::sweeps).endings);
  for (const RowMethod other : {RowMethod::elimination, RowMethod::sums}) {
    EXPECT_NE(d.remainder, by(other).remainder);
    expect_near(d, by(other), 1e-12);
  }
}

TEST(Predictor, RefusesMovesBeyondAnyField) {
  const Chain chain =
      Chain::from_probabilities(matrix(1, 2, {{0, 0, 0.5}, {0, 1, 0.5}}), {{0, 1'000'000, 0}, {}});
  EXPECT_THROW(Predictor{chain}, std::invalid_argument);
  EXPECT_THROW((void)Predictor(Chain::from_probabilities(matrix(1, 1, {{0, 0, 1.0}}), {{}}))
                   .predict({1, 1}, {},
                            {.solver = Solver::rows,
                             .row_method = RowMethod::sums,
                             .tolerance = 0.1,
                             .max_steps = 0}),
               std::invalid_argument);
}

// A limit far beyond the length of walks costs no steps. Options for steps without a limit have no
// effect with a limit.
TEST(Predictor, LimitOfCellsIsNoLimitOfSteps) {
  const Chain chain = Chain::from_counts(lattice_counts(5), lattice_exits());
  const Field field{30, 30};
  expect_near(predict(chain, field, {{15, 0, 12}}, {.max_cells = 60, .max_steps = 3})[0],
              propagate(chain, field, {15, 0, 12}, {.max_cells = 60}), 1e-13);
}

TEST(Predictor, StopsBeforeALimitThatNobodyReaches) {
  const Chain chain = with_gaps(1, never_down());
  const Predictor predictor(chain);
  const auto d = predictor.predict(kNineByNine, kBottomCentre,
                                   {.max_cells = 1'000'000, .solver = Solver::steps});
  EXPECT_LT(d.steps, 1000);
  EXPECT_EQ(d.cut_off(), 0.0);
  EXPECT_LT(d.remainder, 1e-25);
  expect_near(d, solve_absorption(chain, kNineByNine, kBottomCentre), 1e-13);
}

TEST(Predictor, StartInARowThatWasNeverSampled) {
  const Chain chain = with_gaps(1, never_down());
  const Predictor predictor(chain);
  const Start start{4, 2, 40};
  for (const auto& d :
       {predictor.predict(kNineByNine, start, {.max_cells = 13, .solver = Solver::steps}),
        predictor.predict(kNineByNine, start, {.solver = Solver::rows})}) {
    EXPECT_EQ(d.unsampled(), 1.0);
    EXPECT_EQ(d.final_cells(2, 4), 1.0);
    EXPECT_EQ(d.steps, 0);
  }
}

/// Left and right, rarely up, hardly ever trapped: walks of thousands of steps.
Chain weakly_trapping(std::uint64_t seed) {
  test::Words words(seed);
  Counts counts(87, 88);
  for (int row = 0; row < 87; ++row) {
    std::int64_t sideways = 0;
    for (int k = 0; k < 12; ++k) {
      const std::int64_t n = 1000 * (1 + words.below(15));
      counts.coeffRef(row, 25 + words.below(60)) += n;
      sideways += n;
    }
    counts.coeffRef(row, words.below(25)) += sideways / 200;
    counts.coeffRef(row, 87) += sideways / 1250;
  }
  return Chain::from_counts(counts, never_down());
}

// Two other routes to the same result: step by step until nothing is left, and one factorisation.
TEST(Predictor, ByRowsIsTheLimitOfPropagation) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Chain chain = with_gaps(seed, never_down());
    const Predictor predictor(chain);
    ASSERT_TRUE(predictor.can_go_by_rows());
    for (const auto& [field, start] :
         std::vector<std::pair<Field, Start>>{{kNineByNine, kBottomCentre},
                                              {{9, 9}, {0, 8, 3 + 1}},
                                              {{1, 30}, {0, 0, 2}},
                                              {{40, 3}, {39, 1, 7}}}) {
      const auto propagated = propagate(chain, field, start);
      const auto solved = solve_absorption(chain, field, start);
      for (const auto method : kMethods) {
        const auto d = predictor.predict(
            field, start, {.solver = Solver::rows, .row_method = method, .tolerance = 1e-13});
        expect_whole(d);
        EXPECT_LE(d.remainder, 1.1e-13);
        expect_near(d, propagated, 1e-12);
        expect_near(d, solved, 1e-12);
        EXPECT_NEAR(d.mean_steps, solved.mean_steps, 1e-10);
      }
    }
  }
}

TEST(Predictor, ByRowsTakesLongWalksWithoutSummingThem) {
  for (const std::uint64_t seed : {1, 2}) {
    const Chain chain = weakly_trapping(seed);
    const Predictor predictor(chain);
    for (const Field field : {kNineByNine, Field{60, 4}}) {
      const Start start{field.columns / 2, 0, 12};
      const auto solved = solve_absorption(chain, field, start);
      const auto eliminated = predictor.predict(
          field, start,
          {.solver = Solver::rows, .row_method = RowMethod::elimination, .tolerance = 1e-13});
      const auto summed = predictor.predict(
          field, start,
          {.solver = Solver::rows, .row_method = RowMethod::sums, .tolerance = 1e-13});
      expect_whole(eliminated);
      EXPECT_GT(solved.mean_steps, 20.0);
      EXPECT_GT(summed.steps, 1000);
      EXPECT_EQ(eliminated.steps, 0);
      EXPECT_GT(eliminated.remainder, 0.0) << "not measured";
      EXPECT_LE(eliminated.remainder, 1e-12);
      expect_near(eliminated, solved, 1e-11);
      expect_near(summed, solved, 1e-11);
      EXPECT_EQ(predictor.predict(field, start).steps, 0) << "sums were chosen";
    }
  }
}

// Each number lies within remainder + rounding of a route with more digits, and both bounds are
// small.
TEST(Predictor, RemainderAndRoundingBoundTheError) {
  const auto expect_bounded = [](const FinalDistribution& d, const FinalDistribution& exact) {
    const double bound = d.remainder + d.rounding;
    EXPECT_LE((d.final_cells - exact.final_cells).abs().sum(), bound);
    EXPECT_LE(
        std::abs(d.trapped() - exact.trapped()) + std::abs(d.left_field() - exact.left_field()) +
            std::abs(d.cut_off() - exact.cut_off()) + std::abs(d.unsampled() - exact.unsampled()),
        bound);
    EXPECT_GT(d.rounding, 1e-15);
    EXPECT_LE(bound, 1e-11);
  };
  const Chain chain = with_gaps(2, never_down());
  const Predictor predictor(chain);
  for (const int limit : {1, 2, 13, 100}) {
    const auto exact = propagate(chain, kNineByNine, kBottomCentre, {.max_cells = limit});
    expect_bounded(predictor.predict(kNineByNine, kBottomCentre,
                                     {.max_cells = limit, .solver = Solver::steps}),
                   exact);
  }
  const auto exact = propagate(chain, kNineByNine, kBottomCentre, {.max_cells = 600});
  EXPECT_LE(exact.cut_off(), 1e-25);
  expect_bounded(predictor.predict(kNineByNine, kBottomCentre, {.solver = Solver::steps}), exact);
  expect_bounded(solve_absorption(chain, kNineByNine, kBottomCentre), exact);
  for (const auto method : kMethods)
    for (const double tolerance : {1e-13, 1e-12})
      expect_bounded(
          predictor.predict(kNineByNine, kBottomCentre,
                            {.solver = Solver::rows, .row_method = method, .tolerance = tolerance}),
          exact);
}

// The longer the walks, the fewer digits hold; the result states their number, or is refused.
TEST(Predictor, RemainderOfEliminationIsHonest) {
  for (const double escape : {1e-3, 1e-6, 1e-8}) {
    const auto d =
        Predictor(test::nearly_closed(escape))
            .predict(
                {2, 1}, {},
                {.solver = Solver::rows, .row_method = RowMethod::elimination, .tolerance = 1e-13});
    const double error = std::abs(d.final_cells(0, 0) - 1 / (2 - escape));
    EXPECT_LE(error, d.remainder + d.rounding);
    EXPECT_LE(d.remainder, 1e-15 / escape);
    EXPECT_LE(d.rounding, 1e-13 / escape);
  }
  for (const double escape : {1e-13, 1e-16, 1e-300})
    EXPECT_THROW((void)Predictor(test::nearly_closed(escape))
                     .predict({2, 1}, {},
                              {.solver = Solver::rows,
                               .row_method = RowMethod::elimination,
                               .tolerance = 1e-13,
                               .max_steps = 1000}),
                 std::runtime_error);
}

// Starts in different cells and rows, some of which end early, more than fit in a group.
TEST(Predictor, SeveralStartsHaveTheBitsOfEachAlone) {
  for (const auto& exits : {lattice_exits(), never_down(), leaps()}) {
    const Chain chain = with_gaps(3, exits);
    const Predictor predictor(chain);
    for (const Field field : {kNineByNine, Field{1, 3}, Field{5, 12}, Field{30, 2}}) {
      std::vector<Start> starts;
      for (int k = 0; k < 11; ++k)
        starts.push_back({k * 3 % field.columns, k * 5 % field.rows, 7 * k % 87});
      starts.push_back({0, 0, 40});  // never sampled
      for (const int limit : {1, 2, 13, 0}) {
        const auto together = predictor.predict_all(field, starts, {.max_cells = limit});
        ASSERT_EQ(together.size(), starts.size());
        for (std::size_t k = 0; k < starts.size(); ++k)
          EXPECT_TRUE(
              same_bits(together[k], predictor.predict(field, starts[k], {.max_cells = limit})))
              << field.columns << " x " << field.rows << ", limit " << limit << ", start " << k;
      }
      if (!predictor.can_go_by_rows()) continue;
      for (const auto method : kMethods) {
        const auto together = predictor.predict_all(
            field, starts, {.solver = Solver::rows, .row_method = method, .tolerance = 1e-9});
        for (std::size_t k = 0; k < starts.size(); ++k)
          EXPECT_TRUE(same_bits(
              together[k], predictor.predict(
                               field, starts[k],
                               {.solver = Solver::rows, .row_method = method, .tolerance = 1e-9})));
      }
    }
    EXPECT_TRUE(predictor.predict_all(kNineByNine, {}, {.max_cells = 13}).empty());
    EXPECT_THROW(
        (void)predictor.predict_all(kNineByNine, {kBottomCentre, {9, 0, 0}}, {.max_cells = 13}),
        std::invalid_argument);
  }
}

TEST(Predictor, ByRowsCoversRowsThatJumpAcrossOthers) {
  auto exits = never_down();
  for (std::size_t j = 0; j < 10; ++j) exits[j].di_y = 3;
  const Chain chain = Chain::from_counts(lattice_counts(5), exits);
  const Predictor predictor(chain);
  const Field field{11, 17};
  expect_near(predictor.predict(field, {5, 1, 3}, {.solver = Solver::rows}),
              solve_absorption(chain, field, {5, 1, 3}), 1e-12);
}

TEST(Predictor, RemainderIsWhatTheToleranceLeaves) {
  const Chain chain = Chain::from_counts(lattice_counts(1), never_down());
  const Predictor predictor(chain);
  const auto exact = solve_absorption(chain, kNineByNine, kBottomCentre);
  for (const double tolerance : {1e-2, 1e-4, 1e-8}) {
    const auto d = predictor.predict(
        kNineByNine, kBottomCentre,
        {.solver = Solver::rows, .row_method = RowMethod::sums, .tolerance = tolerance});
    EXPECT_GT(d.remainder, 0.0);
    EXPECT_LE(d.remainder, tolerance);
    expect_whole(d);
    // Each number is below the exact one by at most the remainder.
    EXPECT_GE((exact.final_cells - d.final_cells).minCoeff(), -1e-15);
    EXPECT_LE((exact.final_cells - d.final_cells).maxCoeff(), d.remainder + 1e-15);
  }
  const auto all =
      predictor.predict(kNineByNine, kBottomCentre,
                        {.solver = Solver::rows, .row_method = RowMethod::sums, .tolerance = 0.0});
  EXPECT_LE(all.remainder, 1e-270);
  expect_near(all, exact, 1e-13);
}

TEST(Predictor, ByRowsRefusesWhatItCannotDo) {
  const Chain down = Chain::from_counts(lattice_counts(1), lattice_exits());
  EXPECT_FALSE(Predictor(down).can_go_by_rows());
  try {
    (void)Predictor(down).predict(kNineByNine, kBottomCentre, {.solver = Solver::rows});
    FAIL() << "moves to a row below are taken";
  } catch (const std::invalid_argument& e) {  // with the names of the option --solver
    EXPECT_NE(std::string(e.what()).find("solver march"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("auto and klu"), std::string::npos) << e.what();
  }
  EXPECT_THROW(
      (void)Predictor(down).predict(kNineByNine, kBottomCentre,
                                    {.max_cells = 13, .solver = Solver::steps, .tolerance = -1.0}),
      std::invalid_argument);
  EXPECT_THROW((void)Predictor(down).predict({0, 9}, kBottomCentre,
                                             {.max_cells = 13, .solver = Solver::steps}),
               std::invalid_argument);
  // Left and right for ever.
  const Chain circle =
      Chain::from_probabilities(matrix(2, 2, {{0, 1, 1.0}, {1, 0, 1.0}}), {{0, 1, 0}, {1, -1, 0}});
  EXPECT_THROW(
      (void)Predictor(circle).predict(
          {2, 1}, {1, 0, 0}, {.solver = Solver::rows, .tolerance = 1e-13, .max_steps = 1000}),
      std::runtime_error);
  const auto still = Predictor(circle).predict(
      {2, 1}, {1, 0, 0}, {.solver = Solver::steps, .tolerance = 1e-13, .max_steps = 100});
  EXPECT_EQ(still.remainder, 1.0);
  EXPECT_EQ(still.steps, 100);
}

TEST(Predictor, HasTheSameBitsWithAnyInstructionSet) {
  const Field field{13, 7};
  const std::vector<Start> starts{{6, 0, 11}, {0, 1, 30}, {12, 3, 70}};
  for (const auto& exits : {never_down(), leaps()}) {
    const Chain chain = with_gaps(4, exits);
    const auto all = [&] {
      const Predictor predictor(chain);
      auto results =
          predictor.predict_all(field, starts, {.max_cells = 13, .solver = Solver::steps});
      results.push_back(predictor.predict({70, 20}, starts.front(), {.solver = Solver::steps}));
      if (predictor.can_go_by_rows())
        for (const auto method : kMethods)
          for (const auto& d : predictor.predict_all(
                   field, starts,
                   {.solver = Solver::rows, .row_method = method, .tolerance = 1e-13}))
            results.push_back(d);
      return results;
    };
    const auto before = all();
    gatewalk::test::on_every_instruction_set([&] {
      const auto now = all();
      ASSERT_EQ(now.size(), before.size());
      for (std::size_t k = 0; k < now.size(); ++k) EXPECT_TRUE(same_bits(before[k], now[k])) << k;
    });
  }
}

}  // namespace
}  // namespace gatewalk::markov
