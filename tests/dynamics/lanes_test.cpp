// SPDX-License-Identifier: MIT
#include "dynamics/disc/lanes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "dynamics/disc/ensemble.h"
#include "tests/support/gate_runs.h"
#include "tests/support/instruction_sets.h"
#include "tests/support/scenes.h"

namespace gatewalk::dynamics {
namespace {

using test::expect_same_bits;

GateParams marched(GateParams p, double step = 0.004) {
  p.run.method = "moreau";
  p.run.step = step;
  return p;
}

std::vector<GateRun> by_lanes(const GateParams& p, const BodyState& start, int n) {
  return test::trials_by([&](const NextRun& next) { carry_out_in_lanes(p, next); }, p, start, n);
}

struct LaneScene {
  const char* name;
  GateParams p;
  BodyState start;
};

std::vector<LaneScene> lane_scenes() {
  std::vector<LaneScene> scenes;
  const auto add = [&](const char* name, GateParams p, const BodyState& start,
                       double step = 0.004) {
    scenes.push_back({name, marched(p, step), start});
  };
  GateParams p;
  add("field", p, {.vy = 15.0});
  add("Sec. III-B", test::study(10.0), {});
  p.forces.random_rate = 37.0;  // holds of five steps that are shorter than the usual ones
  p.run.time_limit = 3.3333;
  add("odd hold", p, {5.0, 2.0, -3.0, 12.0}, 1.0 / 185);
  p = {};
  p.beams.damping = 0.0;
  p.contact.restitution = 0.0;
  add("undamped, plastic", p, {.vy = 15.0});
  p = {};
  p.beams.stiffness_left = 0.0;
  p.beams.stiffness_right = 14'000.0;
  p.beams.mass = 1.0;
  add("soft and stiff", p, {.vy = 15.0}, 0.001);
  p = {};
  p.beams.length = 40.0;  // longer than half the gate: beams overlap, both touch
  p.body.radius = 5.0;
  add("overlapping", p, {.vy = 15.0});
  p = {};
  p.forces.random = 500.0;
  add("wild", p, {.vy = 15.0});
  return scenes;
}

// With the same noise and the same steps, results that differ by rounding stay close, except for
// few trials in many.
TEST(Lanes, DoWhatThePlainMethodDoes) {
  for (const LaneScene& scene : lane_scenes()) {
    SCOPED_TRACE(scene.name);
    const int n = 400;
    const auto runs = by_lanes(scene.p, scene.start, n);
    const auto method = make_method(scene.p);
    int parted = 0;
    int penetrating[2] = {0, 0};
    double deepest[2] = {0.0, 0.0}, fastest = 0.0;
    for (int i = 0; i < n; ++i) {
      const GateRun plain = run_gate_trial(scene.p, *method, scene.start, 1, i);
      const GateRun& lane = runs[i];
      deepest[0] = std::max(deepest[0], plain.watch.max_penetration);
      deepest[1] = std::max(deepest[1], lane.watch.max_penetration);
      fastest = std::max(fastest, plain.watch.max_speed);
      penetrating[0] += plain.watch.max_penetration > 0.01 * scene.p.body.radius;
      penetrating[1] += lane.watch.max_penetration > 0.01 * scene.p.body.radius;
      const bool near =
          plain.outcome == lane.outcome &&
          std::hypot(plain.exit.x - lane.exit.x, plain.exit.y - lane.exit.y) < 1e-6 &&
          std::hypot(plain.exit.vx - lane.exit.vx, plain.exit.vy - lane.exit.vy) < 1e-6;
      if (!near) {
        ++parted;
        continue;
      }
      EXPECT_NEAR(plain.seconds, lane.seconds, 1e-6);
      EXPECT_EQ(plain.watch.steps, lane.watch.steps);
      EXPECT_EQ(plain.watch.impacts, lane.watch.impacts);
      EXPECT_EQ(plain.watch.fast_steps, lane.watch.fast_steps);
      EXPECT_NEAR(plain.watch.max_speed, lane.watch.max_speed, 1e-6);
      EXPECT_NEAR(plain.watch.energy_created, lane.watch.energy_created, 1e-6);
      EXPECT_NEAR(plain.watch.max_theta[kLeft], lane.watch.max_theta[kLeft], 1e-6);
      EXPECT_NEAR(plain.watch.max_theta[kRight], lane.watch.max_theta[kRight], 1e-6);
    }
    EXPECT_LE(parted, n / 100);
    const double way = fastest * scene.p.run.step;
    EXPECT_NEAR(deepest[0], deepest[1], way * way / scene.p.body.radius);
    EXPECT_EQ(penetrating[0], penetrating[1]);
  }
}

// The other lanes, and the lane's earlier runs, change nothing.
TEST(Lanes, AreIndependentOfTheirCompany) {
  for (const LaneScene& scene : lane_scenes()) {
    SCOPED_TRACE(scene.name);
    const auto together = by_lanes(scene.p, scene.start, 40);
    for (const int i : {0, 1, 7, 8, 15, 16, 23, 39}) {
      GateRun alone;
      bool given = false;
      carry_out_in_lanes(scene.p, [&](RunSlot& slot, const GateRun* ended) {
        if (ended != nullptr) alone = *ended;
        if (given) return false;
        given = true;
        slot.start = scene.start;
        slot.force = gate_force(scene.p, 1, i);
        return true;
      });
      expect_same_bits(alone, together[i]);
    }
  }
}

TEST(Lanes, HaveTheSameBitsWithAnyInstructionSet) {
  for (const LaneScene& scene : lane_scenes()) {
    SCOPED_TRACE(scene.name);
    const auto best = by_lanes(scene.p, scene.start, 60);
    test::on_every_instruction_set([&] {
      const auto runs = by_lanes(scene.p, scene.start, 60);
      for (std::size_t i = 0; i < runs.size(); ++i) expect_same_bits(best[i], runs[i]);
    });
  }
}

// A body that starts outside has ended before the first step; a body whose state is not finite is
// broken; a body whose time is over is trapped. Each gives its lane to the next run.
TEST(Lanes, RunsThatEndAtOnce) {
  GateParams p = marched({});
  p.run.time_limit = 0.004;
  const std::vector<BodyState> starts{{0.0, 61.0, 0.0, 15.0}, {-26.0, 0.0, 0.0, 0.0},
                                      {0.0, 0.0, 0.0, 1e308}, {0.0, 0.0, 1e308, 1e308},
                                      {0.0, 0.0, 0.0, 15.0},  {0.0, 0.0, 0.0, -1e300}};
  std::vector<GateRun> runs(starts.size());
  std::size_t next = 0;
  carry_out_in_lanes(p, [&](RunSlot& slot, const GateRun* ended) {
    if (ended != nullptr) runs[slot.trial] = *ended;
    if (next == starts.size()) return false;
    slot.trial = static_cast<std::int64_t>(next);
    slot.start = starts[next++];
    slot.force = gate_force(p, 1, slot.trial);
    return true;
  });
  const auto method = make_method(p);
  for (std::size_t i = 0; i < starts.size(); ++i) {
    RandomForce force = gate_force(p, 1, static_cast<std::int64_t>(i));
    const GateRun plain = run_gate(p, *method, starts[i], force);
    EXPECT_EQ(plain.outcome, runs[i].outcome) << i;
    EXPECT_EQ(plain.watch.steps, runs[i].watch.steps) << i;
    EXPECT_EQ(plain.seconds, runs[i].seconds) << i;
  }
}

}  // namespace
}  // namespace gatewalk::dynamics
