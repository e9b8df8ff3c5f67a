// SPDX-License-Identifier: MIT
#include "lattice/gates/field_stepper.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "dynamics/disc/ensemble.h"
#include "tests/support/numbers.h"
#include "tests/support/scenes.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;
using test::Draw;

constexpr int kMiddle = 4;  // start column of nine

GateParams moreau(GateParams p = {}, double step = 0.002) {
  p.run.method = "moreau";
  p.run.step = step;
  return p;
}
FieldParams field(Fidelity f, int columns = 9, int rows = 9) { return {columns, rows, 0, f}; }

bool same(const BodyState& a, const BodyState& b) {
  return test::same_bits(a.x, b.x) && test::same_bits(a.y, b.y) && test::same_bits(a.vx, b.vx) &&
         test::same_bits(a.vy, b.vy);
}

/// A free, damped, underdamped beam after t seconds, in closed form.
BeamState swung(double k, double d, double inertia, const BeamState& s, double t) {
  const double a = d / (2 * inertia), w = std::sqrt(k / inertia - a * a);
  const double c = (s.omega + a * s.theta) / w;
  const double decay = std::exp(-a * t), cosine = std::cos(w * t), sine = std::sin(w * t);
  return {decay * (s.theta * cosine + c * sine),
          decay * ((c * w - a * s.theta) * cosine - (s.theta * w + a * c) * sine)};
}

// ---- Free motion

// Beams so short that the body never meets one: a parabola, which the midpoint rule follows
// exactly.
TEST(FieldStepper, PassesGatesWithoutContactOnAParabola) {
  GateParams p = moreau();
  p.beams.length = 1.0;
  p.body.radius = 1.0;
  p.forces.random = 0.0;
  p.forces.drag = 0.0;
  for (const Fidelity f : {Fidelity::remember, Fidelity::all}) {
    FieldStepper stepper(p, field(f), {3, 0, 2, 15});
    RandomForce force(p.forces, Random(Purpose::field, {}));
    double impacts = 0.0;
    for (int gate = 0; gate < 4; ++gate) {
      const GateRun run = stepper.run_gate(force);
      ASSERT_TRUE(is_traversed(run.outcome));
      impacts += static_cast<double>(run.watch.impacts);
      stepper.go_on(run.outcome);
      const double t = stepper.seconds();
      // Round-off of about 5000 steps in numbers up to 240.
      EXPECT_NEAR(60.0 * stepper.row() + stepper.body().y, 15 * t + 4 * t * t, 1e-9);
      EXPECT_NEAR(stepper.body().x, 3 + 2 * t, 1e-9);
      EXPECT_EQ(stepper.row(), gate + 1);
    }
    EXPECT_EQ(impacts, 0.0);
  }
}

// Drag by the midpoint rule: second order in the step.
TEST(FieldStepper, DragIsOfSecondOrder) {
  GateParams p = test::free_rods();
  p.forces.drag = 2.0;
  const auto error = [&](double step) {
    GateParams q = moreau(p, step);
    FieldStepper stepper(q, field(Fidelity::all), {0, 0, 4, 10});
    Watch watch;
    for (int i = 0; i < 25; ++i) (void)stepper.advance(0.0, 0.02, watch);
    return std::abs(stepper.body().vy - 10 * std::exp(-2.0 * 0.5));
  };
  EXPECT_NEAR(std::log2(error(0.004) / error(0.002)), 2.0, 0.02);
}

// ---- Contact

/// A disc near the joint place that its gate shares with the right neighbour, with the beams of
/// three gates turned towards it and in motion. Most beams overlap the disc, so several contacts
/// act at once.
FieldStepper scramble(const GateParams& p, Fidelity f, Draw& draw) {
  FieldStepper stepper(
      p, field(f),
      {draw.uniform(0, 24), draw.uniform(5, 55), draw.uniform(-10, 10), draw.uniform(-10, 10)});
  for (int column = kMiddle - 1; column <= kMiddle + 1; ++column) {
    std::array<BeamState, 2> beams;
    for (const Side side : {kLeft, kRight}) {
      const double joint = 50.0 * (column - kMiddle) + (side == kLeft ? -25.0 : 25.0);
      const double across = side == kLeft ? stepper.body().x - joint : joint - stepper.body().x;
      beams[side] = {std::atan2(stepper.body().y - 30.0, across) + draw.uniform(-0.4, 0.4),
                     draw.uniform(-2, 2)};
    }
    stepper.set_beams(column, 0, beams);
  }
  return stepper;
}

