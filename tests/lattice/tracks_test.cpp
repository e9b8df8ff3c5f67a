// SPDX-License-Identifier: MIT
// Files of tracks: reading what they state, and refusing what they do not.
#include "lattice/recorded/tracks.h"

#include <gtest/gtest.h>
#include <netcdf.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace gatewalk::lattice {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

class TracksFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string file(const std::string& text, const std::string& name = "t.csv") {
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }
  TrackFile read(const std::string& text, const TrackOptions& options) {
    return read_tracks(file(text), options);
  }
  std::string refusal_of(const std::string& at, const TrackOptions& options) {
    try {
      (void)read_tracks(at, options);
    } catch (const std::invalid_argument& e) {
      std::string text = e.what();
      for (std::size_t i; (i = text.find(folder_.string() + "/")) != text.npos;)
        text.erase(i, folder_.string().size() + 1);
      return text;
    }
    return "nothing refused";
  }
  std::string refusal(const std::string& text, const TrackOptions& options) {
    return refusal_of(file(text), options);
  }
  /// Expects these words in the refusal.
  void expect_refused(const std::string& text, const TrackOptions& options,
                      const std::string& words) {
    EXPECT_NE(refusal(text, options).find(words), std::string::npos) << refusal(text, options);
  }

  static TrackOptions table_options(const std::string& columns = "body=id,frame=f,x=x,y=y") {
    TrackOptions options;
    options.columns = columns;
    options.fps = 100.0;
    options.metres_per_unit = 0.001;
    return options;
  }
  static TrackOptions picture_options() {
    TrackOptions options = table_options("");
    options.confidence = 0.9;
    return options;
  }

  std::filesystem::path folder_;
};

TEST_F(TracksFile, TableOfAnyColumns) {
  const TrackFile t = read(
      "f,other,id,y,x\n# a "
      "comment\n3,z,b,30,10\n1,z,a,2,1\n2,z,b,\"20\",nan\n1,z,b,,5\r\n0,z,a,0,0\n",
      table_options());
  ASSERT_EQ(t.tracks.size(), 2U);
  EXPECT_EQ(t.tracks[0].body, "b");
  EXPECT_EQ(t.tracks[0].time, std::vector{0.03});
  EXPECT_EQ(t.tracks[0].x, std::vector{0.01});
  EXPECT_EQ(t.tracks[1].body, "a");
  EXPECT_EQ(t.tracks[1].time, (std::vector{0.0, 0.01}));  // sorted, unlike TrackMate's lines
  EXPECT_EQ(t.tracks[1].y, (std::vector{0.0, 0.002}));
  EXPECT_EQ(t.places, 5);
  EXPECT_EQ(t.no_place, 2);
  EXPECT_DOUBLE_EQ(t.interval, 0.01);
}

TEST_F(TracksFile, OriginScaleAndWhichWayIsUp) {
  TrackOptions options = table_options();
  options.origin_x = 10.0;
  options.origin_y = 100.0;
  const std::string text = "id,f,x,y\na,0,15,90\n";
  EXPECT_DOUBLE_EQ(read(text, options).tracks[0].x[0], 0.005);
  EXPECT_DOUBLE_EQ(read(text, options).tracks[0].y[0], -0.01);
  options.y_down = true;
  EXPECT_DOUBLE_EQ(read(text, options).tracks[0].y[0], 0.01);
}

TEST_F(TracksFile, TimesOfTheirOwnTellTheInterval) {
  TrackOptions options = table_options("body=id,time=t,x=x,y=y");
  options.fps = {};
  const TrackFile t = read("id,t,x,y\na,0,1,1\na,0.5,1,1\na,0.75,1,1\na,1,1,1\n", options);
  EXPECT_EQ(t.tracks[0].time, (std::vector{0.0, 0.5, 0.75, 1.0}));
  EXPECT_DOUBLE_EQ(t.interval, 0.25);
  EXPECT_NE(t.remarks.at(0).find("a frame every 0.25 s"), std::string::npos);
  options.fps = 10.0;
  EXPECT_DOUBLE_EQ(read("id,t,x,y\na,0,1,1\na,0.5,1,1\n", options).interval, 0.1);
}

TEST_F(TracksFile, TrackMateHasThreeRowsOfUnits) {
  const std::string text =
      "LABEL,ID,TRACK_ID,QUALITY,POSITION_X,POSITION_Y,FRAME\n"
      "Label,Spot ID,Track ID,Quality,X,Y,Frame\n"
      "Label,Spot ID,Track ID,Quality,X,Y,Frame\n"
      ",,,(quality),(micron),(micron),\n"
      "ID7,7,3,1.5,12.5,8,1\n"
      "ID8,8,,1.5,99,99,1\n"  // a spot without a track
      "ID6,6,3,1.5,12,7.5,0\n";
  TrackOptions options =
      table_options("body=TRACK_ID,frame=FRAME,x=POSITION_X,y=POSITION_Y,confidence=QUALITY");
  options.confidence = 1.0;
  options.metres_per_unit = 1e-6;
  const TrackFile t = read(text, options);
  ASSERT_EQ(t.tracks.size(), 1U);
  EXPECT_EQ(t.tracks[0].body, "3");
  EXPECT_DOUBLE_EQ(t.tracks[0].x[1], 12.5e-6);
  EXPECT_EQ(t.unit_rows, 3);
  EXPECT_EQ(t.no_body, 1);
  EXPECT_NE(t.remarks.at(0).find("3 rows of descriptions and units"), std::string::npos);
  EXPECT_NE(t.remarks.at(0).find("(micron)"), std::string::npos);
  options.confidence = 2.0;
  EXPECT_EQ(read(text, options).unsure, 2);
  // Two such rows are not TrackMate's: the message names the line that is no number.
  EXPECT_EQ(refusal("id,f,x,y\nID,F,x,y\nID,F,x,y\na,0,1,1\n", table_options()),
            "t.csv:3: column x: \"x\" is no number, nor are there three rows of descriptions and "
            "units behind the header, as TrackMate writes, or one of units");
}

