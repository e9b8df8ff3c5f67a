// SPDX-License-Identifier: MIT
#include "cli/fields/text.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gatewalk::cli {
namespace {

TEST(Text, AZeroHasNoSign) {
  EXPECT_EQ(fixed(-0.004, 2), "0.00");
  EXPECT_EQ(fixed(-0.0, 0), "0");
  EXPECT_EQ(fixed(-0.006, 2), "-0.01");
  EXPECT_EQ(fixed(-10.0, 1), "-10.0");
  EXPECT_EQ(fixed(std::nan(""), 1), "-");
}

TEST(Text, OneOfAKindIsNamedSo) {
  EXPECT_EQ(counted(1, "gap", "gaps"), "1 gap");
  EXPECT_EQ(counted(0, "gap", "gaps"), "0 gaps");
  EXPECT_EQ(counted(12, "gap", "gaps"), "12 gaps");
}

}  // namespace
}  // namespace gatewalk::cli
