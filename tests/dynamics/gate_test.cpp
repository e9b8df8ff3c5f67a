// SPDX-License-Identifier: MIT
#include "dynamics/disc/gate.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/long.h"
#include "tests/support/measured.h"
#include "tests/support/numbers.h"
#include "tests/support/scenes.h"

namespace gatewalk::dynamics {
namespace {

using test::kEps;

RandomForce force_of(const GateParams& p, std::uint64_t trial = 0) {
  return {p.forces, Random(Purpose::gate, {.seed = 1, .row = 0, .trial = trial})};
}

GateRun run(const GateParams& p, const BodyState& start, std::uint64_t trial = 0) {
  RandomForce force = force_of(p, trial);
  return run_gate(p, *make_method(p), start, force);
}

class Gate : public testing::TestWithParam<const char*> {
 protected:
  Gate() { p.run.method = GetParam(); }
  [[nodiscard]] bool whole_steps() const { return p.run.method == "paper"; }
  GateParams p = test::free_rods();
};
INSTANTIATE_TEST_SUITE_P(Methods, Gate,
                         testing::Values("stable", "paper", "moreau", "event", "penalty"),
                         [](const auto& instance) { return std::string(instance.param); });

// Straight motion without forces. The run ends on the border, up to rounding: of a position up to
// 65 m in each of 125 steps. Method paper goes on to the end of the step that crosses the border.
TEST_P(Gate, EndsWhereTheBodyLeaves) {
  const double h = p.run.step;
  struct Case {
    BodyState start;
    Outcome outcome;
    double seconds;
  };
  for (const Case& c : {Case{{20, 5, 10, 0}, Outcome::exited_right, 0.5},
                        Case{{-20, 5, -10, 0}, Outcome::exited_left, 0.5},
                        Case{{0, 55, 0, 10}, Outcome::traversed_even, 0.5},
                        Case{{0, 5, 0, -10}, Outcome::trapped, 12.0}}) {
    const GateRun r = run(p, c.start);
    EXPECT_EQ(r.outcome, c.outcome);
    const double rounding = 125 * 65 * kEps;
    EXPECT_GE(r.seconds, c.seconds - rounding);
    EXPECT_LE(r.seconds, c.seconds + (whole_steps() ? h : 0.0) + rounding);
    EXPECT_NEAR(r.exit.x, c.start.x + c.start.vx * r.seconds, 1e-10);
    EXPECT_NEAR(r.exit.y, c.start.y + c.start.vy * r.seconds, 1e-10);
    // The cubic between a step's ends has the slope 1.5 (b - a) / h and less, a and b rounded.
    const double slope = whole_steps() ? 0.0 : 1.5 / h * 2 * 65 * kEps;
    EXPECT_NEAR(r.exit.vx, c.start.vx, slope);
    EXPECT_NEAR(r.exit.vy, c.start.vy, slope);
    EXPECT_EQ(r.watch.impacts, 0);
    EXPECT_EQ(outside(p, r.exit), c.outcome != Outcome::trapped);
  }
}

// A body that crosses the far end and a side in one step, half a step apart: the first crossing is
// the ending. Method paper sees only the end of the step and reports a traversal.
TEST_P(Gate, TheFirstBorderIsTheEnding) {
  for (const double side : {-1.0, 1.0}) {
    const Outcome beside = side < 0 ? Outcome::exited_left : Outcome::exited_right;
    EXPECT_TRUE(is_traversed(run(p, {side * 24.97, 59.99, side * 10, 10}).outcome));
    EXPECT_EQ(run(p, {side * 24.99, 59.97, side * 10, 10}).outcome,
              whole_steps() ? Outcome::traversed_even : beside);
  }
}

TEST_P(Gate, StartOutsideEndsAtOnce) {
  const GateRun r = run(p, {30, 5, 1, 2});
  EXPECT_EQ(r.outcome, Outcome::exited_right);
  EXPECT_EQ(r.seconds, 0.0);
  EXPECT_EQ(r.watch.steps, 0);
  EXPECT_EQ(r.exit.x, 30.0);
}

TEST_P(Gate, StartOnTheBorderIsInside) {
  const GateRun r = run(p, {25, 5, -10, 0});
  EXPECT_EQ(r.outcome, Outcome::exited_left);
  EXPECT_NEAR(r.seconds, 5.0, 2 * p.run.step);
}

TEST_P(Gate, TrappedMeansTheWholeTimeLimit) {
  for (const double limit : {12.0, 1.0, 0.13, 0.004}) {
    for (const double step : {0.004, 0.001, 0.02}) {
      p.run.time_limit = limit;
      p.run.step = step;
      const GateRun r = run(p, {0, 5, 0, 0});
      EXPECT_EQ(r.outcome, Outcome::trapped);
      // Method paper takes whole steps, the last one beyond the limit if needed. The others end at
      // the limit, with shorter steps in the hold that the limit cuts. The times of 600 spells are
      // summed.
      const double steps = std::ceil(limit / step - 1e-6);
      EXPECT_NEAR(r.seconds, whole_steps() ? steps * step : limit, 600 * 12 * kEps)
          << limit << ' ' << step;
      if (p.run.method != "event") {  // it has no fixed step
        EXPECT_EQ(static_cast<double>(r.watch.steps), steps) << limit << ' ' << step;
      }
    }
  }
}

// Without contact v_x is the sum of one impulse F_i * 0.02 s per hold, for any step...
TEST_P(Gate, LateralSpeedIsTheSumOfItsDrawsAtAnyStep) {
  p.forces.random = 20.0;
  p.beams.joint_x = 1e5;
  p.run.time_limit = 2.0;
  for (const double step : {0.02, 0.01, 0.004, 0.002, 0.001}) {
    p.run.step = step;
    for (std::uint64_t trial = 0; trial < 20; ++trial) {
      Random draws(Purpose::gate, {.seed = 1, .row = 0, .trial = trial});
      double sum = 0.0;
      for (int hold = 0; hold < 100; ++hold) sum += 20.0 * draws.normal() * 0.02;
      const GateRun r = run(p, {}, trial);
      EXPECT_NEAR(r.seconds, 2.0, 1e-12);
      // 2000 roundings of numbers up to 20.
      EXPECT_NEAR(r.exit.vx, sum, 2000 * kEps * 10) << step;
    }
  }
}

// ... so its standard deviation after 2 s is 0.2 Rm (s m/s/N): 0.02 s Rm sqrt(100) / M. 80 000
// trials determine it to 0.25 %; the tolerance is four times that. The full count runs all five
// steps.
TEST_P(Gate, LateralSpeedHasTheStandardDeviationOfHeldForce) {
  p.forces.random = 20.0;
  p.beams.joint_x = 1e5;
  p.run.time_limit = 2.0;
  constexpr double kSteps[] = {0.02, 0.01, 0.004, 0.002, 0.001};
  const int steps = test::usual_or_full(1, 5);
  double worst = 0.0;
  for (int k = 0; k < steps; ++k) {
    p.run.step = kSteps[k];
    constexpr int kTrials = 80'000;
    const auto method = make_method(p);
    std::vector<double> vx(kTrials);
    tbb::parallel_for(0, kTrials, [&](int i) {
      RandomForce force = force_of(p, static_cast<std::uint64_t>(i));
      vx[i] = run_gate(p, *method, {}, force).exit.vx;
    });
    double sum = 0.0, squares = 0.0;
    for (const double v : vx) {
      sum += v;
      squares += v * v;
    }
    EXPECT_NEAR(sum / kTrials, 0.0, 4 * 4.0 / std::sqrt(kTrials));
    worst = std::max(worst, std::abs(std::sqrt(squares / kTrials) / 4.0 - 1.0));
  }
  EXPECT_LE(worst, 0.01);
  test::measured({.requirement = 13,
                  .method = GetParam(),
                  .what = "sd of v_x after 2 s, relative",
                  .figure = worst,
                  .limit = 0.01,
                  .cases = steps,
                  .asked = 5});
}

// The force continues from gate to gate: two runs of 1 s equal one run of 2 s.
TEST_P(Gate, RandomForceGoesOnAcrossRuns) {
  p.run.step = 0.004;
  p.forces.random = 20.0;
  p.beams.joint_x = 1e5;
  p.run.time_limit = 2.0;
  const BodyState whole = run(p, {}).exit;
  for (const double first : {1.0, 0.012, 0.5}) {  // on and off the beat of the holds
    RandomForce force = force_of(p);
    p.run.time_limit = first;
    const GateRun one = run_gate(p, *make_method(p), {}, force);
    p.run.time_limit = 2.0 - first;
    const GateRun two = run_gate(p, *make_method(p), one.exit, force);
    EXPECT_NEAR(two.exit.x, whole.x, 1e-11);
    EXPECT_NEAR(two.exit.vx, whole.vx, 1e-12);
    p.run.time_limit = 2.0;
  }
}

TEST_P(Gate, SameTrialSameBits) {
  p = test::study(10.0);
  p.run.method = GetParam();
  const GateRun a = run(p, {}, 5), b = run(p, {}, 5), c = run(p, {}, 6);
  EXPECT_TRUE(test::same_bits(a.exit.x, b.exit.x));
  EXPECT_TRUE(test::same_bits(a.exit.vy, b.exit.vy));
  EXPECT_EQ(a.watch.impacts, b.watch.impacts);
  EXPECT_TRUE(test::same_bits(a.seconds, b.seconds));
  // Another trial may leave over the same border, but not at the same time and speed.
  EXPECT_NE(a.seconds, c.seconds);
  EXPECT_NE(a.exit.vx, c.exit.vx);
}

/// A method whose state stops being finite in the third call.
class Breaking final : public Method {
 public:
  explicit Breaking(double BodyState::*what) : what_(what) {}
  double advance(GateState& s, double, double duration, EnergyLedger&,
                 Watch& watch) const override {
    if (++watch.steps == 3) s.body.*what_ = std::numeric_limits<double>::quiet_NaN();
    return duration;
  }

 private:
  double BodyState::*what_;
};

TEST(GateRun, BrokenWhenTheStateStopsBeingFinite) {
  const GateParams p;
  for (const auto what : {&BodyState::x, &BodyState::y, &BodyState::vx, &BodyState::vy}) {
    RandomForce force = force_of(p);
    const GateRun r = run_gate(p, Breaking(what), {}, force);
    EXPECT_EQ(r.outcome, Outcome::broken);
    EXPECT_EQ(r.watch.steps, 3);
    EXPECT_NEAR(r.seconds, 0.06, 1e-15);
  }
}

}  // namespace
}  // namespace gatewalk::dynamics
