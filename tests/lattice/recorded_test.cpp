// SPDX-License-Identifier: MIT
// Tables of recorded runs: reading, refusals by line and column, writing text that reads back the
// same, and speed.
#include "lattice/recorded/recorded.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "dynamics/base/random.h"
#include "tests/support/measured.h"

namespace gatewalk::lattice {
namespace {

using dynamics::Entry;

const std::filesystem::path kRoot = std::filesystem::path(__FILE__).parent_path() / ".." / "..";

const std::string kCells = R"(
cell = { width_m = 0.1, length_m = 0.1, trapped_after_s = 10.0, faces = [
  { name = "S", move = [0, 1] }, { name = "W", move = [1, 0] }, { name = "E", move = [-1, 0] }
], coordinates = [
  { name = "s", unit = "m", scale = 0.1 }, { name = "vx", unit = "m s-1" },
  { name = "vy", unit = "m s-1" }
], costs = [{ key = "work_J", unit = "J" }] }
)";
const std::string kHeader = "body,trial,in,s,vx,vy,out,out_s,out_vx,out_vy,time_s,work_J\n";
const std::string kRuns = kHeader +
                          "# two bodies\n"
                          "b7,1,S,0.012,-0.05,0.21,W,0.031,-0.18,0.02,0.63,1.5\n"
                          "b7,1,W,0.031,-0.18,0.02,trapped,,,,10.0,\n"
                          "\n"
                          "b9,1,E,0,0,1,S,0.5,-0,1e-3,2,-4\n"
                          "b9,1,S,0.50,0.0,0.001,lost,,,,,\n"
                          "b7,2,S,0.1,0.2,0.3,S,0.1,0.2,0.3,1,1\n";

class Recorded : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        std::filesystem::path(testing::TempDir()) /
        (std::string("recorded_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string path(const std::string& name = "x.csv") const {
    return (folder_ / name).string();
  }
  RecordedRuns read(const std::string& text, CellFile of) const {
    std::ofstream(path(), std::ios::binary) << text;
    return read_runs(path(), of);
  }
  RecordedRuns read(const std::string& text) const { return read(text, cells); }
  [[nodiscard]] std::string refused_as(const std::string& text, const CellFile& of) const {
    try {
      (void)read(text, of);
    } catch (const std::invalid_argument& error) {
      std::string message = error.what();
      if (const std::size_t at = message.find(path()); at != message.npos)
        message.replace(at, path().size(), "x.csv");
      return message;
    }
    return "(accepted)";
  }
  [[nodiscard]] std::string refused_as(const std::string& text) const {
    return refused_as(text, cells);
  }

  const CellFile cells = parse_cell_file(kCells, "cell.toml");
  std::filesystem::path folder_;
};

/// `text` with `to` instead of the first `from`.
std::string instead(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, text.npos) << from;
  return text.replace(at, from.size(), to);
}

bool equal_or_unknown(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) ||
         (std::isnan(a) && std::isnan(b));
}

void expect_same(const RecordedRuns& a, const RecordedRuns& b) {
  EXPECT_EQ(a.bodies, b.bodies);
  EXPECT_EQ(a.trapped, b.trapped);
  EXPECT_EQ(a.lost, b.lost);
  EXPECT_EQ(a.unknown, b.unknown);
  ASSERT_EQ(a.trials.size(), b.trials.size());
  for (std::size_t t = 0; t < a.trials.size(); ++t) {
    const RecordedTrial &x = a.trials[t], &y = b.trials[t];
    ASSERT_TRUE(x.start == y.start && x.body == y.body && x.first == y.first && x.count == y.count)
        << t;
  }
  ASSERT_EQ(a.passages.size(), b.passages.size());
  for (std::size_t i = 0; i < a.passages.size(); ++i) {
    const auto x = a.passages[i], y = b.passages[i];
    ASSERT_TRUE(x.fate == y.fate && x.type == y.type && x.entry.face == y.entry.face) << i;
    for (std::size_t c = 0; c < x.entry.at.size(); ++c)
      ASSERT_TRUE(equal_or_unknown(x.entry.at[c], y.entry.at[c])) << i;
    for (std::size_t c = 0; c < x.costs.size(); ++c)
      ASSERT_TRUE(equal_or_unknown(x.costs[c], y.costs[c])) << i;
  }
}

