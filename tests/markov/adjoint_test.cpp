// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <numeric>
#include <stdexcept>

#include "chains.h"
#include "markov/solvers.h"
#include "tests/support/instruction_sets.h"
#include "tests/support/propagation.h"

namespace gatewalk::markov {
namespace {

using test::lattice_counts;
using test::lattice_exits;
using test::leaps;
using test::never_down;
using test::propagate;

std::vector<std::int64_t> row_of(const Counts& counts, int row) {
  std::vector<std::int64_t> dense(static_cast<std::size_t>(counts.cols()));
  for (Counts::InnerIterator it(counts, row); it; ++it)
    dense[static_cast<std::size_t>(it.col())] = it.value();
  return dense;
}

void expect_near(const FinalDistribution& a, const FinalDistribution& b, double bound) {
  EXPECT_LE((a.final_cells - b.final_cells).abs().maxCoeff(), bound);
  EXPECT_NEAR(a.left_field(), b.left_field(), bound);
  EXPECT_NEAR(a.mean_steps, b.mean_steps, 20 * bound);
  test::expect_same_endings(a, b, bound);
  test::expect_endings_add_up(a);
}

void expect_equal(const FinalDistribution& a, const FinalDistribution& b) {
  EXPECT_TRUE((a.final_cells == b.final_cells).all());
  EXPECT_EQ(a.endings, b.endings);
  EXPECT_EQ(a.mean_steps, b.mean_steps);
}

struct Case {
  Field field;
  int column, row, max_cells;
};

TEST(Adjoint, SaysWhatPropagationSays) {
  const Case cases[] = {{{9, 9}, 4, 0, 13}, {{9, 9}, 0, 8, 6},      {{1, 1}, 0, 0, 3},
                        {{3, 12}, 2, 5, 9}, {{12, 3}, 7, 1, 1},     {{40, 5}, 20, 2, 2},
                        {{5, 5}, 2, 0, 40}, {{401, 1}, 200, 0, 12}, {{3, 300}, 1, 7, 5}};
  for (const auto& exits : {lattice_exits(), never_down(), leaps()})
    for (const bool has_gaps : {false, true})
      for (const Case& c : cases) {
        Counts counts = lattice_counts(7);
        if (has_gaps)
          for (const int row : {3, 40, 60}) test::empty_row(counts, row);
        const Chain chain = Chain::from_counts(counts, exits);
        const AdjointPredictor adjoint(chain, c.field, c.column, c.row, c.max_cells);
        const EndTable endings = ending_chances(chain, c.field, c.column, c.row, c.max_cells);
        for (const int input : {0, 12, 86}) {
          const auto expected =
              propagate(chain, c.field, {c.column, c.row, input}, {.max_cells = c.max_cells});
          const auto found = adjoint.predict(row_of(counts, input));
          SCOPED_TRACE(std::to_string(c.field.columns) + " x " + std::to_string(c.field.rows) +
                       ", " + std::to_string(c.max_cells) + " cells, input " +
                       std::to_string(input));
          expect_near(found, expected, 1e-14);
          const std::vector<std::int64_t> row = row_of(counts, input);
          const auto all = static_cast<double>(std::accumulate(row.begin(), row.end(), 0LL));
          for (std::size_t e = 0; e < kEndings && all > 0.0; ++e) {
            double share = 0.0;
            for (std::size_t output = 0; output < row.size(); ++output)
              share += static_cast<double>(row[output]) / all *
                       endings(static_cast<Eigen::Index>(output), static_cast<Eigen::Index>(e));
            EXPECT_NEAR(share, expected.endings[e], 1e-13) << e;
          }
        }
      }
}

// Enough states that terms are prefetched.
TEST(Adjoint, OfManyStates) {
  constexpr int kStates = 9000;
  std::vector<Exit> exits;  // to the left, ahead, to the right, in turn
  std::vector<Eigen::Triplet<std::int64_t>> some;
  for (int i = 0; i < kStates; ++i) {
    exits.push_back({i, i % 3 - 1, i % 3 == 1 ? 1 : 0});
    for (int k = 1; k <= 1 + i % 5; ++k) some.emplace_back(i, (i * 7 + k * 1231) % kStates, k);
    some.emplace_back(i, kStates, 1 + i % 2);
  }
  exits.push_back({});
  Counts counts(kStates, kStates + 1);
  counts.setFromTriplets(some.begin(), some.end());
  const Chain chain = Chain::from_counts(counts, exits);
  const Field field{5, 4};
  const AdjointPredictor adjoint(chain, field, 2, 0, 6);
  for (const int input : {0, 4321, kStates - 1})
    expect_near(adjoint.predict(row_of(counts, input)),
                propagate(chain, field, {2, 0, input}, {.max_cells = 6}), 1e-14);
}

// Most cells of a long row cannot be reached.
TEST(Adjoint, LeavesOutWhatCannotBeReached) {
  Counts counts(2, 4);
  for (const int row : {0, 1}) {
    counts.coeffRef(row, row) = 5;
    counts.coeffRef(row, 1 - row) = 2;
    counts.coeffRef(row, 2) = 1;
    counts.coeffRef(row, 3) = 1;
  }
  const Chain chain = Chain::from_counts(counts, {{0, -1, 0}, {1, 1, 0}, {0, 0, 1}, {}});
  for (const Case& c : {Case{{2001, 1}, 1000, 0, 41}, Case{{2001, 1}, 1000, 0, 150},
                        Case{{401, 1}, 200, 0, 40}, Case{{401, 1}, 200, 0, 2}}) {
    const auto found =
        AdjointPredictor(chain, c.field, c.column, 0, c.max_cells).predict(row_of(counts, 0));
    EXPECT_NEAR(found.final_cells.sum(), 1.0, 1e-12);
    expect_near(found, propagate(chain, c.field, {c.column, 0, 0}, {.max_cells = c.max_cells}),
                1e-13);
  }
}

TEST(Adjoint, ChainsOfTwoOutcomesByHand) {
  // One state: up with 1/4, trapped with 3/4.
  Counts counts(1, 2);
  counts.coeffRef(0, 0) = 1, counts.coeffRef(0, 1) = 3;
  const AdjointPredictor adjoint(Chain::from_counts(counts, {{0, 0, 1}, {}}), {1, 3}, 0, 0, 3);
  const auto d = adjoint.predict({2, 2});  // a start that goes up with 1/2
  EXPECT_DOUBLE_EQ(d.final_cells(0, 0), 0.5);
  EXPECT_DOUBLE_EQ(d.final_cells(1, 0), 0.5 * 0.75);
  EXPECT_DOUBLE_EQ(d.final_cells(2, 0), 0.5 * 0.25);
  EXPECT_DOUBLE_EQ(d.endings[static_cast<std::size_t>(Ending::far_edge)], 0.5 / 16);
  EXPECT_DOUBLE_EQ(d.mean_steps, 1 + 0.5 + 0.125);
}

TEST(Adjoint, SameBitsOnAnyThreadsAndInstructions) {
  const Counts counts = lattice_counts(11);
  const Chain chain = Chain::from_counts(counts, never_down());
  const auto shares = [&] {
    return AdjointPredictor(chain, {9, 9}, 4, 0, 13).predict(row_of(counts, 12));
  };
  const FinalDistribution expected = shares();
  {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    expect_equal(shares(), expected);
  }
  gatewalk::test::on_every_instruction_set([&] { expect_equal(shares(), expected); });
}

TEST(Adjoint, RefusesWhatItCannotAnswer) {
  const Counts counts = lattice_counts(3);
  const Chain chain = Chain::from_counts(counts, lattice_exits());
  EXPECT_THROW(AdjointPredictor(chain, {9, 9}, 4, 0, 0), std::invalid_argument);
  EXPECT_THROW(AdjointPredictor(chain, {9, 9}, 9, 0, 5), std::invalid_argument);
  EXPECT_THROW((void)ending_chances(chain, {9, 9}, 4, 0, 0), std::invalid_argument);
  EXPECT_THROW((void)ending_chances(chain, {9, 9}, 9, 0, 5), std::invalid_argument);
  const AdjointPredictor adjoint(chain, {3, 3}, 1, 0, 5);
  EXPECT_THROW((void)adjoint.predict({1, 2, 3}), std::invalid_argument);
  const auto nothing = adjoint.predict(std::vector<std::int64_t>(88, 0));
  EXPECT_EQ(nothing.unsampled(), 1.0);
  EXPECT_EQ(nothing.final_cells(0, 1), 1.0);
}

}  // namespace
}  // namespace gatewalk::markov
