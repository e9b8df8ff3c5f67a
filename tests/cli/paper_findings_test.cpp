// SPDX-License-Identifier: MIT
#include "cli/fields/json_value.h"
#include "cli/paper/findings.h"

#include <gtest/gtest.h>

namespace gatewalk::cli {
namespace {

Json small_sweep() {
  return Json::parse(R"({"points": [
    {"at": {"run.method": "stable", "beams.damping_Nms_per_rad": 50}, "trials": 200,
     "traversed_left": 6, "traversed_right": 2, "traversed_even": 0, "exited_left": 10,
     "exited_right": 20, "trapped": 162, "not_finite": 0, "status": {"worst_penetration_m": 0.5}},
    {"at": {"run.method": "paper", "beams.damping_Nms_per_rad": 0.5}, "trials": 200,
     "traversed_left": 0, "traversed_right": 0, "traversed_even": 0, "exited_left": 0,
     "exited_right": 0, "trapped": 200, "not_finite": 0, "status": {"worst_penetration_m": 2}}]})");
}

TEST(Findings, APointIsFoundByItsNumbersAndWords) {
  const auto sweep = found_in<Sweep>(small_sweep());
  const PaperPoint& p = sweep.at({{"run.method", "stable"}, {"beams.damping_Nms_per_rad", 50}});
  EXPECT_EQ(p[dynamics::Outcome::trapped], 162);
  EXPECT_EQ(p.exited(), 30);
  EXPECT_EQ(p.traversed_share().value, 0.04);
  EXPECT_EQ(p.left_share().value, 0.03);
  EXPECT_EQ(p.right_share().value, 0.25);
  EXPECT_EQ(p.right_share().whole, 8);
  EXPECT_EQ(p.text("beams.damping_Nms_per_rad"), "50");
  EXPECT_EQ(p.text("run.method"), "stable");
  const PaperPoint& other = sweep.at({{"run.method", "paper"}});
  EXPECT_EQ(other.number("beams.damping_Nms_per_rad"), 0.5);
  EXPECT_EQ(other.health.worst_penetration, 2.0);
  EXPECT_EQ(sweep.values("beams.damping_Nms_per_rad"), (std::vector<double>{0.5, 50}));
  EXPECT_THROW((void)sweep.at({{"run.method", "stable"}, {"beams.damping_Nms_per_rad", 10}}),
               std::out_of_range);
  EXPECT_THROW((void)sweep.at({{"run.step_s", 0.02}}), std::out_of_range);
}

TEST(Findings, WhatIsMissingOrOfAnotherKindIsNoResult) {
  const auto refused = [](const Json& json) {
    EXPECT_THROW((void)found_in<Sweep>(json), std::exception) << json;
  };
  Json sweep = small_sweep();
  sweep["points"][1].erase("trials");
  refused(sweep);
  sweep = small_sweep();
  sweep["points"][0]["trapped"] = "all";
  refused(sweep);
  sweep = small_sweep();
  sweep["points"][0]["status"] = 7;
  refused(sweep);
  sweep["points"] = Json::array();
  refused(sweep);
  refused(Json());
}

// The path goes downhill from the basin's place on, so the path from the basin is that place alone.
TEST(Findings, AWayDownhillHasNoBarrier) {
  const auto study = found_in<LandscapeStudy>(Json::parse(R"({"passes": [
    {"grid_m": 0.5,
     "from_start": {"x_m": 0, "y_m": 30, "energy_J": 300, "begins_at_J": 296.5, "way_m": [[0, 0]]},
     "from_basin": {"x_m": 0, "y_m": 30, "energy_J": 300, "begins_at_J": 130,
                    "way_m": [[0, 21], [0, 22]]}},
    {"grid_m": 0.05,
     "from_start": {"x_m": 0, "y_m": 0, "energy_J": 300, "begins_at_J": 300, "way_m": [[0, 0]]},
     "from_basin": {"x_m": 1, "y_m": 65, "energy_J": 0, "begins_at_J": 0, "way_m": [[1, 65]]}}]})"));
  EXPECT_FALSE(study.coarse.downhill());
  EXPECT_EQ(study.coarse.above_start(), 3.5);
  EXPECT_EQ(study.coarse.from_basin.barrier(), 170.0);
  EXPECT_EQ(study.coarse.from_basin.way[0][1], 21.0);
  EXPECT_TRUE(study.fine.downhill());
  EXPECT_EQ(study.fine.from_basin.barrier(), 0.0);
  EXPECT_EQ(study.measured.trials, 0);
}

TEST(Findings, ATraceHasAnEntryForEveryStep) {
  Json json = Json::parse(R"({"trials": 5, "runs": [{"label": "trial 2", "ending": "trapped",
    "trial": 2, "hits": 4, "t": [0, 1], "x": [0, 1], "y": [2, 3], "potential_J": [1, 2],
    "elastic_left_J": [0, 0], "elastic_right_J": [0, 0], "landscape_J": [1, null],
    "landscape_left_J": [0, 0], "landscape_right_J": [1, null]}]})");
  const auto trace = found_in<Trace>(json);
  EXPECT_EQ(trace.runs[0].hits, 4);
  EXPECT_EQ(trace.runs[0].landscape[0], 1.0);
  EXPECT_TRUE(std::isnan(trace.runs[0].landscape[1]));
  json["runs"][0]["y"].erase(0);
  EXPECT_THROW((void)found_in<Trace>(json), std::runtime_error);
}

// Half a second for each of two starts of 100 trials, 30 ms for each of 1000 walks.
TEST(Findings, SecondsOfATrialAndOfAWalk) {
  Validation v;
  v.trials = 100;
  v.walks = 1000;
  v.starts.resize(2);
  for (ValidatedStart& s : v.starts) {
    s.dynamics_seconds = 0.5;
    s.walks_seconds = 0.03;
  }
  EXPECT_DOUBLE_EQ(v.seconds_per_trial(), 0.005);
  EXPECT_DOUBLE_EQ(v.seconds_per_walk(), 3e-5);
}

// The crossings of one body are not independent trials: many of one body count as one.
TEST(Findings, CrossingsHaveTheIntervalOfTheirBodies) {
  const Crossings many{.rt_and_lt = 101, .clamped = 200, .between_gates = 400, .bodies = 100};
  EXPECT_EQ(many.clamped_share().low, share_of(50, 100).low);
  EXPECT_EQ(many.clamped_share().whole, 100);
  EXPECT_EQ(many.rt_and_lt_share().value, 0.2525);
  EXPECT_EQ(many.rt_and_lt_share().high, share_of(25, 100).high);
  const Crossings few{.rt_and_lt = 10, .clamped = 20, .between_gates = 40, .bodies = 100};
  EXPECT_EQ(few.clamped_share().low, share_of(20, 40).low);
  EXPECT_EQ(few.rt_and_lt_share().part, 10);
}

}  // namespace
}  // namespace gatewalk::cli