TEST_F(Recorded, ReadsEveryPassage) {
  const RecordedRuns runs = read(kRuns);
  EXPECT_EQ(runs.bodies, (std::vector<std::string>{"b7", "b9"}));
  EXPECT_EQ(runs.trapped, 1);
  EXPECT_EQ(runs.lost, 1);
  EXPECT_EQ(runs.unknown[0], 0);
  EXPECT_EQ(runs.unknown[1], 1);  // the lost passage's cost does not count
  ASSERT_EQ(runs.trials.size(), 3u);
  EXPECT_EQ(runs.trials[0].start, (Entry{0, {0.012, -0.05, 0.21}}));
  EXPECT_EQ(runs.trials[1].start, (Entry{2, {0.0, 0.0, 1.0}}));
  EXPECT_EQ(runs.trials[2].start, (Entry{0, {0.1, 0.2, 0.3}}));
  const std::array<std::array<std::int64_t, 3>, 3> wanted{{{0, 0, 2}, {1, 2, 2}, {0, 4, 1}}};
  for (std::size_t t = 0; t < 3; ++t)
    EXPECT_EQ((std::array<std::int64_t, 3>{runs.trials[t].body, runs.trials[t].first,
                                           runs.trials[t].count}),
              wanted[t]);
  ASSERT_EQ(runs.passages.size(), 5u);
  const auto first = runs.passages[0], second = runs.passages[1], lost = runs.passages[3];
  EXPECT_EQ(first.entry, (Entry{1, {0.031, -0.18, 0.02}}));
  EXPECT_EQ(first.costs[0], 0.63);
  EXPECT_EQ(first.costs[1], 1.5);
  EXPECT_EQ(second.fate, dynamics::Fate::trapped);
  EXPECT_EQ(second.costs[0], 10.0);
  EXPECT_TRUE(std::isnan(second.costs[1]));
  EXPECT_EQ(lost.fate, dynamics::Fate::broken);
  EXPECT_TRUE(std::isnan(lost.costs[0]));
  EXPECT_TRUE(std::signbit(runs.passages[2].entry.at[1]));
}

// Tables as spreadsheets and other programs write them.
TEST_F(Recorded, ColumnsStandInAnyOrderAndFieldsMayBeQuoted) {
  const RecordedRuns plain = read(kHeader +
                                  "b 1,x,S,1,2,3,W,4,5,6,7,8\n"
                                  "b 1,x,W,4,5,6,lost,,,,0,\n");
  expect_same(read("\xEF\xBB\xBF# first\r\nwork_J,time_s,out_vy,out_vx,out_s,out,vy,vx,s,in,trial,"
                   "body\r\n"
                   "8,7,6,5,4,W,3,2,1,S,x,\"b 1\"\r\n"
                   " , 0 ,\t,,,lost,6.0,5e0, 4.00 ,\"W\",\"x\", b 1 \r\n"),
              plain);
  expect_same(read(kHeader + "b 1,x,S,1,2,3,W,4,5,6,7,8\nb 1,x,W,4,5,6,lost,,,,0,"), plain);
}

TEST_F(Recorded, TypesAreThoseOfTheFileOfCells) {
  const CellFile typed = parse_cell_file(
      instead(kCells, "costs = ", "types = [{ name = \"a\" }, { name = \"b\" }], costs = "),
      "cell.toml");
  const std::string header = "type," + kHeader;
  const std::string line = "p,1,S,1,2,3,S,1,2,3,4,5\n";
  const RecordedRuns runs = read(header + "b," + line + "a," + line, typed);
  EXPECT_EQ(runs.passages[0].type, 1);
  EXPECT_EQ(runs.passages[1].type, 0);
  EXPECT_EQ(refused_as(header + "c," + line, typed),
            "x.csv:2: column type: \"c\" is not permitted: must be a type of cell of cell.toml, "
            "one of a,b");
  EXPECT_EQ(refused_as(kHeader + line, typed),
            "x.csv:1: column type is missing: the columns must be "
            "body,trial,type,in,s,vx,vy,out,out_s,out_vx,out_vy,time_s,work_J; there are body, "
            "trial, in, s, vx, vy, out, out_s, out_vx, out_vy, time_s, work_J");
  EXPECT_EQ(read(header + ".," + line).passages[0].type, 0);  // the name of the only type
}