// e = 1, no damping, no drag: the midpoint rule keeps the energy of the springs, and u+ = -u- that
// of body and beams, at any step and for any number of contacts.
TEST(FieldStepper, KeepsEnergyOverAllBeams) {
  Draw draw(3);
  GateParams p = moreau();
  p.forces = {.propulsion = 0.0, .random = 0.0, .random_rate = 50.0, .drag = 0.0};
  p.beams.damping = 0.0;
  p.contact.restitution = p.contact.tip_restitution = 1.0;
  for (const Fidelity f : {Fidelity::remember, Fidelity::all}) {
    int one = 0, two = 0, more = 0;
    for (int scene = 0; scene < 200; ++scene) {
      FieldStepper stepper = scramble(p, f, draw);
      const double start = stepper.energy();
      // About 300 steps, with a few roundings of the energy each.
      const double rounding = 300 * 8 * test::kEps * start;
      Watch watch;
      for (int step = 0; step < 300; ++step) {
        const std::int64_t before = watch.impacts;
        if (stepper.advance(0.0, p.run.step, watch) < p.run.step || outside(p, stepper.body()))
          break;
        const std::int64_t impacts = watch.impacts - before;
        one += impacts == 1;
        two += impacts == 2;
        more += impacts > 2;
        ASSERT_NEAR(stepper.energy(), start, rounding);
        ASSERT_LE(watch.energy_created, rounding);
      }
    }
    EXPECT_GT(one, 100);
    EXPECT_GT(two, 20);
    EXPECT_GT(more, f == Fidelity::all ? 3 : -1);  // with `remember` there are two beams here
  }
}

// Rods without springs: contacts with beams of two gates on one joint place keep the angular
// momentum about it. The midpoint's lever is exact: the disc's displacement over the step differs
// from the predicted one only along the sum of the impulses.
TEST(FieldStepper, KeepsAngularMomentumAboutASharedJoint) {
  Draw draw(4);
  GateParams p = moreau(test::free_rods());
  p.contact.restitution = 0.8;  // not only for elastic contacts
  int neighbours = 0, own = 0;
  for (int scene = 0; scene < 400; ++scene) {
    // Above the joint (25, 30), between the gate's right beam and the neighbour's left beam.
    FieldStepper stepper(p, field(Fidelity::all),
                         {draw.uniform(10, 24), draw.uniform(45, 56), 0, 0});
    const double up = std::atan2(stepper.body().y - 30.0, 25.0 - stepper.body().x);
    const double distance = std::hypot(stepper.body().y - 30.0, 25.0 - stepper.body().x);
    const double half = std::asin(10.0 / distance);  // half the angle under which the disc is seen
    stepper.set_beams(
        kMiddle, 0,
        {BeamState{-1.5, 0.0}, {up - half - draw.uniform(0.01, 0.3), draw.uniform(0, 2)}});
    stepper.set_beams(
        kMiddle + 1, 0,
        {BeamState{std::numbers::pi - up - half - draw.uniform(0.01, 0.3), draw.uniform(0, 2)},
         {}});
    const auto momentum = [&] {
      const BodyState& b = stepper.body();
      return p.body.mass * ((b.x - 25.0) * b.vy - (b.y - 30.0) * b.vx) +
             p.beams.inertia() * (stepper.beams(kMiddle + 1, 0)[kLeft].omega -
                                  stepper.beams(kMiddle, 0)[kRight].omega);
    };
    const double start = momentum();
    const double scale = 25.0 * 60.0 + p.beams.inertia() * 4.0;
    const double right = stepper.beams(kMiddle, 0)[kRight].omega;
    const double left = stepper.beams(kMiddle + 1, 0)[kLeft].omega;
    Watch watch;
    for (int step = 0; step < 150; ++step) {
      if (stepper.advance(0.0, p.run.step, watch) < p.run.step || outside(p, stepper.body())) break;
      ASSERT_NEAR(momentum(), start, 150 * test::kEps * scale);
    }
    own += stepper.beams(kMiddle, 0)[kRight].omega != right;
    neighbours += stepper.beams(kMiddle + 1, 0)[kLeft].omega != left;
  }
  EXPECT_GT(own, 100);
  EXPECT_GT(neighbours, 100);
}

