// SPDX-License-Identifier: MIT
#include "lattice/scene/study/recording.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "lattice/scene/scene_problem.h"
#include "lattice/scene/terrain.h"
#include "lattice/study/choice_rounds.h"
#include "lattice/study/plan.h"

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

// The endings agree with those that `gate` counts.
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

// From gate to gate, time and losses continue, and the position in the field has no jumps.
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

// Keeps the trials with this ending, in their order, each as it is alone.
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

// If a body chooses the types of its gates, its recorded trials are those that policy_trials
// counts.
TEST(Recording, DoesWhatAPolicySays) {
  const Scene s = parse_scene(
      "[run]\nmethod = \"moreau\"\n[field]\nrows = 3\nmax_gates = 9\n"
      "[actions.push]\nforces.propulsion_N = 9\n[actions.wait]\nforces.random_N = 5\n"
      "[actions.soft]\nbeams.stiffness_left_Nm_per_rad = 200\n"
      "[terrain]\nrandom = { s = 0.5 }\n[terrain.types.s]\nbeams.length_m = 22\n",
      "own.toml");
  const CellChoice action = [](const Place& at, const dynamics::Entry& entry) {
    return (at.passed + at.row + (entry.at[0] > 0.0 ? 1 : 0)) % 3;
  };
  std::vector<Scene> taken;
  std::vector<Action> actions;
  for (const Terrain::Type& type : s.actions) {
    taken.push_back(with_action(s, type));
    actions.push_back({type.name, problem_with_all_types(taken.back())});
  }
  const dynamics::CellField cells = cells_of(actions);
  const Problem& first = actions.front().problem;
  FieldTrials counted{.final_gates = {}, .keep_passages = true};
  (void)chosen_trials(cells, first,
                      {first.start,
                       [&](const Place& at, const dynamics::Entry& entry) {
                         return first.map().type_of(at.column, at.row) * 3 + action(at, entry);
                       }},
                      4, {0, 30}, counted);
  const Recordings all =
      record_trials(s, {.seed = 4,
                        .trials = 30,
                        .across_field = true,
                        .only = {},
                        .chosen = chosen_gates({"push", "soft", "wait"}, taken, action)});
  ASSERT_EQ(all.runs.size(), 30u);
  std::set<int> met;
  for (std::size_t i = 0; i < all.runs.size(); ++i) {
    const Recording& run = all.runs[i];
    const auto passages = counted.of_trial(i);
    ASSERT_EQ(run.gates, static_cast<int>(passages.size()));
    std::vector<int> types;
    for (const Moment& m : run.moments)
      if (types.empty() || m.sample.time == 0.0) types.push_back(m.type);
    double seconds = 0.0;
    std::size_t k = 0;
    for (const CellPassage& passage : passages) {
      EXPECT_EQ(types.at(k), passage.type);
      met.insert(types[k++]);
      seconds += passage.costs[0];
    }
    EXPECT_NEAR(run.seconds, seconds, 1e-9 * seconds);
    EXPECT_EQ(all.of(run.moments.back()).forces.propulsion,
              taken[static_cast<std::size_t>(types.back() % 3)].gate.forces.propulsion);
  }
  EXPECT_EQ(met.size(), 6u);
  const std::vector<Column> with_action = columns_of(all);
  ASSERT_EQ(with_action.size(), columns().size() + 1);
  const Column& said = with_action.back();
  EXPECT_EQ(said.name, "action");
  for (const Moment& m : all.runs.front().moments) {
    const double code = said.value({all.of(m), 0, m});
    EXPECT_EQ(code, m.type % 3);
    EXPECT_EQ(said.words.at(static_cast<std::size_t>(code)),
              actions.at(static_cast<std::size_t>(m.type % 3)).name);
  }
  EXPECT_EQ(columns_of(record_trials(s, {.seed = 4, .only = {}, .chosen = {}})).size(),
            columns().size());
}

TEST(Recording, RefusesActionsThatCannotBelongTogether) {
  const Scene s = scene();
  const CellChoice first = [](const Place&, const dynamics::Entry&) { return 0; };
  const CellChoice third = [](const Place&, const dynamics::Entry&) { return 2; };
  EXPECT_THROW((void)chosen_gates({}, {}, first), std::invalid_argument);
  EXPECT_THROW((void)chosen_gates({"a"}, {s, s}, first), std::invalid_argument);
  Scene wider = s;
  wider.field.columns += 2;
  EXPECT_THROW((void)chosen_gates({"a", "b"}, {s, wider}, first), std::invalid_argument);
  const auto run = [&](const CellChoice& action) {
    return record_trials(
        s, {.across_field = true, .only = {}, .chosen = chosen_gates({"a", "b"}, {s, s}, action)});
  };
  EXPECT_EQ(run(first).runs.size(), 1u);
  EXPECT_THROW((void)run(third), std::out_of_range);
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
