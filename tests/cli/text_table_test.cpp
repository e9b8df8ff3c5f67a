// SPDX-License-Identifier: MIT
#include "cli/fields/text_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace gatewalk::cli {
namespace {

TEST(TextTable, NumbersStandOnTheRightWithDecimalsAndUnit) {
  TextTable table({{"ending", -9}, {"trials", 8}, {"share", 10, 1, "%"}, {"TV", 7, 3}});
  table.row({"crossed", std::int64_t{1490}, 25.06, 0.0314});
  table.row({"trapped", 7, std::nan(""), -0.0001});
  EXPECT_EQ(table.text(),
            "ending     trials     share     TV\n"
            "crossed      1490    25.1 %  0.031\n"
            "trapped         7       - %  0.000\n");
}

TEST(TextTable, AColumnMayFitItsWidestLine) {
  TextTable table(
      {{"key", -kFit, 0, "", "* "}, {"n", kFit, 0, "", " |"}, {"meaning", 0, 0, "", " "}});
  table.row({"a", 12, "short"});
  table.row({"µm", 5, "of a length"});
  EXPECT_EQ(table.text(),
            "* key | n meaning\n"
            "* a   |12 short\n"
            "* µm  | 5 of a length\n");
}

TEST(TextTable, WidthsCountCharactersNotBytes) {
  TextTable table({{"", 4}, {"", -4, 0, "", "|"}, {"", 0, 0, "", "|"}});
  table.row({"µm", "µm", "µm"});
  EXPECT_EQ(table.text(), "  µm|µm  |µm\n");
}

TEST(TextTable, LongerTextMovesTheRestOfItsLineOnly) {
  TextTable table({{"", -3}, {"", 4}});
  table.row({"four", 1});
  table.row({"one", 1});
  EXPECT_EQ(table.text(), "four   1\none   1\n");
}

TEST(TextTable, WithoutHeadingsHasRowsOnly) {
  TextTable table({{"", 3}});
  EXPECT_EQ(table.text(), "");
  table.row({1});
  EXPECT_EQ(table.text(), "  1\n");
}

TEST(TextTable, ALineMayEndEarlyAndNotLate) {
  TextTable table({{"", 3}, {"", 3, 0, "", "|"}});
  table.row({1});
  table.row({1, 2});
  EXPECT_EQ(table.text(), "  1\n  1|  2\n");
  EXPECT_THROW(table.row({1, 2, 3}), std::out_of_range);
}

TEST(TextTable, HeadingsAndRowsStandApart) {
  TextTable table({{"row", 4}, {"chance ", 8}});
  table.row({1, "0.5 "});
  EXPECT_EQ(table.header(), " row chance \n");
  EXPECT_EQ(table.rows(), "   1    0.5 \n");
}

}  // namespace
}  // namespace gatewalk::cli