// The converged figures of the study in Sec. III-B (F 7, Rm 10, k 300/500, d 50;
// results/table4/README.md): 5.5 % traversed left, 53.4 % exited, 41.0 % trapped. The tolerance is
// four standard deviations of 1500 trials, plus 1 % for the step; at 4 ms the step costs `stable`
// half of that.
TEST(FieldStepper, OneGateHasTheConvergedOutcomes) {
  const GateParams p = moreau(test::study(50.0), 0.004);
  constexpr int kTrials = 1500;
  std::array<int, dynamics::kOutcomes> seen{};
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
    FieldStepper stepper(p, field(Fidelity::all, 1, 1), {});
    RandomForce force(p.forces, Random(Purpose::gate, {11, 0, trial}));
    ++seen[static_cast<int>(stepper.run_gate(force).outcome)];
  }
  const auto expect_share = [&](int count, double share) {
    EXPECT_NEAR(static_cast<double>(count) / kTrials, share,
                0.01 + 4 * std::sqrt(share * (1 - share) / kTrials));
  };
  const auto of = [&](Outcome outcome) { return seen[static_cast<std::size_t>(outcome)]; };
  expect_share(of(Outcome::traversed_left) + of(Outcome::traversed_right), 0.055);
  expect_share(of(Outcome::exited_left) + of(Outcome::exited_right), 0.534);
  expect_share(of(Outcome::trapped), 0.410);
}

// Method moreau has the same law for two beams: compares run by run. Round-off grows with every
// hit, so states are compared early (up to a few dozen steps of contact), and endings as shares.
TEST(FieldStepper, OneGateIsMethodMoreau) {
  const GateParams p = moreau();
  const auto method = make_method(p);
  constexpr int kTrials = 300;
  std::array<int, dynamics::kOutcomes> ours{}, theirs{};
  int close = 0, touched = 0;
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
    const BodyState start{0, 0, 0, 15};
    const auto noise = [&] { return RandomForce(p.forces, Random(Purpose::gate, {12, 0, trial})); };
    GateState s{start, {}};
    EnergyLedger ledger(p, s);
    Watch watch, other;
    FieldStepper stepper(p, field(Fidelity::remember, 1, 1), start);
    RandomForce force = noise();
    for (int hold = 0; hold < 65; ++hold) {  // 1.3 s: contact begins after 1.1 s
      const double f = force.value();
      (void)method->advance(s, f, 0.02, ledger, watch);
      (void)stepper.advance(f, 0.02, other);
      force.pass(0.02);
    }
    touched += other.impacts > 0;
    const BodyState& b = stepper.body();
    close += std::abs(b.x - s.body.x) + std::abs(b.y - s.body.y) + std::abs(b.vx - s.body.vx) +
                 std::abs(b.vy - s.body.vy) <
             1e-9;
    RandomForce again = noise(), once_more = noise();
    ++theirs[static_cast<int>(run_gate(p, *method, start, again).outcome)];
    FieldStepper all(p, field(Fidelity::all, 1, 1), start);
    ++ours[static_cast<int>(all.run_gate(once_more).outcome)];
  }
  EXPECT_GT(touched, kTrials / 2);
  EXPECT_GE(close, kTrials * 97 / 100);  // near grazing, round-off may decide
  for (std::size_t i = 0; i < ours.size(); ++i) {
    // Four standard deviations of the difference of two shares, although the noise is shared.
    const double n = ours[i] + theirs[i];
    EXPECT_LE(std::abs(ours[i] - theirs[i]), 4 * std::sqrt(n) + 1) << i;
  }
}

// ---- Memory