TEST_F(TracksFile, TablesAreRefusedByLineAndColumn) {
  const TrackOptions good = table_options();
  const std::string head = "id,f,x,y\n";
  expect_refused("", good, "t.csv: is empty");
  expect_refused(head, good, "has no line of any body");
  expect_refused(head + "a,0,1\n", good,
                 "t.csv:2: has 3 fields, the line of the columns (line 1) has 4");
  expect_refused(head + "a,0,1,1\na,1,one,1\n", good, "t.csv:3: column x: \"one\" is no number");
  expect_refused(head + "a,0.5,1,1\n", good, "t.csv:2: column f: \"0.5\" is no whole number");
  expect_refused(head + "a,,1,1\n", good, "t.csv:2: column f: \"\" is no whole number");
  expect_refused(head + "a,7,1,1\nb,7,1,1\na,7,2,2\n", good,
                 "t.csv:4: body \"a\" has a place in frame 7 already (line 2)");
  expect_refused(head + "\"a,0,1,1\n", good, "t.csv:2: a quotation mark is not closed");
  expect_refused("who;f;x;y\na;0;1;1\n", good,
                 "t.csv:1: there is no column \"id\" (body= of --columns): there are who, f, x, y");
  expect_refused("id,f,x,x,y\na,0,1,2,1\n", good,
                 "t.csv:2: columns 3 and 4 are both named \"x\" and differ: \"1\", \"2\"");
  EXPECT_NE(refusal_of(path("none.csv"), good).find("cannot be read: No such file"),
            std::string::npos);
  EXPECT_NE(refusal_of(folder_.string(), good).find("cannot be read"), std::string::npos);
}

TEST_F(TracksFile, ATableMayHaveColumnsForEachBody) {
  TrackOptions options = table_options("time=seconds,x=x*,y=y*");
  options.fps = {};
  const TrackFile t =
      read("seconds,x1,y1,x2,y2\n0,1,2,3,4\n0.5,NaN,NaN,5,6\n1,7,8,9,10\n", options);
  ASSERT_EQ(t.tracks.size(), 2U);
  EXPECT_EQ(t.tracks[0].body, "1");
  EXPECT_EQ(t.tracks[0].time, (std::vector<double>{0.0, 1.0}));
  ASSERT_EQ(t.tracks[1].x.size(), 3U);
  EXPECT_DOUBLE_EQ(t.tracks[1].x[2], 0.009);
  EXPECT_DOUBLE_EQ(t.tracks[1].y[2], 0.010);
  EXPECT_EQ(t.no_place, 1);
  // AnimalTA's names, and a confidence for each body.
  options = table_options("frame=F,x=X_Arena0_Ind*,y=Y_Arena0_Ind*,confidence=p*");
  options.confidence = 0.5;
  const TrackFile other =
      read("F;X_Arena0_Ind7;Y_Arena0_Ind7;p7\n0;1,5;2;0,9\n1;1,5;2;0,1\n", options);
  EXPECT_EQ(other.tracks.at(0).body, "7");
  EXPECT_EQ(other.tracks[0].x, std::vector<double>{0.0015});
  EXPECT_EQ(other.unsure, 1);
  EXPECT_EQ(read("F,x1,y1,x1\n0,1,1,1\n", table_options("frame=F,x=x*,y=y*")).tracks.size(), 1U);
  expect_refused("F,x1,y1,x2\n0,1,1,1\n", table_options("frame=F,x=x*,y=y*"),
                 "t.csv:1: there is no column \"y2\" (y= of --columns)");
  expect_refused("F,x1,y1,x2,y2\n0,1,1,1,1\n", table_options(),
                 "(if these are places of a body each, give x=x*,y=y* and no body=)");
}

TEST_F(TracksFile, WithoutAColumnOfBodiesThereIsOne) {
  const TrackOptions options = table_options("frame=f,x=x,y=y");
  const TrackFile t = read("f,x,y\n0,1,1\n1,2,1\n", options);
  ASSERT_EQ(t.tracks.size(), 1U);
  EXPECT_EQ(t.tracks[0].body, "t");  // the file's name
  EXPECT_EQ(t.remarks.at(0), "no column is body=: one body, t");
  expect_refused("id,f,x,y\na,0,1,1\nb,0,2,1\n", options,
                 "does a column tell bodies apart (body=)?");
  expect_refused("id,f,x,y\n,0,1,1\nNA,1,2,1\n", table_options(),
                 "column id names no body in any of 2 lines: leave body= out");
}

TEST_F(TracksFile, EthoVisionHasOneRowOfUnitsBelowItsSettings) {
  TrackOptions options = table_options("time=Trial time,x=X center,y=Y center");
  options.fps = options.metres_per_unit = {};
  const TrackFile t = read(
      "\"Number of header lines:\";\"5\"\n\"Experiment\";\"maze\"\n\n"
      "\"Trial time\";\"X center\";\"Y center\"\n\"s\";\"cm\";\"cm\"\n"
      "\"0,00\";\"1,5\";\"2\"\n\"0,04\";\"-\";\"-\"\n\"0,08\";\"2,5\";\"3\"\n",
      options);
  ASSERT_EQ(t.tracks.at(0).x.size(), 2U);
  EXPECT_DOUBLE_EQ(t.tracks[0].x[1], 0.025);
  EXPECT_EQ(t.no_place, 1);
  EXPECT_EQ(t.unit_rows, 1);
}

TEST_F(TracksFile, RecordingsOfOneExperimentAreToldApart) {
  const std::string one = file("id,f,x,y\n1,0,1,1\n1,1,2,1\n", "one.csv"),
                    two = file("id,f,x,y\n1,0,5,1\n2,0,6,1\n", "two.csv");
  const TrackFile t = read_tracks({one, two}, table_options());
  ASSERT_EQ(t.tracks.size(), 3U);
  EXPECT_EQ(t.tracks[0].body, "one/1");
  EXPECT_EQ(t.tracks[1].body, "two/1");
  EXPECT_EQ(t.tracks[2].body, "two/2");
  EXPECT_EQ(t.places, 4);
  EXPECT_EQ(t.source, one + ", " + two);
  ASSERT_EQ(t.remarks.size(), 1U);  // one remark for both files: where the lattice begins
  const TrackFile other =
      read_tracks({one, file("id;f;x;y\n1;0;5;1\n", "three.csv")}, table_options());
  EXPECT_EQ(other.remarks.at(1), path("three.csv") + ": fields are set apart by semicolons");
  EXPECT_THROW((void)read_tracks({one, one}, table_options()), std::invalid_argument);
  EXPECT_THROW((void)read_tracks({one, folder_.string() + "/./one.csv"}, table_options()),
               std::invalid_argument);
  TrackOptions by_time = table_options("body=id,time=f,x=x,y=y");
  by_time.fps = {};
  const std::string slow = file("id,f,x,y\n1,0,1,1\n1,2,2,1\n", "slow.csv");
  EXPECT_THROW((void)read_tracks({one, slow}, by_time), std::invalid_argument);  // 1 s and 2 s
}

