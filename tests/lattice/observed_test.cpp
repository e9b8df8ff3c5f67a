// SPDX-License-Identifier: MIT
// An experiment's counts: reading, refusals, and comparison with the model.
#include "lattice/study/observed.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "lattice/study/validation.h"
#include "lattice/text/csv.h"
#include "lattice/text/lines.h"
#include "lattice/text/text_stream.h"
#include "tests/support/disc_fields.h"

namespace gatewalk::lattice {
namespace {

using Fields = std::vector<std::string>;

// A read error is not the end of a file.
TEST(Lines, WhatCannotBeReadIsNoEnd) {
  try {
    (void)lines_of("/proc/self/mem");  // the first byte of memory cannot be read
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_STREQ(e.what(), "/proc/self/mem: cannot be read: Input/output error");
  }
}

TEST(Csv, ATextThatIsCutIsAnError) {
  TextStream text;
  EXPECT_THROW(text.setstate(std::ios_base::badbit), std::ios_base::failure);
}

TEST(Csv, SplitsALine) {
  EXPECT_EQ(csv_fields("a,b"), (Fields{"a", "b"}));
  EXPECT_EQ(csv_fields(""), Fields{""});
  EXPECT_EQ(csv_fields(" a \t, ,b c ,"), (Fields{"a", "", "b c", ""}));
  EXPECT_EQ(csv_fields(R"("a" , "b, ""c""" ,"")"), (Fields{"a", "b, \"c\"", ""}));
  EXPECT_EQ(csv_fields("a\"b"), Fields{"a\"b"});
  for (const char* wrong : {"\"a", "a,\"", "\"a\"b", "\"a\"\"", "\"a\" b,c"})
    EXPECT_FALSE(csv_fields(wrong)) << wrong;
}

class CountsFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string file(const std::string& name, const std::string& text) {
    const std::string path = (folder_ / name).string();
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }
  Observed read(const std::string& text) { return read_observed({file("x.csv", text)}, kField); }
  std::string message(const std::vector<std::string>& paths) {
    try {
      (void)read_observed(paths, kField);
    } catch (const std::invalid_argument& e) {
      std::string text = e.what();
      for (std::size_t at; (at = text.find(folder_.string() + "/")) != text.npos;)
        text.erase(at, folder_.string().size() + 1);
      return text;
    }
    return "nothing refused";
  }
  std::string refusal(const std::string& text) { return message(std::vector{file("x.csv", text)}); }

  static constexpr FieldParams kField{.columns = 4, .rows = 3};  // i_x = -2 to 1
  std::filesystem::path folder_;
};

TEST_F(CountsFile, OfFinalGates) {
  const Observed o = read("gate_x,gate_y,count\n0,0,3\n-2,2,5\n1,1,0\n");
  ASSERT_TRUE(o.seen.has_gates());
  EXPECT_FALSE(o.seen.has_endings());
  EXPECT_EQ(o.seen.trials(), 8);
  EXPECT_EQ(o.seen.final_gates(0, 2), 3);
  EXPECT_EQ(o.seen.final_gates(2, 0), 5);
  EXPECT_EQ(o.seen.final_gates.rows(), 3);
  EXPECT_EQ(o.seen.final_gates.cols(), 4);
}

TEST_F(CountsFile, OfEndingsAndInAnyOrder) {
  const Observed o = read("count,ending\n12,crossed\n48,trapped\n0,left_side\n");
  EXPECT_FALSE(o.seen.has_gates());
  EXPECT_EQ(o.seen.trials(), 60);
  EXPECT_EQ(o.seen.endings[static_cast<std::size_t>(markov::Ending::far_edge)], 12);
  EXPECT_EQ(o.seen.endings[static_cast<std::size_t>(markov::Ending::trapped)], 48);
  EXPECT_TRUE(o.listed[static_cast<std::size_t>(markov::Ending::left_edge)]);
  EXPECT_FALSE(o.listed[static_cast<std::size_t>(markov::Ending::cut_off)]);
}

TEST_F(CountsFile, AsSpreadsheetsAndPeopleWriteIt) {
  const Observed plain = read("gate_x,gate_y,count\n0,0,3\n1,2,4\n");
  const Observed other = read(
      "\xEF\xBB\xBF# my roaches, June\r\n\r\n \"gate_y\" , \"count\",gate_x\r\n"
      "0,\"3\", 0 \r\n  # the second day\r\n\"2\",4,\"1\"\r\n\r\n");
  EXPECT_TRUE((plain.seen.final_gates == other.seen.final_gates).all());
  const Observed capitals = read("Trial,ENDING\nA,crossed\na,trapped\n");
  EXPECT_EQ(capitals.seen.trials(), 2);
}

TEST_F(CountsFile, OfBothInTwoFiles) {
  const std::string gates = file("g.csv", "gate_x,gate_y,count\n0,0,7\n0,1,3\n"),
                    ends = file("e.csv", "ending,count\ncrossed,4\ntrapped,6\n"),
                    other = file("f.csv", "ending,count\ncrossed,4\n");
  const Observed o = read_observed({ends, gates}, kField);
  EXPECT_TRUE(o.seen.has_gates() && o.seen.has_endings());
  EXPECT_EQ(o.seen.trials(), 10);
  EXPECT_EQ(message({gates, other}),
            "g.csv has 10 trials, f.csv 4: both must be of the same trials");
  EXPECT_EQ(message({gates, ends, gates}), "g.csv: is given twice");
  const std::string lines = file("l.csv", "trial,ending\n1,crossed\n");
  EXPECT_EQ(message({ends, lines}),
            "l.csv: e.csv has endings too; files that are added up have the same columns");
}

TEST_F(CountsFile, RecordingsOfOneExperimentAreAddedUp) {
  const auto trapped = static_cast<std::size_t>(markov::Ending::trapped),
             crossed = static_cast<std::size_t>(markov::Ending::far_edge);
  const std::string one = file("a.csv", "ending,count\ncrossed,4\ntrapped,6\nwent back,1\n"),
                    two = file("b.csv", "ending,count\ntrapped,5\nwent back,2\n"),
                    gates = file("c.csv", "gate_x,gate_y,count\n0,0,7\n0,1,3\n"),
                    more = file("d.csv", "gate_x,gate_y,count\n0,0,5\n");
  const Observed o = read_observed({one, gates, two, more}, kField);
  EXPECT_EQ(o.seen.endings[crossed], 4);
  EXPECT_EQ(o.seen.endings[trapped], 11);
  EXPECT_EQ(o.went_back, 3);
  EXPECT_EQ(o.seen.final_gates.sum(), 15);
  EXPECT_EQ(o.seen.final_gates(0, kField.start_column()), 12);
  EXPECT_EQ(message({one, gates, two}),
            "c.csv has 10 trials, a.csv, b.csv 15: both must be of the same trials");
  // Trials belong to their file, whatever their names.
  const std::string first = file("e.csv", "trial,ending,gate_x,gate_y,time_s\n1,trapped,0,0,\n"),
                    second = file("f.csv", "trial,ending,gate_x,gate_y,time_s\n1,trapped,0,1,\n");
  const Observed lines = read_observed({first, second}, kField);
  EXPECT_EQ(lines.seen.endings[trapped], 2);
  EXPECT_EQ(lines.timed.size(), 2u);
  EXPECT_EQ(lines.gates_by_ending[trapped].sum(), 2);
}

TEST_F(CountsFile, OfTrialsOneLineEach) {
  const Observed o = read(
      "trial,ending\n1,crossed\n2,left side\nroach 3,left_side\n4,trapped\n5,went "
      "back\n6,trapped\n");
  EXPECT_FALSE(o.seen.has_gates());
  EXPECT_EQ(o.seen.trials(), 5);
  EXPECT_EQ(o.went_back, 1);
  EXPECT_EQ(o.seen.endings[static_cast<std::size_t>(markov::Ending::left_edge)], 2);
  EXPECT_EQ(o.seen.endings[static_cast<std::size_t>(markov::Ending::trapped)], 2);
  EXPECT_TRUE(o.listed[static_cast<std::size_t>(markov::Ending::right_edge)]);
  EXPECT_FALSE(o.listed[static_cast<std::size_t>(markov::Ending::cut_off)]);
}

TEST_F(CountsFile, NamesEndingsInCapitalsToo) {
  const Observed o = read("ending,count\nCrossed,4\nLeft side,3\nRIGHT_SIDE,2\nWent back,1\n");
  EXPECT_EQ(o.seen.endings[static_cast<std::size_t>(markov::Ending::far_edge)], 4);
  EXPECT_EQ(o.seen.endings[static_cast<std::size_t>(markov::Ending::left_edge)], 3);
  EXPECT_EQ(o.seen.endings[static_cast<std::size_t>(markov::Ending::right_edge)], 2);
  EXPECT_EQ(o.seen.trials(), 9);
  EXPECT_EQ(o.went_back, 1);
}

TEST_F(CountsFile, OfTrialsWithTheirGatesCountAsTheTwoTablesDo) {
  const Observed lines = read(
      "trial,ending,gate_x,gate_y\n1,crossed,0,2\n2,trapped,-2,1\n3,trapped,-2,1\n4,went back,,\n");
  const Observed tables = read_observed({file("e.csv", "ending,count\ncrossed,1\ntrapped,2\n"),
                                         file("g.csv", "gate_x,gate_y,count\n0,2,1\n-2,1,2\n")},
                                        kField);
  EXPECT_TRUE((lines.seen.final_gates == tables.seen.final_gates).all());
  EXPECT_EQ(lines.seen.endings, tables.seen.endings);
  EXPECT_EQ(lines.went_back, 1);
  const Observed gates = read("gate_x,trial,gate_y\n0,a,2\n-2,b,1\n-2,c,1\n");
  EXPECT_TRUE((gates.seen.final_gates == tables.seen.final_gates).all());
  EXPECT_FALSE(gates.seen.has_endings());
}

TEST_F(CountsFile, OfTimes) {
  const Observed o =
      read("trial,time_s,ending\n1,2.5,crossed\n2,,trapped\n3,7,went back\n4,9,cut off\n");
  ASSERT_EQ(o.timed.size(), 3U);
  EXPECT_EQ(o.timed[0].seconds, 2.5);
  EXPECT_EQ(o.timed[0].ending, static_cast<std::size_t>(markov::Ending::far_edge));
  EXPECT_EQ(o.timed[0].gate, -1);
  EXPECT_EQ(o.timed[1].seconds, 0.0);
  EXPECT_EQ(o.timed[2].seconds, 0.0);
  EXPECT_EQ(o.went_back, 1);
  const Observed gates = read("trial,ending,gate_x,gate_y,time_s\n1,crossed,-1,2,0.5\n");
  ASSERT_EQ(gates.timed.size(), 1U);
  EXPECT_EQ(gates.timed[0].gate, 2 * 4 + 1);
  EXPECT_EQ(gates.gates_by_ending[gates.timed[0].ending](2, 1), 1);
  for (const char* wrong : {"", "0", "-1", "inf", "2 s"})
    EXPECT_NE(refusal("trial,ending,time_s\n1,crossed," + std::string(wrong) + "\n")
                  .find("x.csv:2: column time_s: "),
              std::string::npos)
        << wrong;
  EXPECT_EQ(refusal("trial,ending,time_s\n1,trapped,hello\n").substr(0, 24),
            "x.csv:2: column time_s: ");
  EXPECT_NE(refusal("trial,gate_x,gate_y,time_s\n1,0,0,1\n").find("the columns must be"),
            std::string::npos);
}

TEST_F(CountsFile, RefusalsOfLinesOfTrials) {
  const std::string header = "trial,ending\n";
  EXPECT_EQ(refusal(header + "7,crossed\n8,trapped\n7,trapped\n"),
            "x.csv:4: trial \"7\" was given in line 2 already");
  EXPECT_EQ(refusal(header + ",crossed\n"), "x.csv:2: column trial: has no name or number");
  EXPECT_EQ(refusal(header + "1,crosses\n"),
            "x.csv:2: column ending: \"crosses\" is not permitted: must be one of crossed, left "
            "side, right side, trapped, cut off, or went back");
  EXPECT_EQ(refusal(header), "x.csv: has no trial");
  EXPECT_EQ(refusal(header + "1,went back\n"), "x.csv: has no trial that did not go back");
  EXPECT_EQ(refusal("ending,count\nwent back,3\ncrossed,0\n"),
            "x.csv: has no trial that did not go back: its counts add up to 0");
  EXPECT_EQ(read("ending,count\nwent back,3\ncrossed,2\n").went_back, 3);
  EXPECT_EQ(refusal("trial,ending,gate_x,gate_y\n1,crossed,,2\n").substr(0, 23),
            "x.csv:2: column gate_x:");
}

TEST_F(CountsFile, ABodyLeavesByASideFromAGateAtThatSide) {
  const std::string header = "trial,ending,gate_x,gate_y\n";
  EXPECT_EQ(refusal(header + "1,trapped,0,1\n2,crossed,0,1\n"),
            "x.csv:3: a body that ended as \"crossed\" cannot have gate_y = 1: must be 2, the last "
            "row (field.rows = 3)");
  EXPECT_EQ(refusal(header + "1,left side,0,1\n"),
            "x.csv:2: a body that ended as \"left side\" cannot have gate_x = 0: must be -2, the "
            "first column (field.columns = 4)");
  EXPECT_EQ(refusal(header + "1,right_side,-2,1\n"),
            "x.csv:2: a body that ended as \"right_side\" cannot have gate_x = -2: must be 1, the "
            "last column (field.columns = 4)");
  EXPECT_EQ(read(header + "1,crossed,-1,2\n2,left side,-2,0\n3,right side,01,0\n4,trapped,0,2\n"
                          "5,cut off,0,1\n")
                .seen.trials(),
            5);
}

TEST_F(CountsFile, RefusalsNameFileLineColumnAndWhatIsAllowed) {
  const std::string header = "gate_x,gate_y,count\n";
  const std::string kTables =
      "trial,ending, trial,gate_x,gate_y, or all four (with endings also time_s), "
      "gate_x,gate_y,count, or "
      "ending,count";
  EXPECT_EQ(refusal("gatex,gate_y,count\n"),
            "x.csv:1: unknown column \"gatex\": the columns must be " + kTables +
                ", each once; there are gatex, gate_y, count");
  EXPECT_EQ(refusal("Gate_X,Gate-Y,Count\n").substr(0, 32), "x.csv:1: unknown column \"gate-y\"");
  EXPECT_EQ(refusal("# x\nending count\ncrossed 3\n").substr(0, 40),
            "x.csv:2: unknown column \"ending count\": ");
  for (const char* columns : {"gate_x, count", "ending, gate_x, count", "count", "trial, gate_x"})
    EXPECT_EQ(refusal(columns),
              "x.csv:1: the columns must be " + kTables + ", each once; there are " + columns);
  EXPECT_EQ(refusal(header + "0,0,3\n2,0,1\n"),
            "x.csv:3: column gate_x: \"2\" is not permitted: must be a whole number from -2 to 1 "
            "(field.columns = 4)");
  EXPECT_EQ(refusal(header + "0,-1,3\n"),
            "x.csv:2: column gate_y: \"-1\" is not permitted: must be a whole number from 0 to 2 "
            "(field.rows = 3)");
  for (const char* count : {"-1", "2.5", "3 trials", "1.5e3", "99999999999"})
    EXPECT_EQ(refusal(header + "0,0," + count + "\n"),
              std::string("x.csv:2: column count: \"") + count +
                  "\" is not permitted: must be a whole number from 0 to 1000000000");
  EXPECT_EQ(refusal(header + "0,0,\n"),
            "x.csv:2: column count: nothing is not permitted: must be a whole number from 0 to "
            "1000000000");
  EXPECT_EQ(refusal(header + "0,0\n"),
            "x.csv:2: has 2 fields, the line of the columns (line 1) has 3");
  EXPECT_EQ(refusal(header + "0\n"),
            "x.csv:2: has 1 field, the line of the columns (line 1) has 3");
  EXPECT_EQ(refusal(header + "0,0,\"3\n"), "x.csv:2: a quotation mark is not closed");
  EXPECT_EQ(refusal(header + "0,0,3\n1,0,2\n0,0,3\n"),
            "x.csv:4: gate_x = 0, gate_y = 0 was given in line 2 already");
  EXPECT_EQ(refusal("ending,count\nturned back,3\n"),
            "x.csv:2: column ending: \"turned back\" is not permitted: must be one of crossed, "
            "left side, right side, trapped, cut off, or went back");
  EXPECT_EQ(refusal("ending,count\ncrossed,3\ncrossed,0\n"),
            "x.csv:3: ending crossed was given already");
  for (const std::string& none : {header, header + "0,0,0\n", std::string("ending,count\n")})
    EXPECT_EQ(refusal(none), "x.csv: has no trial: its counts add up to 0");
  for (const char* empty : {"", "\n\n", "# nothing\n"})
    EXPECT_EQ(refusal(empty), "x.csv: is empty: the columns must be " + kTables);
  EXPECT_EQ(message({"none.csv"}), "none.csv: cannot be read: No such file or directory");
  EXPECT_EQ(message({folder_.string()}), folder_.string() + ": cannot be read: Is a directory");
}

// ---- Against the model ----

/// No noise and a strong push: a body goes straight up through all three rows.
Scene straight_up(int max_gates = 9) {
  return parse_scene(
      "forces = { random_N = 0.0, propulsion_N = 100.0 }\n"
      "field = { columns = 3, rows = 3, max_gates = " +
          std::to_string(max_gates) + " }",
      "straight");
}
dynamics::Transitions all_up(const Scene& scene) {
  dynamics::Transitions t(dynamics::table3_space(scene.gate));
  for (int row = 0; row < t.space.size(); ++row) {
    const auto state = t.space.index_of({dynamics::Boundary::enter, {0.0, 0.0, 15.0}}).state;
    t.rows[static_cast<std::size_t>(row)][state] = 100'000;
    t.trials[static_cast<std::size_t>(row)] = 100'000;
  }
  return t;
}
ObservedComparison validated(const SeenEndings& seen, int max_gates = 9) {
  const Scene scene = straight_up(max_gates);
  return *validate_chain(
              problem_of(scene), {all_up(scene)}, {{0, {0.0, 0.0, 15.0}}},
              {.trials = 1000, .walks = {}, .null_draws = 499, .seed = 3, .observed = seen})
              .starts.front()
              .observed;
}
SeenEndings sixty(std::int64_t crossed) {
  SeenEndings seen{CellCounts::Zero(3, 3), {}};
  seen.final_gates(2, 1) = crossed;
  seen.final_gates(0, 1) = 60 - crossed;
  seen.endings[static_cast<std::size_t>(markov::Ending::far_edge)] = crossed;
  seen.endings[static_cast<std::size_t>(markov::Ending::trapped)] = 60 - crossed;
  return seen;
}

TEST(CompareObserved, EqualCountsDifferByNothingAndSayWhatWouldStayUnseen) {
  const ObservedComparison c = validated(sixty(60));
  EXPECT_FALSE(c.against_dynamics.differs());
  EXPECT_FALSE(c.against_chain.differs());
  EXPECT_EQ(c.dynamics_gates->total_variation, 0.0);
  EXPECT_EQ(c.chain_gates->total_variation, 0.0);
  // All trials cross: one that does not is significant, and 1 - (1 - d)^60 is 0.8 for d = 0.0265.
  const auto& crossed = c.least.by_ending[static_cast<std::size_t>(markov::Ending::far_edge)];
  EXPECT_NEAR(crossed.fewer.value(), 1.0 - std::pow(0.2, 1.0 / 60), 1e-9);
  EXPECT_FALSE(crossed.more);
  EXPECT_FALSE(c.least.final_gates);  // a single gate has no shares to shift
}

TEST(CompareObserved, AFewThatDoNotCrossAreSeenInEitherTable) {
  const SeenEndings both = sixty(54);
  for (const SeenEndings& seen :
       {both, SeenEndings{both.final_gates, {}}, SeenEndings{{}, both.endings}}) {
    const ObservedComparison c = validated(seen);
    EXPECT_TRUE(c.against_dynamics.differs());
    EXPECT_TRUE(c.against_chain.differs());
    EXPECT_EQ(c.dynamics_gates.has_value(), seen.has_gates());
    EXPECT_EQ(std::isnan(c.against_dynamics.total_variation.p), !seen.has_gates());
    EXPECT_EQ(std::isnan(c.against_chain.chi_squared.p), !seen.has_gates());
    EXPECT_EQ(c.against_dynamics.differs(markov::Ending::far_edge), seen.has_endings());
    EXPECT_EQ(c.against_chain.differs(markov::Ending::trapped), seen.has_endings());
    EXPECT_FALSE(c.against_dynamics.differs(markov::Ending::left_edge));
    if (seen.has_gates()) {
      EXPECT_NEAR(c.chain_gates->total_variation, 0.1, 1e-12);
    }
  }
}

TEST(CompareObserved, WithoutALimitOfGatesCuttingOffIsRuledOut) {
  constexpr auto kCutOff = markov::Ending::cut_off;
  EXPECT_FALSE(validated(sixty(60)).endings.rules_out(kCutOff));
  EXPECT_TRUE(validated(sixty(60), 0).endings.rules_out(kCutOff));
  SeenEndings seen = sixty(54);
  seen.endings[static_cast<std::size_t>(markov::Ending::trapped)] = 0;
  seen.endings[static_cast<std::size_t>(kCutOff)] = 6;
  EXPECT_FALSE(validated(seen).endings.rules_out(kCutOff));
  EXPECT_THROW((void)validated(seen, 0), std::invalid_argument);
}

TEST(CompareObserved, BelongsToOneStart) {
  const Scene scene = straight_up();
  EXPECT_THROW(
      (void)validate_chain(problem_of(scene), {all_up(scene)}, {{0, {0, 0, 15}}, {0, {1, 0, 15}}},
                           {.trials = 10, .walks = {}, .null_draws = 9, .observed = sixty(60)}),
      std::invalid_argument);
}

// ---- Two samples, judged together ----

SeenEndings three(bool first) {
  SeenEndings seen{CellCounts::Zero(1, 2), {}};
  seen.final_gates(0, first ? 0 : 1) = 3;
  seen.endings[first ? 0 : 1] = 3;
  return seen;
}

// Three here, three there: 2 of the 20 ways to deal them are as far apart.
TEST(JudgeTwoSamples, PermutationsOfAHandfulAreExact) {
  constexpr int kDraws = 9999;
  const JointTest j = joint_test(three(true), three(false), kDraws, 1);
  const double four_errors = 4 * std::sqrt(0.1 * 0.9 / kDraws);
  EXPECT_NEAR(j.total_variation.p, 0.1, four_errors);
  EXPECT_NEAR(j.endings[0].p, 0.1, four_errors);
  EXPECT_EQ(j.endings[2].p, 1.0);
  // Tables are permuted independently: one of them is as far apart in 1 - 0.9^2 of all cases.
  EXPECT_GE(j.p, 0.1 - four_errors);
  EXPECT_LE(j.p, 0.19 + four_errors);
}

// Gates and endings that determine each other are the worst case of independent permutations: even
// then the test finds at most 5 % without a difference, and also if gates and endings are
// independent.
TEST(JudgeTwoSamples, FindsNoMoreThanTheLevelWhereNothingDiffers) {
  constexpr std::uint64_t kRepeats = 600;
  CellProbabilities p(1, 5);
  p << 0.4, 0.3, 0.15, 0.1, 0.05;
  const auto sample = [&](std::int64_t n, std::uint64_t seed, std::uint64_t k, bool together) {
    SeenEndings seen{sampled(p, n, seed, k), {}};
    const CellCounts ends = together ? seen.final_gates : sampled(p, n, seed + 100, k);
    std::copy_n(ends.data(), 5, seen.endings.begin());
    return seen;
  };
  for (const bool together : {true, false}) {
    double found = 0.0;
    for (std::uint64_t k = 0; k < kRepeats; ++k)
      found +=
          joint_test(sample(60, 1, k, together), sample(400, 2, k, together), 199, k).differs();
    EXPECT_LE(found / kRepeats, 0.05 + 4 * std::sqrt(0.05 * 0.95 / kRepeats)) << together;
    RecordProperty(together ? "found_together" : "found_apart", std::to_string(found / kRepeats));
  }
}

TEST(JudgeTwoSamples, RefusesWhatHasNothingInCommon) {
  const SeenEndings seen = three(true);
  EXPECT_THROW((void)joint_test(seen, SeenEndings{{}, {}}, 9, 1), std::invalid_argument);
  EXPECT_THROW(
      (void)joint_test(SeenEndings{seen.final_gates, {}}, SeenEndings{{}, seen.endings}, 9, 1),
      std::invalid_argument);
  EXPECT_THROW((void)joint_test(seen, SeenEndings{CellCounts::Ones(2, 1), {}}, 9, 1),
               std::invalid_argument);
  EXPECT_THROW((void)joint_test(seen, seen, 0, 1), std::invalid_argument);
}

}  // namespace
}  // namespace gatewalk::lattice