TEST_F(Recorded, ScalesAreTheSpreadOfWhatWasSeen) {
  CellFile own = cells;
  std::ofstream(path()) << kHeader << "p,1,S,1,2,7,S,3,4,7,1,\np,1,S,3,4,7,S,100,100,100,1,\n"
                        << "p,2,S,1,9,7,lost,,,,,\n";
  (void)read_runs(path(), own);
  EXPECT_EQ(own.map.section.coordinates[0].scale, 0.1);  // given in the file
  // From 2, 4 and 9, entries into cells; the last moves of bodies are no entries.
  EXPECT_NEAR(own.map.section.coordinates[1].scale, std::sqrt(26.0 / 3.0), 1e-14);
  EXPECT_EQ(own.map.section.coordinates[2].scale, 1.0);
  EXPECT_EQ(own.has_scale, cells.has_scale);
}

TEST_F(Recorded, RefusesByFileLineAndColumn) {
  struct Wrong {
    std::string from, to, message;
  };
  const std::string columns = "body,trial,in,s,vx,vy,out,out_s,out_vx,out_vy,time_s,work_J";
  const std::string known = "body,trial,type,in,s,vx,vy,out,out_s,out_vx,out_vy,time_s,work_J";
  const std::vector<Wrong> all{
      {"time_s", "times",
       "x.csv:1: unknown column \"times\" (did you mean time_s?): the columns must be " + known +
           ", as cell.toml has faces, coordinates and costs"},
      {"work_J", "body",
       "x.csv:1: column work_J is missing: the columns must be " + columns +
           "; there are body, trial, in, s, vx, vy, out, out_s, out_vx, out_vy, time_s, body"},
      {",time_s,work_J\n# two bodies\nb7,1,S,0.012,-0.05,0.21,W,0.031,-0.18,0.02,0.63,1.5",
       ",work_J\n# two bodies\nb7,1,S,0.012,-0.05,0.21,W,0.031,-0.18,0.02,0.63",
       "x.csv:1: column time_s is missing: the columns must be " + columns +
           "; there are body, trial, in, s, vx, vy, out, out_s, out_vx, out_vy, work_J"},
      {",1.5\n", "\n", "x.csv:3: has 11 fields, the line of the columns (line 1) has 12"},
      {",1.5\n", ",1.5,2\n",
       "x.csv:3: has 13 fields, the line of the columns (line 1) has 12 (are there names of rows? "
       "Name their column, or write none)"},
      {"b7,1,S", "b7", "x.csv:3: has 10 fields, the line of the columns (line 1) has 12"},
      {"b7,1,S", "\"b7,1,S", "x.csv:3: a quotation mark is not closed"},
      {"b7,1,S", ",1,S",
       "x.csv:3: column body: nothing is not permitted: must be a name or a number"},
      {"b7,1,S", "NA,1,S",
       "x.csv:3: column body: \"NA\" is not permitted: must be a name or a number"},
      {"b7,1,S", "#N/A,1,S",
       "x.csv:3: column body: \"#N/A\" is not permitted: must be a name or a number"},
      {"b7,1,S", "b7,,S",
       "x.csv:3: column trial: nothing is not permitted: must be a name or a number"},
      {"b7,1,S", "b7,1,N",
       "x.csv:3: column in: \"N\" is not permitted: must be a face of cell.toml, one of S, W, E"},
      {"0.012", "0.012 m",
       "x.csv:3: column s: \"0.012 m\" is not permitted: must be a number, such as 0.25 or "
       "-2.5e-1"},
      {"0.012", "",
       "x.csv:3: column s: nothing is not permitted: must be a number, such as 0.25 or -2.5e-1"},
      {"0.012", "nan",
       "x.csv:3: column s: \"nan\" is not permitted: must be a number, such as 0.25 or -2.5e-1"},
      {"0.012", "1e999",
       "x.csv:3: column s: \"1e999\" is not permitted: must be a number, such as 0.25 or -2.5e-1"},
      {"0.21,W,0.031", "0.21,N,0.031",
       "x.csv:3: column out: \"N\" is not permitted: must be trapped, lost, or the face by which "
       "the next cell is entered, one of S, W, E"},
      {"0.21,W,0.031", "0.21,,0.031",
       "x.csv:3: column out: nothing is not permitted: must be trapped, lost, or the face by which "
       "the next cell is entered, one of S, W, E"},
      {"W,0.031", "W,inf",
       "x.csv:3: column out_s: \"inf\" is not permitted: must be a number, such as 0.25 or "
       "-2.5e-1"},
      {"0.21,W,0.031", "0.21,lost,0.031",
       "x.csv:3: column out_s: \"0.031\" is not permitted: must be blank, as a body that is lost "
       "enters no cell"},
      {"b7,1,W,", "b7,1,S,",
       "x.csv:4: column in: \"S\" is not permitted: must be W, by which the passage before (line "
       "3) went on"},
      {"b7,1,W,0.031,-0.18", "b7,1,W,0.031,-0.1800001",
       "x.csv:4: column vx: \"-0.1800001\" is not permitted: must be -0.18, with which the passage "
       "before (line 3) went on: the same number"},
      {"b9,1,E,0,0,1,S,0.5,-0,1e-3,2", "b7,1,E,0,0,1,S,0.5,-0,1e-3,2",
       "x.csv:6: trial 1 of body b7 was trapped in the passage before (line 4): none can follow; a "
       "body that is seen again begins another trial"},
      {"b7,2,S", "b9,1,S",
       "x.csv:8: trial 1 of body b9 was lost in the passage before (line 7): none can follow; a "
       "body that is seen again begins another trial"},
      {"b7,2,S", "b7,1,S",
       "x.csv:8: this trial of body b7 began in line 3 already: the passages of a trial must stand "
       "one behind the other"},
      {"0.63", "0",
       "x.csv:3: column time_s: \"0\" is not permitted: must be a number of seconds > 0"},
      {"0.63", "-0.5",
       "x.csv:3: column time_s: \"-0.5\" is not permitted: must be a number of seconds > 0"},
      {"0.63", "nan",
       "x.csv:3: column time_s: \"nan\" is not permitted: must be a number of seconds > 0"},
      {"0.63", "",
       "x.csv:3: column time_s: nothing is not permitted: must be a number of seconds > 0"},
      {"lost,,,,,", "lost,,,,-1,",
       "x.csv:7: column time_s: \"-1\" is not permitted: must be a number of seconds from 0, or "
       "blank"},
      {"0.63", "10.1",
       "x.csv:3: column time_s: \"10.1\" is not permitted: must be at most cell.trapped_after_s = "
       "10 of cell.toml; a body that stayed longer is trapped, and its trial ends there"},
      {"lost,,,,,", "lost,,,,11,",
       "x.csv:7: column time_s: \"11\" is not permitted: must be at most cell.trapped_after_s = 10 "
       "of cell.toml; a body that stayed longer is trapped, and its trial ends there"},
      {"trapped,,,,10.0", "trapped,,,,9.9",
       "x.csv:4: column time_s: \"9.9\" is not permitted: must be at least cell.trapped_after_s = "
       "10 of cell.toml where out is trapped; a body that was seen no longer is lost"},
      {",1.5\n", ",1.5 J\n",
       "x.csv:3: column work_J: \"1.5 J\" is not permitted: must be a number, such as 0.25 or "
       "-2.5e-1"}};
  for (const Wrong& wrong : all)
    EXPECT_EQ(refused_as(instead(kRuns, wrong.from, wrong.to)), wrong.message) << wrong.to;
  EXPECT_EQ(refused_as(""), "x.csv: is empty: the columns must be " + columns);
  EXPECT_EQ(refused_as("# nothing\n\n"), "x.csv: is empty: the columns must be " + columns);
  EXPECT_EQ(refused_as(kHeader), "x.csv: has no passage below the line of its columns");
  EXPECT_EQ(refused_as(kHeader + std::string(2 << 20, 'x')),
            "x.csv:2: is longer than 1048576 bytes");
  EXPECT_EQ(
      refused_as(instead(kRuns, "lost,,,,,", "lost,,,\r,,")),
      "x.csv:7: a carriage return within a line: lines must end in \\n or \\r\\n, or all in \\r");
  CellFile of = cells;
  try {
    (void)read_runs(path("none.csv"), of);
    ADD_FAILURE() << "none.csv was read";
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(std::string(error.what()),
              path("none.csv") + ": cannot be read: No such file or directory");
  }
  EXPECT_THROW((void)read_runs(folder_.string(), of), std::invalid_argument);
}