TEST_F(TracksFile, TimesBesideFramesMayContradictTheFrameRate) {
  const std::string text = "id,f,x,y,t_ms\na,0,1,1,0\na,1,2,1,10\na,2,3,1,20\n";
  EXPECT_TRUE(read(text, table_options()).warnings.empty());  // 100 frames per second
  TrackOptions other = table_options();
  other.fps = 50.0;
  const std::string plain = "id,f,x,y,time\na,0,1,1,0\na,1,2,1,";
  EXPECT_FALSE(read(plain + "0.01\n", other).warnings.empty());
  EXPECT_TRUE(read(plain + "20\n", other).warnings.empty());  // ms
  EXPECT_TRUE(read(plain + "1\n", other).warnings.empty());   // frames
  // A value that is no clock says nothing: a place, an exposure.
  EXPECT_TRUE(read("id,f,x_s,y,exposure_ms\na,0,1,1,5\na,1,2,1,5\n",
                   [&] {
                     TrackOptions o = other;
                     o.columns = "body=id,frame=f,x=x_s,y=y";
                     return o;
                   }())
                  .warnings.empty());
  EXPECT_EQ(read(text, other).warnings.at(0).substr(folder_.string().size() + 1),
            "t.csv: --fps 50 is a frame every 0.02 s, but by its times a frame takes 0.01 s "
            "(median): one of both is wrong, and velocities with it");
}

// Places of a moving body, with a noise of 0.1 mm; the tracker's held places are written over them.
class LostFrames : public TracksFile {
 protected:
  TrackFile with(const std::function<void(std::size_t, double&, double&)>& change,
                 double grain = 0.0) {
    std::string text = "id,f,x,y\n";
    std::uint64_t state = 1;
    const auto uniform = [&] {
      state = state * 6364136223846793005U + 1442695040888963407U;
      return static_cast<double>(state >> 11) * 0x1p-53 - 0.5;
    };
    for (std::size_t f = 0; f < 400; ++f) {
      double x = 100.0 + 0.35 * uniform(),
             y = 100.0 + 0.5 * static_cast<double>(f) + 0.35 * uniform();
      if (f >= 100 && f < 200) y = 150.0 + 0.35 * uniform();  // at rest
      if (f >= 200) y -= 50.0;
      if (grain > 0.0) {
        x = grain * std::round(x / grain);
        y = grain * std::round(y / grain);
      }
      change(f, x, y);
      text += "a," + std::to_string(f) + "," + std::to_string(x) + "," + std::to_string(y) + "\n";
    }
    return read(text, table_options());
  }
};

TEST_F(LostFrames, PlacesThatStandStillForLongAreLeftOut) {
  const TrackFile none = with([](std::size_t, double&, double&) {});
  EXPECT_EQ(none.repeated + none.at_zero, 0);
  double held_x = 0.0, held_y = 0.0;
  const TrackFile t = with([&](std::size_t f, double& x, double& y) {
    if (f == 300) held_x = x, held_y = y;
    if (f >= 300 && f < 330) x = held_x, y = held_y;
  });
  EXPECT_EQ(t.repeated, 29);  // the first one is real
  EXPECT_EQ(t.tracks[0].time.size(), 371U);
  EXPECT_NE(t.warnings.at(0).find("29 places stand still exactly"), std::string::npos);
}

// A body at rest continues from its place, or stands there to the end: it may be trapped.
TEST_F(LostFrames, ABodyAtRestIsSeen) {
  double x0 = 0.0, y0 = 0.0;
  const auto hold = [&](std::size_t first, std::size_t last) {
    return with([&, first, last](std::size_t f, double& x, double& y) {
      if (f == first) x0 = x, y0 = y;
      if (f >= first && f < last) x = x0, y = y0;
    });
  };
  for (const auto& [first, last] : {std::pair{120, 150}, std::pair{300, 400}}) {
    const TrackFile t = hold(static_cast<std::size_t>(first), static_cast<std::size_t>(last));
    EXPECT_EQ(t.repeated, 0) << first;
    EXPECT_NE(t.remarks.at(0).find(std::to_string(last - first - 1) + " places stand still"),
              std::string::npos)
        << t.remarks.at(0);
  }
}

// The usual step is that of moving bodies, even if bodies rest nearly all the time.
TEST_F(LostFrames, ABodyAtRestGoesOnWithAStep) {
  double x0 = 0.0, y0 = 0.0;
  const TrackFile t = with([&](std::size_t f, double& x, double& y) {
    if (f == 20) x0 = x, y0 = y;
    if (f >= 20 && f < 385) x = x0, y = y0;
    if (f >= 385) y = y0 + 0.5 * static_cast<double>(f - 384);
  });
  EXPECT_EQ(t.repeated, 0);
}

// If the resolution of places is as coarse as their noise, a body at rest stands exactly still.
TEST_F(LostFrames, CoarsePlacesMayStandStill) {
  EXPECT_EQ(with([](std::size_t, double&, double&) {}, 1.0).repeated, 0);
}

TEST_F(LostFrames, PlacesAtZeroAreLeftOut) {
  const TrackFile t = with([](std::size_t f, double& x, double& y) {
    if (f == 50 || (f >= 120 && f < 140) || f > 395) x = y = 0.0;
  });
  EXPECT_EQ(t.at_zero, 1 + 20 + 4);
  EXPECT_EQ(t.repeated, 0);
  // A body that begins at (0, 0) may really be there.
  EXPECT_EQ(read("id,f,x,y\na,0,0,0\na,1,0.5,0.1\na,2,1.1,0\n", table_options()).at_zero, 0);
}

