// SPDX-License-Identifier: MIT
#include "tests/support/twins.h"

#include <gtest/gtest.h>

#include "dynamics/disc/landscape.h"
#include "dynamics/disc/row_trials.h"
#include "dynamics/disc/study/accuracy.h"
#include "dynamics/disc/study/choice.h"
#include "dynamics/disc/trace.h"

namespace gatewalk::dynamics {
namespace {

using test::Twin;
using test::twins;

/// The scene with default values of the keys that a scene may leave out.
GateParams own_settings(GateParams p) {
  p.contact.impulse_threshold = default_impulse_threshold(p);
  p.run.event_tolerance = default_event_tolerance(p);
  p.run.step = default_step(p);
  return p;
}

GateParams scene(std::string_view method) {
  GateParams p;
  p.forces.propulsion = 7.0;
  p.forces.random = 50.0;
  p.run.method = method;
  p = own_settings(p);
  if (method == "penalty") p.run.step = 5e-4;
  return p;
}

class Twins : public testing::TestWithParam<const char*> {};

TEST_P(Twins, RunsHaveTheSameBits) {
  const GateParams p = scene(GetParam());
  const BodyState start{3.0, 0.0, -2.0, 12.0};
  const auto method = make_method(p);
  for (const Twin& twin : twins()) {
    SCOPED_TRACE(testing::Message() << twin);
    const GateParams q = p.run.method == "penalty" ? twin.of(p) : own_settings(twin.of(p));
    EXPECT_EQ(q.run.step, p.run.step * twin.of(0, 1, 0));
    EXPECT_EQ(q.contact.impulse_threshold, p.contact.impulse_threshold * twin.of(1, -1, 1));
    EXPECT_EQ(q.run.event_tolerance, p.run.event_tolerance * twin.of(1, 0, 0));
    const auto other = make_method(q);
    for (std::int64_t trial = 0; trial < 12; ++trial) {
      const GateRun a = run_gate_trial(p, *method, start, 1, trial);
      const GateRun b = run_gate_trial(q, *other, twin.of(start), 1, trial);
      ASSERT_EQ(a.outcome, b.outcome);
      const BodyState exit = twin.of(a.exit);
      ASSERT_EQ(exit.x, b.exit.x);
      ASSERT_EQ(exit.y, b.exit.y);
      ASSERT_EQ(exit.vx, b.exit.vx);
      ASSERT_EQ(exit.vy, b.exit.vy);
      ASSERT_EQ(a.seconds * twin.of(0, 1, 0), b.seconds);
      ASSERT_EQ(a.watch.evaluations, b.watch.evaluations);
      ASSERT_EQ(a.watch.impacts, b.watch.impacts);
      ASSERT_EQ(a.watch.fast_steps, b.watch.fast_steps);
      ASSERT_EQ(a.watch.energy_created * twin.of(2, -2, 1), b.watch.energy_created);
      ASSERT_EQ(a.watch.max_theta, b.watch.max_theta);
      ASSERT_EQ(a.watch.hit_loss * twin.of(2, -2, 1), b.watch.hit_loss);
    }
  }
}

// Vector lanes and the matrix.
TEST_P(Twins, MatricesHaveTheSameCounts) {
  const GateParams p = scene(GetParam());
  Transitions a(table3_space(p));
  add_trials(a, p, 1, {0, 2});
  for (const Twin& twin : {Twin{-10, 10, -10}, Twin{5, 7, -2}, Twin{-1, 0, 0}, Twin{0, 1, 0}}) {
    SCOPED_TRACE(testing::Message() << twin);
    const GateParams q = p.run.method == "penalty" ? twin.of(p) : own_settings(twin.of(p));
    Transitions b(table3_space(q));
    for (int boundary = 0; boundary < kBoundaries; ++boundary) {
      const auto &x = a.space.bins()[boundary].edges, &y = b.space.bins()[boundary].edges;
      for (std::size_t axis = 0; axis < x.size(); ++axis) {
        const double unit = axis == kEntryD ? twin.of(1, 0, 0) : twin.of(1, -1, 0);
        for (std::size_t i = 0; i < x[axis].size(); ++i) EXPECT_EQ(x[axis][i] * unit, y[axis][i]);
      }
    }
    add_trials(b, q, 1, {0, 2});
    EXPECT_EQ(a.rows, b.rows);
    EXPECT_EQ(a.clamped, b.clamped);
    EXPECT_EQ(a.health.steps, b.health.steps);
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, Twins,
                         testing::Values("paper", "stable", "moreau", "event", "penalty"));

TEST(Twin, AutoChoosesTheSame) {
  GateParams p = scene("auto");
  p.run.tolerance = 0.02;
  const std::array starts{BodyState{0.0, 0.0, 0.0, 15.0}};
  const Choice a = choose_method(p, starts, 1);
  const Twin twin{-6, -8, 9};
  const std::array others{twin.of(starts[0])};
  const Choice b = choose_method(own_settings(twin.of(p)), others, 1);
  EXPECT_EQ(a.params.run.method, b.params.run.method);
  EXPECT_EQ(a.params.run.step * twin.of(0, 1, 0), b.params.run.step);
  ASSERT_EQ(a.tried.size(), b.tried.size());
  for (std::size_t i = 0; i < a.tried.size(); ++i)
    EXPECT_EQ(a.tried[i].error.changed, b.tried[i].error.changed);
}

TEST(Twin, LandscapesAndTracesAreTheSame) {
  const GateParams p = scene("stable");
  const Landscape a = landscape(p, 0.0, 2.0);
  const auto method = make_method(p);
  RandomForce force = gate_force(p, 1, 3);
  const GateTrace run = trace_gate(p, *method, {0.0, 0.0, 0.0, 15.0}, force);
  for (const Twin& twin : twins()) {
    SCOPED_TRACE(testing::Message() << twin);
    const GateParams q = own_settings(twin.of(p));
    const Landscape b = landscape(q, 0.0, 2.0 * twin.of(1, 0, 0));
    ASSERT_EQ(a.total.size(), b.total.size());
    EXPECT_TRUE((a.total * twin.of(2, -2, 1) == b.total || a.total.isInf()).all());
    EXPECT_EQ(lowest_pass(a, 0.0, 0.0).barrier() * twin.of(2, -2, 1),
              lowest_pass(b, 0.0, 0.0).barrier());
    const auto other = make_method(q);
    RandomForce same = gate_force(q, 1, 3);
    const GateTrace t = trace_gate(q, *other, twin.of(BodyState{0.0, 0.0, 0.0, 15.0}), same);
    ASSERT_EQ(run.samples.size(), t.samples.size());
    for (std::size_t i = 0; i < t.samples.size(); ++i) {
      ASSERT_EQ(run.samples[i].state.body.x * twin.of(1, 0, 0), t.samples[i].state.body.x);
      ASSERT_EQ(run.samples[i].energy.lost * twin.of(2, -2, 1), t.samples[i].energy.lost);
      ASSERT_EQ(run.samples[i].contact, t.samples[i].contact);
    }
  }
}

// Settings of the charts, references and limits of comparisons.
TEST(Twin, SettingsAndErrorsAreTheSame) {
  const GateParams p = scene("stable");
  const Twin twin{-10, 10, 3};
  const GateParams q = own_settings(twin.of(p));
  for (const std::string_view method : chart_methods()) {
    const auto a = chart_settings(method, p), b = chart_settings(method, q);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(a[i].value * twin.of(a[i].key), b[i].value);
      EXPECT_EQ(a[i].usual, b[i].usual);
    }
  }
  EXPECT_EQ(reference_setting(p).value * twin.of(1, 0, 0), reference_setting(q).value);
  TrialEnds coarse, fine, other_coarse, other_fine;
  GateParams half = p, other_half = q;
  half.run.step *= 0.5;
  other_half.run.step *= 0.5;
  const BodyState start{0.0, 0.0, 0.0, 15.0};
  add_trial_ends(coarse, p, start, 1, {0, 60});
  add_trial_ends(fine, half, start, 1, {0, 60});
  add_trial_ends(other_coarse, q, twin.of(start), 1, {0, 60});
  add_trial_ends(other_fine, other_half, twin.of(start), 1, {0, 60});
  const StrongError a = strong_error(p, coarse.trials, fine.trials);
  const StrongError b = strong_error(q, other_coarse.trials, other_fine.trials);
  EXPECT_EQ(a.parted, b.parted);
  EXPECT_EQ(a.position * twin.of(1, 0, 0), b.position);
  EXPECT_EQ(a.energy * twin.of(2, -2, 1), b.energy);
}

// ---- Keys left out ----

struct Filled {
  GateParams p;
  BodyState start{0.0, 0.0, 0.0, 15.0};
  std::vector<std::string_view> keys;
};

Filled filled(GateParams p, std::vector<std::string_view> given) {
  Filled f{p, {0.0, 0.0, 0.0, 15.0}, {}};
  f.keys = fill_in(f.p, f.start, [&](std::string_view key) {
    return std::find(given.begin(), given.end(), key) != given.end();
  });
  return f;
}

TEST(FillIn, ASceneWithoutABodyOfItsOwnIsThePapers) {
  const Filled f = filled({}, {"forces.propulsion_N"});
  for (const ParamInfo& info : gate_param_table())
    EXPECT_EQ(info.get(f.p), info.get(GateParams{})) << info.key;
  EXPECT_EQ(f.start.vy, 15.0);
}

TEST(FillIn, ThePapersBodyAndForceGiveThePapersScene) {
  const Filled f = filled({}, {"body.mass_kg", "body.radius_m", "forces.propulsion_N"});
  for (const ParamInfo& info : gate_param_table())
    EXPECT_NEAR(info.get(f.p), info.get(GateParams{}), 1e-14 * info.get(GateParams{})) << info.key;
  EXPECT_NEAR(f.start.vy, 15.0, 1e-13);
}

TEST(FillIn, TwinsOfThreeKeysAreTwins) {
  GateParams robot;
  robot.body = {0.25, 0.08};
  robot.forces.propulsion = 0.8;
  const std::vector<std::string_view> three{"body.mass_kg", "body.radius_m", "forces.propulsion_N"};
  const Filled a = filled(robot, three);
  EXPECT_NO_THROW(validate(a.p));
  EXPECT_NEAR(a.p.beams.length, 0.2, 1e-15);
  EXPECT_NEAR(a.p.run.traverse_y, 0.48, 1e-15);
  for (const Twin& twin : twins()) {
    GateParams rescaled = twin.of(robot);
    const Filled b = filled(rescaled, three);
    for (const ParamInfo& info : gate_param_table())
      EXPECT_EQ(info.get(a.p) * twin.of(info.key), info.get(b.p)) << info.key;
    EXPECT_EQ(a.start.vy * twin.of(1, -1, 0), b.start.vy);
  }
}

TEST(FillIn, WhatIsGivenStays) {
  GateParams p;
  p.body = {0.25, 0.08};
  p.beams.joint_x = 0.23;
  p.beams.stiffness_left = 0.15;
  const Filled f = filled(
      p, {"body.radius_m", "body.mass_kg", "beams.joint_x_m", "beams.stiffness_left_Nm_per_rad"});
  EXPECT_EQ(f.p.beams.joint_x, 0.23);
  EXPECT_EQ(f.p.beams.length, 0.23);  // tips meet
  EXPECT_EQ(f.p.beams.stiffness_right, 0.15);
}

TEST(Scale, IsOneInThePapersScenes) {
  for (const double force : {4.0, 7.0, 9.0})
    for (const double random : {0.0, 10.0, 60.0}) {
      GateParams p;
      p.forces.propulsion = force;
      p.forces.random = random;
      const Scale s = scale_of(p);
      EXPECT_EQ(s.length, 1.0);
      EXPECT_EQ(s.mass, 1.0);
      EXPECT_EQ(s.time, 1.0);
    }
}

}  // namespace
}  // namespace gatewalk::dynamics