// Recorded times may differ from the limit in their last digits.
TEST_F(Recorded, TimesMayBeOffTheLimitByRounding) {
  const std::string line = "p,1,S,1,2,3,";
  EXPECT_EQ(refused_as(kHeader + line + "S,1,2,3,10.000000001,\n"), "(accepted)");
  EXPECT_EQ(refused_as(kHeader + line + "trapped,,,,9.999999999,\n"), "(accepted)");
  EXPECT_EQ(refused_as(kHeader + line + "trapped,,,,1e6,\n"), "(accepted)");
  CellFile without = cells;
  without.trapped_after.reset();
  EXPECT_EQ(refused_as(kHeader + line + "trapped,,,,0.1,\n", without), "(accepted)");
  EXPECT_EQ(refused_as(kHeader + line + "S,1,2,3,1e6,\n", without), "(accepted)");
}

TEST_F(Recorded, TrialsThatAreNamedAlikeAreNotTheSame) {
  const std::string line = ",S,1,2,3,S,1,2,3,4,5\n";
  const RecordedRuns runs =
      read(kHeader + "p,1" + line + "p,01" + line + "p,1a" + line + "p,+1" + line + "p,1.0" + line +
           "p,18446744073709551615" + line + "p,9223372036854775808" + line + "q,1" + line);
  EXPECT_EQ(runs.trials.size(), 8u);
  EXPECT_EQ(refused_as(kHeader + "p,01" + line + "p,1" + line + "p,01" + line),
            "x.csv:4: this trial of body p began in line 2 already: the passages of a trial must "
            "stand one behind the other");
}

