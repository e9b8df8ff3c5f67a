// SPDX-License-Identifier: MIT
#include "cli/render/final_gates.h"

#include <gtest/gtest.h>

#include <sstream>

#include "cli/arguments.h"
#include "cli/fields/json_value.h"
#include "cli/fields/text.h"
#include "cli/render/health.h"
#include "cli/render/start.h"
#include "dynamics/base/share.h"
#include "dynamics/disc/disc_section.h"

namespace gatewalk::cli {
namespace {

using markov::CellProbabilities;

struct Printed {
  std::vector<std::vector<double>> rows;  // farthest first
  std::vector<int> row_labels, columns;
  std::string head, tail;
};

Printed printed(const CellProbabilities& shares) {
  Printed p;
  std::istringstream text(map_of(shares, shares.cols() / 2, "final gate", "% of trials"));
  std::getline(text, p.head);
  for (std::string line; std::getline(text, line);) {
    std::istringstream words(line);
    std::string word;
    if (line.find(" |") != std::string::npos) {
      words >> word;
      p.row_labels.push_back(std::stoi(word));
      words >> word;
      p.rows.emplace_back();
      while (words >> word) p.rows.back().push_back(word == "." ? 0.0 : std::stod(word));
    } else if (line.starts_with("(blocks of ")) {
      p.head += " " + line;
    } else if (line.find("i_x") != std::string::npos) {
      words >> word;
      for (int i = 0; words >> i;) p.columns.push_back(i);
    } else {
      p.tail += line;
    }
  }
  return p;
}

// Counts and an exact share: the endings by name, in a fixed order, with Jeffreys intervals.
TEST(Endings, AreNamedWithTheirIntervals) {
  const std::array<std::int64_t, markov::kEndings> counts{700, 1,  120, 119,
                                                          0,   60, 0};  // by markov::Ending
  const lattice::EndingShares shares(counts, 1000);
  const Json json = json_of([&](Fields& out) { describe_endings(out, counts, 1000.0, shares); });
  EXPECT_EQ(json.at("endings").dump(),
            R"({"crossed":1,"left_side":120,"right_side":119,"trapped":700,"cut_off":60})");
  const Json& intervals = json.at("endings_95");
  EXPECT_EQ(intervals["trapped"][0], 1000.0 * dynamics::share_interval(700, 1000)[0]);
  EXPECT_LT(intervals["crossed"][0].get<double>(), 1.0);
  EXPECT_GT(intervals["crossed"][1].get<double>(), 1.0);
  for (const int k : {0, 1})
    EXPECT_NEAR(dynamics::interval_of_share(0.7, 1000.0)[k], dynamics::share_interval(700, 1000)[k],
                1e-12);
  const std::string text = endings_text(shares, "of 1000 trials");
  EXPECT_EQ(text.substr(0, text.find('\n')), "crossed       0.10 %  [0.01, 0.47]  of 1000 trials");
  EXPECT_NE(text.find("\nleft side    12.00 %  [10.10, 14.12]\n"), std::string::npos) << text;
  // Shares without intervals, of which one is too small for two decimals.
  EXPECT_EQ(endings_text(lattice::EndingShares({0.5, 1.23e-7, 0, 0, 0, 0, 0}), "x").substr(0, 23),
            "crossed    1.2e-05 %  x");
  const lattice::EndingShares without({0.5, 0.5, 0, 0, 0, 0, 0});
  EXPECT_TRUE(json_of([&](Fields& out) { describe_endings(out, without); })["endings_95"]["crossed"]
                  .is_null());
}

TEST(Endings, LabelsOfStartsKeepTheirDigits) {
  const dynamics::Section& disc = dynamics::disc_section();
  const StartTexts paper(disc, {{0, {0, 0, 15}}, {0, {23, -11, 16}}});
  EXPECT_EQ(paper.header, "   d   vx   vy");
  EXPECT_EQ(paper.texts[1], "  23  -11   16");
  const StartTexts own(disc, {{0, {4.3, 5.1, 10.2}}, {0, {-0.00125, 0, 15}}});
  EXPECT_EQ(own.header, "        d   vx    vy");
  EXPECT_EQ(own.texts[0], "      4.3  5.1  10.2");
  EXPECT_EQ(own.texts[1], " -0.00125    0    15");
  // Starts through other faces add a column with the face.
  const StartTexts sides(disc, {{0, {1, 2, 3}}, {dynamics::left_deflect, {4, 5, 6}}});
  EXPECT_EQ(sides.header, " face   d   vx   vy");
  EXPECT_EQ(sides.texts[1], "   LD   4    5    6");
}

TEST(MapOf, SmallFieldsAreShownWhole) {
  CellProbabilities shares = CellProbabilities::Zero(2, 3);
  shares(0, 1) = 0.25;
  shares(1, 2) = 0.75;
  EXPECT_EQ(map_of(shares, 1, "final gate", "% of trials"),
            "final gate, % of trials (i_y upwards, i_x to the right)\n"
            "   1 |      .      .  75.00\n"
            "   0 |      .  25.00      .\n"
            "  i_x      -1      0      1\n");
  const std::string from_left = map_of(shares, 0, "final gate", "% of trials");
  EXPECT_TRUE(from_left.ends_with("  i_x       0      1      2\n")) << from_left;
}

// Visits per 100 bodies by walks that circle for long: a blank stands before each number.
TEST(MapOf, LargeNumbersStandApart) {
  CellProbabilities visits = CellProbabilities::Zero(2, 3);
  visits(0, 1) = 25000.5;
  visits(0, 2) = 123456.25;
  visits(1, 0) = 0.25;
  EXPECT_EQ(map_of(visits, 1, "visits of each gate", "per 100 bodies"),
            "visits of each gate, per 100 bodies (i_y upwards, i_x to the right)\n"
            "   1 |       25.00           .           .\n"
            "   0 |           .  2500050.00 12345625.00\n"
            "  i_x           -1           0           1\n");
}

TEST(MapOf, LargeFieldsAreShownWhereTheSharesLie) {
  CellProbabilities shares = CellProbabilities::Zero(500, 301);
  shares(123, 140) = 0.5;
  shares(130, 149) = 0.49999;
  shares(400, 7) = 1e-5;
  const Printed p = printed(shares);
  EXPECT_EQ(p.head, "final gate, % of trials (i_y upwards, i_x to the right)");
  EXPECT_EQ(p.row_labels, (std::vector{130, 129, 128, 127, 126, 125, 124, 123}));
  EXPECT_EQ(p.columns, (std::vector{-10, -9, -8, -7, -6, -5, -4, -3, -2, -1}));
  EXPECT_EQ(p.rows.back().front(), 50.0);
  EXPECT_EQ(p.rows.front().back(), 50.0);
  EXPECT_EQ(p.tail, "elsewhere in the 301 x 500 gates: 0.0010 %");
}

TEST(MapOf, WideSharesAreShownInBlocksAroundTheStart) {
  for (const auto& [rows, columns] :
       {std::pair{200, 301}, {41, 16}, {3, 100}, {1000, 9}, {2001, 2001}}) {
    const CellProbabilities shares =
        CellProbabilities::Constant(rows, columns, 1.0 / rows / columns);
    const Printed p = printed(shares);
    EXPECT_LE(p.rows.size(), 40u);
    EXPECT_LE(p.columns.size(), 13u);
    EXPECT_NE(std::find(p.columns.begin(), p.columns.end(), 0), p.columns.end());
    double sum = 0.0;
    for (const auto& row : p.rows) {
      EXPECT_EQ(row.size(), p.columns.size());
      for (const double share : row) sum += share;
    }
    EXPECT_NEAR(sum, 100.0, 0.005 * static_cast<double>(p.rows.size() * p.columns.size()));
    EXPECT_EQ(p.row_labels.back(), 0);
    EXPECT_EQ(p.tail, "");
  }
}

// A share within the rounding error is shown as 0; a share above it is shown, however small.
TEST(FinalGates, SharesWithinRoundingAreNone) {
  markov::FinalDistribution f;
  constexpr auto kCut = static_cast<std::size_t>(markov::Ending::cut_off),
                 kFar = static_cast<std::size_t>(markov::Ending::far_edge);
  f.endings[kCut] = 4.2e-16;
  f.endings[kFar] = 3e-13;
  f.rounding = 2e-13;
  f.remainder = 5e-14;
  lattice::EndingShares shares(f.endings);
  shares.interval[kCut] = {1e-17, 0.01};
  const lattice::EndingShares shown = shown_endings(shares, f);
  EXPECT_EQ(shown.share[kCut], 0.0);
  EXPECT_EQ(shown.interval[kCut], (std::array<double, 2>{0.0, 0.01}));
  EXPECT_EQ(shown.share[kFar], 3e-13);
  EXPECT_TRUE(std::isnan(shown.interval[kFar][0]));
  f.rounding = 3e-13;
  EXPECT_EQ(shown_endings(shares, f).share[kFar], 0.0);
}

TEST(FinalGates, LargeFieldsAreLeftOutOfJson) {
  const CellProbabilities small = CellProbabilities::Zero(100, 1000),
                          large = CellProbabilities::Zero(101, 1000);
  Json json = json_of([&](Fields& out) {
    describe_map(out, {"small", "1", "a map"}, small);
    describe_map(out, {"large", "1", "a map"}, large);
  });
  EXPECT_EQ(json["small"], Json(100, std::vector<double>(1000, 0.0)));
  EXPECT_TRUE(json["large"].is_null());
  json = json_of([](Fields& out) { describe_left_out(out, 1000, 100); });
  EXPECT_TRUE(json.empty());
  json = json_of([](Fields& out) { describe_left_out(out, 1000, 101); });
  EXPECT_NE(json.at("left_out").get<std::string>().find("--netcdf"), std::string::npos);
}

}  // namespace
}  // namespace gatewalk::cli
