// SPDX-License-Identifier: MIT
// Hits that take no energy, or nearly none, in scenes without forces: the loss follows from the
// restitution at any speed, because weak hits must not end the bouncing there.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "dynamics/disc/methods/hybrid.h"
#include "tests/support/numbers.h"
#include "tests/support/ride.h"
#include "tests/support/scenes.h"

namespace gatewalk::dynamics {
namespace {

using test::Draw;
using test::kEps;
using test::Ride;

/// A gate without forces, damping and drag, with random numbers and the method's own settings.
GateParams free_gate(const std::string& method, Draw& draw, double restitution) {
  GateParams p = test::free_rods();
  p.run.method = method;
  p.body.mass = draw.log_uniform(0.3, 3.0);
  p.beams.mass = draw.log_uniform(0.03, 10.0);
  if (draw.coin()) {
    p.beams.stiffness_left = draw.log_uniform(1.0, 1000.0);
    p.beams.stiffness_right = draw.log_uniform(1.0, 1000.0);
  }
  p.contact.restitution = p.contact.tip_restitution = restitution;
  p.run.step = default_step(p);
  p.contact.impulse_threshold = default_impulse_threshold(p);
  p.run.event_tolerance = default_event_tolerance(p);
  return p;
}

struct Trip {
  double before, after;  // J
  Watch watch;
};

/// A body with this initial speed (m/s), simulated for the time in which it crosses the gate a few
/// times.
Trip trip(const GateParams& p, Draw& draw, double speed) {
  Ride ride(p, test::at_rest(draw.uniform(-20, 20), 15.0, speed * draw.uniform(-0.5, 0.5), speed));
  Trip t{energy(p, ride.s), 0.0, {}};
  for (double time = 0.0; time * speed < 100.0 && !outside(p, ride.s.body); time += 2.0)
    for (int hold = 0; hold < 100 && !outside(p, ride.s.body); ++hold) ride.go(0.02);
  t.after = energy(p, ride.s);
  t.watch = ride.watch;
  return t;
}

constexpr double kSpeeds[] = {15.0, 1.0, 0.1, 0.02};

class Elastic : public testing::TestWithParam<const char*> {};

// Law: e = 1 keeps the energy. Each step and each hit rounds it by a few eps.
TEST_P(Elastic, HitsKeepTheEnergyAtAnySpeed) {
  for (const double speed : kSpeeds) {
    Draw draw(11);
    std::int64_t impacts = 0;
    for (int i = 0; i < 20; ++i) {
      SCOPED_TRACE(testing::Message() << speed << " m/s, gate " << i);
      const GateParams p = free_gate(GetParam(), draw, 1.0);
      const Trip t = trip(p, draw, speed);
      impacts += t.watch.impacts;
      const double events = static_cast<double>(t.watch.steps + t.watch.impacts);
      EXPECT_NEAR(t.after / t.before, 1.0, 20 * kEps * events);
      EXPECT_EQ(t.watch.forced_holds, 0);
    }
    EXPECT_GT(impacts, 20);
  }
}

// Law: a hit takes at most the share 1 - e^2 of the energy, and every hit is counted.
TEST_P(Elastic, NearlyElasticHitsTakeNoMoreThanTheirRestitution) {
  for (const double e : {0.96, 0.99, 0.999})
    for (const double speed : kSpeeds) {
      Draw draw(12);
      double lost = 0.0;
      for (int i = 0; i < 20; ++i) {
        SCOPED_TRACE(testing::Message() << "e = " << e << ", " << speed << " m/s, gate " << i);
        const GateParams p = free_gate(GetParam(), draw, e);
        const Trip t = trip(p, draw, speed);
        const double rounding = 20 * kEps * static_cast<double>(t.watch.steps + t.watch.impacts);
        EXPECT_LE(t.after / t.before, 1.0 + rounding);
        EXPECT_GE(t.after / t.before,
                  std::pow(e * e, static_cast<double>(t.watch.impacts)) - rounding);
        lost += 1.0 - t.after / t.before;
      }
      EXPECT_GT(lost, 0.0);
    }
}

// Law: the loss of a hit follows from the surface that is hit, independent of the other surface's
// restitution.
TEST_P(Elastic, AHitOfTheElasticSurfaceKeepsTheEnergy) {
  for (const bool tip : {false, true})
    for (const double other : {0.0, 0.5, 0.94})
      for (const double speed : kSpeeds) {
        SCOPED_TRACE(testing::Message()
                     << (tip ? "tip" : "side") << ", the other " << other << ", " << speed);
        Draw draw(13);
        GateParams p = free_gate(GetParam(), draw, 1.0);
        (tip ? p.contact.restitution : p.contact.tip_restitution) = other;
        p.beams.length = 0.6 * p.beams.joint_x;
        // Straight up: at the middle of the right beam, or past its tip by half a radius.
        const double tip_x = p.beams.joint_x - p.beams.length;
        const double x = tip ? tip_x - 0.5 * p.body.radius : tip_x + 0.5 * p.beams.length;
        Ride ride(p, test::at_rest(x, p.beams.joint_y - 2.0 * p.body.radius, 0.0, speed));
        const double before = energy(p, ride.s);
        for (int i = 0; i < 100'000 && ride.watch.impacts == 0; ++i) ride.go(0.02);
        ASSERT_EQ(ride.watch.impacts, 1);
        EXPECT_EQ(ride.touch(kRight).kind == ContactKind::tip, tip);
        EXPECT_NEAR(energy(p, ride.s) / before, 1.0,
                    20 * kEps * static_cast<double>(ride.watch.steps + 1));
      }
}

INSTANTIATE_TEST_SUITE_P(Methods, Elastic, testing::Values("stable", "event"),
                         [](const auto& method) { return std::string(method.param); });

// In scenes with forces, bouncing ends as before.
TEST(WeakHits, EndTheBouncingUpToARestitutionOfNineteenTwentieths) {
  const auto factor = [](double side, double tip, double propulsion, double random,
                         ContactKind kind = ContactKind::interior) {
    GateParams p;
    p.contact.restitution = side;
    p.contact.tip_restitution = tip;
    p.forces.propulsion = propulsion;
    p.forces.random = random;
    return weak_hits(p, kind);
  };
  for (const double e : {0.0, 0.8, 0.95}) {
    EXPECT_EQ(factor(e, 1.0, 7.0, 50.0), 1.0);
    EXPECT_EQ(factor(1.0, e, 7.0, 50.0), 1.0);
    EXPECT_EQ(factor(e, 1.0, 0.0, 0.0), 1.0);
    EXPECT_EQ(factor(e, 1.0, 0.0, 0.0, ContactKind::pin), 1.0);
    EXPECT_EQ(factor(1.0, e, 0.0, 0.0, ContactKind::tip), 1.0);
    // The restitution is that of the surface hit if nothing presses bodies onto the other one.
    EXPECT_EQ(factor(1.0, e, 0.0, 0.0), 0.0);
    EXPECT_EQ(factor(1.0, e, 0.0, 0.0, ContactKind::pin), 0.0);
    EXPECT_EQ(factor(e, 1.0, 0.0, 0.0, ContactKind::tip), 0.0);
    EXPECT_EQ(factor(e, 1.0, 7.0, 50.0, ContactKind::tip), 1.0);
  }
  EXPECT_NEAR(factor(0.975, 1.0, 7.0, 0.0), 0.5, 1e-12);
  EXPECT_NEAR(factor(0.99, 1.0, 0.0, 50.0), 0.2, 1e-12);
  EXPECT_EQ(factor(1.0, 1.0, 7.0, 50.0), 0.0);
  EXPECT_EQ(factor(0.96, 0.96, 0.0, 0.0), 0.0);
}

}  // namespace
}  // namespace gatewalk::dynamics