/// Trials with random numbers; a third of the times of lost bodies is unknown.
RecordedRuns any_runs(const CellFile& cells, std::int64_t passages, std::int64_t bodies) {
  RecordedRuns runs;
  runs.passages.begin(cells.map.section);
  dynamics::Random random(dynamics::Purpose::field, {7, 0, 0});
  for (std::int64_t b = 0; b < bodies; ++b) runs.bodies.push_back("b" + std::to_string(b));
  const auto faces = static_cast<double>(cells.map.section.faces.size());
  const auto entry = [&] {
    Entry e{static_cast<int>(random.uniform() * faces), {}};
    for (std::size_t c = 0; c < cells.map.section.coordinates.size(); ++c)
      e.at[c] = std::ldexp(random.uniform() - 0.5, static_cast<int>(20 * random.uniform()) - 10);
    return e;
  };
  while (std::ssize(runs.passages) < passages) {
    RecordedTrial trial{entry(), static_cast<std::int32_t>(runs.trials.size() % bodies),
                        std::ssize(runs.passages), 0};
    for (bool goes_on = true; goes_on; ++trial.count) {
      CellPassage passage;
      passage.type = static_cast<std::uint8_t>(random.uniform() * 2.0);
      passage.costs[0] = 10.0 * random.uniform();
      passage.costs[1] = -random.uniform() / 3.0;
      const double what = random.uniform();
      passage.fate = what < 0.02   ? dynamics::Fate::trapped
                     : what < 0.05 ? dynamics::Fate::broken
                                   : dynamics::Fate::left;
      goes_on = what >= 0.1;  // the body may leave the field
      if (what >= 0.05) passage.entry = entry();
      if (what < 0.01) passage.costs[1] = std::numeric_limits<double>::quiet_NaN();
      if (what >= 0.04 && what < 0.05) passage.costs[0] = std::numeric_limits<double>::quiet_NaN();
      runs.trapped += what < 0.02;
      runs.lost += what >= 0.02 && what < 0.05;
      runs.unknown[1] += what < 0.01;
      runs.passages.push_back(passage);
    }
    runs.trials.push_back(trial);
  }
  return runs;
}

CellFile two_types() {
  CellFile cells = parse_cell_file(
      instead(kCells, "costs = ", "types = [{ name = \"a\" }, { name = \"b\" }], costs = "),
      "cell.toml");
  cells.trapped_after.reset();
  return cells;
}

TEST_F(Recorded, WhatIsWrittenReadsBackToTheLastBit) {
  CellFile typed = two_types();
  RecordedRuns runs = any_runs(typed, 5000, 100);
  runs.bodies[3] = "a, \"b\"";
  runs.bodies[4] = "#4";
  runs.bodies[5] = " 5";
  write_runs(path(), typed, runs);
  expect_same(read_runs(path(), typed), runs);
  // Extreme numbers, and a table without types.
  RecordedRuns few = read(kHeader +
                          "p,1,S,5e-324,-1.7976931348623157e308,-0,S,2.2250738585072014e-308,"
                          "0.1,1e22,0.30000000000000004,\n");
  write_runs(path("few.csv"), cells, few);
  CellFile own = cells;
  own.has_scale.assign(3, true);
  expect_same(read_runs(path("few.csv"), own), few);
}

