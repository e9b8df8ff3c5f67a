// SPDX-License-Identifier: MIT
#include "cli/paper/figures.h"

#include <gtest/gtest.h>

#include <limits>

#include "cli/paper/studies.h"
#include "cli/terminal/gnuplot.h"

namespace gatewalk::cli {
namespace {

const double kNone = std::nan("");

TEST(PaperFigures, SymbolsAreSetAsThePaperPrintsThem) {
  EXPECT_EQ(as_printed("k_L = 5").quoted(), "'{/:Italic k}_{/=12 L} = 5'");
  EXPECT_EQ(as_printed("d = 5, and = 5").quoted(), "'{/:Italic d} = 5, an{/:Italic d} = 5'");
  EXPECT_EQ(as_printed("the paper's").quoted(), "'the paper''s'");
}

// The paper's value of the first group is a line beside the two rows of that group only, and a mark
// on the axis.
TEST(PaperFigures, AMarkConcernsItsOwnGroup) {
  const Share share{0.01, 0.005, 0.02};
  const Figure f =
      rates({"head"}, {{"a", kFirstColour, 7}, {"b", kSecondColour, 5}},
            {{"first", {{"x", {share, share}}, {"y", {share, {kNone, 0.0, 0.0}}}}, 25.0, "paper"},
             {"second", {{"z", {share, share}}}, kNone, ""}},
            "%");
  EXPECT_NE(f.commands.find("$marks << EOD\n5 0.5 0 2\nEOD"), std::string::npos) << f.commands;
  EXPECT_NE(f.commands.find("set xrange [0:5.1]"), std::string::npos) << f.commands;
  // The second series has no value in the second row.
  EXPECT_NE(f.commands.find("$series0 << EOD\n1 0.87 0.7071068 1.414214\n1 1.87 "),
            std::string::npos)
      << f.commands;
  EXPECT_NE(f.commands.find("$series1 << EOD\n1 1.13 0.7071068 1.414214\n1 4.13 "),
            std::string::npos)
      << f.commands;
}

TEST(PaperFigures, AMapIsCutAtItsCeilingAndHasHolesWhereADiscCoversAJoint) {
  dynamics::Landscape l;
  l.x = {0.0, 1.0};
  l.y = {0.0, 1.0};
  l.total.resize(2, 2);
  l.total << 10.0, 90.0, 20.0, std::numeric_limits<double>::infinity();
  const EnergyMap map{"$m", 50.0, 10.0};
  Panels out = paper_panels();
  EXPECT_EQ(map.add_data(out, l, l.total).text(), "0 0 10\n1 0 50\n\n0 1 20\n1 1 NaN\n\n");
}

TEST(PaperFigures, Fig5HasItsNumbersOnAGridOfOneMetre) {
  const Section s = fig5();
  EXPECT_EQ(s.csv.substr(0, 37), "panel,x_m,y_m,energy_J\nA,-25,0,0\nA,-2");
  EXPECT_TRUE(s.film.is_null());
  EXPECT_EQ(s.figure.width, Sheet::kWidth);
  EXPECT_NO_THROW((void)drawn("set terminal svg\n" + s.figure.commands));
}

}  // namespace
}  // namespace gatewalk::cli
