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

TEST(Text, LinesAreBrokenAtBlanksWithinTheScreen) {
  EXPECT_EQ(wrapped("one line"), "one line\n");
  EXPECT_EQ(wrapped(""), "\n");
  const std::string word(45, 'x'), wide(120, 'y'), accents = "\u00e9\u00e9";
  EXPECT_EQ(wrapped("  " + word + " " + word, "    "), "  " + word + " " + word + "\n");
  EXPECT_EQ(wrapped("  " + word + " " + word + " on", "    "), "  " + word + " " + word + " on\n");
  EXPECT_EQ(wrapped("  " + word + " " + word + " next line", "    "),
            "  " + word + " " + word + " next\n    line\n");
  EXPECT_EQ(wrapped("a " + wide + " b", "  "), "a\n  " + wide + "\n  b\n");
  // A p-value and a percentage stay on one line.
  EXPECT_EQ(wrapped(word + " " + word + " (p = 0.05)"), word + " " + word + "\n(p = 0.05)\n");
  EXPECT_EQ(wrapped(word + " " + word + " (p < 0.001"), word + " " + word + "\n(p < 0.001\n");
  EXPECT_EQ(wrapped(word + " " + word + " is at 80 %"), word + " " + word + " is at\n80 %\n");
  // A letter of two bytes is one column.
  EXPECT_EQ(wrapped(word + " " + word + " 12345 " + accents),
            word + " " + word + " 12345 " + accents + "\n");
}

}  // namespace
}  // namespace gatewalk::cli
