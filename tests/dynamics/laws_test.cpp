// SPDX-License-Identifier: MIT
// The laws of motion, of hits and of symmetry for each method, within the tolerances of the
// method's row in tests/support/any_method.h.

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "dynamics/disc/ensemble.h"
#include "dynamics/disc/gate.h"
#include "tests/support/any_method.h"
#include "tests/support/long.h"
#include "tests/support/measured.h"
#include "tests/support/mirror.h"
#include "tests/support/ride.h"
#include "tests/support/scenes.h"
#include "tests/support/threads.h"

namespace gatewalk::dynamics {
namespace {

using test::alike;
using test::AnyMethod;
using test::at_rest;
using test::Draw;
using test::exact;
using test::go_in_holds;
using test::kEps;
using test::kHold;
using test::measured;
using test::method_name;
using test::MethodLaws;
using test::methods_that;
using test::Ride;
using test::same_bits;
using test::stepping;
using test::usual_or_full;

class ExactHits : public AnyMethod {};
class BothAlike : public AnyMethod {};
class EnergyInSteps : public AnyMethod {};

INSTANTIATE_TEST_SUITE_P(Methods, AnyMethod, testing::ValuesIn(test::all_methods()), method_name);
INSTANTIATE_TEST_SUITE_P(Methods, ExactHits, methods_that(exact), method_name);
INSTANTIATE_TEST_SUITE_P(Methods, BothAlike, methods_that(alike), method_name);
INSTANTIATE_TEST_SUITE_P(Methods, EnergyInSteps, methods_that(stepping), method_name);

// ---- Free motion ----

// Two released beams, compared with the closed form of a damped oscillator.
TEST_P(AnyMethod, FreeBeamFollowsItsClosedForm) {
  const MethodLaws& m = GetParam();
  GateParams p = by({});
  p.forces.propulsion = 0.0;
  const double w0 = std::sqrt(400.0 / p.beams.inertia()), wd = std::sqrt(w0 * w0 - 1.44);
  const double decay = std::exp(-2.4), c = std::cos(2 * wd), s = std::sin(2 * wd);
  GateState start;
  start.beams[kLeft] = {0.5, 0.0, false};
  start.beams[kRight] = {-0.4, 0.3, false};
  const auto errors = [&](bool one_spell) {
    Ride ride(p, start);
    one_spell ? (void)ride.go(2.0) : go_in_holds(ride, 2.0);
    EXPECT_EQ(ride.watch.impacts, 0);
    std::array<double, 2> error{};
    for (const Side side : {kLeft, kRight}) {
      const auto& [theta0, omega0, held] = start.beams[side];
      const double theta = decay * (theta0 * c + (omega0 + 1.2 * theta0) / wd * s);
      const double omega = decay * (omega0 * c - (w0 * w0 * theta0 + 1.2 * omega0) / wd * s);
      const BeamState& beam = ride.s.beams[side];
      error[side] = std::hypot(beam.theta - theta, (beam.omega - omega) / w0);
    }
    return error;
  };
  double last = 0.0, off = 0.0;
  for (const bool one_spell : {false, true}) {
    const auto [left, right] = errors(one_spell);
    EXPECT_NEAR(left, m.beam_error, m.beam_digits);
    EXPECT_LE(right, m.beam_error + m.beam_digits);  // it never swings wider
    last = std::max(left, last);
  }
  measured({.requirement = 1,
            .method = m.name,
            .what = "free beam after 2 s, error",
            .figure = last,
            .unit = "rad",
            .limit = 1e-8});
  if (m.beam_order == 0) return;
  for (int halvings = 1; halvings <= 5; ++halvings) {
    p.run.step = m.step / (1 << halvings);
    const double now = errors(true)[kLeft];
    off = std::max(off, std::abs(std::log2(last / now) - m.beam_order));
    last = now;
  }
  EXPECT_LE(off, 0.1);
  measured({.requirement = 1,
            .method = m.name,
            .what = "order over 5 halvings, off the nominal",
            .figure = off,
            .limit = 0.1});
}

// An undamped beam keeps its energy. Each step rounds angle and speed by an eps or so.
TEST_P(ExactHits, FreeBeamKeepsItsEnergyWithoutDamping) {
  for (const double step : {0.02, 0.004}) {
    GateParams p = by({}, step);
    p.forces.propulsion = 0.0;
    p.beams.damping = 0.0;
    GateState s;
    s.beams[kLeft] = {0.5, 0.0, false};
    s.beams[kRight] = {-0.2, 1.0, false};
    Ride ride(p, s);
    const double before = energy(p, ride.s);
    go_in_holds(ride, 12.0);
    EXPECT_EQ(ride.watch.impacts, 0);
    const double error = std::abs(energy(p, ride.s) / before - 1.0);
    EXPECT_LE(error, step == 0.02 ? 600 * 4 * kEps : 1e-12);
    if (step == GetParam().step)
      measured({.requirement = 2,
                .method = GetParam().name,
                .what = "energy of an undamped beam after 12 s",
                .figure = error,
                .limit = 1e-6});
  }
}

// A body under drag, propulsion and a lateral force: v_x approaches -12 m/s; along y, 4 m/s is the
// final speed.
TEST_P(AnyMethod, FreeBodyFollowsItsClosedForm) {
  const MethodLaws& m = GetParam();
  GateParams p = by(test::free_rods());
  p.forces.propulsion = 2.0;
  p.forces.drag = 0.5;
  p.body.mass = 2.0;
  p.beams.joint_x = p.beams.joint_y = 1e4;
  p.run.traverse_y = 2e4;
  Ride ride(p, at_rest(1.0, -2.0, 3.0, 4.0));
  go_in_holds(ride, 2.0, -6.0);
  const double g = 0.25 * m.step, q = std::pow(m.kept(g), std::round(2.0 / m.step));
  EXPECT_NEAR(ride.s.body.vx, -12.0 + 15.0 * q, m.flight);
  EXPECT_NEAR(ride.s.body.vy, 4.0, m.flight);
  EXPECT_NEAR(ride.s.body.x, 1.0 - 24.0 + 15.0 * m.way(g) * (1 - q) / 0.25, m.flight);
  EXPECT_NEAR(ride.s.body.y, 6.0, m.flight);
}

// 5.01 m at 10 m/s: straight motion is interpolated without error.
TEST_P(AnyMethod, StopsAtTheMomentOfLeaving) {
  Ride ride(by(test::free_rods(), 0.004), at_rest(19.99, 0.0, 10.0, 0.0));
  EXPECT_NEAR(ride.go(1.0), 0.501, GetParam().exit_time);
  EXPECT_TRUE(outside(ride.p, ride.s.body));
  EXPECT_NEAR(ride.s.body.x, 25.0, GetParam().exit_place);
  if (GetParam().name != "event") {
    EXPECT_EQ(ride.watch.steps, 126);
  }
}

TEST_P(AnyMethod, NothingMovesWithoutForces) {
  GateParams p = by({});
  p.forces.propulsion = p.forces.random = 0.0;
  const auto method = make_method(p);
  // Apart, touching a beam, touching both tips, touching a joint.
  for (const BodyState& start :
       {BodyState{3, 5}, BodyState{-10, 20}, BodyState{0, 20}, BodyState{-25, 20}}) {
    RandomForce force = force_of(p, 0);
    const GateRun run = run_gate(p, *method, start, force);
    EXPECT_EQ(run.outcome, Outcome::trapped);
    EXPECT_EQ(run.exit.x, start.x);
    EXPECT_EQ(run.exit.y, start.y);
    EXPECT_EQ(run.exit.vx, 0.0);
    EXPECT_EQ(run.exit.vy, 0.0);
    EXPECT_EQ(run.watch.max_theta[kLeft], 0.0);
    EXPECT_EQ(run.watch.max_theta[kRight], 0.0);
    EXPECT_EQ(run.watch.impacts, 0);
  }
}

// The speed of a free body after 2 s is the sum of its 100 held draws times 0.02 s, for any step.
// Over 4000 trials sd = 4 m/s, determined to 1 / sqrt(2 * 4000) = 1.1 %; the tolerance is four
// times that.
TEST_P(AnyMethod, RandomForceSpreadsAFreeBodyAlikeAtAnyStep) {
  for (const double step : {0.02, 0.004}) {
    constexpr int kTrials = 4000;
    GateParams p = by(test::free_rods(), step);
    p.forces.random = 20.0;
    p.beams.joint_x = 1e4;
    p.run.time_limit = 2.0;
    const auto method = make_method(p);
    std::vector<double> vx(kTrials), drawn(kTrials);
    tbb::parallel_for(0, kTrials, [&](int trial) {
      RandomForce force = force_of(p, trial), again = force_of(p, trial);
      vx[trial] = run_gate(p, *method, {}, force).exit.vx;
      for (int i = 0; i < 100; ++i) {
        drawn[trial] += 0.02 * again.value();
        again.pass(again.left());
      }
    });
    double squares = 0.0;
    for (int trial = 0; trial < kTrials; ++trial) {
      // 500 additions to numbers up to 16.
      ASSERT_NEAR(vx[trial], drawn[trial], 500 * 8 * kEps) << trial;
      squares += vx[trial] * vx[trial];
    }
    EXPECT_NEAR(std::sqrt(squares / kTrials), 4.0, 4.0 * 4 * 0.011) << step;
  }
}

// ---- Single hits ----

// A tangential hit at 15 m/s, 15 m from the joint: J = 135/59, then 750/59 and 97.2/59, after 2 ms
// of 4. In mid-step the overlap is 5 mm, for methods that detect contact by overlap.
TEST_P(ExactHits, TangentialHitOfTheKnownAnswers) {
  const double y = GetParam().at_mid_step ? 19.975 : 19.97, place = GetParam().place;
  Ride ride(by(test::free_rods(), 0.004), at_rest(-10.0, y, 0.0, 15.0));
  ride.step();
  EXPECT_EQ(ride.watch.impacts, 1);
  EXPECT_NEAR(ride.s.body.vy, 750.0 / 59, 32 * kEps);
  EXPECT_EQ(ride.s.body.vx, 0.0);
  EXPECT_NEAR(ride.s.beams[kLeft].omega, 97.2 / 59, 16 * kEps);
  EXPECT_EQ(ride.s.beams[kRight].omega, 0.0);
  EXPECT_NEAR(ride.s.body.y, y + 0.002 * (15.0 + 750.0 / 59), place);
  EXPECT_NEAR(ride.s.beams[kLeft].theta, 0.002 * 97.2 / 59, place / 15);
}

// A symmetric double hit: beams that overlap so that the disc meets both 15 m from their joints.
TEST_P(ExactHits, SymmetricDoubleHitOfTheKnownAnswers) {
  GateParams p = by(test::free_rods(), 0.004);
  p.beams.joint_x = 15.0;
  Ride ride(p, at_rest(0.0, GetParam().at_mid_step ? 19.975 : 19.97, 0.0, 15.0));
  const double before = energy(p, ride.s);
  ride.step();
  EXPECT_EQ(ride.watch.impacts, 2);
  EXPECT_NEAR(ride.s.body.vy, 10.78125, 64 * kEps);
  EXPECT_NEAR(ride.s.beams[kLeft].omega, 1.51875, 16 * kEps);
  test::measured_double_hit(GetParam().name, ride.s.body.vy, ride.s.beams[kLeft].omega,
                            ride.s.beams[kRight].omega);
  EXPECT_NEAR(energy(p, ride.s) - before, -6.328125, 16 * kEps * before);
  EXPECT_TRUE(same_bits(ride.s.beams[kLeft].omega, ride.s.beams[kRight].omega));
  EXPECT_TRUE(same_bits(ride.s.beams[kLeft].theta, ride.s.beams[kRight].theta));
  EXPECT_EQ(ride.s.body.vx, 0.0);
}

// The first hits of rides without forces, 500 and more each of side, tip and pin, with any
// restitution. All motion is straight, so the hit can be reconstructed from outside: where the two
// lines of the body cross, or in the middle of the step. There the impulse is along the normal and
// restitution holds; the angular momentum about the joint and the energy, except for the law's
// loss, are conserved.
TEST_P(ExactHits, FirstHitsObeyTheLaw) {
  GateParams p = by(test::free_rods());
  p.contact.impulse_threshold = 0.0;  // nor does `event` stop low rebounds
  p.run.event_tolerance = 1e-10;
  const MethodLaws& m = GetParam();
  const double inertia = p.beams.inertia();
  Draw draw(1);
  std::array<int, 3> hits{};  // by ContactKind
  while (std::min({hits[0], hits[1], hits[2]}) < 500) {
    p.contact.restitution = draw.uniform(0.1, 1);
    p.contact.tip_restitution = draw.coin() ? 1.0 : draw.uniform(0.1, 1);
    GateState start = at_rest(draw.uniform(-24, 24), draw.uniform(5, 55), draw.uniform(-15, 15),
                              draw.uniform(-15, 15));
    for (BeamState& b : start.beams) b = {draw.uniform(-1.5, 1.5), draw.uniform(-1, 1), false};
    Ride ride(p, start);
    if (ride.touch(kLeft).gap < 0.0 || ride.touch(kRight).gap < 0.0) continue;
    double t = 0.0;
    while (t < 1.0 && ride.watch.impacts == 0 && !outside(p, ride.s.body)) t += ride.step();
    // When the body leaves, its state is interpolated, which is not exact enough.
    if (ride.watch.impacts != 1 || outside(p, ride.s.body)) continue;
    const GateState& end = ride.s;
    const bool left = end.beams[kLeft].omega != start.beams[kLeft].omega;
    const bool right = end.beams[kRight].omega != start.beams[kRight].omega;
    const double kick_x = end.body.vx - start.body.vx, kick_y = end.body.vy - start.body.vy;
    const double kick = std::hypot(kick_x, kick_y);
    if (kick < 0.1) continue;  // too weak to be seen from outside
    // start + v t + kick (t - hit) = end, along the kick.
    const double after = ((end.body.x - start.body.x - start.body.vx * t) * kick_x +
                          (end.body.y - start.body.y - start.body.vy * t) * kick_y) /
                         (kick * kick);
    // In the middle of the step: errors of rates up to 50 m/s, of 500 J and of 1000 kg m^2/s, from
    // positions with the rounding of up to 250 steps.
    const double digits = 1280 * kEps;
    // Up to 250 steps round the positions; the kick converts this error into time.
    const double late = m.at_mid_step ? 1e-13 : m.place + 50 * 7e-15 / kick;  // m; s
    const double hit = m.at_mid_step ? t - 0.5 * p.run.step : t - after;
    ASSERT_NEAR(hit, t - after, 1e-11 / kick + m.place);
    const auto touch_at = [&](Side side, double time) {
      BodyState body = start.body;
      body.x += body.vx * time;
      body.y += body.vy * time;
      return nearest(p, side, body, start.beams[side].theta + start.beams[side].omega * time);
    };
    ASSERT_FALSE(left && right);  // the other beam is not touched
    const bool nearer = std::abs(touch_at(kLeft, hit).gap) < std::abs(touch_at(kRight, hit).gap);
    const bool pin = !left && !right;  // neither beam feels it
    const Side side = left || (pin && nearer) ? kLeft : kRight;
    const Touch touch = touch_at(side, hit);
    ++hits[static_cast<int>(touch.kind)];
    const double e = touch.kind == ContactKind::tip ? p.contact.tip_restitution  //
                                                    : p.contact.restitution;
    const double u = gap_rate(touch, start.body, start.beams[side]);
    ASSERT_LE(touch.gap, 40.0 * late) << start.body.x << ' ' << start.body.y;
    if (m.at_mid_step) {  // no contact in the middle of the step before
      ASSERT_GT(touch_at(side, hit - p.run.step).gap, 0.0);
    } else {
      ASSERT_GE(touch.gap, -40.0 * late);
    }
    ASSERT_NEAR(gap_rate(touch, end.body, end.beams[side]), -e * u,
                m.at_mid_step ? 50 * digits : 1e3 * late);
    ASSERT_NEAR(kick_x * touch.ny - kick_y * touch.nx, 0.0,
                m.at_mid_step ? 50 * digits : 1e2 * late);
    const double lost = 0.5 * (1 - e * e) * u * u / compliance(p.body.mass, inertia, touch.lever);
    ASSERT_NEAR(energy(p, start) - energy(p, end), lost,
                m.at_mid_step ? 500 * digits : 1e-10 + 1e3 * late);
    // In the gate's frame theta of the right beam turns the other way.
    const double sign = side == kLeft ? 1.0 : -1.0;
    const auto spin = [&](const GateState& s) {
      const double rx = s.body.x + sign * p.beams.joint_x, ry = s.body.y - p.beams.joint_y;
      return rx * s.body.vy - ry * s.body.vx + sign * inertia * s.beams[side].omega;
    };
    if (touch.kind != ContactKind::pin) {
      ASSERT_NEAR(spin(end), spin(start), m.at_mid_step ? 1000 * digits : 1e-10);
    }
  }
}

// ---- Energy ----

// Elastic hits between two rods, without springs, or with springs and propulsion: energy neither
// appears nor is lost, up to rounding. The exit may cut the last step short. A hold that is forced
// on a method is inelastic.
TEST_P(ExactHits, ElasticHitsKeepTheEnergy) {
  for (const bool springs : {false, true}) {
    GateParams p = by(springs ? test::study(0.0) : test::free_rods());
    p.forces.random = 0.0;
    p.contact.restitution = 1.0;
    p.contact.impulse_threshold = 0.0;
    Draw draw(1);
    std::int64_t impacts = 0;
    for (int i = 0; i < (springs ? 100 : 500); ++i) {
      GateState s = at_rest(draw.uniform(-20, 20), 0.0, draw.uniform(-5, 5), draw.uniform(5, 20));
      s.beams[kLeft].omega = draw.uniform(-0.5, 0.1);
      s.beams[kRight].omega = draw.uniform(-0.5, 0.1);
      Ride ride(p, s);
      const auto balance = [&] { return energy(p, ride.s) - p.forces.propulsion * ride.s.body.y; };
      const double before = balance();
      double passed = 0.0, inside = before;
      while (passed < (springs ? 12.0 : 4.0) && !outside(p, ride.s.body)) {
        inside = balance();
        passed += ride.step();
      }
      if (ride.watch.forced_holds > 0) continue;
      impacts += ride.watch.impacts;
      // 3000 steps that round up to 700 J.
      ASSERT_NEAR(inside, before, springs ? 3000 * kEps * 700 : 1e-12 * before) << i;
    }
    EXPECT_GT(impacts, 500);
  }
}

TEST_P(BothAlike, CreatesLittleEnergyInTrials) {
  for (const test::CreatedEnergy& c : GetParam().created) {
    SCOPED_TRACE(testing::Message() << "Rm = " << c.random << ", step " << c.step);
    GateParams p = by(test::study(10.0), c.step);
    p.forces.random = c.random;
    p.run.event_tolerance = c.event_tolerance;
    const bool by_default = c.event_tolerance == GateParams{}.run.event_tolerance;
    const int trials = GetParam().name == "event" ? usual_or_full(c.trials, 10'000) : c.trials;
    const Health health = run_gate_trials(p, {}, 1, {0, trials}).health;
    EXPECT_LE(health.worst_energy_created, c.most);
    EXPECT_LE(health.worst_penetration, GetParam().overlap_m);
    EXPECT_EQ(health.clean(), GetParam().clean);
    EXPECT_EQ(health.creating_energy > 0, GetParam().reported);
    if (GetParam().holds && by_default && c.step == GateParams{}.run.step)
      measured({.requirement = 5,
                .method = GetParam().name,
                .what = "energy created in a trial, default",
                .figure = health.worst_energy_created,
                .unit = "J",
                .cases = trials});
  }
}

TEST_P(EnergyInSteps, EnergyCreatedFallsWithTheStep) {
  const auto& [least, most, random, trials, one_restitution, limits] = GetParam().order;
  double last = 0.0, order = 10.0;
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const double step = 0.004 / (1 << i);
    GateParams p = by(test::study(10.0), step);
    p.forces.random = random;
    if (one_restitution) p.contact.tip_restitution = p.contact.restitution;
    const auto [mean, worst] = test::energy_created(p, trials);
    EXPECT_LE(worst, limits[i]) << step;
    if (last > 0.0) {
      EXPECT_LE(std::log2(last / mean), most) << step;
      order = std::min(order, std::log2(last / mean));
    }
    last = mean;
  }
  EXPECT_GE(order, least);
  measured({.requirement = 5,
            .method = GetParam().name,
            .what = "order of the energy's error in the step",
            .figure = order,
            .limit = 0.9,
            .at_least = true,
            .cases = trials});
}

// ---- Symmetry ----

// Mirror images of trials: equal and unequal beams, weak and strong noise, from the middle and from
// anywhere.
TEST_P(BothAlike, MirrorImagesHaveTheSameBits) {
  const std::vector<double> tolerances =
      GetParam().name == "event" ? std::vector{1e-2, 1e-7} : std::vector{1e-2};
  for (const double tolerance : tolerances) {
    const auto& [usual, full] = GetParam().mirrored;
    const int trials = usual_or_full(tolerance == 1e-2 ? usual : usual / 10, full);
    std::vector<GateRun> seen(trials), mirror(trials);
    tbb::parallel_for(0, trials, [&](int trial) {
      GateParams p = by(test::study(trial % 4 < 2 ? 10.0 : 50.0));
      p.run.event_tolerance = tolerance;
      p.forces.random = trial % 4 < 2 ? 10.0 : 40.0;
      if (trial % 8 < 4) p.beams.stiffness_right = 300.0;
      const GateParams m = test::mirrored(p);
      Draw draw(static_cast<std::uint64_t>(trial));
      BodyState start;
      if (trial % 2)
        start = {draw.uniform(-15, 15), 0.0, draw.uniform(-10, 10), draw.uniform(0, 20)};
      RandomForce force = force_of(p, trial), flipped = force_of(m, trial, -1.0);
      seen[trial] = run_gate(p, *make_method(p), start, force);
      mirror[trial] = run_gate(m, *make_method(m), test::mirrored(start), flipped);
    });
    for (int trial = 0; trial < trials && !HasFatalFailure(); ++trial) {
      SCOPED_TRACE(trial);
      test::expect_mirror_images(mirror[trial], seen[trial], GetParam().same_work);
    }
    test::measured_mirror(GetParam().name, trials, full);
  }
}

// Both beams are hit at once, repeatedly, until they are held; also with beams that hardly move.
TEST_P(BothAlike, ASymmetricSceneStaysSymmetric) {
  for (const double mass : {0.1, 1.0, 10.0, 100.0, 1e6})
    for (const double e : {0.0, 0.1, 0.5, 0.9, 1.0}) {
      SCOPED_TRACE(testing::Message() << "mass = " << mass << ", e = " << e);
      GateParams p = by(test::free_rods());
      p.forces.propulsion = 6.0;
      p.contact.restitution = p.contact.tip_restitution = e;
      p.beams.mass = mass;
      p.beams.stiffness_left = p.beams.stiffness_right = 1e6 * mass;
      Ride ride(p, at_rest(0.0, 19.9));
      bool was_held = false;
      for (int hold = 0; hold < 600; ++hold) {
        ride.go(kHold);
        was_held |= ride.s.beams[kLeft].held;
        ASSERT_EQ(ride.s.body.x, 0.0);
        ASSERT_EQ(ride.s.beams[kLeft].held, ride.s.beams[kRight].held);
        ASSERT_TRUE(same_bits(ride.s.beams[kLeft].theta, ride.s.beams[kRight].theta));
        ASSERT_TRUE(same_bits(ride.s.beams[kLeft].omega, ride.s.beams[kRight].omega));
      }
      EXPECT_GT(ride.watch.impacts, 0);
      if (e < 1.0) {
        EXPECT_EQ(was_held, GetParam().holds);
      }
    }
}

// If lengths, masses and times are multiplied by powers of 4, results are the same bits times these
// powers. Therefore no limit in the code has a unit.
TEST_P(AnyMethod, OtherUnitsGiveTheSameBits) {
  const double l = 0x1p-6, mass = 0x1p4, t = 0x1p2, force = mass * l / (t * t), torque = force * l;
  constexpr int kTrials = 100;
  tbb::parallel_for(0, kTrials, [&](int trial) {
    GateParams p = by(test::study(trial % 2 ? 10.0 : 50.0));
    p.forces.random = trial % 4 < 2 ? 10.0 : 40.0;
    p.forces.drag = 0.06;
    GateParams q = p;
    q.body = {p.body.mass * mass, p.body.radius * l};
    q.beams = {p.beams.length * l,
               p.beams.mass * mass,
               p.beams.stiffness_left * torque,
               p.beams.stiffness_right * torque,
               p.beams.damping * torque * t,
               p.beams.joint_x * l,
               p.beams.joint_y * l};
    q.forces = {p.forces.propulsion * force, p.forces.random * force, p.forces.random_rate / t,
                p.forces.drag * mass / t};
    q.contact.impulse_threshold *= mass * l / t;
    q.run.step *= t;
    q.run.time_limit *= t;
    q.run.traverse_y *= l;
    q.run.event_tolerance *= l;
    const double v = l / t;
    RandomForce force_p = force_of(p, trial), force_q = force_of(q, trial);
    const BodyState start{1.0, 0.0, 0.5 * (trial % 5), 3.0};
    const GateRun a = run_gate(p, *make_method(p), start, force_p);
    const GateRun b = run_gate(q, *make_method(q),
                               {start.x * l, start.y * l, start.vx * v, start.vy * v}, force_q);
    EXPECT_EQ(a.outcome, b.outcome) << trial;
    EXPECT_TRUE(same_bits(a.exit.x * l, b.exit.x)) << trial;
    EXPECT_TRUE(same_bits(a.exit.y * l, b.exit.y)) << trial;
    EXPECT_TRUE(same_bits(a.exit.vx * v, b.exit.vx)) << trial;
    EXPECT_TRUE(same_bits(a.exit.vy * v, b.exit.vy)) << trial;
    EXPECT_TRUE(same_bits(a.seconds * t, b.seconds)) << trial;
    EXPECT_EQ(a.watch.impacts, b.watch.impacts) << trial;
    EXPECT_EQ(a.watch.evaluations, b.watch.evaluations) << trial;
  });
}

TEST_P(AnyMethod, AnyNumberOfThreadsGivesTheSameBits) {
  const GateParams p = by(test::study(10.0));
  const auto tally = [&](int threads) {
    return test::on_threads(threads, [&] { return run_gate_trials(p, {}, 7, {0, 400}); });
  };
  const GateTally one = tally(1);
  EXPECT_GT(one.traversed(), 0);
  for (const int threads : {2, 8}) {
    const GateTally t = tally(threads);
    EXPECT_EQ(t.counts, one.counts);
    EXPECT_EQ(t.health.steps, one.health.steps);
    EXPECT_EQ(t.health.impacts, one.health.impacts);
    EXPECT_EQ(t.health.evaluations, one.health.evaluations);
    EXPECT_TRUE(same_bits(t.health.worst_penetration, one.health.worst_penetration));
    EXPECT_TRUE(same_bits(t.health.worst_energy_created, one.health.worst_energy_created));
    EXPECT_TRUE(same_bits(t.health.worst_speed, one.health.worst_speed));
  }
}

// Time reversal: elastic, without damping and drag. With its velocities reversed the disc returns
// through four to ten hits, from any start.
TEST_P(ExactHits, ReturnsToTheStart) {
  GateParams p = by(test::study(0.0), 0.004);
  p.forces.random = 0.0;
  p.contact.restitution = 1.0;
  p.contact.impulse_threshold = 0.0;
  const auto turn_round = [](GateState& s) {
    s.body.vx = -s.body.vx;
    s.body.vy = -s.body.vy;
    for (BeamState& b : s.beams) b.omega = -b.omega;
  };
  double worst = 0.0;
  for (int x = -18; x < 18; ++x) {
    SCOPED_TRACE(x);
    const GateState start = at_rest(x, 5.0, 0.3, 12.0);
    Ride ride(p, start);
    int steps = 0;
    for (; ride.watch.impacts < 10 && steps < 1000 && !outside(p, ride.s.body); ++steps)
      ride.step();
    EXPECT_FALSE(outside(p, ride.s.body));
    EXPECT_EQ(ride.watch.forced_holds, 0);  // a hold cannot be reversed
    const auto there = ride.watch.impacts;
    EXPECT_GE(there, 4);
    turn_round(ride.s);
    ride.watch.counted = {};  // the last hit, reversed, counts again
    for (int i = 0; i < steps; ++i) ride.step();
    turn_round(ride.s);
    EXPECT_EQ(ride.watch.impacts, 2 * there);
    worst = std::max(worst, test::largest_difference(ride.s, start));
  }
  EXPECT_LE(worst, GetParam().reversed);
  measured({.requirement = 10,
            .method = GetParam().name,
            .what = "distance from the start on return",
            .figure = worst,
            .unit = "m, m/s, rad",
            .limit = 1e-6,
            .cases = 36});
}

}  // namespace
}  // namespace gatewalk::dynamics