// The beams of a gate left behind swing on in closed form, and are met again where they are by
// then, but not before they are within reach. The beams ahead are stiff: the body bounces off them
// and comes back.
TEST(FieldStepper, RememberedBeamsSwingOnInClosedForm) {
  GateParams p = moreau();
  p.forces = {.propulsion = 0.0, .random = 0.0, .random_rate = 50.0, .drag = 0.0};
  p.beams.stiffness_left = 4e4;
  p.beams.stiffness_right = 3e4;
  p.beams.damping = 4.0;  // so that the beams still move after seconds
  FieldStepper stepper(p, field(Fidelity::remember), {-20, 50, 0, 25});
  stepper.set_beams(kMiddle, 0, {BeamState{0.4, -3.0}, {-0.2, 1.0}});
  Watch watch;
  const auto step = [&] {
    (void)stepper.advance(0.0, p.run.step, watch);
    if (outside(p, stepper.body())) stepper.go_on(Outcome::traversed_even);
  };
  while (stepper.row() == 0) step();
  EXPECT_EQ(stepper.awake(), 1U);  // gates were last chosen before the step out
  step();
  EXPECT_EQ(stepper.awake(), 2U);
  while (stepper.awake() == 2U) step();
  // The reach is a circle of 35 m about the joint at (-25, -30), plus the travel of one step.
  EXPECT_NEAR(stepper.body().y, std::sqrt(35.0 * 35.0 - 5.0 * 5.0) - 30.0, 3 * 25 * p.run.step);
  const auto left = stepper.beams(kMiddle, 0);
  const double then = stepper.seconds();
  EXPECT_GT(std::abs(left[kLeft].theta) + std::abs(left[kRight].theta), 0.01);

  const auto expect_swung = [&](double tolerance) {
    const auto now = stepper.beams(kMiddle, 0);
    for (const Side side : {kLeft, kRight}) {
      const double k = p.beams.stiffness(side);
      const BeamState s =
          swung(k, p.beams.damping, p.beams.inertia(), left[side], stepper.seconds() - then);
      EXPECT_NEAR(now[side].theta, s.theta, tolerance);
      EXPECT_NEAR(now[side].omega, s.omega, 50 * tolerance);  // rates are about 40 1/s
    }
  };
  int steps = 0;
  while (stepper.awake() == 1U) {
    ASSERT_LT(++steps, 5000);
    step();
    // A phase of about 100 rad, with a rounding or two each.
    if (stepper.awake() == 1U) expect_swung(1e-12);
  }
  EXPECT_GT(stepper.seconds() - then, 1.0);
  EXPECT_LT(stepper.body().vy, 0.0);
  EXPECT_EQ(stepper.row(), 1);  // below its lower edge a body still counts in its gate
  // Since then, one step of the midpoint rule: h^3 w^3 theta / 12.
  expect_swung(std::pow(p.run.step * 44.0, 3) * 0.4 / 12);
  while (stepper.body().y > 0.0) step();
  EXPECT_EQ(stepper.row(), 1);
}

// The gate just left pushes from behind until it is out of reach.
TEST(FieldStepper, TheGateJustLeftStillPushes) {
  GateParams p = moreau();
  p.beams.stiffness_left = p.beams.stiffness_right = p.beams.damping =
      1.0;  // so that beams keep swinging
  const auto pushed = [&](Fidelity f) {
    FieldStepper stepper(p, field(f), {-20, 59.9, 0, 8});
    stepper.set_beams(kMiddle, 0, {BeamState{0.9, 2.0}, {}});
    Watch before, after;
    while (!outside(p, stepper.body())) (void)stepper.advance(0.0, p.run.step, before);
    EXPECT_EQ(before.impacts, 0);
    stepper.go_on(Outcome::traversed_even);
    for (int i = 0; i < 150; ++i) (void)stepper.advance(0.0, p.run.step, after);
    EXPECT_GT(after.impacts, 0);
    EXPECT_EQ(stepper.row(), 1);
    // The watch records it, although it belongs to another gate.
    EXPECT_LT(after.max_penetration, 0.1);
    EXPECT_GT(after.max_penetration, 0.0);
    return stepper.body();
  };
  const BodyState b = pushed(Fidelity::remember);
  EXPECT_GT(b.vy, 11.4);  // 8 m/s and 0.3 s of 8 N alone: 10.4
  // Nothing else is near: the beams of all gates give the same result as those of the last gate.
  EXPECT_TRUE(same(b, pushed(Fidelity::all)));
}