TEST_F(TracksFile, WhatATableLacksIsAskedFor) {
  const std::string text = "id,f,x,y,c\na,0,1,1,1\n";
  const std::string all = refusal(text, {});
  for (const char* option : {"--columns body=", "--fps N", "--metres-per-unit X"})
    EXPECT_NE(all.find(option), std::string::npos) << all;
  TrackOptions options = table_options("body=id,frame=f,x=x,y=y,confidence=c");
  expect_refused(text, options, "--confidence X");
  options.confidence = 0.5;
  EXPECT_EQ(read(text, options).places, 1);
  options.columns = "body=id,frame=f,x=x,y=y";
  expect_refused(text, options, "--confidence has no effect");
  options.confidence = {};
  options.key_point = "nose";
  expect_refused(text, options, "--key-point has no effect");
  options.key_point = {};
  options.fps = 0.0;
  expect_refused(text, options, "--fps 0: must be above 0");
  options = table_options();
  options.metres_per_unit = -1.0;
  expect_refused(text, options, "--metres-per-unit -1: must be above 0");
  options = table_options();
  options.confidence = -1.0;
  expect_refused(text, options, "--confidence -1: must be 0 or more");
}

TEST_F(TracksFile, ColumnsThatMakeNoSense) {
  const auto refused = [&](const std::string& columns, const std::string& words) {
    expect_refused("id,f,x,y\na,0,1,1\n", table_options(columns), words);
  };
  refused("body=id,frame=f,x=x", "y= is missing");
  refused("body=id,frame=f,x=x*,y=y*", "body= has no meaning beside x=x*");
  refused("frame=f,x=x*,y=y", "must have a * all");
  refused("frame=f,x=x*,y=y**", "more than one *");
  refused("body=id,x=x,y=y", "one of frame= and time= is needed");
  refused("body=id,frame=f,time=f,x=x,y=y", "and only one");
  refused("body=id,frame=f,x=x,y=y,z=z", "\"z\" is none of body, frame, time, x, y, confidence");
  refused("body=id,frame=f,x=x,x=y,y=y", "x= is given twice");
  refused("body,frame=f,x=x,y=y", "\"body\" is no MEANING=COLUMN");
  refused("\"body=id,frame=f", "a quotation mark is not closed");
}

// A time of 20 ms, and a place 5 mm from the origin, in any unit that the file states.
TEST_F(TracksFile, UnitsInNamesAreBelieved) {
  const auto read_as = [&](const std::string& time, const std::string& x, const std::string& y,
                           const std::string& values) {
    TrackOptions options;
    options.columns = "body=id,\"time=" + time + "\",\"x=" + x + "\",\"y=" + y + "\"";
    return read("id,\"" + time + "\",\"" + x + "\",\"" + y + "\"\n" + "a,0,0,0\na," + values + "\n",
                options);
  };
  const std::vector<std::array<std::string, 4>> all{
      {"t_s", "x_m", "y_m", "0.02,0.005,0.005"},
      {"t_ms", "x_mm", "y_mm", "20,5,5"},
      {"Time [ms]", "X (cm)", "Y (cm)", "20,0.5,0.5"},
      {"time (µs)", "x [µm]", "y [um]", "20000,5000,5000"},
      {"time_milliseconds", "x.mm", "y mm", "20,5,5"},
      {"T/ns", "x_nm", "y_nm", "2e7,5e6,5e6"},
      {"TIME_MS", "POSITION_MM", "y_millimeters", "20,5,5"},
      {"time{ms}", "x{mm}", "y {mm}", "20,5,5"},
      {"time:ms", "x:mm", "y#mm", "20,5,5"},
      {"timeMs", "xMm", "yMm", "20,5,5"},
      {"time_ms_", "x_mm_", "y_mm_", "20,5,5"},
      {"time_ms_rel", "x (mm) raw", "y (mm) raw", "20,5,5"},
      {"ms since start", "x [km]", "y [km]", "20,5e-6,5e-6"},
      {"milliseconds_elapsed", "x_dm", "y_dm", "20,0.05,0.05"},
      {"frame_time_s", "x (in)", "y (inch)", "0.02,0.19685039370078738,0.19685039370078738"},
      {"frame_ms", "x (ft)", "y_ft", "20,0.016404199475065617,0.016404199475065617"},
      {"frame_time", "x_m", "y_m", "0.02,0.005,0.005"},
      {"FrameTimestamp", "x_m", "y_m", "0.02,0.005,0.005"},
      {"time of frame", "x_m", "y_m", "0.02,0.005,0.005"},
      {"min_time", "x_m", "y_m", "0.02,0.005,0.005"},
      {"h_time", "x_m", "y_m", "0.02,0.005,0.005"},
      {"timeH", "x_m", "y_m", "0.02,0.005,0.005"}};
  for (const auto& [time, x, y, values] : all) {
    const TrackFile t = read_as(time, x, y, values);
    EXPECT_DOUBLE_EQ(t.tracks.at(0).time.at(1), 0.02) << time;
    EXPECT_DOUBLE_EQ(t.tracks.at(0).x.at(1), 0.005) << x;
    EXPECT_DOUBLE_EQ(t.tracks.at(0).y.at(1), 0.005) << y;
    EXPECT_DOUBLE_EQ(t.interval, 0.02) << time;
  }
  const auto remarks = read_as("t_ms", "x_mm", "y_mm", "20,5,5").remarks;
  EXPECT_EQ(remarks.at(0), "column t_ms is in ms, by its name: converted to s");
  EXPECT_EQ(remarks.at(1), "places are in mm, by its name");
  EXPECT_DOUBLE_EQ(read_as("t_min", "x_m", "y_m", "2,1,1").tracks[0].time[1], 120.0);
  EXPECT_DOUBLE_EQ(read_as("t (h)", "x_m", "y_m", "0.5,1,1").tracks[0].time[1], 1800.0);
}

