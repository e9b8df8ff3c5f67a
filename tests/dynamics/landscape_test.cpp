// SPDX-License-Identifier: MIT
#include "dynamics/disc/landscape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "dynamics/base/random.h"
#include "dynamics/disc/contact.h"
#include "tests/support/scenes.h"

namespace gatewalk::dynamics {
namespace {

GateParams unequal() {
  GateParams p;
  p.beams.stiffness_left = 500.0;
  p.beams.stiffness_right = 250.0;
  return p;
}

// A deflected beam touches the disc: gap 0, the disc behind it, at its side or its tip.
TEST(Landscape, DeflectedBeamsTouchTheDisc) {
  const GateParams p;
  Random random(Purpose::gate, {.seed = 1, .row = 0, .trial = 0});
  int sides = 0, tips = 0;
  for (int i = 0; i < 20'000; ++i) {
    const double x = -25.0 + 50.0 * random.uniform(), y = 60.0 * random.uniform();
    for (const Side side : {kLeft, kRight}) {
      const double theta = forward_deflection(p, side, x, y);
      ASSERT_GE(theta, 0.0);
      if (std::isinf(theta)) {
        EXPECT_LT(std::hypot(from_joint(p, side, x), y - p.beams.joint_y), p.body.radius);
      } else if (theta > 0.0) {
        const Touch t = nearest(p, side, {x, y, 0, 0}, theta);
        EXPECT_NEAR(t.gap, 0.0, 1e-12 * p.body.radius) << x << ' ' << y;
        EXPECT_LT(t.lever, 0.0);  // a push along n turns the beam forward
        ++(t.kind == ContactKind::tip ? tips : sides);
      }
    }
  }
  EXPECT_GT(sides, 1000);
  EXPECT_GT(tips, 1000);
}

TEST(Landscape, ABeamOutOfReachRests) {
  const GateParams p;
  EXPECT_EQ(forward_deflection(p, kLeft, 0.0, 15.0), 0.0);             // 5 m behind it
  EXPECT_EQ(forward_deflection(p, kLeft, 24.0, 55.0), 0.0);            // beyond its tip's circle
  EXPECT_NEAR(forward_deflection(p, kLeft, -12.0, 20.0), 0.0, 1e-12);  // just touching
  // Straight ahead at the distance of the tip: the beam stands upright beside the disc.
  EXPECT_NEAR(forward_deflection(p, kLeft, -15.0, 30.0 + 5.0), std::numbers::pi / 2, 1e-12);
}

// Minus the gradient is the quasi-static force: of beams at rest in contact, k theta = -l f, and of
// the propulsion. Central differences have errors of h^2 times a third derivative and of eps E / h
// by rounding.
TEST(Landscape, MinusTheGradientIsTheForce) {
  const GateParams p = unequal();
  Random random(Purpose::gate, {.seed = 2, .row = 0, .trial = 0});
  constexpr double h = 1e-4;  // m
  int compared = 0;
  for (int i = 0; i < 5000; ++i) {
    const double x = -24.0 + 48.0 * random.uniform(), y = 5.0 + 54.0 * random.uniform();
    double fx = 0.0, fy = p.forces.propulsion;
    bool smooth = true;
    for (const Side side : {kLeft, kRight}) {
      const double theta = forward_deflection(p, side, x, y);
      for (const double dx :
           {-h, h})  // no corner between: tip and side, rest and reach, a joint nearby
        for (const double dy : {-h, h}) {
          const double other = forward_deflection(p, side, x + dx, y + dy);
          smooth = smooth && std::isfinite(other) && (other > 0.0) == (theta > 0.0);
          if (theta > 0.0 && smooth)
            smooth = nearest(p, side, {x + dx, y + dy, 0, 0}, other).kind ==
                     nearest(p, side, {x, y, 0, 0}, theta).kind;
        }
      if (theta <= 0.0 || !smooth) continue;
      const Touch t = nearest(p, side, {x, y, 0, 0}, theta);
      smooth = std::abs(t.lever) > 1.0;
      const double f = -p.beams.stiffness(side) * theta / t.lever;
      fx += f * t.nx;
      fy += f * t.ny;
    }
    if (!smooth) continue;
    const auto total = [&](double u, double v) {
      return beam_energy(p, u, v) + propulsion_energy(p, v);
    };
    const double size = std::hypot(fx, fy);
    EXPECT_NEAR(-(total(x + h, y) - total(x - h, y)) / (2 * h), fx, 1e-5 * size) << x << ' ' << y;
    EXPECT_NEAR(-(total(x, y + h) - total(x, y - h)) / (2 * h), fy, 1e-5 * size) << x << ' ' << y;
    ++compared;
  }
  EXPECT_GT(compared, 4000);
}

TEST(Landscape, MirroredBeamsMirrorIt) {
  GateParams p = unequal(), m = p;
  std::swap(m.beams.stiffness_left, m.beams.stiffness_right);
  const Landscape a = landscape(p, 0.0, 0.5), b = landscape(m, 0.0, 0.5);
  ASSERT_EQ(a.x.size(), 101u);
  ASSERT_EQ(a.y.size(), 121u);
  for (Eigen::Index i = 0; i < a.total.rows(); ++i)
    for (Eigen::Index j = 0; j < a.total.cols(); ++j) {
      const double here = a.total(i, j), there = b.total(i, a.total.cols() - 1 - j);
      EXPECT_TRUE(here == there || std::abs(here - there) < 1e-9) << i << ' ' << j;
    }
}

// Sec. III-B with equal beams of 500 N m/rad at 7 N. On the paper's grid the start lacks 32 J. The
// true pass is lower: it follows the edge of one beam's reach, where the other beam alone resists,
// and no grid point lies on that circle. The pass computed along that edge is the limit of ever
// finer grids.
TEST(Landscape, TheLowestPassOfThePapersGates) {
  GateParams p = test::study(10.0);
  p.forces.propulsion = 7.0;
  p.beams.stiffness_left = p.beams.stiffness_right = 500.0;
  double along_the_edge = -1e300;
  for (double angle = 2.2; angle < 3.9; angle += 1e-4) {
    const double reach = (p.beams.length + p.body.radius) * (1 + 1e-12);
    const double x = p.beams.joint_x + reach * std::cos(angle),
                 y = p.beams.joint_y + reach * std::sin(angle);
    if (std::abs(x) > p.beams.joint_x) continue;
    along_the_edge = std::max(along_the_edge, beam_energy(p, x, y) - p.forces.propulsion * y);
  }
  EXPECT_NEAR(along_the_edge, 18.15, 0.01);
  EXPECT_NEAR(lowest_pass(landscape(p, 0.0, 0.5), 0.0, 0.0).barrier(), 32.03, 0.01);
  double last = 32.1;
  for (const double spacing : {0.5, 0.25, 0.1, 0.05}) {
    const double barrier = lowest_pass(landscape(p, 0.0, spacing), 0.0, 0.0).barrier();
    EXPECT_LT(barrier, last);
    EXPECT_GT(barrier, along_the_edge);
    last = barrier;
  }
  EXPECT_LT(last, along_the_edge + 1.6);
}

// With a softer left beam the pass is lower than the start, and on the left side.
TEST(Landscape, ASofterBeamOpensItsSide) {
  GateParams p = test::study(10.0);
  p.forces.propulsion = 7.0;
  p.beams.stiffness_right = 500.0;
  p.beams.stiffness_left = 300.0;
  const Landscape l = landscape(p, 0.0, 0.5);
  // The start is higher than any pass, but between them lies a basin, from which the body must
  // climb.
  EXPECT_EQ(lowest_pass(l, 0.0, 0.0).barrier(), 0.0);
  const auto [x, y] = basin_below(l, 0.0, 0.0);
  EXPECT_GT(y, 15.0);
  EXPECT_LT(y, 30.0);
  const Pass pass = lowest_pass(l, x, y);
  EXPECT_GT(pass.barrier(), 0.0);
  EXPECT_LT(pass.x, 0.0);
  const auto beyond =
      std::find_if(pass.way.begin(), pass.way.end(), [](const auto& at) { return at[1] > 40.0; });
  ASSERT_NE(beyond, pass.way.end());
  EXPECT_LT((*beyond)[0], 0.0);
}

// Four points around a wall with one gap, worked out by hand.
TEST(Landscape, ThePassIsTheLowestOfTheHighest) {
  Landscape l;
  l.x = {0, 1, 2};
  l.y = {0, 1, 2};
  l.total = Eigen::ArrayXXd::Zero(3, 3);
  l.total << 1, 2, 3, 9, 8, 7, 0, 0, 0;
  const Pass pass = lowest_pass(l, 0.0, 0.0);
  EXPECT_EQ(pass.energy, 7.0);
  EXPECT_EQ(pass.x, 2.0);
  EXPECT_EQ(pass.y, 1.0);
  EXPECT_EQ(pass.start_energy, 1.0);
  EXPECT_EQ(pass.barrier(), 6.0);
  EXPECT_EQ(basin_below(l, 2.0, 0.0), (std::array<double, 2>{0.0, 0.0}));  // 3, 2, 1
  EXPECT_EQ(basin_below(l, 2.0, 1.0),
            (std::array<double, 2>{2.0, 2.0}));  // beyond the wall, straight on
  ASSERT_EQ(pass.way.size(), 4u);                // (0,0), (1,0), (2,1), then up
  l.total.row(1) = std::numeric_limits<double>::infinity();
  EXPECT_THROW((void)lowest_pass(l, 0.0, 0.0), std::runtime_error);
  EXPECT_THROW((void)lowest_pass(l, 5.0, 0.0), std::invalid_argument);
}

// ---- The pass on two grids ----

// Without springs only the propulsion acts: 8 N downhill from y = 20 to 60 m.
TEST(Passes, WithoutSpringsAreDownhill) {
  GateParams p = test::free_rods();
  p.forces.propulsion = 8.0;
  ASSERT_EQ(p.run.traverse_y, 60.0);
  const Passes found = passes(p, {.x = 0.0, .y = 20.0, .vx = 3.0, .vy = 4.0}, 5.0);
  EXPECT_DOUBLE_EQ(found.kinetic_energy, 12.5 * p.body.mass);
  EXPECT_EQ(found.coarse.spacing, 5.0);
  EXPECT_EQ(found.fine.spacing, 0.5);
  for (const GridPasses& grid : {found.coarse, found.fine}) {
    EXPECT_TRUE(grid.downhill());
    EXPECT_DOUBLE_EQ(grid.from_start.start_energy, 320.0);
    EXPECT_EQ(grid.from_start.barrier(), 0.0);
    EXPECT_NEAR(grid.above_start(), -320.0, 1e-10);  // the far boundary
    EXPECT_DOUBLE_EQ(grid.landscape.y[1] - grid.landscape.y[0], grid.spacing);
  }
}

// Stiff beams and a start below y = 0: the climb out of the basin in front of the beams, measured
// from the start and from the basin itself, which is lower.
TEST(Passes, OfABasinAreToldFromTheStartAndFromTheBasin) {
  GateParams p = test::study(10.0);
  const BodyState start{.x = 1.0, .y = -4.0, .vx = 0.0, .vy = 0.0};
  const Passes found = passes(p, start, 2.0);
  for (const GridPasses& grid : {found.coarse, found.fine}) {
    const Landscape l = landscape(p, -4.0, grid.spacing);
    EXPECT_EQ(grid.landscape.y, l.y);
    EXPECT_FALSE(grid.downhill());
    EXPECT_EQ(grid.from_basin.way.front(), basin_below(l, start.x, start.y));
    EXPECT_EQ(
        grid.from_basin.energy,
        lowest_pass(l, grid.from_basin.way.front()[0], grid.from_basin.way.front()[1]).energy);
    EXPECT_EQ(grid.above_start(), grid.from_basin.energy - grid.from_start.start_energy);
    EXPECT_LT(grid.from_basin.start_energy, grid.from_start.start_energy);
    EXPECT_GT(grid.from_basin.barrier(), grid.above_start());
  }
  EXPECT_LT(found.fine.from_basin.energy, found.coarse.from_basin.energy);
  // One beam alone resists less.
  EXPECT_LT(passes(p, start, 2.0, {true, false}).coarse.from_basin.barrier(),
            found.coarse.from_basin.barrier());
}

TEST(Passes, HaveGridsThatFitTheGate) {
  const GateParams p;  // 50 m wide, 60 m deep
  const Spacings from_inside = spacings_for(p, {}), from_below = spacings_for(p, {.y = -40.0});
  EXPECT_DOUBLE_EQ(from_inside.least, 0.03);
  EXPECT_DOUBLE_EQ(from_below.least, 0.05);
  EXPECT_DOUBLE_EQ(from_inside.usual, 0.5);
  EXPECT_DOUBLE_EQ(from_inside.most, 25.0);
  for (const double spacing : {0.029, 25.1, std::nan("")})
    EXPECT_THROW((void)passes(p, {}, spacing), std::invalid_argument);
}

TEST(Landscape, RefusesWhatIsNoGrid) {
  const GateParams p;
  EXPECT_THROW((void)landscape(p, 0.0, 0.0), std::invalid_argument);
  EXPECT_THROW((void)landscape(p, 60.0, 0.5), std::invalid_argument);
  EXPECT_THROW((void)landscape(p, 0.0, 1e-4), std::invalid_argument);
}

}  // namespace
}  // namespace gatewalk::dynamics
