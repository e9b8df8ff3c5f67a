// SPDX-License-Identifier: MIT
#include "dynamics/disc/flow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "tests/support/numbers.h"

namespace gatewalk::dynamics {
namespace {

using test::Draw;
using test::kEps;

using Real = long double;
using Complex = std::complex<Real>;

/// The same six numbers of BeamFlow from the characteristic roots -a +- delta, in complex long
/// double.
struct ClosedForm {
  Real tt, tw, wt, ww, ta, wa;
  ClosedForm(Real k, Real d, Real t) {
    const Real a = d / 2;
    const Complex delta = std::sqrt(Complex(a * a - k));
    const auto sine = [&](Real s) {  // e^{-a s} sinh(delta s) / delta, also for delta = 0
      const Complex z = delta == Complex(0) ? Complex(s) : std::sinh(delta * s) / delta;
      return std::exp(-a * s) * z.real();
    };
    const Real cosine = std::exp(-a * t) * std::cosh(delta * t).real();
    wa = tw = sine(t);
    tt = cosine + a * wa;
    ww = cosine - a * wa;
    wt = -k * wa;
    ta = integral(sine, t);
  }

 private:
  /// Gauss-Legendre, 5 points on each of 512 panels: for rate * t up to 200 the error is far below
  /// double's round-off.
  template <class F>
  static Real integral(F f, Real t) {
    constexpr Real x1 = 0.538469310105683091036L, x2 = 0.906179845938663992798L;
    constexpr Real w0 = 0.568888888888888888889L, w1 = 0.478628670499366468041L,
                   w2 = 0.236926885056189087514L;
    constexpr int panels = 512;
    const Real half = t / (2 * panels);
    Real sum = 0;
    for (int i = 0; i < panels; ++i) {
      const Real mid = (2 * i + 1) * half;
      sum += w0 * f(mid) + w1 * (f(mid - x1 * half) + f(mid + x1 * half)) +
             w2 * (f(mid - x2 * half) + f(mid + x2 * half));
    }
    return sum * half;
  }
};

struct Oscillator {
  double k, d;  // divided by the inertia
};

/// Beams that are under-, over- and critically damped, within 1e-3 and 1e-9 of critical, without
/// spring, without damper.
std::vector<Oscillator> oscillators() {
  std::vector<Oscillator> all;
  for (const double k : {0.0, 1e-8, 1e-3, 1.0, 19.2, 1e3, 1e5}) {
    for (const double d : {0.0, 1e-8, 0.1, 2.4, 40.0, 480.0}) all.push_back({k, d});
    for (const double off : {0.0, 1e-9, -1e-9, 1e-3, -1e-3, 1e-2})
      all.push_back({k, 2 * std::sqrt(k) * (1 + off)});
  }
  return all;
}

TEST(BeamFlow, AgreesWithTheCharacteristicRoots) {
  for (const auto& [k, d] : oscillators()) {
    for (const double dt : {1e-8, 1e-4, 0.004, 0.02, 0.3, 2.0}) {
      const double rate = std::sqrt(k) + d, a = d / 2;
      if (rate * dt > 200) continue;
      SCOPED_TRACE(testing::Message() << "k/I = " << k << ", d/I = " << d << ", dt = " << dt);
      const BeamFlow flow(k, d, dt);
      const ClosedForm exact(k, d, dt);
      // exp and sin of rate * dt have errors of eps * rate * dt. Just above critical damping, the
      // difference of two exponentials loses dt * (difference of their rates).
      const double z = (a * a - k) * dt * dt;
      const double loss = 1 + rate * dt + (z > 1e-4 ? 1 / std::sqrt(z) : 0.0);
      const double tolerance = 8 * kEps * loss;
      const double tau = std::min(dt, 1 / rate);  // the time for which a velocity lasts
      ASSERT_NEAR(flow.tt, static_cast<double>(exact.tt), tolerance);
      ASSERT_NEAR(flow.tw, static_cast<double>(exact.tw), tolerance * tau);
      ASSERT_NEAR(flow.wt, static_cast<double>(exact.wt), tolerance * k * tau);
      ASSERT_NEAR(flow.ww, static_cast<double>(exact.ww), tolerance);
      ASSERT_NEAR(flow.ta, static_cast<double>(exact.ta), tolerance * tau * dt);
      ASSERT_NEAR(flow.wa, static_cast<double>(exact.wa), tolerance * tau);
    }
  }
}

// flow(a) o flow(b) = flow(a + b), also across the switch between series and closed form.
TEST(BeamFlow, IsASemigroup) {
  Draw draw(1);
  for (const auto& [k, d] : oscillators()) {
    for (int i = 0; i < 50; ++i) {
      const double first = draw.log_uniform(1e-5, 1.0), second = draw.log_uniform(1e-5, 1.0);
      const double rate = std::sqrt(k) + d;
      if (rate * (first + second) > 200) continue;
      const double push = draw.uniform(-3, 3);
      const BeamState start{draw.uniform(-1, 1), draw.uniform(-2, 2), false};
      BeamState twice = start, once = start;
      BeamFlow(k, d, first).apply(twice, push);
      BeamFlow(k, d, second).apply(twice, push);
      BeamFlow(k, d, first + second).apply(once, push);
      const double a = d / 2, z = (a * a - k) * std::pow(std::min(first, second), 2);
      const double overdamped = z > 0 ? 1 / std::sqrt(std::max(z, 1e-4)) : 0;
      const double loss = 1 + rate * (first + second) + overdamped;
      // Largest angle and speed on the way: those of the start, plus the effects of the speed and
      // of the push.
      const double t = first + second, tau = std::min(t, 1 / rate);
      const double omega = std::abs(start.omega) + 3 * tau + std::sqrt(k) * std::abs(start.theta);
      const double theta = std::abs(start.theta) + std::abs(start.omega) * tau + 3 * t * tau;
      SCOPED_TRACE(testing::Message()
                   << "k/I = " << k << ", d/I = " << d << ", dt = " << first << " + " << second);
      ASSERT_NEAR(twice.theta, once.theta, 16 * kEps * loss * theta);
      ASSERT_NEAR(twice.omega, once.omega, 16 * kEps * loss * (omega + std::sqrt(k) * theta));
    }
  }
}

// On both sides of the switch, forwards and backwards in time.
TEST(BeamLaw, AgreesWithTheCharacteristicRootsAtEveryNumberOfTerms) {
  for (const auto& [k, d] : oscillators()) {
    const double rate = std::sqrt(k) + d;
    if (rate == 0.0) continue;
    const BeamLaw law(k, d);
    for (const double edge : {1e-6, 1e-3, 0.02, 0.15, 0.5, 1.0}) {
      for (const double phase : {0.999 * edge, 1.001 * edge}) {
        for (const double sign : {1.0, -1.0}) {
          const double dt = sign * phase / rate;
          SCOPED_TRACE(testing::Message() << "k/I = " << k << ", d/I = " << d << ", dt = " << dt);
          const BeamFlow flow = law.over(dt);
          const ClosedForm exact(k, d, dt);
          const double a = d / 2, z = (a * a - k) * dt * dt;
          // Series: a few roundings. Closed form just overdamped: see above; else the push's angle
          // is a difference over k dt^2.
          const bool series = phase < 0.5;
          const double overdamped = z > 1e-4 ? 1 / std::sqrt(z) : 0;
          const double tolerance = (series ? 4 : 8 * (1 + overdamped)) * kEps;
          const double lost = series || z > 1e-4 ? 1.0 : 1 + 1 / (k * dt * dt);
          const double tau = std::abs(dt);
          ASSERT_NEAR(flow.tt, static_cast<double>(exact.tt), tolerance);
          ASSERT_NEAR(flow.tw, static_cast<double>(exact.tw), tolerance * tau);
          ASSERT_NEAR(flow.wt, static_cast<double>(exact.wt), tolerance * k * tau);
          ASSERT_NEAR(flow.ww, static_cast<double>(exact.ww), tolerance);
          ASSERT_NEAR(flow.ta, static_cast<double>(exact.ta), tolerance * lost * tau * tau);
          ASSERT_NEAR(flow.wa, static_cast<double>(exact.wa), tolerance * tau);
        }
      }
    }
  }
}

// A flow backwards in time is the inverse of the flow forwards.
TEST(BeamLaw, BackwardsUndoesForwards) {
  const BeamLaw law(19.2, 2.4);
  for (const double dt : {1e-4, 0.004, 0.02, 0.05, 0.3}) {
    BeamState beam{0.3, -0.7, false};
    law.over(dt).apply(beam, 1.5);
    law.over(-dt).apply(beam, 1.5);
    EXPECT_NEAR(beam.theta, 0.3, 8 * kEps) << dt;
    EXPECT_NEAR(beam.omega, -0.7, 8 * kEps) << dt;
  }
}

// A free beam with the paper's numbers, in decimals.
TEST(BeamFlow, FreeBeamOfTheKnownAnswers) {
  const GateParams p;
  const double k = 400.0 / p.beams.inertia(), d = 50.0 / p.beams.inertia();
  const double w0 = std::sqrt(k), zeta = d / (2 * w0), wd = std::sqrt(k - d * d / 4);
  EXPECT_NEAR(w0, 4.3818, 5e-5);
  EXPECT_NEAR(zeta, 0.2739, 5e-5);
  EXPECT_NEAR(wd, 4.2143, 5e-5);
  EXPECT_NEAR(2 * test::kPi / wd, 1.4909, 5e-5);
  for (const double t : {0.004, 0.1, 1.0, 2.0}) {
    BeamState beam{0.5, 0.3, false};
    BeamFlow(k, d, t).apply(beam, 0.0);
    const double expected =
        std::exp(-1.2 * t) * (0.5 * std::cos(wd * t) + (0.3 + 1.2 * 0.5) / wd * std::sin(wd * t));
    EXPECT_NEAR(beam.theta, expected, 16 * kEps) << t;
  }
}

TEST(BeamFlow, LimitsWithoutSpringOrDamper) {
  const double dt = 0.3;
  const BeamFlow free(0.0, 0.0, dt);
  EXPECT_EQ(free.tt, 1.0);
  EXPECT_EQ(free.tw, dt);
  EXPECT_EQ(free.wt, 0.0);
  EXPECT_EQ(free.ww, 1.0);
  EXPECT_EQ(free.ta, 0.5 * dt * dt);
  EXPECT_EQ(free.wa, dt);
  // Only a damper: omega = e^{-d t}, theta = (1 - e^{-d t}) / d, pushed: (t - that) / d.
  for (const double d : {1e-12, 1e-3, 3.0, 400.0}) {
    const BeamFlow flow(0.0, d, dt);
    const double glide = -std::expm1(-d * dt) / d;
    EXPECT_EQ(flow.tt, 1.0);
    EXPECT_EQ(flow.wt, 0.0);
    EXPECT_NEAR(flow.ww, std::exp(-d * dt), 8 * kEps * (1 + d * dt));
    EXPECT_NEAR(flow.tw, glide, 8 * kEps * glide);
  }
  // a rotation in phase space
  for (const double k : {1e-12, 1e-3, 3.0, 4e4}) {
    const BeamFlow flow(k, 0.0, dt);
    const double w = std::sqrt(k), phase_error = 8 * kEps * (1 + w * dt);
    EXPECT_NEAR(flow.tt, std::cos(w * dt), phase_error);
    EXPECT_NEAR(flow.ww, std::cos(w * dt), phase_error);
    EXPECT_NEAR(flow.tw * w, std::sin(w * dt), phase_error);
    EXPECT_NEAR(flow.tt * flow.ww - flow.tw * flow.wt, 1.0, 2 * phase_error);  // area is kept
  }
}

TEST(BeamFlow, ForgetsItsStartWhenStronglyDamped) {
  // 0.3 s of a beam whose fast root is 10^12/s: only the slow root -k/d is left, without overflow.
  const BeamFlow flow(1e3, 1e12, 0.3);
  EXPECT_NEAR(flow.tt, std::exp(-1e3 / 1e12 * 0.3), 4 * kEps);
  EXPECT_NEAR(flow.tw, 1e-12, 1e-12 * 1e-9);
  EXPECT_NEAR(flow.ww, 0.0, 1e-20);
}

// ---- Body ----

TEST(BodyFlow, AgreesWithTheClosedForm) {
  for (const double g : {1e-300, 1e-9, 0.06, 1.0, 2.4999, 2.5, 2.5001, 30.0, 1e4}) {
    for (const double dt : {1e-8, 0.004, 0.1, 2.0}) {
      SCOPED_TRACE(testing::Message() << "D/M = " << g << ", dt = " << dt);
      const Real z = Real(g) * dt;
      const BodyFlow flow(g, dt);
      EXPECT_NEAR(flow.decay, static_cast<double>(std::exp(-z)), 4 * kEps);
      const double rise = static_cast<double>(z < 1e-15L ? dt * (1 - z / 2) : -std::expm1(-z) / g);
      EXPECT_NEAR(flow.rise, rise, 8 * kEps * rise);
      // (z - 1 + e^-z) / g^2 = dt^2 (1/2 - z/6 + z^2/24 ...); computed as a difference, it loses
      // digits as z gets small.
      Real fall = 0, term = 0.5L;
      if (z < 0.5L) {
        for (int n = 3; n < 30; ++n) {
          fall += term;
          term *= -z / n;
        }
        fall *= Real(dt) * dt;
      } else {
        fall = (z + std::expm1(-z)) / (Real(g) * g);
      }
      const double lost = z < 1e-2L ? 1.0 : 1.0 + 2.0 / static_cast<double>(z);
      EXPECT_NEAR(flow.fall, static_cast<double>(fall),
                  8 * kEps * lost * static_cast<double>(fall));
    }
  }
}

TEST(BodyFlow, WithoutDragIsAParabola) {
  const BodyFlow flow(0.0, 0.3);
  EXPECT_EQ(flow.decay, 1.0);
  EXPECT_EQ(flow.rise, 0.3);
  EXPECT_EQ(flow.fall, 0.3 * 0.3 / 2);
  BodyState b{1, 2, 3, 4};
  flow.apply(b, 10, -20);
  EXPECT_NEAR(b.x, 1 + 0.9 + 0.45, 8 * kEps);
  EXPECT_NEAR(b.y, 2 + 1.2 - 0.9, 8 * kEps);
  EXPECT_NEAR(b.vx, 6, 8 * kEps);
  EXPECT_NEAR(b.vy, -2, 8 * kEps);
}

TEST(BodyFlow, IsASemigroup) {
  Draw draw(2);
  for (int i = 0; i < 2000; ++i) {
    const double g = draw.coin() ? 0.0 : draw.log_uniform(1e-6, 100);
    const double first = draw.log_uniform(1e-5, 2), second = draw.log_uniform(1e-5, 2);
    const double ax = draw.uniform(-10, 10), ay = draw.uniform(-10, 10);
    const BodyState start{0, 0, draw.uniform(-10, 10), draw.uniform(-10, 10)};
    BodyState twice = start, once = start;
    BodyFlow(g, first).apply(twice, ax, ay);
    BodyFlow(g, second).apply(twice, ax, ay);
    BodyFlow(g, first + second).apply(once, ax, ay);
    const double t = first + second, v = 10 + 10 * t, tolerance = 16 * kEps * (1 + g * t);
    // `fall` loses up to 200 eps of dt^2 just above the switch at g dt = 0.01.
    EXPECT_NEAR(twice.x, once.x, tolerance * v * t + 800 * kEps * 10 * t * t);
    EXPECT_NEAR(twice.y, once.y, tolerance * v * t + 800 * kEps * 10 * t * t);
    EXPECT_NEAR(twice.vx, once.vx, tolerance * v);
    EXPECT_NEAR(twice.vy, once.vy, tolerance * v);
  }
}

TEST(GateFlow, GivesEachBeamItsOwnSpring) {
  GateParams p;
  p.beams.stiffness_left = 300;
  p.beams.stiffness_right = 500;
  p.body.mass = 2.0;
  const GateFlow flow = GateLaw(p).over(0.1);
  const double inertia = p.beams.inertia();
  EXPECT_EQ(flow.dt, 0.1);
  EXPECT_EQ(flow.left.wt, BeamFlow(300 / inertia, 50 / inertia, 0.1).wt);
  EXPECT_EQ(flow.right.wt, BeamFlow(500 / inertia, 50 / inertia, 0.1).wt);
  EXPECT_NE(flow.left.wt, flow.right.wt);
  EXPECT_EQ(flow.body.decay, BodyFlow(0.03, 0.1).decay);
}

// The first turning point of the beam, compared with the closed form sampled in small steps.
TEST(BeamLaw, SwingIsTheLargestDeflectionOnTheWay) {
  Draw draw(8);
  int turned = 0;
  for (const Oscillator& o : oscillators()) {
    const BeamLaw law(o.k, o.d);
    const double rate = std::sqrt(o.k) + o.d + 1e-3;
    for (int i = 0; i < 8; ++i) {
      const BeamState start{draw.uniform(-1.0, 1.0), draw.uniform(-3.0, 3.0) * rate};
      const double dt = draw.uniform(0.1, 6.0) / rate;
      constexpr int kLooks = 2000;
      double seen = 0.0;  // in between
      BeamState end = start;
      for (int n = 1; n <= kLooks; ++n) {
        end = start;
        law.over(dt * n / kLooks).apply(end, 0.0);
        seen = std::max(seen, std::abs(end.theta));
      }
      const double swing = law.swing(start, dt);
      turned += swing > 0.0;
      // Between samples the deflection changes by at most (rate dt / looks)^2 of itself about its
      // maximum.
      EXPECT_NEAR(std::max({swing, std::abs(start.theta), std::abs(end.theta)}),
                  std::max(seen, std::abs(start.theta)), 1e-4)
          << o.k << ' ' << o.d << ' ' << start.theta << ' ' << start.omega << ' ' << dt;
      if (start.omega * end.omega < 0.0) {
        EXPECT_GT(swing, 0.0);
      }
    }
  }
  EXPECT_GT(turned, 50);
}

TEST(BeamLaw, SwingFromRestAndWithoutForces) {
  EXPECT_EQ(BeamLaw(0.0, 0.0).swing({0.3, 2.0}, 10.0), 0.0);  // never turns
  EXPECT_EQ(BeamLaw(0.0, 1.0).swing({0.3, 2.0}, 10.0), 0.0);  // slows down but never turns
  EXPECT_EQ(BeamLaw(4.0, 0.0).swing({0.0, 0.0}, 10.0), 0.0);
  EXPECT_NEAR(BeamLaw(4.0, 0.0).swing({0.0, -3.0}, 10.0), 1.5,
              1e-15);  // energy: omega^2 = k theta^2
  EXPECT_LE(BeamLaw(4.0, 1.0).swing({0.5, 0.0}, 10.0), 0.5);
}

}  // namespace
}  // namespace gatewalk::dynamics