TEST_F(TracksFile, UnitsThatDoNotFitAreRefused) {
  const auto refused = [&](const std::string& time, const std::string& x, const std::string& y,
                           const std::string& words, std::optional<double> scale = {},
                           std::optional<double> fps = {}) {
    TrackOptions options;
    options.columns = "body=id,time=" + time + ",x=" + x + ",y=" + y;
    options.metres_per_unit = scale;
    options.fps = fps;
    expect_refused("id," + time + "," + x + "," + y + "\na,0,1,1\na,20,1,2\na,40,1,3\n", options,
                   words);
  };
  refused("frame", "x", "y",
          "column frame is in frame, by its name: give frame=frame of --columns "
          "in place of time=, and frames per second, --fps N",
          1.0);
  refused("t_frames", "x", "y", "give frame=t_frames", 1.0);
  for (const char* name :
       {"frame_idx", "frame_number", "FrameNumber", "frameNo", "frame_id", "Frame #", "framecount",
        "nframes", "time_frame_idx", "index of frame", "frame_min_id", "{frame}"})
    refused(name, "x", "y",
            std::string("give frame=") + name + " of --columns in place of time=", 1.0);
  refused("t_mm", "x", "y", "column t_mm is in mm, by its name, which is no unit of time", 1.0);
  refused("t (a.u.)", "x", "y", "column t (a.u.) is in (a.u.), by its name, which is no unit of",
          1.0);
  refused("t_s", "x_mm", "y_cm", "column x_mm is in mm, by its name, column y_cm in cm");
  refused("t_s", "x_mm", "y_px", "both must be in the same unit");
  refused("t_s", "x [s]", "y", "column x [s] is in [s], by its name, which is no length", 1.0);
  for (const char* speed : {"x (mm/s)", "x (m/s)", "x (mm s-1)", "x [mm·s⁻¹]", "x (px per frame)",
                            "x (1/s)", "x_mm/s", "x_mm_per_s"})
    for (const std::optional<double> scale : {std::optional<double>(), std::optional(0.001)})
      refused("t_s", speed, "y", ", by its name, which is no length", scale);
  refused("t_s", "x_mm", "y_mm",
          "column x_mm is in mm, by its name, which is 0.001 m; "
          "--metres-per-unit says 1",
          1.0);
  refused("t_s", "x_mm", "y", "column x_mm is in mm, by its name, which is 0.001 m", 1.0);
  refused("t_s", "x_mm", "y", "what column y is in: --metres-per-unit X");
  refused("t_s", "x_px", "y_px", "are in px, by its name): --metres-per-unit X");
  refused("t_s", "x", "y", "what x and y are in: --metres-per-unit X");
  // Steps of 20 ms are 50 frames per second; steps of 20 s, in a file without a unit, every 1000th
  // frame.
  refused("t_ms", "x", "y",
          "--fps 30 is a frame every 0.0333333 s, but column t_ms has "
          "steps of 0.02 s",
          1.0, 30.0);
  refused("t_s", "x", "y", "--fps 0.01 is a frame every 100 s, but column t_s has steps of 20 s",
          1.0, 0.01);
  // Frame numbers are no times.
  TrackOptions options = table_options("body=id,frame=t_ms,x=x,y=y");
  expect_refused("id,t_ms,x,y\na,0,1,1\n", options,
                 "column t_ms is in ms, by its name, no numbers of frames: time=t_ms in place of");
  // The end of a name may mean something else: x_s is smoothed, and the size of a pixel was given.
  options = table_options("body=id,time=t,x=x_s,y=y_s");
  options.fps = {};
  EXPECT_EQ(read("id,t,x_s,y_s\na,0,1,1\na,1,1,1\n", options).places, 2);
  options.columns = "body=id,time=t,x=x_px,y=y_px";
  EXPECT_EQ(read("id,t,x_px,y_px\na,0,1,1\na,1,1,1\n", options).places, 2);
  options.columns = "body=id,time=t,x=x_foot,y=y_in";
  EXPECT_DOUBLE_EQ(read("id,t,x_foot,y_in\na,0,1,1\na,1,1,1\n", options).metres_per_unit, 0.001);
  options.columns = "body=id,time=t,x=xM,y=frame_y";
  EXPECT_TRUE(read("id,t,xM,frame_y\na,0,1,1\na,1,1,1\n", options).warnings.empty());
}

TEST_F(TracksFile, UnitsOfPlacesThatNobodyKnowsAreSaid) {
  TrackOptions options = table_options("body=id,time=t,x=x (furlong),y=y");
  options.fps = {};
  const TrackFile t = read("id,t,x (furlong),y\na,0,1,1\na,1,1,1\n", options);
  ASSERT_EQ(t.warnings.size(), 1U);
  EXPECT_NE(t.warnings[0].find("t.csv: column x (furlong) is in (furlong), by its name, which is "
                               "no length that is known; --metres-per-unit 0.001 is used"),
            std::string::npos)
      << t.warnings[0];
  EXPECT_DOUBLE_EQ(t.tracks[0].x[1], 0.001);
}

TEST_F(TracksFile, TrackMatesUnitsAreBelieved) {
  const auto text = [](const std::string& place, const std::string& time,
                       const std::string& frame) {
    return "TRACK_ID,POSITION_X,POSITION_Y,POSITION_T,FRAME\nTrack ID,X,Y,T,Frame\nTrack "
           "ID,X,Y,T,F\n," +
           place + "," + place + "," + time + "," + frame + "\n1,1000,2000,0,0\n1,1000,4000,40,2\n";
  };
  TrackOptions options;
  options.columns = "body=TRACK_ID,time=POSITION_T,x=POSITION_X,y=POSITION_Y";
  const TrackFile t = read(text("(micron)", "(ms)", ""), options);
  EXPECT_DOUBLE_EQ(t.tracks[0].time[1], 0.04);
  EXPECT_DOUBLE_EQ(t.tracks[0].y[1], 0.004);
  EXPECT_EQ(t.remarks.at(1), "column POSITION_T is in (ms), in the row of units: converted to s");
  expect_refused(text("(micron)", "(frame)", ""), options, "give frame=POSITION_T of --columns");
  expect_refused(text("(pixel)", "(sec)", ""), options,
                 "are in (pixel), in the row of units): --metres");
  expect_refused(text("(micron)", "(parsec)", ""), options, "which is no unit of time");
  options.metres_per_unit = 0.001;
  EXPECT_DOUBLE_EQ(read(text("(pixel)", "(sec)", ""), options).tracks[0].y[1], 4.0);
  // TrackMate writes a unit of places whether or not it was set: the user's unit goes first, with a
  // remark.
  const TrackFile other = read(text("(micron)", "(ms)", ""), options);
  EXPECT_DOUBLE_EQ(other.tracks[0].y[1], 4.0);
  EXPECT_DOUBLE_EQ(other.tracks[0].time[1], 0.04);
  ASSERT_EQ(other.warnings.size(), 1U);
  EXPECT_NE(other.warnings[0].find(
                "column POSITION_X is in (micron), in the row of units, which is 1e-06 "
                "m; --metres-per-unit 0.001 is used. Leave the option out to use the file's unit."),
            std::string::npos)
      << other.warnings[0];
  const TrackFile unknown = read(text("(furlong)", "(ms)", ""), options);
  ASSERT_EQ(unknown.warnings.size(), 2U);
  EXPECT_NE(
      unknown.warnings[0].find("column POSITION_X is in (furlong), in the row of units, which "
                               "is no length that is known; --metres-per-unit 0.001 is used"),
      std::string::npos)
      << unknown.warnings[0];
  expect_refused(text("(mm/s)", "(ms)", ""), options,
                 "column POSITION_X is in (mm/s), in the row of units, which is no length");
  options.metres_per_unit = 1e-6;
  EXPECT_TRUE(read(text("(micron)", "(ms)", ""), options).warnings.empty());
  options.columns = "body=TRACK_ID,frame=FRAME,x=POSITION_X,y=POSITION_Y";
  options.fps = 10.0;
  EXPECT_DOUBLE_EQ(read(text("(mm)", "(ms)", "(frame)"), options).tracks[0].time[1], 0.2);
  expect_refused(text("(mm)", "(ms)", "(sec)"), options, "time=FRAME in place of frame=");
}

