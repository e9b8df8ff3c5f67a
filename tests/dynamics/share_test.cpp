// SPDX-License-Identifier: MIT
#include "dynamics/base/share.h"

#include <gtest/gtest.h>

namespace gatewalk::dynamics {
namespace {

// Jeffreys' interval of 0 of n has the lower end 0; other values from the table of Brown, Cai and
// DasGupta (2001), n = 10.
TEST(ShareInterval, IsJeffreys) {
  EXPECT_EQ(share_interval(0, 10)[0], 0.0);
  EXPECT_NEAR(share_interval(0, 10)[1], 0.217, 5e-4);
  EXPECT_NEAR(share_interval(5, 10)[0], 0.224, 5e-4);
  EXPECT_NEAR(share_interval(5, 10)[1], 0.776, 5e-4);
  EXPECT_EQ(share_interval(10, 10)[1], 1.0);
  EXPECT_EQ(interval_of_share(0.5, 10.0), share_interval(5, 10));
}

TEST(ShareInterval, ContainsTheShare) {
  const auto [low, high] = interval_of_share(1e-99, 100.0);
  EXPECT_LE(low, 1e-99);
  EXPECT_NEAR(high, 0.0247, 1e-4);
  EXPECT_GE(interval_of_share(1.0 - 1e-16, 100.0)[1], 1.0 - 1e-16);
}

TEST(ShareInterval, LessThanOneTrialMayBeNone) {
  EXPECT_EQ(interval_of_share(0.009, 100.0)[0], 0.0);
  EXPECT_EQ(interval_of_share(0.991, 100.0)[1], 1.0);
  EXPECT_NEAR(interval_of_share(1.0 / 49.0, 49.0)[0], share_interval(1, 49)[0], 1e-12);
}

}  // namespace
}  // namespace gatewalk::dynamics
