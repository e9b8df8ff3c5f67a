// SPDX-License-Identifier: MIT
#include "dynamics/disc/stable_lanes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "dynamics/disc/ensemble.h"
#include "tests/support/gate_runs.h"
#include "tests/support/instruction_sets.h"
#include "tests/support/long.h"
#include "tests/support/scenes.h"

namespace gatewalk::dynamics {
namespace {

using test::expect_same_bits;
using test::usual_or_full;

std::vector<GateRun> by_lanes(const GateParams& p, const BodyState& start, int n,
                              std::int64_t most_work = kAnyWork, std::int64_t at_once = kAnyWork) {
  const StableMethod method(p);
  return test::trials_by(
      [&](const NextRun& next) { carry_out_in_lanes(p, method, next, most_work, at_once); }, p,
      start, n);
}

std::vector<GateRun> one_by_one(const GateParams& p, const BodyState& start, int n,
                                std::int64_t most_work = kAnyWork) {
  const StableMethod method(p);
  std::vector<GateRun> runs(n);
  for (int i = 0; i < n; ++i) runs[i] = run_gate_trial(p, method, start, 1, i, most_work);
  return runs;
}

void expect_same(const std::vector<GateRun>& a, const std::vector<GateRun>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    SCOPED_TRACE(testing::Message() << "trial " << i);
    expect_same_bits(a[i], b[i]);
    if (testing::Test::HasFailure()) return;
  }
}

struct Scene {
  const char* name;
  GateParams p;
  BodyState start;
};

/// The kinds of motion in the paper's scenes, and those that the lanes leave to the plain method.
std::vector<Scene> scenes() {
  std::vector<Scene> all;
  const auto add = [&](const char* name, const GateParams& p,
                       const BodyState& start = {.vy = 15.0}) {
    all.push_back({name, p, start});
  };
  GateParams p;
  add("field", p);
  add("Sec. III-B", test::study(10.0), {});
  p.run.step = 0.004;
  add("five steps a draw", p);
  p = {};
  p.forces.random_rate = 37.0;
  p.run.step = 1.0 / 111;
  p.run.time_limit = 3.3333;
  add("a time limit within a step", p, {5.0, 2.0, -3.0, 12.0});
  p = {};
  p.beams.damping = 0.0;
  p.contact.restitution = 0.0;
  add("undamped, plastic", p);
  p.contact.restitution = 1.0;
  p.contact.impulse_threshold = 0.0;
  add("undamped, elastic", p);
  p = {};
  p.beams.stiffness_left = 0.0;
  p.beams.stiffness_right = 14'000.0;
  add("soft and stiff", p);
  p.beams.stiffness_left = 50'000.0;
  p.beams.mass = 0.03;
  add("very stiff", p);
  p = {};
  p.beams.mass = 0.001;
  add("light beams", p);
  p = {};
  p.beams.mass = 50.0;
  add("heavy beams", p);
  p = {};
  p.beams.damping = 3000.0;
  p.forces.propulsion = 60.0;
  add("strongly damped", p);
  p = {};
  p.beams.length = 40.0;  // longer than half the gate: both touch
  p.body.radius = 5.0;
  add("overlapping", p);
  p = {};
  p.forces.random = 0.0;
  p.forces.drag = 0.0;
  add("symmetric, no force at random", p, {});
  p = {};
  p.forces.random = 0.0;
  p.beams.length = p.beams.joint_x;  // the tips meet and do not give way: both hits coincide
  p.run.time_limit = 5.0;
  p.beams.mass = 1e17;
  add("a wall of both beams", p);
  p.beams.mass = 1e15;  // both share one impulse
  add("a wall that hardly gives way", p);
  p = {};
  p.forces.drag = 2.0;  // beyond the power series of free motion
  p.forces.propulsion = 60.0;
  add("wading", p);
  p = {};
  p.forces.random = 500.0;
  add("wild", p);
  p.forces.random = 50'000.0;
  add("wilder", p);
  p = {};
  add("faster than any step follows", p, {-20.0, -20.0, 3e4, 4e4});
  p = {};
  p.beams.stiffness_left = p.beams.stiffness_right = p.beams.damping = 0.0;
  p.body.mass = 1e-3;
  add("beams that go round and round", p);
  for (const bool elastic_tips : {false, true}) {
    p = test::free_rods();  // weak hits of tips and sides end otherwise
    p.beams.stiffness_left = p.beams.stiffness_right = 100.0;
    p.contact.restitution = elastic_tips ? 0.5 : 1.0;
    p.contact.tip_restitution = elastic_tips ? 1.0 : 0.5;
    p.run.time_limit = 20.0;
    add(elastic_tips ? "elastic tips, no forces" : "elastic sides, no forces", p,
        {4.0, 0.0, 0.5, 3.0});
  }
  return all;
}

TEST(StableLanes, HaveTheBitsOfThePlainMethod) {
  const int n = static_cast<int>(usual_or_full(200, 20'000));
  std::int64_t impacts = 0;
  for (const Scene& scene : scenes()) {
    SCOPED_TRACE(scene.name);
    const auto runs = by_lanes(scene.p, scene.start, n);
    expect_same(runs, one_by_one(scene.p, scene.start, n));
    for (const GateRun& run : runs) impacts += run.watch.impacts;
  }
  EXPECT_GT(impacts, 50'000);
}

// Random starts in motion, also on and in beams: contacts of every kind from the first step.
TEST(StableLanes, HaveTheBitsOfThePlainMethodFromAnyStart) {
  const GateParams p;
  const StableMethod method(p);
  const int n = static_cast<int>(usual_or_full(1000, 100'000));
  const auto next_start = [&](int i) {
    Random random(Purpose::row, {7, 0, static_cast<std::uint64_t>(i)});
    const auto between = [&](double a, double b) { return a + (b - a) * random.uniform(); };
    return BodyState{between(-24, 24), between(-10, 59), between(-80, 80), between(-80, 80)};
  };
  int next = 0;
  std::vector<GateRun> runs(n);
  carry_out_in_lanes(
      p, method,
      [&](RunSlot& slot, const GateRun* ended) {
        if (ended != nullptr) runs[slot.trial] = *ended;
        if (next == n) return false;
        slot.trial = next;
        slot.start = next_start(next++);
        slot.force = gate_force(p, 1, slot.trial);
        return true;
      },
      kAnyWork, kAnyWork);
  for (int i = 0; i < n; ++i) {
    SCOPED_TRACE(testing::Message() << "trial " << i);
    expect_same_bits(run_gate_trial(p, method, next_start(i), 1, i), runs[i]);
    if (HasFailure()) return;
  }
}

#if defined(__x86_64__)
TEST(StableLanes, AreTakenWhereThereAreRegisters) { EXPECT_TRUE(lanes_pay_for_stable()); }
#endif

// The other runs in flight, and their number, change nothing.
TEST(StableLanes, AreIndependentOfTheirCompany) {
  for (const Scene& scene : scenes()) {
    SCOPED_TRACE(scene.name);
    const auto together = by_lanes(scene.p, scene.start, 60);
    for (const int at_once : {1, 3, 17})
      expect_same(by_lanes(scene.p, scene.start, 60, kAnyWork, at_once), together);
  }
}

TEST(StableLanes, HaveTheSameBitsWithAnyInstructionSet) {
  for (const Scene& scene : scenes()) {
    SCOPED_TRACE(scene.name);
    const auto best = by_lanes(scene.p, scene.start, 60);
    test::on_every_instruction_set([&] { expect_same(by_lanes(scene.p, scene.start, 60), best); });
  }
}

// A trial that continues in its slot keeps its force, also in the middle of a hold.
TEST(StableLanes, RunsThatGoOn) {
  const GateParams p;
  const StableMethod method(p);
  const int n = 40;
  const auto again = [](const GateRun& run) {
    BodyState b = run.exit;
    b.x *= 0.5;
    b.y = 0.0;
    return b;
  };
  std::vector<GateRun> second(n);
  std::vector<int> ran(n, 0);
  int next = 0;
  carry_out_in_lanes(
      p, method,
      [&](RunSlot& slot, const GateRun* ended) {
        if (ended != nullptr && ++ran[slot.trial] == 1) {
          slot.start = again(*ended);
          return true;
        }
        if (ended != nullptr) second[slot.trial] = *ended;
        if (next == n) return false;
        slot.trial = next++;
        slot.start = {.vy = 15.0};
        slot.force = gate_force(p, 1, slot.trial);
        return true;
      },
      kAnyWork, kAnyWork);
  for (int i = 0; i < n; ++i) {
    RandomForce force = gate_force(p, 1, i);
    const GateRun first = run_gate(p, method, {.vy = 15.0}, force);
    expect_same_bits(run_gate(p, method, again(first), force), second[i]);
  }
}

// The first runs may also begin in the middle of a hold, and of a hold of another length.
TEST(StableLanes, RunsThatBeginWithinAHold) {
  GateParams p, other;
  other.forces.random_rate = 25.0;
  for (const auto& [before, here] : {std::pair{p, p}, std::pair{p, other}, std::pair{other, p}}) {
    const StableMethod first(before), method(here);
    const int n = 60;
    std::vector<RunSlot> begins;
    for (int i = 0; i < n; ++i) {
      RandomForce force = gate_force(before, 1, i);
      const GateRun run = run_gate(before, first, {.vy = 15.0}, force);
      force.enter(here.forces);
      begins.push_back({i, {0.5 * run.exit.x, 0.0, run.exit.vx, run.exit.vy}, force});
    }
    std::vector<GateRun> runs(n);
    int next = 0;
    carry_out_in_lanes(
        here, method,
        [&](RunSlot& slot, const GateRun* ended) {
          if (ended != nullptr) runs[slot.trial] = *ended;
          if (next == n) return false;
          slot = begins[next++];
          return true;
        },
        kAnyWork, kAnyWork);
    for (RunSlot& b : begins) {
      SCOPED_TRACE(testing::Message() << "trial " << b.trial);
      expect_same_bits(run_gate(here, method, b.start, b.force), runs[b.trial]);
      if (HasFailure()) return;
    }
  }
}

// A run at its limit of work stops at the same draw of the force.
TEST(StableLanes, StopWhenTheyAreOutOfWork) {
  const GateParams p;
  const auto runs = by_lanes(p, {.vy = 15.0}, 60, 500);
  expect_same(runs, one_by_one(p, {.vy = 15.0}, 60, 500));
  EXPECT_TRUE(std::any_of(runs.begin(), runs.end(), [](const auto& r) { return r.out_of_work; }));
}

// A body that starts outside has ended before the first step; a body whose state is not finite, or
// soon is not, is broken; a body whose time is over is trapped. None of them takes a lane, however
// many there are.
TEST(StableLanes, RunsThatEndAtOnce) {
  GateParams p;
  p.run.time_limit = 0.02;
  for (const BodyState& start : {BodyState{0.0, 61.0, 0.0, 15.0}, BodyState{-26.0, 0.0, 0.0, 0.0},
                                 BodyState{0.0, 0.0, 0.0, 1e308}, BodyState{0.0, 0.0, 1e308, 1e308},
                                 BodyState{0.0, 0.0, std::nan(""), 0.0},
                                 BodyState{0.0, 0.0, 0.0, 15.0}, BodyState{0.0, 0.0, 0.0, -1e300}})
    expect_same(by_lanes(p, start, 2000), one_by_one(p, start, 2000));
}

}  // namespace
}  // namespace gatewalk::dynamics
