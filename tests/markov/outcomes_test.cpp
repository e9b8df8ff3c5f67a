// SPDX-License-Identifier: MIT
#include "markov/outcomes.h"

#include <gtest/gtest.h>

#include "markov/totals.h"
#include "tests/markov/chains.h"
#include "tests/support/propagation.h"

namespace gatewalk::markov {
namespace {

using test::propagate;

struct OutcomesCase {
  Field field;
  Start start;
  int max_cells;
};

/// How walks end, from the outcomes after their first draw.
EndTable after_first_draw(const FieldChain& chain, const Start& start, const Outcomes& o) {
  const Chain& c = chain.at(start.column, start.row);
  return (c.matrix().row(start.input) * o.by_output.matrix()).array();
}

void expect_outcomes(const EndTable& found, const FinalDistribution& expected, double bound) {
  for (std::size_t e = 0; e < kEndings; ++e)
    EXPECT_NEAR(found(0, static_cast<Eigen::Index>(e)), expected.endings[e], bound) << e;
  for (Eigen::Index cell = 0; cell < expected.final_cells.size(); ++cell)
    EXPECT_NEAR(found(0, static_cast<Eigen::Index>(kEndings) + cell),
                expected.final_cells.data()[cell], bound)
        << cell;
}

void expect_all_outcomes(const FieldChain& chain, const OutcomesCase& c) {
  const Outcomes o = outcomes(chain, c.field, c.start, c.max_cells);
  const double bound = c.max_cells > 0 ? 1e-14 : 1e-11;
  for (const int input : {0, c.start.input, chain.inputs() - 1}) {
    const Start start{c.start.column, c.start.row, input};
    expect_outcomes(after_first_draw(chain, start, o),
                    propagate(chain, c.field, start, {.max_cells = c.max_cells}), bound);
  }
  // Visits equal those of the totals, for any ending.
  const WalkTotals totals = walk_totals(chain, c.field, c.start, c.max_cells);
  constexpr auto kEnds = static_cast<Eigen::Index>(kEndings);
  for (Eigen::Index cell = 0; cell < totals.visits.size(); ++cell) {
    const double visits = totals.visits.data()[cell];
    EXPECT_NEAR(o.by_cell.row(cell).head(kEnds).sum(), visits, 1e3 * bound);
    EXPECT_NEAR(o.by_cell.row(cell).tail(totals.visits.size()).sum(), visits, 1e3 * bound);
    EXPECT_NEAR(o.next.row(cell).sum(), visits, 1e3 * bound);
  }
  // All walks visit the first cell at the first draw and never return.
  double trapped = 0.0;
  for (Eigen::Index cell = 0; cell < o.next.rows(); ++cell)
    trapped += o.next(cell, o.next.cols() - 1);
  EXPECT_NEAR(trapped, totals.endings[0], 1e2 * bound);
}

TEST(Outcomes, ArePropagationsOfAllStarts) {
  const OutcomesCase cases[] = {{{9, 9}, {4, 0, 12}, 13},
                                {{3, 12}, {2, 5, 40}, 9},
                                {{12, 3}, {7, 1, 12}, 1},
                                {{5, 5}, {2, 0, 60}, 40}};
  for (const auto& exits : {test::lattice_exits(), test::never_down(), test::leaps()})
    for (const bool has_gaps : {false, true})
      for (const OutcomesCase& c : cases) {
        Counts counts = test::lattice_counts(7);
        if (has_gaps)
          for (const int row : {3, 41, 61}) test::empty_row(counts, row);
        expect_all_outcomes(Chain::from_counts(counts, exits), c);
      }
}

TEST(Outcomes, WithoutLimitAndOfSeveralTypes) {
  const Field field{4, 3};
  const std::vector<int> types{0, 1, 0, 0, 1, 1, 0, 1, 0, 0, 1, 0};
  for (const auto& exits : {test::boundary_exits(), test::boundary_exits_down()})
    for (const int max_cells : {0, 6})
      expect_all_outcomes(FieldChain::by_cell({Chain::from_counts(test::boundary_counts(3), exits),
                                               Chain::from_counts(test::boundary_counts(4), exits)},
                                              field.columns, types),
                          {field, {1, 0, 2}, max_cells});
}

TEST(Outcomes, OfACellAreThoseOfItsVisitors) {
  // Up with 3/4, else trapped: of the walks that reach row 1, 3/4 cross the two rows.
  const Chain up =
      Chain::from_probabilities(test::matrix(1, 2, {{0, 0, 0.75}, {0, 1, 0.25}}), {{0, 0, 1}, {}});
  const Outcomes o = outcomes(up, {1, 2}, {0, 0, 0}, 0);
  const auto far = static_cast<Eigen::Index>(Ending::far_edge);
  EXPECT_DOUBLE_EQ(o.by_cell(0, far), 0.5625);
  EXPECT_DOUBLE_EQ(o.by_cell(1, far) / o.next.row(1).sum(), 0.75);
  EXPECT_DOUBLE_EQ(o.by_cell(1, static_cast<Eigen::Index>(kEndings) + 1), 0.75);
  ASSERT_EQ(o.moves, (std::vector<std::array<int, 2>>{{0, 1}}));
  EXPECT_DOUBLE_EQ(o.next(1, 0), 0.75 * 0.75);
  EXPECT_DOUBLE_EQ(o.next(1, 1), 0.75 * 0.25);
}

TEST(Outcomes, RefuseEndlessCircles) {
  const Chain closed =
      Chain::from_probabilities(test::matrix(1, 2, {{0, 0, 1.0}}), {{0, 0, 0}, {}});
  EXPECT_ANY_THROW((void)outcomes(closed, {2, 2}, {0, 0, 0}, 0));
}

}  // namespace
}  // namespace gatewalk::markov