// A body on its way out through a side still touches the beam that it has been leaning on.
TEST(FieldStepper, ASideLeftBehindStillPushes) {
  GateParams p = moreau();
  p.forces.propulsion = 0.0;
  p.beams.stiffness_left = p.beams.stiffness_right = p.beams.damping =
      1.0;  // so that beams keep swinging
  FieldStepper stepper(p, field(Fidelity::remember), {24.9, 45, 6, 0});
  // The right beam stands beside the disc, to its left, and swings after it.
  stepper.set_beams(kMiddle, 0, {BeamState{}, {0.7, 2.0}});
  Watch watch;
  while (!outside(p, stepper.body())) (void)stepper.advance(0.0, p.run.step, watch);
  stepper.go_on(Outcome::exited_right);
  const double before = stepper.body().vx;
  for (int i = 0; i < 100; ++i) (void)stepper.advance(0.0, p.run.step, watch);
  EXPECT_EQ(stepper.column(), kMiddle + 1);
  EXPECT_GT(stepper.body().vx, before + 1.0);
}

// Only `all` includes the beams of a gate that the body has never been in.
TEST(FieldStepper, NeighboursPushInAllOnly) {
  GateParams p = moreau();
  p.forces.propulsion = 0.0;
  p.beams.stiffness_left = p.beams.stiffness_right = p.beams.damping =
      1.0;  // so that beams keep swinging
  for (const Fidelity f : {Fidelity::remember, Fidelity::all}) {
    FieldStepper stepper(p, field(f), {15, 46, 0, 0});
    stepper.set_beams(kMiddle + 1, 0, {BeamState{1.2, 3.0}, {}});  // swings over from the right
    Watch watch;
    for (int i = 0; i < 200; ++i) (void)stepper.advance(0.0, p.run.step, watch);
    EXPECT_EQ(watch.impacts > 0, f == Fidelity::all);
    EXPECT_EQ(stepper.body().vx < -0.5, f == Fidelity::all);
  }
}

// Gates outside the field do not exist. Gates inside are awake if their joints are within reach: at
// most four in the paper's field.
TEST(FieldStepper, FourGatesAtMostAreWithinReach) {
  const GateParams p = moreau();
  Watch watch;
  FieldStepper alone(p, field(Fidelity::all, 1, 1), {24, 10, 0, 0});
  (void)alone.advance(0.0, 0.02, watch);
  EXPECT_EQ(alone.awake(), 1U);
  // (24, 2): within 35 m of the joint at (25, 30), in row 1 also of that at (25, -30).
  FieldStepper first(p, field(Fidelity::all), {24, 2, 0, 0});
  (void)first.advance(0.0, 0.02, watch);
  EXPECT_EQ(first.awake(), 2U);
  FieldStepper second(p, field(Fidelity::all), {24, 59.9, 0, 20});
  while (!outside(p, second.body())) (void)second.advance(0.0, p.run.step, watch);
  second.go_on(Outcome::traversed_even);
  (void)second.advance(0.0, 0.02, watch);
  EXPECT_EQ(second.awake(), 4U);

  std::size_t most = 0;
  for (std::uint64_t trial = 0; trial < 10; ++trial) {
    FieldStepper stepper(p, field(Fidelity::all), {0, 0, 0, 15});
    RandomForce force(p.forces, Random(Purpose::field, {13, 0, trial}));
    for (int hold = 0; hold < 600 && stepper.row() < 8 && std::abs(stepper.column() - kMiddle) < 4;
         ++hold) {
      const double passed = stepper.advance(force.value(), force.left(), watch);
      force.pass(passed);
      most = std::max(most, stepper.awake());
      const Outcome end = outcome_of(p, {stepper.body(), {}}, {});
      if (end != Outcome::trapped) stepper.go_on(end);
    }
  }
  EXPECT_EQ(most, 4U);
}

// ---- Whole runs

