// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <map>
#include <sstream>

#include "cli/render/observed.h"

namespace gatewalk::cli {
namespace {

using lattice::EndingShares;
using lattice::FieldTally;
using markov::Ending;

/// The lines "share row low high" of a data block of a figure.
std::vector<std::array<double, 4>> block(const Figure& figure, const std::string& name) {
  const std::string head = "$" + name + " << EOD\n";
  const std::size_t begin = figure.commands.find(head);
  if (begin == figure.commands.npos) return {};
  const std::size_t end = figure.commands.find("EOD", begin + head.size());
  std::istringstream lines(figure.commands.substr(begin + head.size(), end - begin - head.size()));
  std::vector<std::array<double, 4>> all;
  for (std::array<double, 4> line{}; lines >> line[0] >> line[1] >> line[2] >> line[3];)
    all.push_back(line);
  return all;
}

struct Experiment {
  lattice::FieldParams field{.columns = 3, .rows = 8};
  lattice::ObservedComparison c;
  lattice::StartValidation v;

  /// Half of 10 trials crossed, half were trapped.
  Experiment()
      : v{.start = {},
          .chain_start = {},
          .dynamics = FieldTally(field),
          .walks = {},
          .exact = {},
          .walks_against = {},
          .exact_against = {},
          .paper_sized = {},
          .floor_100_exact = {},
          .floor_100_walks = {},
          .joint_test = {},
          .dynamics_endings = none(),
          .walks_endings = none(),
          .exact_endings = none(),
          .dynamics_exits = {},
          .exact_exits = {}} {
    c.seen.endings[static_cast<std::size_t>(Ending::far_edge)] = 5;
    c.seen.endings[static_cast<std::size_t>(Ending::trapped)] = 5;
    c.endings = EndingShares(c.seen.endings, 10);
    v.exact_endings.share[static_cast<std::size_t>(Ending::trapped)] = 0.25;
  }
  static EndingShares none() { return EndingShares(std::array<double, markov::kEndings>{}); }
};

// The Jeffreys interval of 5 in 10 is [0.224, 0.776] (Brown, Cai and DasGupta 2001, table 5).
TEST(ObservedFigure, EndingsWithTheirIntervals) {
  const Experiment e;
  const Figure figure = figure_of(e.c, e.v, e.field);
  const auto observed = block(figure, "observed_endings"), chain = block(figure, "chain_endings");
  ASSERT_EQ(observed.size(), 5U);
  ASSERT_EQ(chain.size(), 5U);
  for (const std::size_t at : {0, 3}) {  // crossed, trapped
    EXPECT_EQ(observed[at][0], 50.0);
    EXPECT_NEAR(observed[at][2], 22.4, 0.05);
    EXPECT_NEAR(observed[at][3], 77.6, 0.05);
  }
  EXPECT_EQ(observed[1][0], 0.0);
  EXPECT_NEAR(observed[1][3], 21.7, 0.05);  // of 0 in 10: [0, 0.217]
  EXPECT_EQ(chain[3][0], 25.0);
  EXPECT_EQ(block(figure, "observed_gates").size(), 0U) << "no gates were counted";
}

// Of 24 gates, the figure shows the 20 with the largest share, by trials or by chain, and the rest
// together.
TEST(ObservedFigure, GatesInWhichMostEnd) {
  Experiment e;
  e.c.seen.endings = {};
  e.c.seen.final_gates = markov::CellCounts::Zero(8, 3);
  e.c.seen.final_gates(0, 1) = 5;
  e.c.seen.final_gates(7, 2) = 5;
  e.v.dynamics.final_cells = markov::CellCounts::Constant(8, 3, 10);
  e.v.dynamics.trials = 240;
  e.v.exact.final_cells = markov::CellProbabilities::Constant(8, 3, 0.02);
  e.v.exact.final_cells(4, 0) = 0.54;
  const Figure figure = figure_of(e.c, e.v, e.field);
  const auto observed = block(figure, "observed_gates"), dynamics = block(figure, "dynamics_gates"),
             chain = block(figure, "chain_gates");
  ASSERT_EQ(observed.size(), 21U);
  ASSERT_EQ(chain.size(), 21U);
  EXPECT_EQ(chain[0][0], 54.0);
  EXPECT_EQ(observed[1][0], 50.0);
  EXPECT_NEAR(observed[1][2], 22.4, 0.05);
  EXPECT_EQ(observed[2][0], 50.0);
  EXPECT_EQ(observed[20][0], 0.0);
  EXPECT_NEAR(observed[20][3], 21.7, 0.05);
  EXPECT_NEAR(dynamics[20][0], 100.0 * 4 / 24, 1e-4);
  EXPECT_NEAR(chain[20][0], 100.0 * 4 * 0.02, 1e-4);
  EXPECT_NE(figure.commands.find("'-1, 4' 0, '0, 0' 1, '1, 7' 2"), std::string::npos)
      << "gates by column and row";
  EXPECT_EQ(block(figure, "observed_endings").size(), 0U) << "no endings were counted";
}

}  // namespace
}  // namespace gatewalk::cli
