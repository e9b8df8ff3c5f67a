#include "cli/paper/verdicts.h"

#include <gtest/gtest.h>

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

// Fewer trials widen our interval: what was reproduced or different becomes unsure, never the other
// way round.
TEST(PaperVerdict, FewerTrialsAreNeverSurer) {
  EXPECT_EQ(against(52, share_of(46, 100)), Verdict::cannot_tell);
  EXPECT_EQ(against(52, share_of(23, 50)), Verdict::cannot_tell);
  EXPECT_EQ(against(13, share_of(0, 20)), Verdict::cannot_tell);
  EXPECT_EQ(against(13, share_of(0, 2000)), Verdict::differs);
}

std::vector<Share> shares(const std::vector<double>& values, std::int64_t trials) {
  std::vector<Share> s;
  for (const double v : values)
    s.push_back(share_of(static_cast<std::int64_t>(v * static_cast<double>(trials)), trials));
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
  EXPECT_EQ(verdict({0.1, 0.5, 0.2, 0.6}, 10000), Verdict::differs);  // a fall that 100 trials show
  EXPECT_EQ(verdict({0.1, 0.5, 0.2, 0.6}, 10000, true),
            Verdict::reproduced);  // if the paper allows it
  EXPECT_EQ(verdict({0.01, 0.05, 0.03, 0.6}, 10000),
            Verdict::agrees);  // a fall that they do not
  EXPECT_EQ(verdict({0.1, 0.2, 0.3, 0.4}, 100),
            Verdict::cannot_tell);  // too few trials to say "never falls"
}

// Shares of few: what 100 trials of all would show of them depends on how few they are.
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
