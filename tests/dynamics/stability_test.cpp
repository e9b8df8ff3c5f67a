// SPDX-License-Identifier: MIT
#include "dynamics/disc/study/stability.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dynamics/disc/methods/paper.h"
#include "dynamics/disc/study/accuracy.h"
#include "tests/support/numbers.h"

namespace gatewalk::dynamics {
namespace {

using test::kEps;

Verdict at(MapKind kind, std::string_view method, double x, double y) {
  return run_point(kind, method, x, y, 1).verdict;
}

// ---- Maps ----

TEST(StabilityMap, EveryMethodHasEveryMap) {
  for (const auto method : chart_methods()) {
    for (int kind = 0; kind < kMapKinds; ++kind) {
      for (const bool quick : {true, false}) {
        const StabilityMap map = stability_map(static_cast<MapKind>(kind), method, quick);
        EXPECT_EQ(map.method, method);
        for (const MapAxis* axis : {&map.x, &map.y}) {
          ASSERT_GE(axis->values.size(), 5u) << map.name;
          EXPECT_TRUE(std::is_sorted(axis->values.begin(), axis->values.end()) ||
                      map.kind == MapKind::grazing_speed)
              << map.name;
        }
      }
    }
  }
}

TEST(StabilityMap, SpansWhatItPromises) {
  const auto ends = [](const MapAxis& a) { return std::pair(a.values.front(), a.values.back()); };
  const auto stiffness = stability_map(MapKind::step_stiffness, "stable", false);
  EXPECT_DOUBLE_EQ(stiffness.x.values.front(), 0.0005);
  EXPECT_DOUBLE_EQ(stiffness.x.values.back(), 0.02);
  EXPECT_NEAR(stiffness.y.values.front(), 10.0, 1e-12);
  EXPECT_GE(stiffness.y.values.back(), 1e8);
  EXPECT_EQ(ends(stability_map(MapKind::step_damping, "paper", false).y),
            std::pair(0.0, std::pow(10.0, 6.0)));
  const auto grazing = stability_map(MapKind::grazing_speed, "paper", false).x.values;
  EXPECT_DOUBLE_EQ(grazing.front(), -1e-3);
  EXPECT_DOUBLE_EQ(*std::min_element(grazing.begin(), grazing.end(),
                                     [](double a, double b) { return std::abs(a) < std::abs(b); }),
                   -1e-15);
}

TEST(StabilityMap, PointsCanBeRepeated) {
  const MapPoint a = run_point(MapKind::step_stiffness, "stable", 0.004, 400.0, 1);
  const MapPoint b = run_point(MapKind::step_stiffness, "stable", 0.004, 400.0, 1);
  EXPECT_EQ(a.health.runs, kTrialsPerPoint);
  EXPECT_EQ(a.health.impacts, b.health.impacts);
  EXPECT_GT(a.health.impacts, kTrialsPerPoint);  // the disc does meet the beams
  EXPECT_NE(a.health.worst_speed,
            run_point(MapKind::step_stiffness, "stable", 0.004, 400.0, 2).health.worst_speed);
}

// `paper` is stable up to the stiffness d/h. With steps c, 2c, 4c and stiffnesses of 1.5 and 3
// times d/4c, whose bounds in those units are 4, 2 and 1, by hand:
//          c     2c    4c
//   3      in    out   out
//   1.5    in    in    out
StabilityMap small_map() {
  const double c = 0.001, unit = GateParams{}.beams.damping / (4 * c);
  StabilityMap map;
  map.kind = MapKind::step_stiffness;
  map.name = "small";
  map.method = "paper";
  map.x.values = {c, 2 * c, 4 * c};
  map.y.values = {1.5 * unit, 3 * unit};
  return map;
}

TEST(RunMap, PutsEveryPointInItsPlace) {
  const FinishedMap done = run_map(small_map(), 1);
  ASSERT_EQ(done.points.size(), 6u);
  ASSERT_EQ(done.seconds.size(), 6u);
  for (const auto& [ix, iy] : {std::pair{2u, 0u}, {1u, 1u}, {2u, 1u}})
    EXPECT_EQ(done.at(ix, iy).verdict, Verdict::beyond_bound) << ix << ' ' << iy;
  EXPECT_EQ(done.count(Verdict::beyond_bound), 3);
  // The point itself, of that seed.
  const auto& map = done.map;
  EXPECT_EQ(
      done.at(0, 1).health.worst_speed,
      run_point(map.kind, map.method, map.x.values[0], map.y.values[1], 1).health.worst_speed);
  for (const double seconds : done.seconds) EXPECT_GT(seconds, 0.0);
}

TEST(RunMap, CanBeStopped) {
  struct Enough {};
  std::int64_t told = 0;
  const Work work{[&](std::string_view what, std::int64_t done, std::int64_t total) {
    EXPECT_EQ(what, "small, paper");
    EXPECT_EQ(total, 6);
    ++told;
    if (done > 0) throw Enough{};
  }};
  EXPECT_THROW((void)run_map(small_map(), 1, work), Enough);
  EXPECT_EQ(told, 2);  // before the first point, and after it
}

TEST(StabilityMaps, AreKindByKindForEveryMethod) {
  const auto maps = stability_maps(true);
  const auto methods = chart_methods();
  ASSERT_EQ(maps.size(), kMapKinds * methods.size());
  for (std::size_t i = 0; i < maps.size(); ++i) {
    EXPECT_EQ(static_cast<std::size_t>(maps[i].kind), i / methods.size());
    EXPECT_EQ(maps[i].method, methods[i % methods.size()]);
  }
}

// ---- Borders that are known ----

// Explicit Euler grows a swinging beam when h > d/k. Both sides of the border, 1 % away.
TEST(Stability, PaperBreaksBeyondItsStiffnessBound) {
  for (const double h : {0.001, 0.002, 0.004}) {
    const double border = GateParams{}.beams.damping / h;
    EXPECT_EQ(at(MapKind::step_stiffness, "paper", h, 1.01 * border), Verdict::beyond_bound) << h;
    EXPECT_LT(at(MapKind::step_stiffness, "paper", h, 0.99 * border), Verdict::beyond_bound) << h;
  }
}

// ... and a creeping one when h > about 2 I/d; a swinging one also when the damping is too small.
TEST(Stability, PaperBreaksBeyondBothDampingBounds) {
  const double inertia = GateParams{}.beams.inertia(), k = GateParams{}.beams.stiffness_left;
  for (const double h : {0.001, 0.004}) {
    const double high = 2.0 * inertia / h + 0.5 * k * h, low = k * h;
    EXPECT_EQ(at(MapKind::step_damping, "paper", h, 1.01 * high), Verdict::beyond_bound) << h;
    EXPECT_LT(at(MapKind::step_damping, "paper", h, 0.99 * high), Verdict::beyond_bound) << h;
    EXPECT_LT(at(MapKind::step_damping, "paper", h, 1.01 * low), Verdict::beyond_bound) << h;
    EXPECT_EQ(at(MapKind::step_damping, "paper", h, 0.99 * low), Verdict::beyond_bound) << h;
  }
}

// Well beyond it the bound is not only claimed: energy appears by orders of magnitude.
TEST(Stability, BeyondTheBoundEnergyAppears) {
  const MapPoint inside = run_point(MapKind::step_stiffness, "paper", 0.001, 1e3, 1);
  const MapPoint beyond = run_point(MapKind::step_stiffness, "paper", 0.001, 1e6, 1);
  EXPECT_LT(inside.health.worst_energy_created, 100.0);
  EXPECT_GT(beyond.health.worst_energy_created, 1e4);
}

// `stable` refuses when a step would need more than 1024 pieces of half a radian or e-fold.
TEST(Stability, StableRefusesBeyond1024Pieces) {
  const double inertia = GateParams{}.beams.inertia();
  for (const double h : {0.004, 0.02}) {
    const double stiffness = inertia * (512.0 / h) * (512.0 / h), damping = 512.0 * inertia / h;
    EXPECT_EQ(at(MapKind::step_stiffness, "stable", h, 1.01 * stiffness), Verdict::refused) << h;
    EXPECT_NE(at(MapKind::step_stiffness, "stable", h, 0.99 * stiffness), Verdict::refused) << h;
    EXPECT_EQ(at(MapKind::step_damping, "stable", h, 1.01 * damping), Verdict::refused) << h;
    EXPECT_NE(at(MapKind::step_damping, "stable", h, 0.99 * damping), Verdict::refused) << h;
  }
}

// A matrix's largest eigenvalue modulus, 2 x 2: semi-implicit Euler's step of a free beam,
// omega+ = omega - h (k theta + d omega)/I, theta+ = theta + h omega+.
double growth(const GateParams& p, double h) {
  const double a = h * p.beams.stiffness_left / p.beams.inertia();
  const double b = h * p.beams.damping / p.beams.inertia();
  const double half_trace = 0.5 * (2.0 - h * a - b), determinant = 1.0 - b;
  const double under = half_trace * half_trace - determinant;
  return under < 0.0 ? std::sqrt(determinant) : std::abs(half_trace) + std::sqrt(under);
}

TEST(SemiImplicitBound, IsWhereFreeBeamsBeginToGrow) {
  for (const double k : {1.0, 400.0, 1e6}) {
    for (const double d : {0.0, 50.0, 1e4}) {
      GateParams p;
      p.beams.stiffness_left = p.beams.stiffness_right = k;
      p.beams.damping = d;
      const double bound = semi_implicit_bound(p);
      EXPECT_GT(growth(p, 1.001 * bound), 1.0) << k << ' ' << d;
      // Without damping the multipliers lie on the unit circle.
      EXPECT_LE(growth(p, 0.999 * bound), 1.0 + 4 * kEps) << k << ' ' << d;
    }
  }
}

// The lines of the figures lie where the methods' own bounds are.
TEST(Borders, OfPaperAreItsEulerBound) {
  for (const MapKind kind : {MapKind::step_stiffness, MapKind::step_damping}) {
    const auto lines = borders(stability_map(kind, "paper", true));
    ASSERT_EQ(lines.size(), kind == MapKind::step_stiffness ? 1u : 2u);
    for (const Border& line : lines) {
      for (std::size_t i = 0; i < line.x.size(); ++i) {
        GateParams p;
        if (kind == MapKind::step_stiffness)
          p.beams.stiffness_left = p.beams.stiffness_right = line.y[i];
        else
          p.beams.damping = line.y[i];
        // d/k and the root of a quadratic: a few rounding errors, amplified by the root's
        // difference of nearly equal numbers by d^2 / (4 k I) < 1e6 here.
        EXPECT_NEAR(euler_bound(p) / line.x[i], 1.0, 1e-9) << line.label << ' ' << line.x[i];
      }
    }
  }
}

TEST(Borders, OfPenaltyAreTheSemiImplicitBound) {
  for (const MapKind kind : {MapKind::step_stiffness, MapKind::step_damping}) {
    const auto lines = borders(stability_map(kind, "penalty", true));
    ASSERT_GE(lines.size(), 1u);
    const Border& line = lines.front();
    EXPECT_GT(line.x.size(), 20u);
    const Beams beams = GateParams{}.beams;
    for (std::size_t i = 0; i < line.x.size(); ++i) {
      const double h = line.x[i], y = line.y[i];
      const double k = kind == MapKind::step_stiffness ? y : beams.stiffness_left;
      const double d = kind == MapKind::step_damping ? y : beams.damping;
      // Few rounding errors: no difference of nearly equal numbers on the way.
      EXPECT_NEAR((h * h * k + 2.0 * h * d) / beams.inertia(), 4.0, 40 * kEps) << h;
    }
  }
}

TEST(Borders, OfStableAreWhereItRefuses) {
  const auto lines = borders(stability_map(MapKind::step_stiffness, "stable", false));
  ASSERT_EQ(lines.size(), 1u);
  const double inertia = GateParams{}.beams.inertia();
  for (std::size_t i = 0; i < lines[0].x.size(); ++i) {
    const double h = lines[0].x[i];
    // The search stops at a thousandth.
    EXPECT_NEAR(lines[0].y[i] / (inertia * (512.0 / h) * (512.0 / h)), 1.0, 2e-3);
  }
  EXPECT_TRUE(borders(stability_map(MapKind::lever_speed, "paper", true)).empty());
}

// ---- Borders that were measured ----

// `stable` holds from soft to rigid, creeping to undamped, at any restitution and threshold.
TEST(Stability, StableHoldsInTheInterior) {
  for (const double h : {0.001, 0.02})
    for (const double k : {1e1, 1e4, 1e8})
      EXPECT_EQ(at(MapKind::step_stiffness, "stable", h, k), Verdict::fine) << h << ' ' << k;
  for (const double d : {0.0, 1e3, 1e5})
    EXPECT_EQ(at(MapKind::step_damping, "stable", 0.004, d), Verdict::fine) << d;
  for (const double e : {0.0, 0.8, 1.0})
    for (const double threshold : {1e-4, 1.0})
      EXPECT_EQ(at(MapKind::restitution_threshold, "stable", e, threshold), Verdict::fine)
          << e << ' ' << threshold;
}

TEST(Stability, StableHoldsAtTheJoint) {
  for (const double r : {1e-9, 1e-6, 1e-3, 1.0})
    for (const double speed : {0.1, 10.0})
      EXPECT_EQ(at(MapKind::lever_speed, "stable", r, speed), Verdict::fine) << r << ' ' << speed;
}

// `paper` creates energy or sinks wherever its constraint acts, however far from any stability
// bound.
TEST(Stability, PaperFailsAtItsOwnSetting) {
  const Verdict v = at(MapKind::step_stiffness, "paper", 0.004, 400.0);
  EXPECT_GE(v, Verdict::energy);
  EXPECT_LT(v, Verdict::beyond_bound);
}

// Never a hit above R; below, the shorter the overlap (R sqrt(8 delta) / v) against the step, the
// sooner it is missed: 89 ms at delta 1e-3 and 10 m/s, 28 ms at 1e-4, 0.09 ms at 1e-9.
TEST(Stability, GrazingHitsAreMissedWhenShorterThanAStep) {
  for (const char* method : {"paper", "stable"}) {
    for (const double delta : {1e-3, 1e-9, 1e-15})
      EXPECT_EQ(at(MapKind::grazing_speed, method, delta, 10.0), Verdict::fine) << method << delta;
    EXPECT_EQ(at(MapKind::grazing_speed, method, -1e-3, 10.0), Verdict::fine) << method;
  }
  EXPECT_EQ(at(MapKind::grazing_speed, "stable", -1e-4, 10.0), Verdict::fine);
  EXPECT_EQ(at(MapKind::grazing_speed, "stable", -1e-9, 10.0), Verdict::missed_hit);
}

}  // namespace
}  // namespace gatewalk::dynamics
