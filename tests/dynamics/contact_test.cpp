// SPDX-License-Identifier: MIT
#include "dynamics/disc/contact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/support/long.h"
#include "tests/support/measured.h"
#include "tests/support/numbers.h"
#include "tests/support/scenes.h"

namespace gatewalk::dynamics {
namespace {

using test::Draw;
using test::kEps;
using test::kPi;
using test::measured;
using test::same_bits;
using test::usual_or_full;

struct Point {
  double x = 0.0, y = 0.0;
};

/// Point of the beam `r` from its joint, in the gate's frame.
Point beam_point(const GateParams& p, Side side, double theta, double r) {
  const double inwards = side == kLeft ? 1.0 : -1.0;
  return {inwards * (r * std::cos(theta) - p.beams.joint_x), p.beams.joint_y + r * std::sin(theta)};
}

/// A body whose centre is `at` in the beam's own frame (joint at the origin, x inwards).
BodyState body_at(const GateParams& p, Side side, Point at, Point v = {}) {
  const double inwards = side == kLeft ? 1.0 : -1.0;
  return {inwards * (at.x - p.beams.joint_x), p.beams.joint_y + at.y, inwards * v.x, v.y};
}

/// A body at a random place around the beam, with a random velocity.
BodyState random_body(const GateParams& p, Side side, Draw& draw) {
  return body_at(p, side, {draw.uniform(-20, 45), draw.uniform(-40, 40)},
                 {draw.uniform(-15, 15), draw.uniform(-15, 15)});
}

// ---- Geometry ----

TEST(Nearest, KnownPlaces) {
  const GateParams p;  // L = 25, R = 10, joints at (-25, 30) and (25, 30)
  struct Case {
    const char* what;
    Side side;
    BodyState body;
    double theta;
    ContactKind kind;
    double gap, nx, ny, lever, bend;
  };
  const double h = std::sqrt(0.5);
  const Case cases[] = {
      {"behind the beam", kLeft, {-10, 15}, 0, ContactKind::interior, 5, 0, -1, -15, 0},
      {"ahead of the beam", kLeft, {-10, 45}, 0, ContactKind::interior, 5, 0, 1, 15, 0},
      {"behind the right beam", kRight, {10, 15}, 0, ContactKind::interior, 5, 0, -1, -15, 0},
      {"overlapping", kLeft, {-10, 23}, 0, ContactKind::interior, -3, 0, -1, -15, 0},
      {"beyond the tip", kLeft, {3, 26}, 0, ContactKind::tip, -5, 0.6, -0.8, -20, 0.6},
      {"on the beam's line", kLeft, {15, 30}, 0, ContactKind::tip, 5, 1, 0, 0, 1},
      {"beyond the joint", kLeft, {-33, 24}, 0, ContactKind::pin, 0, -0.8, -0.6, 0, -0.8},
      {"right beyond the joint", kRight, {33, 24}, 0, ContactKind::pin, 0, 0.8, -0.6, 0, -0.8},
      {"beam forward", kLeft, {0, 40}, kPi / 2, ContactKind::interior, 15, 1, 0, -10, 0},
      {"right beam forward", kRight, {0, 40}, kPi / 2, ContactKind::interior, 15, -1, 0, -10, 0},
      {"beam at 45 degrees", kLeft, {-25, 30}, kPi / 4, ContactKind::pin, -10, -h, h, 0, 0},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.what);
    const Touch t = nearest(p, c.side, c.body, c.theta);
    EXPECT_EQ(t.kind, c.kind);
    // Coordinates up to 50 and sin, cos of pi/2 that are half an eps off.
    const double tolerance = 50 * kEps;
    EXPECT_NEAR(t.gap, c.gap, tolerance);
    EXPECT_NEAR(t.nx, c.nx, tolerance);
    EXPECT_NEAR(t.ny, c.ny, tolerance);
    EXPECT_NEAR(t.lever, c.lever, tolerance);
    EXPECT_NEAR(t.bend, c.bend, tolerance);
  }
}

TEST(Nearest, AgreesWithSamplingTheSegment) {
  const GateParams p;
  Draw draw(1);
  std::array<int, 3> seen{};
  for (int i = 0; i < 2000; ++i) {
    const Side side = draw.coin() ? kLeft : kRight;
    const BodyState body = random_body(p, side, draw);
    const double theta = draw.uniform(-3, 3);
    const auto distance = [&](double r) {
      const Point q = beam_point(p, side, theta, r);
      return std::hypot(body.x - q.x, body.y - q.y);
    };
    // 1000 samples along the beam, then 1000 more around the best one: positions to 1.25e-5 m.
    double best = 0.0, low = 0.0, high = p.beams.length;
    for (int round = 0; round < 2; ++round) {
      const double spacing = (high - low) / 1000;
      double closest = distance(best);
      for (int k = 0; k <= 1000; ++k) {
        const double r = low + k * spacing;
        if (distance(r) < closest) {
          closest = distance(r);
          best = r;
        }
      }
      low = std::max(0.0, best - spacing);
      high = std::min(p.beams.length, best + spacing);
    }
    const double half_spacing = 0.5 * p.beams.length * 2e-6;
    const double shortest = distance(best);

    const Touch t = nearest(p, side, body, theta);
    ++seen[static_cast<int>(t.kind)];
    const double dist = t.gap + p.body.radius;
    // The best sample is too far by at most spacing^2 / (2 dist), and never too near.
    EXPECT_LE(dist, shortest + 100 * kEps);
    EXPECT_GE(dist, shortest - half_spacing * half_spacing / shortest - 100 * kEps);
    EXPECT_NEAR(std::hypot(t.nx, t.ny), 1.0, 4 * kEps);
    // Going back from the centre along n leads to the contact point.
    const Point q = beam_point(p, side, theta, best);
    EXPECT_NEAR(body.x - dist * t.nx, q.x, half_spacing + 1e-9);
    EXPECT_NEAR(body.y - dist * t.ny, q.y, half_spacing + 1e-9);
    // The lever is the speed of the contact point along n for omega = 1: n.(dq/dtheta).
    const double inwards = side == kLeft ? 1.0 : -1.0;
    const double turn_x = -inwards * best * std::sin(theta), turn_y = best * std::cos(theta);
    EXPECT_NEAR(t.lever, t.nx * turn_x + t.ny * turn_y, half_spacing + 1e-9);
    EXPECT_NEAR(t.bend, t.nx * inwards * std::cos(theta) + t.ny * std::sin(theta), 8 * kEps);
  }
  for (const int n : seen) EXPECT_GT(n, 200);
}

TEST(Nearest, MirroredSceneGivesMirroredBits) {
  const GateParams p;
  Draw draw(2);
  for (int i = 0; i < 100'000; ++i) {
    const BodyState body = random_body(p, kLeft, draw);
    const double theta = draw.uniform(-7, 7);
    const BeamState beam{theta, draw.uniform(-2, 2), false};
    const BodyState image = test::mirrored(body);
    const Touch t = nearest(p, kLeft, body, theta), m = nearest(p, kRight, image, theta);
    ASSERT_EQ(t.kind, m.kind);
    ASSERT_EQ(t.nx, -m.nx);
    ASSERT_TRUE(same_bits(t.ny, m.ny) && same_bits(t.gap, m.gap));
    ASSERT_TRUE(same_bits(t.lever, m.lever) && same_bits(t.bend, m.bend));
    ASSERT_TRUE(same_bits(gap_rate(t, body, beam), gap_rate(m, image, beam)));
    ASSERT_TRUE(same_bits(gap_rate_bias(p, kLeft, t, body, beam),
                          gap_rate_bias(p, kRight, m, image, beam)));
    ASSERT_EQ(out_of_reach(p, kLeft, body, theta), out_of_reach(p, kRight, image, theta));
  }
}

// At r = L the tangential contact hands over to the tip, at r = 0 to the pin. A step of delta along
// the beam moves the contact point by delta and turns n by delta / dist.
TEST(Nearest, HandsOverContinuously) {
  const GateParams p;
  Draw draw(3);
  for (int i = 0; i < 10'000; ++i) {
    const Side side = draw.coin() ? kLeft : kRight;
    const double theta = draw.uniform(-1.5, 1.5), delta = draw.log_uniform(1e-12, 1e-6);
    const double dist = draw.uniform(9, 11), ahead = draw.sign();
    const double end = draw.coin() ? p.beams.length : 0.0;
    const auto at = [&](double along) {
      const double c = std::cos(theta), s = std::sin(theta);
      return body_at(p, side, {along * c - ahead * dist * s, along * s + ahead * dist * c},
                     {5.0, -3.0});
    };
    const double inner = end > 0 ? end - delta : delta;
    const BodyState in = at(inner), out = at(2 * end - inner);
    const Touch a = nearest(p, side, in, theta), b = nearest(p, side, out, theta);
    ASSERT_EQ(a.kind, ContactKind::interior);
    ASSERT_EQ(b.kind, end > 0 ? ContactKind::tip : ContactKind::pin);
    const double round_off = 100 * kEps;  // of coordinates up to 50 m
    const double turn = 2 * delta / dist;
    EXPECT_NEAR(a.gap, b.gap, delta * delta / dist + round_off);
    EXPECT_NEAR(a.nx, b.nx, turn + round_off);
    EXPECT_NEAR(a.ny, b.ny, turn + round_off);
    EXPECT_NEAR(a.lever, b.lever, 2 * delta + round_off);
    const BeamState beam{theta, 0.7, false};
    const double u_a = gap_rate(a, in, beam), u_b = gap_rate(b, out, beam);
    const double u_tolerance = 6.0 * turn + 0.7 * 2 * delta + 10 * round_off;  // |v| < 6
    EXPECT_NEAR(u_a, u_b, u_tolerance);
    // J = -(1+e) u / W with dW/dl = 2 l / I, |J| <= |(1+e) u| M.
    const auto impulse = [&](const Touch& t, double u) {
      return impact_impulse(1.0, p.beams.inertia(), t.lever, u, 0.8);
    };
    const double dw = 2 * 26.0 / p.beams.inertia() * (2 * delta + round_off);
    EXPECT_NEAR(impulse(a, u_a), impulse(b, u_b), 1.8 * (u_tolerance + std::abs(u_a) * dw));
  }
}

TEST(Nearest, CentreOnTheBeamStillHasANormal) {
  const GateParams p;
  for (const Side side : {kLeft, kRight}) {
    for (const double along : {0.0, 10.0, 25.0}) {
      const BodyState body = body_at(p, side, {along, 0.0}, {1.0, 2.0});
      const Touch t = nearest(p, side, body, 0.0);
      EXPECT_EQ(t.gap, -p.body.radius);
      EXPECT_EQ(t.nx, 0.0);
      EXPECT_EQ(std::abs(t.ny), 1.0);
      EXPECT_EQ(std::abs(t.lever), along);
    }
  }
}

TEST(OutOfReach, NeverMissesAContact) {
  GateParams p;
  Draw draw(4);
  int reached = 0, skipped = 0, touching = 0;
  for (int i = 0; i < 1'000'000; ++i) {
    p.body.radius = draw.uniform(1, 20);
    const Side side = draw.coin() ? kLeft : kRight;
    const BodyState body = random_body(p, side, draw);
    const double theta = draw.uniform(-3.5, 3.5);
    const bool skip = out_of_reach(p, side, body, theta);
    const double gap = nearest(p, side, body, theta).gap;
    ASSERT_FALSE(skip && gap < 0.0) << body.x << ' ' << body.y << ' ' << theta;
    (skip ? skipped : reached) += 1;
    touching += gap < 0.0;
  }
  // The shortcut must be worth its cost: it detects more than half of all misses.
  EXPECT_GT(skipped, (reached + skipped - touching) / 2);
}

// ---- Rates, against differences of the gap along the motion ----

/// d/dt at t = 0 by central differences at h and h/2, extrapolated: error O(h^4).
template <class F>
double derivative(F f, double h) {
  const double wide = (f(h) - f(-h)) / (2 * h), narrow = (f(h / 2) - f(-h / 2)) / h;
  return (4 * narrow - wide) / 3;
}

TEST(GapRate, IsTheDerivativeOfTheGapAndBiasThatOfTheRate) {
  const GateParams p;
  Draw draw(5);
  std::array<int, 4> seen{};  // interior behind, interior ahead, tip, pin
  constexpr double h = 1e-3;  // s
  for (int i = 0; i < 20'000; ++i) {
    const Side side = draw.coin() ? kLeft : kRight;
    const BodyState body = random_body(p, side, draw);
    const BeamState beam{draw.uniform(-1.5, 1.5), draw.uniform(-1, 1), false};
    const auto body_after = [&](double t) {
      return BodyState{body.x + body.vx * t, body.y + body.vy * t, body.vx, body.vy};
    };
    const auto touch_after = [&](double t) {
      return nearest(p, side, body_after(t), beam.theta + beam.omega * t);
    };
    const Touch now = touch_after(0.0);
    if (now.gap < -5.0 || touch_after(h).kind != now.kind || touch_after(-h).kind != now.kind)
      continue;
    const bool interior = now.kind == ContactKind::interior;
    ++seen[interior ? (now.lever > 0 ? 1 : 0) : static_cast<int>(now.kind) + 1];
    // Relative speeds are up to 60 m/s, distances 5 m and more. In the time h things move by a part
    // q of the distance, up to 0.012, so the fifth-order term is below q^5 dist / h, less than 1e-7
    // of the rate's scale q dist / h. Round-off: 50 eps / h = 1e-11.
    const double speed = std::hypot(body.vx, body.vy) + 45 * std::abs(beam.omega);
    const double dist = now.gap + p.body.radius, q = speed * h / dist;
    const double rate_tolerance = std::pow(q, 5) * dist / h + 5e-11;
    const double rate = gap_rate(now, body, beam);
    EXPECT_NEAR(rate, derivative([&](double t) { return touch_after(t).gap; }, h), rate_tolerance);
    const double bias = gap_rate_bias(p, side, now, body, beam);
    const auto rate_after = [&](double t) {
      return gap_rate(touch_after(t), body_after(t),
                      {beam.theta + beam.omega * t, beam.omega, false});
    };
    EXPECT_NEAR(bias, derivative(rate_after, h), rate_tolerance * speed / dist + 2e-10);
  }
  for (const int n : seen) EXPECT_GT(n, 1000);
}

// ---- Impacts ----

GateParams with(double mass, double inertia) {
  GateParams p;
  p.body.mass = mass;
  p.beams.length = 25.0;
  p.beams.mass = 3.0 * inertia / (25.0 * 25.0);
  return p;
}

/// One hit of the left beam.
GateState hit(const GateParams& p, const Touch& t, double e, GateState s,
              double* impulse = nullptr) {
  const double u = gap_rate(t, s.body, s.beams[kLeft]);
  const double j = impact_impulse(p.body.mass, p.beams.inertia(), t.lever, u, e);
  apply_impulses(p, {t, Touch{}}, {j, 0.0}, s);
  if (impulse) *impulse = j;
  return s;
}

// A tangential hit at 15 m/s, 15 m from the joint, in fractions: mu = 1/11.8, J = 135/59, v' =
// 750/59, w' = 97.2/59, dE = -202.5/59.
TEST(Impact, TangentialHitOfTheKnownAnswers) {
  const GateParams p;
  GateState s;
  s.body = {-10, 20, 0, 15};
  const Touch t = nearest(p, kLeft, s.body, 0.0);
  double j = 0.0;
  const GateState after = hit(p, t, 0.8, s, &j);
  EXPECT_NEAR(j, 135.0 / 59, 8 * kEps);
  EXPECT_NEAR(after.body.vy, 750.0 / 59, 32 * kEps);
  EXPECT_NEAR(after.beams[kLeft].omega, 97.2 / 59, 8 * kEps);
  EXPECT_EQ(after.body.vx, 0.0);
  EXPECT_EQ(after.beams[kRight].omega, 0.0);
  const auto energy = [&](const GateState& g) {
    const double w = g.beams[kLeft].omega;
    return 0.5 * g.body.vy * g.body.vy + 0.5 * p.beams.inertia() * w * w;
  };
  EXPECT_NEAR(energy(after) - energy(s), -202.5 / 59, 1e-12);  // 112.5 J are known to 1.4e-14
  // The same values in decimals.
  EXPECT_NEAR(j, 2.2881, 5e-5);
  EXPECT_NEAR(after.body.vy, 12.7119, 5e-5);
  EXPECT_NEAR(after.beams[kLeft].omega, 1.64746, 5e-6);
}

struct RandomHit {
  double mass, inertia, e;
  Touch t;
  GateState s;
};

RandomHit random_hit(Draw& draw) {
  RandomHit h{draw.log_uniform(1e-6, 1e6), draw.log_uniform(1e-6, 1e6), draw.uniform(0, 1), {}, {}};
  const double angle = draw.uniform(0, 2 * kPi);
  h.t.nx = std::cos(angle);
  h.t.ny = std::sin(angle);
  h.t.lever = draw.sign() * draw.log_uniform(1e-6, 1e6);
  h.s.body.vx = draw.uniform(-20, 20);
  h.s.body.vy = draw.uniform(-20, 20);
  // The speed of the beam's contact point ranges from nothing to far above the body's.
  h.s.beams[kLeft].omega = draw.sign() * draw.log_uniform(1e-2, 1e2) / std::abs(h.t.lever);
  return h;
}

// Eqs. (4) and (5) are two linear equations for v_nf and w_f; solved here by Cramer's rule in long
// double. The paper's normal is the beam's, (-sin, cos): n for a body ahead of it (lever r), -n
// for one behind (lever -r).
TEST(Impact, SolvesEqs4And5) {
  Draw draw(6);
  double impulse = 0.0, velocity = 0.0, spin = 0.0, restitution = 0.0;  // worst, relative
  const int hits = usual_or_full(300'000, 1'000'000);
  const auto most = [](double& worst, double error, double scale) {
    worst = std::max(worst, std::abs(error) / scale);
  };
  for (int i = 0; i < hits; ++i) {
    const RandomHit h = random_hit(draw);
    const GateParams p = with(h.mass, h.inertia);
    double j = 0.0;
    const GateState after = hit(p, h.t, h.e, h.s, &j);

    const long double M = h.mass, I = p.beams.inertia(), e = h.e, r = std::abs(h.t.lever);
    const double sign = h.t.lever > 0 ? 1.0 : -1.0;
    const long double nx = sign * h.t.nx, ny = sign * h.t.ny;
    const long double v_ni = nx * h.s.body.vx + ny * h.s.body.vy, w_i = h.s.beams[kLeft].omega;
    // [ M r   I ] (v_nf)   [ M r v_ni + I w_i  ]     Eq. (4)
    // [ 1    -r ] ( w_f) = [ e (r w_i - v_ni)  ]     Eq. (5)
    const long double b1 = M * r * v_ni + I * w_i, b2 = e * (r * w_i - v_ni);
    const long double det = -M * r * r - I;
    const long double v_nf = (-r * b1 - I * b2) / det, w_f = (M * r * b2 - b1) / det;

    // The differences are small compared with their operands, so round-off is relative to the
    // operands. n is a unit vector only to eps; both routes use it alike except for v - (n.v) n.
    const double speed = std::hypot(h.s.body.vx, h.s.body.vy);
    const double u_scale = speed + static_cast<double>(r) * std::abs(h.s.beams[kLeft].omega);
    const double mu = static_cast<double>(M * I / (I + M * r * r));
    // J from the difference of Eq. (7) or (8), of the lighter of the two bodies, where it cancels
    // least.
    const long double J = M * r * r < I ? sign * M * (v_nf - v_ni) : -sign * I * (w_f - w_i) / r;
    most(impulse, j - static_cast<double>(J), 2 * mu * u_scale);
    const double vx = static_cast<double>(h.s.body.vx + (v_nf - v_ni) * nx);
    const double vy = static_cast<double>(h.s.body.vy + (v_nf - v_ni) * ny);
    const double v_scale = speed + 2 * mu * u_scale / h.mass;
    most(velocity, after.body.vx - vx, v_scale);
    most(velocity, after.body.vy - vy, v_scale);
    const double w_scale = std::abs(h.s.beams[kLeft].omega) +
                           2 * mu * u_scale * std::abs(h.t.lever) / p.beams.inertia();
    most(spin, after.beams[kLeft].omega - static_cast<double>(w_f), w_scale);

    // Newton's restitution: u' = -e u.
    const double u = gap_rate(h.t, h.s.body, h.s.beams[kLeft]);
    const double u_after = gap_rate(h.t, after.body, after.beams[kLeft]);
    most(restitution, u_after + h.e * u, u_scale);
  }
  EXPECT_LE(impulse, 16 * kEps);
  EXPECT_LE(velocity, 16 * kEps);
  EXPECT_LE(spin, 16 * kEps);
  EXPECT_LE(restitution, 32 * kEps);
  for (const auto& [what, error] :
       {std::pair("side hits, J", impulse), std::pair("side hits, v'", velocity),
        std::pair("side hits, w'", spin), std::pair("side hits, restitution", restitution)})
    measured({.requirement = 3,
              .method = "contact",
              .what = what,
              .figure = error,
              .limit = 1e-12,
              .cases = hits,
              .asked = 1'000'000});
}

// Eqs. (6)-(9), e = 1: with dP = J n and I dw = -l J the energy of Eq. (6) is a parabola in J that
// is zero for no impulse; two of its values, in long double, give the other zero.
TEST(Impact, TipHitIsTheOtherZeroOfTheEnergyChange) {
  Draw draw(7);
  double worst = 0.0;
  const int hits = usual_or_full(100'000, 1'000'000);
  for (int i = 0; i < hits; ++i) {
    const RandomHit h = random_hit(draw);
    const GateParams p = with(h.mass, h.inertia);
    double j = 0.0;
    (void)hit(p, h.t, 1.0, h.s, &j);
    using L = long double;
    const L M = h.mass, I = p.beams.inertia(), l = h.t.lever;
    const L w = h.s.beams[kLeft].omega, vx = h.s.body.vx, vy = h.s.body.vy;
    const auto energy_change = [&](L J) {  // (after - before).(after + before) avoids cancellation
      const L dx = J * h.t.nx / M, dy = J * h.t.ny / M, dw = -l * J / I;
      return M / 2 * (dx * (2 * vx + dx) + dy * (2 * vy + dy)) + I / 2 * dw * (2 * w + dw);
    };
    const double u_scale =
        std::hypot(h.s.body.vx, h.s.body.vy) + std::abs(h.t.lever * h.s.beams[kLeft].omega);
    const L unit = u_scale * M * I / (I + M * l * l);
    const L up = energy_change(unit), down = energy_change(-unit);
    const L other = -(up - down) / (up + down) * unit;
    // n is a unit vector to eps only, which (up + down) sees and J's formula does not.
    worst =
        std::max(worst, std::abs(j - static_cast<double>(other)) / (2 * static_cast<double>(unit)));
  }
  EXPECT_LE(worst, 16 * kEps);
  measured({.requirement = 3,
            .method = "contact",
            .what = "tip hits, J",
            .figure = worst,
            .limit = 1e-12,
            .cases = hits,
            .asked = 1'000'000});
}

// Law: the angular momentum about the joint stays, because the only other force acts there.
TEST(Impact, ConservesAngularMomentum) {
  Draw draw(8);
  double worst = 0.0;
  const int hits = usual_or_full(300'000, 1'000'000);
  for (int i = 0; i < hits; ++i) {
    GateParams p = with(draw.log_uniform(1e-6, 1e6), draw.log_uniform(1e-6, 1e6));
    p.body.radius = 10.0;
    const Side side = draw.coin() ? kLeft : kRight;
    GateState s;
    s.body = random_body(p, side, draw);
    s.beams[side] = {draw.uniform(-1.5, 1.5), draw.sign() * draw.log_uniform(1e-3, 1e3), false};
    const Touch t = nearest(p, side, s.body, s.beams[side].theta);
    std::array<Touch, 2> touch{};
    std::array<double, 2> impulse{};
    touch[side] = t;
    impulse[side] = impact_impulse(p.body.mass, p.beams.inertia(), t.lever,
                                   gap_rate(t, s.body, s.beams[side]), draw.uniform(0, 1));
    GateState after = s;
    apply_impulses(p, touch, impulse, after);
    const double inwards = side == kLeft ? 1.0 : -1.0;
    const double x = inwards * s.body.x + p.beams.joint_x, y = s.body.y - p.beams.joint_y;
    const auto momentum = [&](const GateState& g) {
      return p.body.mass * (x * g.body.vy - y * inwards * g.body.vx) +
             p.beams.inertia() * g.beams[side].omega;
    };
    const auto magnitude = [&](const GateState& g) {
      return p.body.mass * std::hypot(x, y) * std::hypot(g.body.vx, g.body.vy) +
             p.beams.inertia() * std::abs(g.beams[side].omega);
    };
    const double scale = std::max(magnitude(s), magnitude(after));
    worst = std::max(worst, std::abs(momentum(after) - momentum(s)) / scale);
    EXPECT_EQ(after.beams[1 - side].omega, 0.0);
  }
  // A few roundings of a handful of terms.
  EXPECT_LE(worst, 16 * kEps);
  measured({.requirement = 3,
            .method = "contact",
            .what = "angular momentum about the joint",
            .figure = worst,
            .limit = 1e-13,
            .cases = hits,
            .asked = 1'000'000});
}

// Law: dE = -(1 - e^2)/2 mu u^2; no loss for e = 1, and for e = 0 the whole energy of the relative
// motion.
TEST(Impact, LosesTheEnergyOfItsRestitution) {
  Draw draw(9);
  for (int i = 0; i < 100'000; ++i) {
    RandomHit h = random_hit(draw);
    h.e = i % 3 == 0 ? 1.0 : i % 3 == 1 ? 0.0 : h.e;
    const GateParams p = with(h.mass, h.inertia);
    const GateState after = hit(p, h.t, h.e, h.s);
    using L = long double;
    const L M = h.mass, I = p.beams.inertia(), l = h.t.lever, e = h.e;
    const auto energy = [&](const GateState& g) {
      const L w = g.beams[kLeft].omega, vx = g.body.vx, vy = g.body.vy;
      return M / 2 * (vx * vx + vy * vy) + I / 2 * w * w;
    };
    const L mu = M * I / (I + M * l * l);
    const L u = L(h.t.nx) * h.s.body.vx + L(h.t.ny) * h.s.body.vy - l * h.s.beams[kLeft].omega;
    const double scale = static_cast<double>(std::max(energy(h.s), energy(after)));
    ASSERT_NEAR(static_cast<double>(energy(after) - energy(h.s)),
                static_cast<double>(-(1 - e * e) / 2 * mu * u * u), 64 * kEps * scale);
  }
}

TEST(Impact, LimitsAreWallAndPin) {
  EXPECT_EQ(impact_impulse(2.0, 1e300, 15.0, -3.0, 0.5), 9.0);   // wall: (1+e) M |u|
  EXPECT_EQ(impact_impulse(2.0, 20.0, 1e-200, -3.0, 0.5), 9.0);  // lever -> 0
  EXPECT_EQ(impact_impulse(2.0, 20.0, 0.0, -3.0, 0.5), 9.0);     // pin
  EXPECT_EQ(impact_impulse(2.0, 20.0, 15.0, 0.0, 0.5), 0.0);     // grazing
}

// ---- Both beams at once ----

// A symmetric double hit: J = (1+e) v / (2/M + r^2/I), dE = -6.328125 J. All numbers are binary
// fractions but r^2/I.
TEST(DoubleImpact, OfTheKnownAnswersIsSymmetric) {
  const GateParams p;
  Touch t;
  t.ny = -1.0;
  t.lever = -15.0;
  GateState s;
  s.body.vy = 15.0;
  const double u = gap_rate(t, s.body, s.beams[kLeft]);
  const auto j = unilateral_impulses(coupling(p, {t, t}), {1.8 * u, 1.8 * u}, {true, true});
  apply_impulses(p, {t, t}, j, s);
  EXPECT_TRUE(same_bits(j[kLeft], j[kRight]));
  EXPECT_NEAR(j[kLeft], 2.109375, 16 * kEps);
  EXPECT_NEAR(s.body.vy, 10.78125, 64 * kEps);
  EXPECT_NEAR(s.beams[kLeft].omega, 1.51875, 16 * kEps);
  EXPECT_TRUE(same_bits(s.beams[kLeft].omega, s.beams[kRight].omega));
  const double w = s.beams[kLeft].omega;
  const double energy = 0.5 * s.body.vy * s.body.vy + p.beams.inertia() * w * w;
  EXPECT_NEAR(energy - 112.5, -6.328125, 1e-12);
}

/// W as contacts produce it, over wide ranges of levers and angles.
Coupling random_coupling(Draw& draw) {
  const double mass = draw.log_uniform(1e-3, 1e3);
  const auto diagonal = [&] {
    return 1.0 / mass + (draw.coin() ? draw.log_uniform(1e-6, 1e6) : 0.0);
  };
  return {diagonal(), diagonal(), std::cos(draw.uniform(0, kPi)) / mass};
}

/// Residual that round-off in Cramer's rule may leave: W |z| + |b|, times the determinant's
/// condition W_l W_r / det.
double residual_bound(const Coupling& w, const std::array<double, 2>& b,
                      const std::array<double, 2>& z) {
  const double condition = w.left * w.right / (w.left * w.right - w.cross * w.cross);
  const double size = std::max(w.left, std::abs(w.cross)) * std::abs(z[kLeft]) +
                      std::max(w.right, std::abs(w.cross)) * std::abs(z[kRight]) +
                      std::max(std::abs(b[kLeft]), std::abs(b[kRight]));
  return 16 * kEps * condition * size;
}

TEST(PushOnly, MeetsItsConditions) {
  Draw draw(10);
  std::array<int, 4> answers{};  // none, left, right, both
  for (int i = 0; i < 100'000; ++i) {
    const Coupling w = random_coupling(draw);
    const double det = w.left * w.right - w.cross * w.cross;
    if (det < 1e-10 * w.left * w.right) continue;  // the other branch, below
    const std::array<double, 2> b{draw.sign() * draw.log_uniform(1e-3, 1e3),
                                  draw.sign() * draw.log_uniform(1e-3, 1e3)};
    const std::array<bool, 2> active{draw.below(8) != 0, draw.below(8) != 0};
    const auto z = unilateral_impulses(w, b, active);
    const std::array<double, 2> y{w.left * z[kLeft] + w.cross * z[kRight] + b[kLeft],
                                  w.cross * z[kLeft] + w.right * z[kRight] + b[kRight]};
    const double bound = residual_bound(w, b, z);
    for (const Side side : {kLeft, kRight}) {
      ASSERT_GE(z[side], 0.0);  // only push
      if (!active[side]) {
        ASSERT_EQ(z[side], 0.0);
        continue;
      }
      ASSERT_GE(y[side], -bound);  // no contact closes
      // A contact that opens is not pushed.
      if (z[side] > 0.0) {
        ASSERT_LE(std::abs(y[side]), bound);
      }
    }
    ++answers[(z[kLeft] > 0.0) + 2 * (z[kRight] > 0.0)];
  }
  for (const int n : answers) EXPECT_GT(n, 5000);
}

TEST(PushOrPull, Solves) {
  Draw draw(11);
  int pulls = 0;
  for (int i = 0; i < 100'000; ++i) {
    const Coupling w = random_coupling(draw);
    if (w.left * w.right - w.cross * w.cross < 1e-10 * w.left * w.right) continue;
    const std::array<double, 2> b{draw.uniform(-10, 10), draw.uniform(-10, 10)};
    const std::array<bool, 2> active{draw.below(8) != 0, draw.below(8) != 0};
    const auto z = bilateral_impulses(w, b, active);
    const std::array<double, 2> y{w.left * z[kLeft] + w.cross * z[kRight] + b[kLeft],
                                  w.cross * z[kLeft] + w.right * z[kRight] + b[kRight]};
    for (const Side side : {kLeft, kRight}) {
      if (active[side]) {
        ASSERT_LE(std::abs(y[side]), residual_bound(w, b, z));
      } else {
        ASSERT_EQ(z[side], 0.0);
      }
      pulls += z[side] < 0.0;
    }
  }
  EXPECT_GT(pulls, 10'000);
}

TEST(PushOnly, SwappedSidesGiveSwappedBits) {
  Draw draw(12);
  for (int i = 0; i < 100'000; ++i) {
    const Coupling w = random_coupling(draw), m{w.right, w.left, w.cross};
    const bool even = draw.below(4) == 0;
    const double first = draw.uniform(-10, 10), second = even ? first : draw.uniform(-10, 10);
    const std::array<bool, 2> active{draw.below(8) != 0, draw.below(8) != 0};
    const auto same = [](const std::array<double, 2>& a, const std::array<double, 2>& b) {
      return same_bits(a[kLeft], b[kRight]) && same_bits(a[kRight], b[kLeft]);
    };
    ASSERT_TRUE(same(unilateral_impulses(w, {first, second}, active),
                     unilateral_impulses(m, {second, first}, {active[1], active[0]})));
    ASSERT_TRUE(same(bilateral_impulses(w, {first, second}, active),
                     bilateral_impulses(m, {second, first}, {active[1], active[0]})));
  }
}

// Two contacts in one place: W is singular, b the same twice, and any split of 6 solves it.
TEST(PushOrPull, SharesEquallyBetweenCoincidingContacts) {
  const Coupling w{0.5, 0.5, 0.5};
  const auto z = bilateral_impulses(w, {-3.0, -3.0}, {true, true});
  EXPECT_EQ(z[kLeft], 3.0);
  EXPECT_EQ(z[kRight], 3.0);
  const auto pushed = unilateral_impulses(w, {-3.0, -3.0}, {true, true});
  EXPECT_EQ(pushed[kLeft] + pushed[kRight], 6.0);
}

TEST(Impulses, MirroredScenesGiveMirroredBits) {
  const GateParams p;
  Draw draw(13);
  for (int i = 0; i < 100'000; ++i) {
    GateState s;
    s.body = random_body(p, kLeft, draw);
    s.beams = {BeamState{draw.uniform(-1, 1), draw.uniform(-1, 1), false},
               BeamState{draw.uniform(-1, 1), draw.uniform(-1, 1), false}};
    GateState m{test::mirrored(s.body), {s.beams[kRight], s.beams[kLeft]}};
    const auto push = [&](GateState& g) {
      const std::array<Touch, 2> t{nearest(p, kLeft, g.body, g.beams[kLeft].theta),
                                   nearest(p, kRight, g.body, g.beams[kRight].theta)};
      const std::array<double, 2> u{gap_rate(t[kLeft], g.body, g.beams[kLeft]),
                                    gap_rate(t[kRight], g.body, g.beams[kRight])};
      apply_impulses(p, t, unilateral_impulses(coupling(p, t), u, {true, true}), g);
    };
    push(s);
    push(m);
    ASSERT_EQ(s.body.vx, -m.body.vx);
    ASSERT_TRUE(same_bits(s.body.vy, m.body.vy));
    ASSERT_TRUE(same_bits(s.beams[kLeft].omega, m.beams[kRight].omega));
    ASSERT_TRUE(same_bits(s.beams[kRight].omega, m.beams[kLeft].omega));
  }
}

// ---- Constraints: the accelerations of contact_forces, put into the printed equations ----

struct Accelerations {
  double x, y, theta;  // in the beam's own frame
};

/// The effect of one beam's contact force on body and beam, by Eqs. (2) and (3).
Accelerations accelerations(const GateParams& p, Side side, const GateState& s, double force_x) {
  const Touch t = nearest(p, side, s.body, s.beams[side].theta);
  std::array<Touch, 2> touch{};
  std::array<bool, 2> active{false, false};
  touch[side] = t;
  active[side] = true;
  const double f = contact_forces(p, s, touch, force_x, active, bilateral_impulses)[side];
  const double inwards = side == kLeft ? 1.0 : -1.0;
  const double ax = (force_x - p.forces.drag * s.body.vx + f * t.nx) / p.body.mass;
  const double ay = (p.forces.propulsion - p.forces.drag * s.body.vy + f * t.ny) / p.body.mass;
  const double k = p.beams.stiffness(side);
  const BeamState& b = s.beams[side];
  const double torque = -t.lever * f - k * b.theta - p.beams.damping * b.omega;
  return {inwards * ax, ay, torque / p.beams.inertia()};
}

GateParams unequal_beams() {
  GateParams p;
  p.beams.stiffness_left = 300.0;
  p.beams.stiffness_right = 500.0;
  return p;
}

TEST(ContactForces, TangentialContactObeysEq11) {
  const GateParams p = unequal_beams();
  Draw draw(14);
  for (int i = 0; i < 50'000; ++i) {
    const Side side = draw.coin() ? kLeft : kRight;
    const double th = draw.uniform(-1.5, 1.5), r = draw.uniform(1, 24), R = p.body.radius;
    const double c = std::cos(th), sn = std::sin(th);
    const double x = r * c + R * sn, y = r * sn - R * c;  // the body behind the beam, gap 0
    const double vx = draw.uniform(-15, 15), vy = draw.uniform(-15, 15);
    const double omega = (-sn * vx + c * vy) / r;  // Eq. (10)
    GateState s;
    s.body = body_at(p, side, {x, y}, {vx, vy});
    s.beams[side] = {th, omega, true};
    const auto [ax, ay, beta] = accelerations(p, side, s, draw.uniform(-100, 100));
    const double rr = std::sqrt(x * x + y * y - R * R);
    const double eq11 =
        beta * rr + sn * ax - c * ay + (x / rr + c) * omega * vx + (y / rr + sn) * omega * vy;
    // The spring's part of beta, up to 500 * 1.5 / I, and the contact force's part may cancel.
    const double terms =
        (std::abs(beta) + 36) * rr + std::abs(ax) + std::abs(ay) + 100 +
        (std::hypot(x, y) / rr + 1) * std::abs(omega) * (std::abs(vx) + std::abs(vy));
    // Some 20 roundings; r from the root and x/r lose (x^2 + y^2) / r^2 more.
    ASSERT_LE(std::abs(eq11), 20 * kEps * terms * (x * x + y * y) / (rr * rr));
  }
}

TEST(ContactForces, PointContactObeysEq13) {
  const GateParams p = unequal_beams();
  Draw draw(15);
  for (int i = 0; i < 50'000; ++i) {
    const Side side = draw.coin() ? kLeft : kRight;
    const double th = draw.uniform(-1.5, 1.5), L = p.beams.length, R = p.body.radius;
    const double c = std::cos(th), sn = std::sin(th);
    const double turn = draw.sign() * draw.uniform(0.05, 1.5);  // of n against the beam
    const double x = L * c + R * std::cos(th + turn), y = L * sn + R * std::sin(th + turn);
    const double vx = draw.uniform(-15, 15), vy = draw.uniform(-15, 15);
    const double arm = sn * x - c * y;
    const double omega = ((L * c - x) * vx + (L * sn - y) * vy) / (L * arm);  // Eq. (12)
    GateState s;
    s.body = body_at(p, side, {x, y}, {vx, vy});
    s.beams[side] = {th, omega, true};
    ASSERT_EQ(nearest(p, side, s.body, th).kind, ContactKind::tip);
    const auto [ax, ay, beta] = accelerations(p, side, s, draw.uniform(-100, 100));
    const double lhs = beta * L * arm;
    const double rhs = (L * c - x) * ax + (L * sn - y) * ay - vx * vx - vy * vy +
                       2 * L * omega * (c * vy - sn * vx) - L * (c * x + sn * y) * omega * omega;
    const double terms = std::abs(lhs) + 36 * L * std::abs(arm) +
                         R * (std::abs(ax) + std::abs(ay) + 100) + vx * vx + vy * vy +
                         2 * L * std::abs(omega) * (std::abs(vx) + std::abs(vy)) +
                         L * (L + R) * omega * omega;
    // Some 20 roundings; omega from Eq. (12) loses R / |arm|.
    ASSERT_LE(std::abs(lhs - rhs), 20 * kEps * terms * (1 + R / std::abs(arm)));
  }
}

// Without forces and drag the body would go on, while the damper brakes the beam: only a pull could
// keep body and beam together.
TEST(ContactForces, PushOnlyNeverPulls) {
  GateParams p;
  p.forces.propulsion = p.forces.drag = 0.0;
  GateState s;
  s.body = {-10, 20, 0, -8};
  s.beams[kLeft] = {0.0, -8.0 / 15, true};
  const std::array<Touch, 2> t{nearest(p, kLeft, s.body, 0.0), Touch{}};
  EXPECT_LT(contact_forces(p, s, t, 0.0, {true, false}, bilateral_impulses)[kLeft], -1.0);
  EXPECT_EQ(contact_forces(p, s, t, 0.0, {true, false}, unilateral_impulses)[kLeft], 0.0);
}

// ---- Direction ----

// A series is used below 1/16 rad, cos and sin beyond. Each has a handful of roundings of numbers
// up to 1.
TEST(Direction, TurnedToIsTheDirectionItself) {
  const auto expect = [](double from, double to) {
    const Direction d = Direction::of(from).turned_to(to);
    EXPECT_EQ(d.theta, to);
    // The angle between the two is itself rounded, by half an eps of it.
    EXPECT_NEAR(d.c, std::cos(to), 3 * kEps) << from << ' ' << to;
    EXPECT_NEAR(d.s, std::sin(to), 3 * kEps) << from << ' ' << to;
    EXPECT_NEAR(d.c * d.c + d.s * d.s, 1.0, 6 * kEps) << from << ' ' << to;
  };
  Draw draw(1);
  for (int i = 0; i < 100'000; ++i) {
    const double from = draw.uniform(-kPi, kPi);
    expect(from, from + draw.sign() * draw.log_uniform(1e-17, 1.0));
    expect(from, from + draw.uniform(-0.0625, 0.0625));
    for (const double edge : {0.0625 * (1 - 1e-12), 0.0625, 0.0625 * (1 + 1e-12)})
      expect(from, from + draw.sign() * edge);
  }
}

TEST(Direction, TurnedByNothingIsTheSame) {
  const Direction d = Direction::of(0.7), same = d.turned_to(0.7);
  EXPECT_EQ(same.c, d.c);
  EXPECT_EQ(same.s, d.s);
}

// A mirror image turns the other way with the same bits.
TEST(Direction, TurnedToKeepsMirrorImages) {
  Draw draw(2);
  for (int i = 0; i < 1000; ++i) {
    const double from = draw.uniform(-2, 2), to = from + draw.uniform(-0.1, 0.1);
    const Direction a = Direction::of(from).turned_to(to), b = Direction::of(-from).turned_to(-to);
    ASSERT_EQ(a.c, b.c);
    ASSERT_EQ(a.s, -b.s);
  }
}

TEST(Direction, TurnedToNowhereIsNowhere) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const double to : {nan, infinity, -infinity}) {
    EXPECT_TRUE(std::isnan(Direction::of(0.3).turned_to(to).c));
    EXPECT_TRUE(std::isnan(Direction::of(0.3).turned_to(to).s));
  }
  // A turn from a direction that is not finite gives the exact direction, because the angle itself
  // is used.
  EXPECT_EQ(Direction::of(nan).turned_to(0.3).c, Direction::of(0.3).c);
}

}  // namespace
}  // namespace gatewalk::dynamics
