// SPDX-License-Identifier: MIT
#include "cli/render/tested_shares.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gatewalk::cli {
namespace {

using markov::Ending;

constexpr double kLevel = 0.05;

TEST(TestedShares, TheLargestOfThoseThatDifferIsNamed) {
  const std::vector<TestedShare> shares{{Ending::trapped, 0.30, 0.20},
                                        {Ending::far_edge, 0.04, 0.01},
                                        {Ending::left_edge, 0.05, 0.04},
                                        {Ending::unsampled, 0.02, 0.001}};
  EXPECT_EQ(named_share(shares, 0.001, kLevel), 2U);
}

TEST(TestedShares, OfEqualDifferencesTheFirstIsNamed) {
  const std::vector<TestedShare> shares{{Ending::far_edge, 0.1, 0.01},
                                        {Ending::trapped, 0.3 - 0.2 + 1e-15, 0.01}};
  EXPECT_EQ(named_share(shares, 1.0, kLevel), 0U);
}

TEST(TestedShares, StatesNeverSampledCount) {
  const std::vector<TestedShare> shares{{Ending::trapped, 0.30, 0.20},
                                        {Ending::unsampled, 0.02, 0.001}};
  EXPECT_EQ(named_share(shares, 1.0, kLevel), 1U);
  EXPECT_EQ(name_of(Ending::unsampled), "never sampled");
  EXPECT_EQ(name_of(Ending::far_edge), "crossed");
}

TEST(TestedShares, NoneIsNamedIfOnlyFinalGatesDiffer) {
  const std::vector<TestedShare> shares{{Ending::trapped, 0.30, 0.20},
                                        {Ending::far_edge, 0.04, 0.06}};
  EXPECT_EQ(named_share(shares, 0.01, kLevel), std::nullopt);
  // Without a difference, the largest of all; NaN: final gates were not counted.
  EXPECT_EQ(named_share(shares, 0.06, kLevel), 0U);
  EXPECT_EQ(named_share(shares, std::nan(""), kLevel), 0U);
}

}  // namespace
}  // namespace gatewalk::cli