TEST_F(Recorded, EightCoordinatesReadBackToTheLastBit) {
  CellFile wide = two_types();
  std::vector<dynamics::Coordinate>& coordinates = wide.map.section.coordinates;
  while (coordinates.size() < 8) {
    const std::string name = "c" + std::to_string(coordinates.size());
    coordinates.push_back({name, name, "1", name});
  }
  wide.has_scale.assign(8, true);
  const RecordedRuns runs = any_runs(wide, 5000, 100);
  write_runs(path(), wide, runs);
  const RecordedRuns back = read_runs(path(), wide);
  expect_same(back, runs);
  EXPECT_NE(back.passages[0].entry.at[7], 0.0);
}

TEST_F(Recorded, WhatCouldNotBeReadIsNotWritten) {
  const auto refused = [&](auto change) {
    RecordedRuns runs = read(kRuns);
    change(runs);
    try {
      write_runs(path("new.csv"), cells, runs);
    } catch (const std::invalid_argument&) {
      return !std::filesystem::exists(path("new.csv"));
    }
    return false;
  };
  EXPECT_TRUE(refused([](RecordedRuns& r) { r.bodies[0] = ""; }));
  EXPECT_TRUE(refused([](RecordedRuns& r) { r.bodies[0] = "two\nlines"; }));
  EXPECT_TRUE(refused([](RecordedRuns& r) { r.trials[0].start.at[1] = NAN; }));
  // Continues after it was trapped.
  EXPECT_TRUE(refused([](RecordedRuns& r) { r.trials[0].count = 3; }));
  EXPECT_TRUE(refused([&](RecordedRuns& r) {
    r.passages = PassageTable(cells.map.section);
    r.trials = {{{}, 0, 0, 1}};
    r.passages.push_back({dynamics::Fate::left, 0, {}, {}});  // takes no time
  }));
  EXPECT_FALSE(refused([](RecordedRuns&) {}));
}

/// The text between two lines of three backticks, the first of which continues with `kind`.
std::string example_of(const std::string& kind) {
  std::ifstream file(kRoot / "cli" / "site" / "reference" / "files.md");
  std::string text, line;
  while (std::getline(file, line) && line != "```" + kind) continue;
  while (std::getline(file, line) && line != "```") text += line + "\n";
  return text;
}

TEST_F(Recorded, TheExamplesOfTheDocumentationAreRead) {
  const CellFile documented = parse_cell_file(example_of("toml"), "files.md");
  EXPECT_EQ(documented.types, (std::vector<std::string>{"soft", "hard"}));
  EXPECT_EQ(documented.map.type_of_cell, (std::vector<int>{0, 0, 0, 0, 0, 1}));
  EXPECT_EQ(documented.map.section.costs.size(), 2u);
  ASSERT_TRUE(documented.start);

  const std::string tracks = (kRoot / "scenes" / "tracks" / "").string();
  CellFile of_tracks = read_cell_file(tracks + "cell.toml");
  const RecordedRuns lines = read(example_of("csv"), of_tracks);
  EXPECT_EQ(lines.passages.size(), 2u);
  const RecordedRuns made_up = read_runs(tracks + "runs.csv", of_tracks);
  EXPECT_EQ(made_up.passages.size(), 40u);
  EXPECT_EQ(made_up.bodies.size(), 12u);
  EXPECT_EQ(made_up.trapped, 7);
  EXPECT_EQ(made_up.lost, 2);
}

// A million passages, in CPU time relative to a program that only finds the lines.
TEST_F(Recorded, AMillionLinesAreReadInABoundedTime) {
  CellFile typed = two_types();
  const RecordedRuns runs = any_runs(typed, 1'000'000, 200);
  const double written_from = test::thread_seconds();
  write_runs(path(), typed, runs);
  const double read_from = test::thread_seconds();
  const RecordedRuns again = read_runs(path(), typed);
  const double plain_from = test::thread_seconds();
  std::ifstream file(path());
  std::int64_t lines = 0;
  for (std::string line; std::getline(file, line);) ++lines;
  const double end = test::thread_seconds();
  EXPECT_EQ(lines, 1 + std::ssize(runs.passages));
  EXPECT_EQ(again.passages.size(), runs.passages.size());
  const double plain = end - plain_from;
  RecordProperty("read_seconds", std::to_string(plain_from - read_from));
  RecordProperty("write_seconds", std::to_string(read_from - written_from));
  RecordProperty("getline_seconds", std::to_string(plain));
  std::printf("read %.3f s, written %.3f s, std::getline %.3f s\n", plain_from - read_from,
              read_from - written_from, plain);
  EXPECT_LT((plain_from - read_from) / plain, 40.0);
  expect_same(again, runs);
}

}  // namespace
}  // namespace gatewalk::lattice
