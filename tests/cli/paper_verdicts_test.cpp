// SPDX-License-Identifier: MIT
#include "cli/paper/verdicts.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cli/paper/claims.h"
#include "cli/paper/studies.h"

namespace gatewalk::cli {
namespace {

TEST(PaperVerdict, OfANumberCountedIn100Trials) {
  EXPECT_EQ(against(52, share_of(4630, 10000)),
            Verdict::reproduced);  // within [42, 62] whatever our chance
  EXPECT_EQ(against(52, share_of(500, 10000)), Verdict::differs);
  EXPECT_EQ(against(13, share_of(20, 10000)), Verdict::differs);
  EXPECT_EQ(against(98, share_of(9800, 10000)), Verdict::reproduced);
  EXPECT_EQ(against(13, share_of(750, 10000)), Verdict::agrees);  // on the edge
  EXPECT_EQ(against(52, share_of(0, 0)), Verdict::cannot_tell);
}

// Fewer trials widen our interval. A claim that was reproduced or different then becomes unsure,
// never the reverse.
TEST(PaperVerdict, FewerTrialsAreNeverSurer) {
  EXPECT_EQ(against(52, share_of(46, 100)), Verdict::cannot_tell);
  EXPECT_EQ(against(52, share_of(23, 50)), Verdict::cannot_tell);
  EXPECT_EQ(against(13, share_of(0, 20)), Verdict::cannot_tell);
  EXPECT_EQ(against(13, share_of(0, 2000)), Verdict::differs);
}

std::vector<Share> shares(const std::vector<double>& values, std::int64_t trials) {
  std::vector<Share> s;
  for (const double v : values)
    s.push_back(share_of(std::llround(v * static_cast<double>(trials)), trials));
  return s;
}
Verdict verdict(const std::vector<double>& values, std::int64_t trials, bool wiggles = false) {
  Trend trend;
  trend.add({4, 5, 6, 7}, shares(values, trials));
  return trend.verdict(wiggles);
}

TEST(PaperVerdict, OfATrend) {
  EXPECT_EQ(verdict({0.1, 0.2, 0.3, 0.4}, 10000), Verdict::reproduced);
  EXPECT_EQ(verdict({0.4, 0.3, 0.2, 0.1}, 10000), Verdict::differs);
  EXPECT_EQ(verdict({0.3, 0.3, 0.3, 0.3}, 10000), Verdict::differs);  // it does not rise
  EXPECT_EQ(verdict({0.1, 0.5, 0.2, 0.6}, 10000), Verdict::differs);  // 100 trials show this fall
  EXPECT_EQ(verdict({0.1, 0.5, 0.2, 0.6}, 10000, true),
            Verdict::reproduced);  // the paper allows the fall
  EXPECT_EQ(verdict({0.01, 0.05, 0.03, 0.6}, 10000),
            Verdict::agrees);  // 100 trials would not show this fall
  EXPECT_EQ(verdict({0.1, 0.2, 0.3, 0.4}, 100),
            Verdict::cannot_tell);  // too few trials to say "never falls"
}

// A slow fall: 100 trials tell its ends apart, but not two neighbours.
TEST(PaperVerdict, ATrendFallsBetweenAnyTwoPlaces) {
  EXPECT_EQ(verdict({0.2, 0.6, 0.53, 0.46, 0.39, 0.7}, 10000), Verdict::differs);
  EXPECT_EQ(verdict({0.2, 0.6, 0.57, 0.54, 0.51, 0.7}, 10000), Verdict::agrees);
}

TEST(PaperVerdict, ATrendThatThePaperAllowsToWiggleGoesMoreUpThanDown) {
  EXPECT_EQ(verdict({0.3, 0.2, 0.1, 0.4}, 10000, true), Verdict::differs);  // down in most steps
  EXPECT_EQ(verdict({0.3, 0.4, 0.2, 0.5}, 10000, true), Verdict::reproduced);
}

TEST(PaperVerdict, MostSeriesOfATrendMustRise) {
  const auto of = [](int rising) {
    Trend trend;
    for (int i = 0; i < 8; ++i)
      trend.add(
          {4, 5, 6},
          shares(i < rising ? std::vector{0.1, 0.2, 0.3} : std::vector{0.3, 0.3, 0.3}, 10000));
    return trend.verdict();
  };
  EXPECT_EQ(of(1), Verdict::differs);
  EXPECT_EQ(of(4), Verdict::differs);
  EXPECT_EQ(of(5), Verdict::reproduced);
}

// 17 of 1000 trials: 17 / (17 / 1000.0) is slightly below 1000, and must count as 1000.
TEST(PaperVerdict, TrialsBehindSharesOfFewAreRounded) {
  Trend trend;
  trend.add({1, 2}, {share_of(1, 17), share_of(17, 17)}, {17 / 1000.0, 17 / 1000.0});
  EXPECT_EQ(trend.verdict(), Verdict::reproduced);
}

Verdict rise_then_fall(const std::vector<std::vector<double>>& series, std::int64_t trials) {
  RiseThenFall shape;
  for (const std::vector<double>& values : series) shape.add(shares(values, trials));
  return shape.verdict();
}

TEST(PaperVerdict, OfARiseAndAFall) {
  const std::vector<double> both{0.0, 0.3, 0.5, 0.2}, flat{0.1, 0.1, 0.1, 0.1},
      only_down{1.0, 0.976, 0.741, 0.43}, slightly_down{0.1, 0.08, 0.07, 0.06},
      only_up{0.0, 0.1, 0.3, 0.6}, no_fall{0.0, 0.3, 0.31, 0.31}, again{0.0, 0.5, 0.1, 0.4},
      dip{0.3, 0.0, 0.5, 0.2};
  EXPECT_EQ(rise_then_fall({both}, 10000), Verdict::reproduced);
  EXPECT_EQ(rise_then_fall({both}, 100), Verdict::cannot_tell);
  // Enough trials show that nothing rises.
  EXPECT_EQ(rise_then_fall({flat, flat}, 10000), Verdict::differs);
  EXPECT_EQ(rise_then_fall({flat, flat}, 100), Verdict::cannot_tell);
  // A contradiction that 100 trials would show decides, however many series agree.
  EXPECT_EQ(rise_then_fall({both, both, both, only_down}, 10000), Verdict::differs);
  EXPECT_EQ(rise_then_fall({both, only_up}, 10000), Verdict::differs);
  EXPECT_EQ(rise_then_fall({both, again}, 10000), Verdict::differs);
  EXPECT_EQ(rise_then_fall({both, dip}, 10000), Verdict::differs);
  EXPECT_EQ(rise_then_fall({both, both, slightly_down}, 10000), Verdict::agrees);
  EXPECT_EQ(rise_then_fall({both, no_fall, no_fall}, 10000), Verdict::agrees);
}

TEST(PaperVerdict, OfAStatementInManyPlaces) {
  const bool enough = true, few = false;
  EXPECT_EQ((Places{100, 90, 1, 0}.verdict(enough)), Verdict::reproduced);
  EXPECT_EQ((Places{100, 90, 1, 0}.verdict(enough, true)), Verdict::agrees);
  EXPECT_EQ((Places{100, 70, 12, 0}.verdict(enough)), Verdict::agrees);
  EXPECT_EQ((Places{100, 70, 12, 5}.verdict(enough)), Verdict::differs);
  EXPECT_EQ((Places{100, 0, 0, 0}.verdict(enough)), Verdict::differs);
  EXPECT_EQ((Places{100, 12, 12, 0}.verdict(enough)), Verdict::differs);
  EXPECT_EQ((Places{0, 0, 0, 0}.verdict(enough)), Verdict::differs);
  EXPECT_EQ((Places{0, 0, 0, 0}.verdict(few)), Verdict::cannot_tell);
  EXPECT_EQ((Places{100, 90, 0, 0}.verdict(few)), Verdict::cannot_tell);
  EXPECT_EQ((Places{100, 1, 30, 0}.verdict(few)), Verdict::differs);
}

TEST(PaperVerdict, RareAndEven) {
  EXPECT_EQ(rare_and_even(share_of(41, 10000), share_of(21, 41)), Verdict::reproduced);
  EXPECT_EQ(rare_and_even(share_of(20, 10000), share_of(6, 20)), Verdict::cannot_tell);
  EXPECT_EQ(rare_and_even(share_of(1000, 10000), share_of(600, 1000)), Verdict::agrees);
  EXPECT_EQ(rare_and_even(share_of(1000, 10000), share_of(900, 1000)), Verdict::differs);
  EXPECT_EQ(rare_and_even(share_of(5000, 10000), share_of(2500, 5000)), Verdict::differs);
  EXPECT_EQ(rare_and_even(share_of(0, 10000), share_of(0, 0)), Verdict::cannot_tell);
}

/// The findings of Figs. 8 and 12 if the outcomes are these.
Findings found(std::int64_t trials, std::int64_t (*left)(double force, double random),
               std::int64_t (*right)(double force, double random)) {
  Findings f;
  const auto add = [&](Sweep& to, double damping, double force, double random, double k) {
    PaperPoint p;
    p.trials = trials;
    p.counts = {left(force, random), right(force, random)};
    p.place = {{kDamping, damping}, {kPropulsion, force}, {kRandom, random}};
    if (k > 0) p.place[kLeftStiffness] = k;
    to.points.push_back(std::move(p));
  };
  for (const double damping : {50.0, 10.0})
    for (double random = 0; random <= 60; random += 10) {
      for (double force = 4; force <= 9; ++force) add(f.fig8, damping, force, random, 0);
      for (const double force : {7.0, 8.0})
        for (const double k : {100.0, 300.0, 500.0}) add(f.fig12, damping, force, random, k);
    }
  return f;
}

// If nothing of the paper's statement is seen, enough trials say that it differs; few cannot tell.
TEST(PaperClaims, WhatIsSeenNowhereDiffers) {
  const auto none = [](double, double) { return std::int64_t{0}; };
  const auto verdicts = [](const Findings& f) {
    std::vector<Verdict> all;
    for (const char* id : {"rises_with_propulsion", "rises_then_falls", "peak_at_20", "escape",
                           "softer_side", "fig12_propulsion"})
      all.push_back(claim_of(id, f).verdict);
    return all;
  };
  EXPECT_EQ(verdicts(found(10000, none, none)), std::vector(6, Verdict::differs));
  EXPECT_EQ(verdicts(found(100, none, none)), std::vector(6, Verdict::cannot_tell));
}

TEST(PaperClaims, BothSidesAlikeIsNotTheSofterSide) {
  const auto some = [](double, double) { return std::int64_t{2000}; };
  const auto none = [](double, double) { return std::int64_t{0}; };
  EXPECT_EQ(claim_of("softer_side", found(10000, some, some)).verdict, Verdict::differs);
  EXPECT_EQ(claim_of("softer_side", found(10000, some, none)).verdict, Verdict::reproduced);
}

// The verdict on Table IV needs a standard deviation, and so enough repeats.
TEST(PaperClaims, AStartOfFewRepeatsIsNotJudged) {
  ValidatedStart start;
  start.paper_corrcoef = 0.9;
  start.paper_rmse = 1.0;
  start.exact.corrcoef = start.walks.corrcoef = {0.5, 0.01};
  start.exact.rmse = start.walks.rmse = {1.0, 0.1};
  Findings f;
  f.field.starts = {start, start};
  f.field.starts[0].repeats = 10;
  f.field.starts[1].repeats = 100;
  EXPECT_EQ(claim_of("table4_1", f).verdict, Verdict::cannot_tell);
  EXPECT_EQ(claim_of("table4_2", f).verdict, Verdict::differs);
}

// Sentences without their value are left out; numbers have the digits that the text asks for.
TEST(PaperClaims, TextsHoldWhatWasMeasured) {
  Findings f;
  f.fig9_300.runs.resize(4);
  f.fig9_300.runs[0].hits = 52;
  const Claim claim = claim_of("many_hits", f);
  EXPECT_EQ(claim.ours, "13 hits on average");
  EXPECT_EQ(claim.why,
            "In 4 traversals with k_L = 300, k_R = 500, d = 10; ten would count as many.");
  EXPECT_EQ(claim_of("inertia", f).ours, "20.83 kg m^2");
  const auto none = [](double, double) { return std::int64_t{0}; };
  EXPECT_EQ(claim_of("peak_at_20", found(100, none, none)).why,
            "Of 0 to 40 N no random force gives more than none beyond chance.");
  EXPECT_THROW((void)claim_of("nothing", f), std::out_of_range);
}

TEST(PaperClaims, ALittleLessThanAlwaysAgrees) {
  const auto verdict_of_steep = [](std::int64_t traversed, bool downhill) {
    Findings f = found(
        10, [](double, double) { return std::int64_t{1}; },
        [](double, double) { return std::int64_t{1}; });
    f.steep.fine.from_basin.way.resize(downhill ? 1 : 2);
    f.steep.measured.trials = 10000;
    f.steep.measured.counts = {traversed};
    return claim_of("steep", f).verdict;
  };
  EXPECT_EQ(verdict_of_steep(10000, true), Verdict::reproduced);
  EXPECT_EQ(verdict_of_steep(9990, true), Verdict::agrees);
  EXPECT_EQ(verdict_of_steep(9000, true), Verdict::differs);
  EXPECT_EQ(verdict_of_steep(10000, false), Verdict::differs);
}

// Shares of a subset of the trials: what 100 trials would show depends on the size of the subset.
TEST(PaperVerdict, OfATrendOfSharesOfFew) {
  const std::vector<Share> s = shares({0.05, 0.6, 0.3, 0.5}, 1000);
  Trend many, few;
  many.add({100, 200, 300, 400}, s, {1, 1, 1, 1});
  few.add({100, 200, 300, 400}, s, {0.02, 0.02, 0.02, 0.02});
  EXPECT_EQ(many.falling, 1);
  EXPECT_EQ(many.at, 200);
  EXPECT_EQ(many.verdict(), Verdict::differs);
  EXPECT_EQ(few.verdict(), Verdict::agrees);
}

TEST(PaperVerdict, TextHasDigitsAsTheTrialsAllow) {
  EXPECT_EQ(percent_text(share_of(46, 100)), "46 % [36, 56]");
  EXPECT_EQ(percent_text(share_of(0, 10000)), "0.00 % [0.00, 0.03]");
  EXPECT_EQ(percent_text(share_of(0, 0)), "none of none");
}

}  // namespace
}  // namespace gatewalk::cli