TEST_F(TracksFile, WordsForNobody) {
  for (const char* word : {"NA", "None", "null", "<NA>", "N/A", "#N/A", "#NA", "NaN", "nan", "-nan",
                           "NULL", "", "-", "-1"}) {
    const TrackFile t = read(std::string("id,f,x,y\n0,0,1,1\n") + word + ",0,5,5\n1,0,2,2\n" +
                                 word + ",1,5,5\n1,1,2,3\n",
                             table_options());
    ASSERT_EQ(t.tracks.size(), 2U) << word;
    EXPECT_EQ(t.tracks[1].body, "1") << word;
    EXPECT_EQ(t.tracks[1].y, (std::vector{0.002, 0.003})) << word;
    EXPECT_EQ(t.no_body, 2) << word;
    EXPECT_EQ(t.places, 3) << word;
  }
  // Animals may have these names.
  for (const char* name : {"Nat", "NIL", "nat"}) {
    const TrackFile t =
        read(std::string("id,f,x,y\nBo,0,1,1\n") + name + ",0,5,5\n", table_options());
    ASSERT_EQ(t.tracks.size(), 2U) << name;
    EXPECT_EQ(t.tracks[1].body, name);
    EXPECT_EQ(t.no_body, 0) << name;
  }
  // Names, not numbers from 0: -1 may be one of them.
  for (const char* other : {"a", "-2", "0.5"})
    EXPECT_EQ(read(std::string("id,f,x,y\n-1,0,1,1\n") + other + ",0,1,1\n", table_options())
                  .tracks.size(),
              2U);
  // A missing or infinite place was not seen.
  const TrackFile t =
      read("id,f,x,y\n1,0,1,1\n1,1,NA,1\n1,2,1,None\n1,3,inf,1\n1,4,1,-inf\n", table_options());
  EXPECT_EQ(t.no_place, 4);
}

constexpr const char* kOneMouse =
    "scorer,net,net,net,net,net,net\n"
    "bodyparts,nose,nose,nose,tail,tail,tail\n"
    "coords,x,y,likelihood,x,y,likelihood\n"
    "0,10,20,0.99,1,2,1\n"
    "1,11,21,0.5,1,2,1\n"
    "2,,,1.0,1,2,1\n"
    "3,13,23,1,1,2,1\n";

TEST_F(TracksFile, DeepLabCut) {
  TrackOptions options = picture_options();
  options.key_point = "nose";
  const TrackFile t = read_tracks(file(kOneMouse, "mouse4.csv"), options);
  EXPECT_EQ(t.kind, "DeepLabCut");
  ASSERT_EQ(t.tracks.size(), 1U);
  EXPECT_EQ(t.tracks[0].body, "mouse4");
  EXPECT_EQ(t.tracks[0].time, (std::vector{0.0, 0.03}));
  EXPECT_EQ(t.no_place, 1);  // with a likelihood of 1
  EXPECT_EQ(t.unsure, 1);
  EXPECT_DOUBLE_EQ(t.tracks[0].y[1], 0.023);
}

TEST_F(TracksFile, DeepLabCutWithIndividuals) {
  TrackOptions options = picture_options();
  options.key_point = "nose";
  const TrackFile t = read(
      "scorer,n,n,n,n,n,n,n,n,n\n"
      "individuals,m1,m1,m1,m2,m2,m2,single,single,single\n"
      "bodyparts,nose,nose,nose,nose,nose,nose,corner,corner,corner\n"
      "coords,x,y,likelihood,x,y,likelihood,x,y,likelihood\n"
      "0,1,2,1,3,4,1,5,6,1\n"
      "1,1,2,1,,,,5,6,1\n",
      options);
  ASSERT_EQ(t.tracks.size(), 2U);
  EXPECT_EQ(t.tracks[1].body, "m2");
  EXPECT_EQ(t.tracks[1].x, std::vector{0.003});
  EXPECT_EQ(t.places, 4);
}

TEST_F(TracksFile, DeepLabCutIsRefused) {
  TrackOptions options = picture_options();
  expect_refused(kOneMouse, options, "--key-point NAME, of nose, tail");
  options.key_point = "paw";
  expect_refused(kOneMouse, options, "--key-point paw: there are nose, tail");
  options.key_point = "nose";
  TrackOptions lacking;
  lacking.key_point = "nose";
  for (const char* option : {"--fps N", "--metres-per-unit X", "--confidence X"})
    expect_refused(kOneMouse, lacking, option);
  options.columns = "body=id,frame=f,x=x,y=y";
  expect_refused(kOneMouse, options, "--columns has no effect");
  options.columns = {};
  const std::string text = kOneMouse;
  expect_refused(text + "3,1,1,1,1,1,1\n", options, "t.csv:8: frame 3 comes behind frame 3");
  expect_refused(text + "4,a,1,1,1,1,1\n", options,
                 "t.csv:8: column 2 (nose x): \"a\" is no number");
  expect_refused(text + "4,1,1\n", options,
                 "t.csv:8: has 3 fields, the line of the columns (line 1) has 7");
  expect_refused(text + "img4.png,1,1,1,1,1,1\n", options, "the frame \"img4.png\" is no whole");
  expect_refused("scorer,n,n\ncoords,x,y\n", options, "t.csv:2: the row bodyparts is missing");
  expect_refused("scorer,n,n\nbodyparts,nose,nose\n0,1,2\n", options, "the row coords is missing");
  expect_refused("scorer,n,n\nbodyparts,nose,nose\ncoords,x,z\n0,1,2\n", options,
                 "of nose of t there is no y");
  expect_refused("scorer,n,n\nbodyparts,nose,nose\ncoords,x,x\n0,1,2\n", options, "twice");
  expect_refused("scorer,n\nbodyparts,nose\ncoords,x\n0,1\n", options, "there is no y");
  options.confidence = {};
  EXPECT_EQ(read("scorer,n,n\nbodyparts,nose,nose\ncoords,x,y\n0,1,2\n", options).places, 1);
  options.confidence = 0.5;
  const TrackFile unsure = read("scorer,n,n\nbodyparts,nose,nose\ncoords,x,y\n0,1,2\n", options);
  EXPECT_EQ(unsure.places, 1);
  EXPECT_NE(unsure.warnings.at(0).find("no likelihood"), std::string::npos);
  options.confidence = {};
  expect_refused("scorer,n,n\nbodyparts,nose,nose\ncoords,x,y\n", options, "has no frame");
}

