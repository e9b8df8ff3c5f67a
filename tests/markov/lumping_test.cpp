// SPDX-License-Identifier: MIT
#include "markov/lumping.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <vector>

#include "tests/markov/chains.h"
#include "tests/support/propagation.h"

namespace gatewalk::markov {
namespace {

using test::matrix;
using test::propagate;

constexpr double kFewEps = 1e-15;

/// The paper's states by boundary: EN, RD, LD, RT, LT.
std::vector<int> boundaries() {
  std::vector<int> group_of;
  for (int input = 0; input < 87; ++input)
    group_of.push_back(input < 25 ? 0 : input < 55 ? 1 : input < 85 ? 2 : input < 86 ? 3 : 4);
  return group_of;
}

/// Each state of a chain three times: the three copies have the same transitions, but divide them
/// among the copies of a target by shares of their own.
Chain three_copies(const Chain& chain) {
  const double shares[3][3] = {{0.5, 0.25, 0.25}, {0.125, 0.5, 0.375}, {0.0, 0.0, 1.0}};
  const int n = chain.inputs();
  std::vector<Exit> exits;
  for (const Exit& exit : chain.exits())
    for (int copy = 0; copy < (exit.next_input == Exit::kTrapped ? 1 : 3); ++copy) {
      exits.push_back(exit);
      if (exit.next_input != Exit::kTrapped) exits.back().next_input = 3 * exit.next_input + copy;
    }
  std::vector<test::Entry> entries;
  for (int row = 0; row < 3 * n; ++row)
    for (Probabilities::InnerIterator it(chain.matrix(), row / 3); it; ++it) {
      const auto output = static_cast<int>(it.col());
      if (output == n)
        entries.push_back({row, 3 * n, it.value()});
      else
        for (int copy = 0; copy < 3; ++copy)
          entries.push_back(
              {row, 3 * output + copy, it.value() * shares[(row + output) % 3][copy]});
    }
  return Chain::from_probabilities(matrix(3 * n, 3 * n + 1, entries), exits);
}

TEST(Lumping, CopiesOfAStateAreLumpedExactly) {
  const Chain base = Chain::from_counts(test::boundary_counts(1), test::boundary_exits());
  const Chain copies = three_copies(base);
  std::vector<int> group_of;
  std::vector<double> weights;
  for (int row = 0; row < 15; ++row) {
    group_of.push_back(row / 3);
    weights.push_back(1.0 + row % 4);
  }
  const Lumping lumping = lump(copies, group_of, weights);
  EXPECT_LE(lumping.largest, kFewEps);
  EXPECT_LE(lumping.mean, kFewEps);
  for (const Lumping::Group& group : lumping.groups) EXPECT_LE(group.largest, kFewEps);
  EXPECT_EQ(lumping.chain.exits(), base.exits());
  EXPECT_LE((Eigen::MatrixXd(lumping.chain.matrix()) - Eigen::MatrixXd(base.matrix()))
                .cwiseAbs()
                .maxCoeff(),
            kFewEps);
  for (const int max_cells : {0, 13}) {
    const LumpingError error = lumping_error(copies, lumping.chain, group_of, test::kNineByNine,
                                             {4, 0, 1}, {.max_cells = max_cells});
    EXPECT_LE(error.endings, 1e-14);
    EXPECT_LE(error.final_cells, 1e-14);
  }
}

/// Groups: state 0 alone, states 1 and 2 together.
Chain three_states() {
  return Chain::from_probabilities(matrix(3, 4,
                                          {{0, 1, 0.25},
                                           {0, 2, 0.25},
                                           {0, 3, 0.5},
                                           {1, 0, 0.5},
                                           {1, 1, 0.25},
                                           {1, 3, 0.25},
                                           {2, 0, 0.5},
                                           {2, 2, 0.125},
                                           {2, 3, 0.375}}),
                                   {{0, 0, 1}, {1, 1, 0}, {2, 1, 0}, {}});
}

// Rows of 1 and 2, lumped: (1/2, 1/4, 1/4) and (1/2, 1/8, 3/8), 1/8 apart. Weighted by 3 and 1:
// (1/2, 7/32, 9/32), from which they are 1/32 and 3/32 apart, 3/64 in the mean.
TEST(Lumping, SaysHowFarByHand) {
  const Lumping lumping = lump(three_states(), {0, 1, 1}, {4.0, 3.0, 1.0});
  EXPECT_EQ(Eigen::MatrixXd(lumping.chain.matrix()),
            (Eigen::MatrixXd{{0.0, 0.5, 0.5}, {0.5, 7.0 / 32, 9.0 / 32}}));
  EXPECT_EQ(lumping.chain.exits(), (std::vector<Exit>{{0, 0, 1}, {1, 1, 0}, {}}));
  EXPECT_EQ(lumping.groups[0].largest, 0.0);
  EXPECT_EQ(lumping.groups[1].weight, 4.0);
  EXPECT_EQ(lumping.groups[1].largest, 1.0 / 8);
  EXPECT_EQ(lumping.groups[1].mean, 3.0 / 64);
  EXPECT_EQ(lumping.largest, 1.0 / 16);
  EXPECT_EQ(lumping.mean, 3.0 / 128);
  // One cell, one draw, from state 2: its row beside the group's.
  const LumpingError error =
      lumping_error(three_states(), lumping.chain, {0, 1, 1}, {1, 1}, {0, 0, 2});
  EXPECT_NEAR(error.endings, 3.0 / 32, kFewEps);
  EXPECT_NEAR(error.final_cells, 0.0, kFewEps);
}

TEST(Lumping, OfNothingIsTheChain) {
  const Chain chain = Chain::from_counts(test::lattice_counts(1), test::lattice_exits());
  std::vector<int> itself;
  for (int input = 0; input < 87; ++input) itself.push_back(input);
  const Lumping lumping = lump(chain, itself, std::vector<double>(87, 0.0));
  EXPECT_EQ(lumping.largest, 0.0);
  EXPECT_EQ(lumping.groups[17].largest, 0.0);
  EXPECT_EQ(lumping.chain.exits(), chain.exits());
  EXPECT_TRUE(Eigen::MatrixXd(lumping.chain.matrix()) == Eigen::MatrixXd(chain.matrix()));
}

// All states in one group, which still goes up, left, right and down.
TEST(Lumping, TellsDirectionsApart) {
  const Counts counts = test::boundary_counts(1);
  const Lumping lumping = lump(Chain::from_counts(counts, test::boundary_exits_down()),
                               {0, 0, 0, 0, 0}, {0.0, 0.0, 1.0, 0.0, 0.0});
  EXPECT_EQ(lumping.chain.exits(),
            (std::vector<Exit>{{0, 0, 1}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {}}));
  const double total = Eigen::MatrixXd(counts.cast<double>()).row(2).sum();
  const Eigen::MatrixXd p = lumping.chain.matrix();
  EXPECT_NEAR(p(0, 2), static_cast<double>(counts.coeff(2, 2) + counts.coeff(2, 4)) / total,
              kFewEps);
  EXPECT_NEAR(p(0, 3), static_cast<double>(counts.coeff(2, 3)) / total, kFewEps);
}

TEST(Lumping, WeightsOfCountsAddThem) {
  const Counts counts = test::lattice_counts(1);
  const std::vector<int> group_of = boundaries();
  std::vector<double> totals;
  Eigen::MatrixXd pooled = Eigen::MatrixXd::Zero(5, 88);
  for (int row = 0; row < 87; ++row) {
    const Eigen::RowVectorXd dense = Eigen::RowVectorXd(counts.row(row).cast<double>());
    totals.push_back(dense.sum());
    pooled.row(group_of[static_cast<std::size_t>(row)]) += dense;
  }
  const Lumping lumping = lump(Chain::from_counts(counts, test::lattice_exits()), group_of, totals);
  ASSERT_EQ(lumping.chain.outputs(), 6);  // up, right, left; down in two states; trapped
  for (int group = 0; group < 5; ++group) {
    const double total = pooled.row(group).sum();
    const Eigen::RowVectorXd p = Eigen::MatrixXd(lumping.chain.matrix()).row(group);
    EXPECT_NEAR(p(0), pooled.row(group).head(25).sum() / total, kFewEps);
    EXPECT_NEAR(p(1), pooled.row(group).segment(25, 30).sum() / total, kFewEps);
    EXPECT_NEAR(p(2), pooled.row(group).segment(55, 30).sum() / total, kFewEps);
    EXPECT_NEAR(p(5), pooled(group, 87) / total, kFewEps);
  }
}

// All exits stay in the cell, so groups are visited as often as their states.
TEST(Lumping, VisitsAsWeightsKeepVisits) {
  auto exits = test::lattice_exits();
  for (Exit& exit : exits) exit.di_x = exit.di_y = 0;
  const Chain chain = Chain::from_counts(test::lattice_counts(2), exits);
  const std::vector<int> group_of = boundaries();
  const std::vector<double> visits = expected_visits(chain, {1, 1}, {0, 0, 12});
  const Lumping lumping = lump(chain, group_of, visits);
  const std::vector<double> of_groups = expected_visits(lumping.chain, {1, 1}, {0, 0, 0});
  std::vector<double> together(5, 0.0);
  double all = 0.0;
  for (std::size_t input = 0; input < visits.size(); ++input) {
    together[static_cast<std::size_t>(group_of[input])] += visits[input];
    all += visits[input];
  }
  for (std::size_t g = 0; g < 5; ++g) EXPECT_NEAR(of_groups[g], together[g], 1e-11) << g;
  EXPECT_NEAR(all, propagate(chain, {1, 1}, {0, 0, 12}).mean_steps, 1e-11);
  EXPECT_GT(lumping.largest, lumping.mean);
  EXPECT_GT(lumping.mean, 0.1);
}

TEST(Lumping, ThePapersShapeByBoundary) {
  const Chain chain = Chain::from_counts(test::lattice_counts(3), test::never_down());
  const Start start{4, 0, 12};
  const std::vector<int> group_of = boundaries();
  for (const int max_cells : {0, 13}) {
    const std::vector<double> visits = expected_visits(chain, test::kNineByNine, start, max_cells);
    const Lumping lumping = lump(chain, group_of, visits);
    const LumpingError error = lumping_error(chain, lumping.chain, group_of, test::kNineByNine,
                                             start, {.max_cells = max_cells});
    EXPECT_EQ(error.lumped.final_cells.rows(), 9);
    EXPECT_GT(error.final_cells, 1e-3);
    // The error of a lumped draw is at most that of its start's row, then ever smaller.
    EXPECT_LT(error.final_cells, 0.3);
    EXPECT_LE(error.endings, 0.3);
    const FinalDistribution plain =
        propagate(chain, test::kNineByNine, start, {.max_cells = max_cells});
    double all = 0.0;
    for (const double v : visits) all += v;
    EXPECT_NEAR(all, plain.mean_steps, 1e-11);
  }
}

TEST(Lumping, RowsNeverSampledAreLeftOut) {
  Counts counts = test::boundary_counts(1);
  for (const int row : {1, 2, 4}) test::empty_row(counts, row);
  const Chain chain = Chain::from_counts(counts, test::boundary_exits());
  const Lumping lumping = lump(chain, {0, 1, 2, 1, 2}, {1.0, 5.0, 1.0, 1.0, 1.0});
  EXPECT_TRUE(lumping.chain.is_sampled(1));
  EXPECT_FALSE(lumping.chain.is_sampled(2));
  EXPECT_EQ(lumping.groups[1].weight, 1.0);
  EXPECT_EQ(lumping.groups[1].largest, 0.0);
}

TEST(Lumping, RefusesOtherGroupsAndWeights) {
  const Chain chain = three_states();
  using Groups = std::vector<int>;
  for (const Groups& groups : {Groups{0, 1}, Groups{0, 1, 3}, Groups{0, 2, 2}, Groups{-1, 0, 1}})
    EXPECT_THROW((void)lump(chain, groups, {1, 1, 1}), std::invalid_argument);
  EXPECT_THROW((void)lump(chain, {0, 1, 1}, {1, 1}), std::invalid_argument);
  EXPECT_THROW((void)lump(chain, {0, 1, 1}, {1, -1, 1}), std::invalid_argument);
  EXPECT_THROW((void)lump(chain, {0, 1, 1}, {1, std::numeric_limits<double>::infinity(), 1}),
               std::invalid_argument);
  EXPECT_THROW((void)lumping_error(chain, chain, {0, 1}, {3, 3}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace gatewalk::markov