// Mirror images agree to the last bit, with crowded contacts: gates so narrow that beams of four
// gates overlap.
TEST(FieldStepper, MirroredFieldsGiveMirroredTrials) {
  GateParams wide = moreau();
  GateParams narrow = wide;
  narrow.beams.joint_x = 10.0;
  narrow.body.radius = 9.0;
  for (GateParams p : {wide, narrow}) {
    p.beams.stiffness_left = 250.0;
    const GateParams m = test::mirrored(p);
    for (const Fidelity f : {Fidelity::remember, Fidelity::all}) {
      int crowded = 0, moved = 0;
      for (std::uint64_t trial = 0; trial < 12; ++trial) {
        const BodyState start{-3, 0, 4, 15};
        FieldStepper a(p, field(f), start), b(m, field(f), test::mirrored(start));
        RandomForce fa(p.forces, Random(Purpose::field, {14, 0, trial}));
        RandomForce fb(m.forces, Random(Purpose::field, {14, 0, trial}), -1.0);
        for (int step = 0; step < 4000 && a.row() < 8 && std::abs(a.column() - kMiddle) < 4;
             ++step) {
          Watch wa, wb;
          const double force = fa.value();
          ASSERT_TRUE(test::same_bits(force, -fb.value()));
          const double h = std::min(fa.left(), p.run.step);
          const double passed = a.advance(force, h, wa);
          ASSERT_TRUE(test::same_bits(passed, b.advance(-force, h, wb)));
          fa.pass(passed);
          fb.pass(passed);
          ASSERT_TRUE(same(a.body(), test::mirrored(b.body()))) << trial << ", step " << step;
          ASSERT_EQ(wa.impacts, wb.impacts);
          crowded += wa.impacts >= 3;
          const Outcome end = outcome_of(p, {a.body(), {}}, {});
          if (end == Outcome::trapped) continue;
          a.go_on(end);
          b.go_on(end == Outcome::exited_left    ? Outcome::exited_right
                  : end == Outcome::exited_right ? Outcome::exited_left
                                                 : end);
          ASSERT_EQ(a.column() + b.column(), 2 * kMiddle);
          ++moved;
        }
      }
      EXPECT_GT(moved, 12);
      if (f == Fidelity::all && p.beams.joint_x < 20.0) {
        EXPECT_GT(crowded, 10);  // three or more contacts in one step
      }
    }
  }
}

// The limit of 12 s counts from the entry into a gate, not from the start.
TEST(FieldStepper, TheTimeLimitIsThatOfAGate) {
  GateParams p = moreau();
  p.forces.random = 0.0;
  p.beams.stiffness_left = p.beams.stiffness_right = 1e5;  // no body passes
  FieldStepper stepper(p, field(Fidelity::all), {0, 45, 0, 5});
  RandomForce force(p.forces, Random(Purpose::field, {}));
  const GateRun out = stepper.run_gate(force);
  ASSERT_TRUE(is_traversed(out.outcome));
  stepper.go_on(out.outcome);
  const GateRun held = stepper.run_gate(force);
  EXPECT_EQ(held.outcome, Outcome::trapped);
  EXPECT_NEAR(held.seconds, 12.0, 1e-6);
  EXPECT_NEAR(stepper.seconds(), out.seconds + held.seconds, 1e-9);
}

// The energy balance includes all beams: damping and impacts take energy, nothing adds any, and
// Health reports a step that is too long.
TEST(FieldStepper, HealthIsKept) {
  for (const double step : {0.001, 0.02}) {
    const GateParams p = moreau({}, step);
    Health health;
    for (std::uint64_t trial = 0; trial < 25; ++trial) {
      FieldStepper stepper(p, field(Fidelity::all), {0, 0, 0, 15});
      RandomForce force(p.forces, Random(Purpose::field, {15, 0, trial}));
      for (int gate = 0; gate < 3; ++gate) {
        const GateRun run = stepper.run_gate(force);
        add_run(health, p, run);
        if (run.outcome == Outcome::trapped || stepper.row() == 8) break;
        stepper.go_on(run.outcome);
      }
    }
    EXPECT_GT(health.runs, 30);
    EXPECT_GT(health.impacts, 1000);
    EXPECT_EQ(health.creating_energy, 0);
    if (step < 0.01) {
      EXPECT_TRUE(health.clean());
    } else {
      EXPECT_GT(health.penetrating, 0);
    }
  }
}

// Non-finite numbers end a run, which is reported as broken.
TEST(FieldStepper, BrokenRunsAreCalledBroken) {
  const GateParams p = moreau();
  FieldStepper stepper(p, field(Fidelity::all), {0, 0, 0, 15});
  stepper.set_beams(kMiddle, 0, {BeamState{std::numeric_limits<double>::quiet_NaN(), 0.0}, {}});
  RandomForce force(p.forces, Random(Purpose::field, {}));
  EXPECT_EQ(stepper.run_gate(force).outcome, Outcome::broken);
}

}  // namespace
}  // namespace gatewalk::lattice