/// Writes a file as movement does, with three frames of two bodies with two key points, after
/// `change`.
struct MovementWriter {
  std::string individual = "individuals", key_point = "keypoints", time_unit = "seconds";
  std::vector<std::string> order{"time", "space", "K", "I"};
  std::vector<double> times{0.0, 0.02, 0.04};
  std::vector<std::string> spaces{"x", "y"};
  std::string units{}, place_units{};  // of the times, of the places
  bool has_fps = true, has_confidence = true, all_nan = false, packed = false;
  double fill = kNaN;

  void write(const std::string& path) const {
    int nc = -1;
    const auto check = [](int rc) { ASSERT_EQ(rc, NC_NOERR) << nc_strerror(rc); };
    check(nc_create(path.c_str(), NC_NETCDF4 | NC_CLOBBER, &nc));
    const auto name_of = [&](const std::string& d) {
      return d == "K" ? key_point : d == "I" ? individual : d;
    };
    const auto length_of = [&](const std::string& d) {
      return d == "time" ? times.size() : d == "space" ? spaces.size() : std::size_t{2};
    };
    std::vector<int> dims, sure_dims;
    for (const std::string& d : order) {
      int id = -1;
      check(nc_def_dim(nc, name_of(d).c_str(), length_of(d), &id));
      dims.push_back(id);
      if (d != "space") sure_dims.push_back(id);
      int label = -1;
      check(
          nc_def_var(nc, name_of(d).c_str(), d == "time" ? NC_DOUBLE : NC_STRING, 1, &id, &label));
      if (d == "time") {
        check(nc_put_var_double(nc, label, times.data()));
        if (!units.empty()) check(nc_put_att_text(nc, label, "units", units.size(), units.c_str()));
        continue;
      }
      std::vector<std::string> words = d == "space" ? spaces
                                       : d == "K"   ? std::vector<std::string>{"nose", "tail"}
                                                    : std::vector<std::string>{"m1", "m2"};
      std::vector<const char*> raw;
      for (const std::string& word : words) raw.push_back(word.c_str());
      check(nc_put_var_string(nc, label, raw.data()));
    }
    int position = -1, confidence = -1;
    check(nc_def_var(nc, "position", NC_FLOAT, static_cast<int>(dims.size()), dims.data(),
                     &position));
    if (!std::isnan(fill)) {
      const float value = static_cast<float>(fill);
      check(nc_put_att_float(nc, position, "_FillValue", NC_FLOAT, 1, &value));
    }
    if (!place_units.empty())
      check(nc_put_att_text(nc, position, "units", place_units.size(), place_units.c_str()));
    if (packed) check(nc_put_att_double(nc, position, "scale_factor", NC_DOUBLE, 1, &times[1]));
    // 1000 frame + 100 body + 10 key point + space, so that each place shows its origin.
    const auto values = [&](const std::vector<std::string>& by, auto&& value) {
      std::vector<float> all;
      std::vector<std::size_t> at(by.size(), 0);
      std::size_t size = 1;
      for (const std::string& d : by) size *= length_of(d);
      for (std::size_t i = 0; i < size; ++i) {
        std::size_t rest = i, t = 0, s = 0, k = 0, b = 0;
        for (std::size_t d = by.size(); d-- > 0;) {
          const std::size_t index = rest % length_of(by[d]);
          rest /= length_of(by[d]);
          (by[d] == "time" ? t : by[d] == "space" ? s : by[d] == "K" ? k : b) = index;
        }
        all.push_back(static_cast<float>(value(t, s, k, b)));
      }
      return all;
    };
    const auto places =
        values(order, [&](std::size_t t, std::size_t s, std::size_t k, std::size_t b) {
          if (t == 1 && b == 1) return fill;
          return static_cast<double>(1000 * t + 100 * b + 10 * k + s);
        });
    check(nc_put_var_float(nc, position, places.data()));
    if (has_confidence) {
      std::vector<std::string> by;
      for (const std::string& d : order)
        if (d != "space") by.push_back(d);
      check(nc_def_var(nc, "confidence", NC_FLOAT, static_cast<int>(by.size()), sure_dims.data(),
                       &confidence));
      const auto sure = values(by, [&](std::size_t t, std::size_t, std::size_t k, std::size_t b) {
        if (all_nan) return kNaN;
        return t == 2 && b == 0 && k == 1 ? 0.3 : 1.0;
      });
      check(nc_put_var_float(nc, confidence, sure.data()));
    }
    const double fps = 50.0;
    if (has_fps) check(nc_put_att_double(nc, NC_GLOBAL, "fps", NC_DOUBLE, 1, &fps));
    if (!time_unit.empty())
      check(nc_put_att_text(nc, NC_GLOBAL, "time_unit", time_unit.size(), time_unit.c_str()));
    check(nc_close(nc));
  }
};

class MovementTracks : public TracksFile {
 protected:
  TrackFile read(const MovementWriter& w, const TrackOptions& options) {
    w.write(path("t.nc"));
    return read_tracks(path("t.nc"), options);
  }
  void expect_refused(const MovementWriter& w, const TrackOptions& options,
                      const std::string& words) {
    w.write(path("t.nc"));
    const std::string said = refusal_of(path("t.nc"), options);
    EXPECT_NE(said.find(words), std::string::npos) << said;
  }
  static TrackOptions options() {
    TrackOptions o = picture_options();
    o.fps = {};
    o.key_point = "tail";
    return o;
  }
};

