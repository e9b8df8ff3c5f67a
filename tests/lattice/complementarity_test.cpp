// SPDX-License-Identifier: MIT
#include "lattice/gates/complementarity.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "dynamics/disc/contact.h"
#include "tests/support/numbers.h"

namespace gatewalk::lattice {
namespace {

using test::Draw;

struct Contacts {
  Eigen::MatrixXd w;
  Eigen::VectorXd b;
};

/// Contacts as a disc has them: W = N N^T / M + diag(l^2 / I), b from velocities of disc and beams,
/// so that a solution exists with any pins.
Contacts contacts(Draw& draw, int n, bool with_pins) {
  const double mass = draw.log_uniform(0.1, 10.0), inertia = draw.log_uniform(1.0, 100.0);
  const double vx = draw.uniform(-20, 20), vy = draw.uniform(-20, 20);
  Eigen::MatrixXd normals(n, 2);
  Contacts p{Eigen::MatrixXd(n, n), Eigen::VectorXd(n)};
  Eigen::VectorXd own(n);
  for (int i = 0; i < n; ++i) {
    const double angle = draw.uniform(0.0, 2.0 * std::numbers::pi);
    normals.row(i) << std::cos(angle), std::sin(angle);
    const bool pin = with_pins && draw.coin();
    // At the same place.
    if (pin && i > 0 && draw.coin()) normals.row(i) = normals.row(draw.below(i));
    const double lever = pin ? 0.0 : draw.sign() * draw.log_uniform(1e-3, 25.0);
    own[i] = lever * lever / inertia;
    p.b[i] =
        1.8 * (normals(i, 0) * vx + normals(i, 1) * vy - lever * (pin ? 0.0 : draw.uniform(-3, 3)));
  }
  p.w = normals * normals.transpose() / mass;
  p.w.diagonal() += own;
  return p;
}

/// Tries every set of contacts, and returns the first solution that fulfils all conditions: plain
/// and slow.
Eigen::VectorXd by_enumeration(const Contacts& p) {
  const auto n = static_cast<int>(p.b.size());
  const double scale = p.b.cwiseAbs().maxCoeff();
  for (int set = 0; set < (1 << n); ++set) {
    std::vector<int> in;
    for (int i = 0; i < n; ++i)
      if (set >> i & 1) in.push_back(i);
    const auto m = static_cast<Eigen::Index>(in.size());
    Eigen::MatrixXd w(m, m);
    Eigen::VectorXd b(m);
    for (Eigen::Index i = 0; i < m; ++i) {
      b[i] = p.b[in[i]];
      for (Eigen::Index j = 0; j < m; ++j) w(i, j) = p.w(in[i], in[j]);
    }
    Eigen::VectorXd z = Eigen::VectorXd::Zero(n);
    if (m > 0) {  // an empty matrix has no decomposition
      const Eigen::FullPivLU<Eigen::MatrixXd> lu(w);
      if (!lu.isInvertible()) continue;
      const Eigen::VectorXd part = lu.solve(-b);
      for (Eigen::Index i = 0; i < m; ++i) z[in[i]] = part[i];
    }
    const Eigen::VectorXd after = p.w * z + p.b;
    if (z.minCoeff() >= 0.0 && after.minCoeff() >= -1e-9 * scale) return z;
  }
  ADD_FAILURE() << "no set of contacts does";
  return Eigen::VectorXd::Zero(n);
}

// W = I + ones/2 and b = (-1, -1, 1): with the first two contacts, 1.5 z + 0.5 z = 1, z = 1/2; the
// third then opens at 1 + 1/2.
TEST(PushOnly, ThreeByHand) {
  Eigen::MatrixXd w = Eigen::MatrixXd::Identity(3, 3) + Eigen::MatrixXd::Constant(3, 3, 0.5);
  const Eigen::VectorXd z = solve_lcp(w, Eigen::Vector3d(-1, -1, 1));
  EXPECT_NEAR(z[0], 0.5, 4 * test::kEps);
  EXPECT_NEAR(z[1], 0.5, 4 * test::kEps);
  EXPECT_EQ(z[2], 0.0);
  EXPECT_EQ(solve_lcp(w, Eigen::Vector3d(1, 0, 2)), Eigen::Vector3d::Zero());
  EXPECT_EQ(solve_lcp(Eigen::MatrixXd(0, 0), Eigen::VectorXd(0)).size(), 0);
}

// The fastest closing contact joins first and must leave again: alone it is no obstacle, but the
// two others push the body away from it.
TEST(PushOnly, AContactMayHaveToLeave) {
  Eigen::MatrixXd normals(3, 2);
  normals << 0.0, 1.0, 0.8, 0.6, -0.8, 0.6;
  const Eigen::MatrixXd w = normals * normals.transpose() + 0.01 * Eigen::MatrixXd::Identity(3, 3);
  const Eigen::Vector3d b(-1.0, -0.99, -0.99);
  const Eigen::VectorXd z = solve_lcp(w, b);
  EXPECT_EQ(z[0], 0.0);
  EXPECT_GT(z[1], 0.0);
  EXPECT_DOUBLE_EQ(z[1], z[2]);
  EXPECT_GT((w * z + b)[0], 0.0);
}

TEST(PushOnly, OneAndTwoAreThoseOfTheGate) {
  Draw draw(1);
  for (int run = 0; run < 2000; ++run) {
    const Contacts p = contacts(draw, 1 + run % 2, false);
    const bool two = run % 2 == 1;
    const auto gate =
        dynamics::unilateral_impulses({p.w(0, 0), two ? p.w(1, 1) : 1.0, two ? p.w(0, 1) : 0.0},
                                      {p.b[0], two ? p.b[1] : 0.0}, {true, two});
    const Eigen::VectorXd z = solve_lcp(p.w, p.b);
    EXPECT_EQ(z[0], gate[0]);
    if (two) {
      EXPECT_EQ(z[1], gate[1]);
    }
  }
}

// Second route, also with several pins at one place, where impulses are not unique but rates are.
TEST(PushOnly, AgreesWithEnumeration) {
  Draw draw(2);
  int many = 0;
  for (int run = 0; run < 6000; ++run) {
    const int n = 3 + run % 5;
    const Contacts p = contacts(draw, n, run % 3 == 0);
    const Eigen::VectorXd z = solve_lcp(p.w, p.b), slow = by_enumeration(p);
    const Eigen::VectorXd after = p.w * z + p.b;
    const double scale = p.b.cwiseAbs().maxCoeff();
    // unilateral_impulses ignores contacts that close more slowly than 1e-12 of the fastest;
    // solving W z = -b by Cholesky leaves a residual of about n eps |W| |z|.
    const double rounding =
        1.01e-12 * scale + 20 * n * test::kEps * (p.w.cwiseAbs() * z).maxCoeff();
    EXPECT_GE(z.minCoeff(), 0.0);
    EXPECT_GE(after.minCoeff(), -rounding) << run;
    for (int i = 0; i < n; ++i) {
      if (z[i] > 0.0) {
        EXPECT_NEAR(after[i], 0.0, rounding) << run;
      }
    }
    EXPECT_LT((after - (p.w * slow + p.b)).cwiseAbs().maxCoeff(), 1e-8 * scale) << run;
    many += (z.array() > 0.0).count() >= 3;
  }
  EXPECT_GT(many, 500);
}

// Eight equal pins at one place act as one.
TEST(PushOnly, PinsInOnePlaceActAsOne) {
  const Eigen::MatrixXd w = Eigen::MatrixXd::Constant(8, 8, 2.0);
  const Eigen::VectorXd z = solve_lcp(w, Eigen::VectorXd::Constant(8, -3.0));
  EXPECT_DOUBLE_EQ(z.sum(), 1.5);
}

}  // namespace
}  // namespace gatewalk::lattice
