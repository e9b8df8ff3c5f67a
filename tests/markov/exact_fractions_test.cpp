// SPDX-License-Identifier: MIT
/// All solvers without a limit against exact fractions of integer counts: 3 x 3 cells of five
/// states.

#include <gtest/gtest.h>

#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "markov/committor.h"
#include "markov/predict.h"
#include "tests/markov/chains.h"
#include "tests/markov/fractions.h"
#include "tests/support/field_states.h"
#include "tests/support/propagation.h"

namespace gatewalk::markov {
namespace {

using RowMethod = PredictOptions::RowMethod;
using Solver = PredictOptions::Solver;
using test::propagate;
using test::Rational;

constexpr Field kThreeByThree{3, 3};

/// Counts divided by the row's total, as any kind of number.
template <class Number>
auto chance_of(const FieldChain& chain, const std::vector<Counts>& counts) {
  return [&](const Start& s, const FieldStates::Draw& draw) {
    const Counts& c = counts[static_cast<std::size_t>(chain.type_of(s.column, s.row))];
    std::int64_t total = 0;
    for (Counts::InnerIterator it(c, s.input); it; ++it) total += it.value();
    return Number(Number(static_cast<int>(c.coeff(s.input, draw.output))) /
                  Number(static_cast<int>(total)));
  };
}

template <class Number>
FieldAnswer<Number> exact_answer(const FieldChain& chain, const std::vector<Counts>& counts,
                                 const Start& start) {
  const FieldStates f = field_states(chain, kThreeByThree, {start});
  return field_answer(f,
                      end_chances(absorbing_chain<Number>(f, chance_of<Number>(chain, counts)), 1));
}

struct Route {
  const char* name;
  Solver solver;
  RowMethod row_method = RowMethod::cheapest;
  friend void PrintTo(const Route& route, std::ostream* out) { *out << route.name; }
};

class ExactFractions : public testing::TestWithParam<Route> {
 protected:
  static void expect_right(const FieldChain& chain, const std::vector<Counts>& counts) {
    for (const Start& start : {Start{1, 0, 0}, Start{2, 1, 4}, Start{0, 0, 3}}) {
      SCOPED_TRACE("start in state " + std::to_string(start.input));
      const auto exact = exact_answer<Rational>(chain, counts, start);
      Rational total(0);
      for (const Rational& p : exact.endings) total += p;
      EXPECT_TRUE(total == 1);
      const FinalDistribution d = predict(chain, kThreeByThree, {start},
                                          {.solver = GetParam().solver,
                                           .row_method = GetParam().row_method,
                                           .tolerance = 1e-17})
                                      .front();
      constexpr double kWidest = 1e-14;
      for (std::size_t e = 0; e < kEndings; ++e)
        EXPECT_NEAR(d.endings[e], exact.endings[e].convert_to<double>(), kWidest) << "ending " << e;
      for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
          EXPECT_NEAR(d.final_cells(row, column),
                      exact.final_cells(row, column).convert_to<double>(), kWidest)
              << "cell " << column << " " << row;
    }
  }
};

INSTANTIATE_TEST_SUITE_P(
    All, ExactFractions,
    testing::Values(Route{"automatic", Solver::automatic}, Route{"steps", Solver::steps},
                    Route{"rows_by_elimination", Solver::rows, RowMethod::elimination},
                    Route{"rows_by_sweeps", Solver::rows, RowMethod::sweeps},
                    Route{"rows_by_sums", Solver::rows, RowMethod::sums},
                    Route{"klu", Solver::klu}),
    [](const auto& param) { return std::string(param.param.name); });

TEST_P(ExactFractions, OfAUniformField) {
  const Counts counts = test::boundary_counts(1);
  expect_right(Chain::from_counts(counts, test::boundary_exits()), {counts});
}

TEST_P(ExactFractions, OfRowsOfTwoTypes) {
  const std::vector<Counts> counts{test::boundary_counts(1), test::boundary_counts(2)};
  const std::vector<Chain> chains{Chain::from_counts(counts[0], test::boundary_exits()),
                                  Chain::from_counts(counts[1], test::boundary_exits())};
  expect_right(FieldChain::by_row(chains, {0, 1, 1}), counts);
}

TEST_P(ExactFractions, OfCellsOfTwoTypesAndMovesDown) {
  if (GetParam().solver == Solver::rows) return;  // which takes neither
  const std::vector<Counts> counts{test::boundary_counts(3), test::boundary_counts(4)};
  const std::vector<Chain> chains{Chain::from_counts(counts[0], test::boundary_exits_down()),
                                  Chain::from_counts(counts[1], test::boundary_exits_down())};
  expect_right(FieldChain::by_cell(chains, 3, {0, 1, 0, 1, 1, 0, 0, 0, 1}), counts);
}

TEST(FieldStates, EnclosuresHoldTheFractions) {
  const Counts counts = test::boundary_counts(1);
  const FieldChain chain = Chain::from_counts(counts, test::boundary_exits_down());
  const auto exact = exact_answer<Rational>(chain, {counts}, {1, 0, 0});
  const auto held = exact_answer<Enclosure>(chain, {counts}, {1, 0, 0});
  const auto doubles = exact_answer<double>(chain, {counts}, {1, 0, 0});
  for (std::size_t e = 0; e < kEndings; ++e) {
    test::expect_is(held.endings[e], exact.endings[e], 45);
    test::expect_is(doubles.endings[e], exact.endings[e], 45);
  }
}

TEST(FieldStates, CommittorIsTheFractionFromEachState) {
  const Counts counts = test::boundary_counts(1);
  const FieldChain chain = Chain::from_counts(counts, test::boundary_exits());
  std::vector<Start> starts;
  for (int cell = 0; cell < 9; ++cell)
    for (int input = 0; input < 5; ++input) starts.push_back({cell % 3, cell / 3, input});
  const FieldStates f = field_states(chain, kThreeByThree, starts);
  ASSERT_EQ(f.states.size(), 45u);
  const auto chances =
      end_chances(absorbing_chain<Rational>(f, chance_of<Rational>(chain, {counts})), 45);
  const Committor c = committor(chain, kThreeByThree);
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const double right = field_answer(f, chances, static_cast<Eigen::Index>(i))
                             .endings[static_cast<std::size_t>(Ending::far_edge)]
                             .convert_to<double>();
    EXPECT_NEAR(c(starts[i].column, starts[i].row, starts[i].input), right, 1e-11 * right);
  }
}

TEST(FieldStates, KnowStatesNeverSampled) {
  Counts counts = test::boundary_counts(1);
  test::empty_row(counts, 4);
  const FieldChain chain = Chain::from_counts(counts, test::boundary_exits());
  for (const int input : {0, 4}) {
    const FieldStates f = field_states(chain, kThreeByThree, {{1, 1, input}});
    const auto a = field_answer(f, absorption(absorbing_chain<double>(f)).ends);
    const auto d = propagate(chain, kThreeByThree, {1, 1, input}, {.tolerance = 1e-17});
    EXPECT_GT(d.unsampled(), 0.01);
    for (std::size_t e = 0; e < kEndings; ++e) EXPECT_NEAR(a.endings[e], d.endings[e], 1e-14) << e;
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column)
        EXPECT_NEAR(a.final_cells(row, column), d.final_cells(row, column), 1e-14);
  }
}

TEST(FieldStates, RefuseMoreThanADenseChainHolds) {
  const FieldChain chain = Chain::from_counts(test::boundary_counts(1), test::boundary_exits());
  try {
    (void)field_states(chain, {100, 100}, {{50, 0, 0}});
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_STREQ(e.what(),
                 "field: more than 4000 states of 100 x 100 cells can be reached; take fewer "
                 "cells, or a chain of fewer states");
  }
  EXPECT_EQ(field_states(chain, {100, 100}, {{50, 0, 0}}, 50'000).states.front().column, 50);
  EXPECT_THROW((void)field_states(chain, {3, 3}, {}), std::invalid_argument);
  EXPECT_THROW((void)field_states(chain, {3, 3}, {{3, 0, 0}}), std::invalid_argument);
}

}  // namespace
}  // namespace gatewalk::markov