TEST_F(MovementTracks, AllOrdersAndNamesOfDimensions) {
  MovementWriter w;
  const std::vector<std::vector<std::string>> orders{
      {"time", "space", "K", "I"}, {"I", "K", "space", "time"}, {"K", "time", "I", "space"}};
  for (const auto& order : orders)
    for (const bool singular : {false, true}) {
      w.order = order;
      w.individual = singular ? "individual" : "individuals";
      w.key_point = singular ? "keypoint" : "keypoints";
      const TrackFile t = read(w, options());
      ASSERT_EQ(t.tracks.size(), 2U);
      EXPECT_EQ(t.kind, "movement");
      EXPECT_EQ(t.tracks[1].body, "m2");
      EXPECT_EQ(t.tracks[0].time, (std::vector{0.0, 0.02}));  // low confidence in the third frame
      EXPECT_EQ(t.tracks[1].time, (std::vector{0.0, 0.04}));  // no place in the second frame
      EXPECT_DOUBLE_EQ(t.tracks[0].x[1], 1.010);
      EXPECT_DOUBLE_EQ(t.tracks[1].y[1], 2.111);
      EXPECT_EQ(t.unsure, 1);
      EXPECT_EQ(t.no_place, 1);
      EXPECT_DOUBLE_EQ(t.interval, 0.02);
    }
}

TEST_F(MovementTracks, FramesNeedAFrameRate) {
  MovementWriter w;
  w.time_unit = "frames";
  w.times = {0.0, 1.0, 2.0};
  EXPECT_EQ(read(w, options()).tracks[1].time, (std::vector{0.0, 0.04}));
  w.has_fps = false;
  expect_refused(w, options(), "frames per second: --fps N");
  TrackOptions with_fps = options();
  with_fps.fps = 10.0;
  EXPECT_DOUBLE_EQ(read(w, with_fps).tracks[1].time[1], 0.2);
  w.times = {0.0, 1.5, 2.0};
  expect_refused(w, with_fps, "time[1] = 1.5 is no whole frame");
}

TEST_F(MovementTracks, UnitsOfTimeAreBelieved) {
  MovementWriter w;
  w.times = {0.0, 20.0, 40.0};
  for (const char* units : {"milliseconds", "ms", "milliseconds since 2024-05-01 10:00:00"})
    for (const char* time_unit : {"seconds", ""}) {
      w.units = units;
      w.time_unit = time_unit;
      const TrackFile t = read(w, options());
      EXPECT_DOUBLE_EQ(t.tracks[1].time[1], 0.04) << units;
      EXPECT_DOUBLE_EQ(t.interval, 0.02) << units;
      EXPECT_NE(t.remarks.at(1).find("converted to s"), std::string::npos) << t.remarks.at(1);
    }
  w.units = "frames";
  w.times = {0.0, 1.0, 2.0};
  EXPECT_DOUBLE_EQ(read(w, options()).tracks[1].time[1], 0.04);
  w.time_unit = "seconds";
  expect_refused(w, options(), "time_unit is \"seconds\", but the units of time are \"frames\"");
  w.time_unit = "frames";
  w.units = "ms";
  expect_refused(w, options(), "time_unit is \"frames\", but the units of time are \"ms\"");
  w.units = "fortnights";
  expect_refused(w, options(), "the units of time are \"fortnights\": must be seconds");
  // The file's fps is 50.
  w = {};
  w.times = {0.0, 0.03, 0.06};
  expect_refused(w, options(),
                 "its fps of 50 is a frame every 0.02 s, but time has steps of 0.03 s");
}

TEST_F(MovementTracks, UnitsOfPlacesAreBelieved) {
  MovementWriter w;
  w.place_units = "mm";
  TrackOptions o = options();
  EXPECT_DOUBLE_EQ(read(w, o).tracks[1].y[1], 2.111);
  o.metres_per_unit = {};
  EXPECT_DOUBLE_EQ(read(w, o).tracks[1].y[1], 2.111);
  o.metres_per_unit = 1.0;
  expect_refused(w, o,
                 "position is in \"mm\", by its attribute units, which is 0.001 m; "
                 "--metres-per-unit says 1");
}

TEST_F(MovementTracks, WithoutConfidencesOrFrameRate) {
  MovementWriter w;
  w.has_confidence = false;
  TrackOptions o = options();
  expect_refused(w, o, "--confidence has no effect");
  o.confidence = {};
  EXPECT_EQ(read(w, o).tracks[0].time.size(), 3U);
  w.has_confidence = true;
  expect_refused(w, o, "--confidence X");
  w.all_nan = true;
  EXPECT_EQ(read(w, o).tracks[0].time.size(), 3U);
  w.has_fps = false;
  EXPECT_NEAR(read(w, o).interval, 0.02, 1e-12);
}

TEST_F(MovementTracks, OtherMarksOfNoPlace) {
  MovementWriter w;
  w.fill = -99.0;
  EXPECT_EQ(read(w, options()).no_place, 1);
}

TEST_F(MovementTracks, AreRefused) {
  MovementWriter w;
  TrackOptions o = options();
  o.key_point = {};
  expect_refused(w, o, "--key-point NAME, of nose, tail");
  o = options();
  o.metres_per_unit = {};
  expect_refused(w, o, "--metres-per-unit X");
  o = options();
  o.fps = 25.0;
  expect_refused(w, o, "has an fps of 50, not that of --fps, 25");
  o = options();
  o.columns = "body=a,frame=b,x=x,y=y";
  expect_refused(w, o, "--columns has no effect");
  o = options();
  w.times = {0.0, 0.04, 0.02};
  expect_refused(w, o, "time[2] = 0.02: times must rise");
  w = {};
  w.time_unit = "";
  expect_refused(w, o, "time_unit is missing");
  w.time_unit = "hours";
  expect_refused(w, o, "time_unit is \"hours\"");
  w = {};
  w.packed = true;
  expect_refused(w, o, "scale_factor");
  w = {};
  w.spaces = {"x", "z"};
  expect_refused(w, o, "space has no y");
  w = {};
  w.individual = "views";
  expect_refused(w, o, "position has a dimension views");
  const std::string damaged = file("\x89HDF\r\n\x1a\nnothing behind", "d.nc");
  EXPECT_NE(refusal_of(damaged, o).find("cut short or damaged"), std::string::npos);
}

}  // namespace
}  // namespace gatewalk::lattice
