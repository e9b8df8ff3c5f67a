// SPDX-License-Identifier: MIT
#include "lattice/scene/recording.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace gatewalk::lattice {
namespace {

Scene scene(const std::string& more = "") {
  return parse_scene(
      "[beams]\nstiffness_left_Nm_per_rad = 300.0\nstiffness_right_Nm_per_rad = "
      "500.0\ndamping_Nms_per_rad = 10.0\n"
      "[forces]\npropulsion_N = 7.0\nrandom_N = 10.0\ndrag_Ns_per_m = 0.0\n[run]\ntraverse_y_m = "
      "65.0\n[start]\nvy_m_per_s = 0.0\n" +
          more,
      "soft.toml");
}

// The endings are those that `gate` counts.
TEST(Recording, EndsAsTheRunThatIsCounted) {
  const Scene s = scene();
  dynamics::GateTally counted = dynamics::run_gate_trials(s.gate, s.start, 5, {10, 12});
  std::map<std::string, std::int64_t> ends;
  for (int i = 10; i < 22; ++i) ++ends[record(s, 5, i, false).ending];
  EXPECT_EQ(ends["traversed left"], counted[dynamics::Outcome::traversed_left]);
  EXPECT_EQ(ends["exited left"], counted[dynamics::Outcome::exited_left]);
  EXPECT_EQ(ends["exited right"], counted[dynamics::Outcome::exited_right]);
  EXPECT_EQ(ends["trapped"], counted[dynamics::Outcome::trapped]);
  EXPECT_GE(ends.size(), 3u);
  const auto known = endings(false);
  for (const auto& [ending, n] : ends)
    EXPECT_NE(std::find(known.begin(), known.end(), ending), known.end());
}

// Gate after gate: time and losses go on, the field's frame has no jumps.
TEST(Recording, GoesOnFromGateToGate) {
  const Scene s = parse_scene("", "field.toml");
  for (int trial = 0; trial < 5; ++trial) {
    const Recording r = record(s, 1, trial, true);
    for (std::size_t i = 1; i < r.moments.size(); ++i) {
      const Moment &a = r.moments[i - 1], &b = r.moments[i];
      EXPECT_GE(b.time, a.time);
      EXPECT_GE(b.energy.lost, a.energy.lost - 0.01);
      const double ax = a.sample.state.body.x + 50 * a.i_x, bx = b.sample.state.body.x + 50 * b.i_x;
      const double ay = a.sample.state.body.y + 60 * a.i_y, by = b.sample.state.body.y + 60 * b.i_y;
      EXPECT_LT(std::hypot(bx - ax, by - ay), 0.02 * 60);
      const double start = 0.5 * 15 * 15;
      EXPECT_NEAR(start + b.energy.propulsion_work + b.energy.random_work,
                  b.energy.mechanical() + b.energy.lost, 1e-6);
    }
  }
}

TEST(Recording, WhatItsEndIsCalled) {
  EXPECT_TRUE(ends_so("traversed left", "traversed"));
  EXPECT_TRUE(ends_so("traversed left", "traversed left"));
  EXPECT_FALSE(ends_so("traversed left", "traversed right"));
  EXPECT_FALSE(ends_so("traversed left", "trav")) << "whole words";
  EXPECT_FALSE(ends_so("traversed left", ""));
  for (const char* ending : {"crossed", "left side", "right side"})
    EXPECT_TRUE(ends_so(ending, "departed")) << ending;
  for (const char* ending : {"trapped", "cut off", "not finite", "traversed left"})
    EXPECT_FALSE(ends_so(ending, "departed")) << ending;
  EXPECT_TRUE(ends_so("left side", "left_side"));
  EXPECT_TRUE(ends_so("cut off", "cut_off"));
  EXPECT_FALSE(ends_so("right side", "left side"));
  EXPECT_FALSE(ends_so("left side", "left field"));
}

// Kept are the trials that end so, in their order, each as it is alone.
TEST(Recording, KeepsTheTrialsThatEndSo) {
  const Scene s = scene();
  const Recordings all = record_trials(s, {.seed = 5, .first = 10, .trials = 12});
  const Recordings left =
      record_trials(s, {.seed = 5, .first = 10, .trials = 12, .only = "traversed left"});
  ASSERT_EQ(all.runs.size(), 12u);
  EXPECT_EQ(all.health.runs, 12);
  std::vector<std::int64_t> expected, found;
  for (const Recording& r : all.runs)
    if (r.ending == "traversed left") expected.push_back(r.trial);
  for (const Recording& r : left.runs) found.push_back(r.trial);
  EXPECT_EQ(found, expected);
  EXPECT_LT(found.size(), 12u);
  EXPECT_EQ(left.trials, 12);
  EXPECT_EQ(left.runs.front().moments.size(), record(s, 5, found.front(), false).moments.size());
  EXPECT_THROW((void)record_trials(s, {.seed = 5, .trials = 2, .only = "traversed evenly"}),
               std::runtime_error);
  EXPECT_THROW((void)record_trials(s, {.only = "stuck"}), std::invalid_argument);
}

// A moment made by hand: 3 m beside the joint's height in gate (1, 2) of a field of 50 m x 65 m
// gates.
TEST(Recording, ColumnsOfAMomentMadeByHand) {
  const Scene s = scene();
  Moment m;
  m.i_x = 1;
  m.i_y = 2;
  m.sample.state.body = {3.0, 60.0, -1.0, 2.0};
  m.sample.contact = {dynamics::ContactMode::free, dynamics::ContactMode::held};
  m.energy.beams = {1.0, 2.0};
  m.energy.elastic = {10.0, 20.0};
  const auto value = [&](const char* name) { return column(name).value({s.gate, 7, m}); };
  EXPECT_EQ(value("trial"), 7.0);
  EXPECT_EQ(value("field_x_m"), 53.0);
  EXPECT_EQ(value("field_y_m"), 190.0);
  EXPECT_EQ(value("vx_m_per_s"), -1.0);
  EXPECT_EQ(value("kinetic_beams_J"), 3.0);
  EXPECT_EQ(value("potential_J"), 30.0 + 7.0 * (65.0 - 60.0));
  EXPECT_EQ(column("contact_right").words.at(static_cast<std::size_t>(value("contact_right"))),
            "held");
  EXPECT_THROW((void)column("colour"), std::out_of_range);
}

}  // namespace
}  // namespace gatewalk::lattice
