// SPDX-License-Identifier: MIT
#pragma once
/// Contact of a disc with a hinged beam, as pure functions of the state: where they touch, what an
/// impact does, and which forces keep a contact closed.
///
/// Each beam is described in its own frame: joint at the origin, x towards the gate's middle, y
/// forward, theta > 0 deflected forward. The right beam's frame is the mirror image of the left's.
/// `nearest` does the mirroring, so a mirrored scene gives mirrored results to the last bit.
///
/// Every contact has the same form. With n the unit vector from contact point to disc centre and
/// lever l = r_c x n (r_c from joint to contact point), the gap changes at the rate
///     u = n.v - l omega                                              (m/s, < 0 while closing)
/// and an impulse J along n changes u by J (1/M + l^2/I). Eqs. (4)-(5) are the case l = -+r, Eqs.
/// (6)-(9) the case e = 1, and a joint pin the case l = 0.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "dynamics/disc/params.h"

namespace gatewalk::dynamics {

struct BeamState {
  double theta = 0.0;  // rad, > 0 deflected forward
  double omega = 0.0;  // rad/s
  bool held = false;   // the contact is a constraint (Sec. II-B, "constraint method")
};

struct GateState {
  BodyState body;
  std::array<BeamState, 2> beams;  // left, right
};

enum class ContactKind : std::uint8_t { interior, tip, pin };

/// The direction of a beam in its own frame: the unit vector (c, s) = (cos theta, sin theta).
struct Direction {
  double theta = 0.0;  // rad
  double c = 1.0, s = 0.0;
  /// The direction of angle theta (rad), by the arithmetic of the vector lanes (wide-inl.h); by the
  /// C library beyond kMostAngle.
  [[nodiscard]] static Direction of(double theta);
  static constexpr double kMostAngle = 1e6;  // rad
  static constexpr double kNearby = 0.0625;  // rad
  /// The direction of another angle (rad). Within kNearby it needs no trigonometry and is exact to
  /// the last digits.
  [[nodiscard]] Direction turned_to(double angle) const;
};

/// The contact point: the point of a beam nearest to the disc's centre.
struct Touch {
  ContactKind kind = ContactKind::interior;
  double gap = 0.0;  // m, distance from centre to contact point, less R; < 0: penetration
  double nx = 0.0;   // unit vector from contact point to centre, gate's frame
  double ny = 0.0;
  double lever = 0.0;  // m, r_c x n in the beam's own frame
  double bend = 0.0;   // n.(unit vector along the beam); 0 on the interior
  Direction beam;
};

/// The point of the segment from joint to tip nearest to the disc's centre. If their distance is
/// below the smallest normal number, n is the beam's own normal.
[[nodiscard]] Touch nearest(const GateParams& p, Side side, const BodyState& body,
                            const Direction& beam);
[[nodiscard]] inline Touch nearest(const GateParams& p, Side side, const BodyState& body,
                                   double theta) {
  return nearest(p, side, body, Direction::of(theta));
}

/// The distance (m) of `x` from the joint towards the tip of a resting beam.
[[nodiscard]] inline double from_joint(const GateParams& p, Side side, double x) {
  return side == kLeft ? x + p.beams.joint_x : p.beams.joint_x - x;
}

/// Whether the disc is certainly out of the beam's reach, even if its radius were larger by
/// `margin` (m). Needs no trigonometry.
[[nodiscard]] inline bool out_of_reach(const GateParams& p, Side side, const BodyState& body,
                                       double theta, double margin = 0.0) {
  const double px = from_joint(p, side, body.x);
  const double py = body.y - p.beams.joint_y;
  const double radius = p.body.radius + margin;
  const double reach = p.beams.length + radius;
  if (px * px + py * py > reach * reach) return true;
  if (std::abs(theta) > 3.0) return false;  // the bounds below need a sin(theta) of constant sign
  return py + radius < std::min(0.0, p.beams.length * theta) ||
         py - radius > std::max(0.0, p.beams.length * theta);
}

/// Rate of the gap (m/s): u = n.v - l omega.
[[nodiscard]] inline double gap_rate(const Touch& t, const BodyState& b, const BeamState& beam) {
  const double nv = t.nx * b.vx + t.ny * b.vy;
  return nv - t.lever * beam.omega;
}

/// The part of du/dt (m/s^2) from motion around a tip or pin: the squared velocity across n,
/// relative to the contact point, divided by the distance; 0 on the interior.
[[nodiscard]] double curvature_term(const GateParams& p, Side side, const Touch& t,
                                    const BodyState& body, const BeamState& beam);

/// The part of du/dt (m/s^2) from velocities rather than accelerations: Eq. (11) (interior) and Eq.
/// (13) (tip) without their a_x, a_y and beta terms; for a pin, motion on a circle of radius R.
[[nodiscard]] double gap_rate_bias(const GateParams& p, Side side, const Touch& t,
                                   const BodyState& body, const BeamState& beam);

/// Inverse effective mass (1/kg) of one contact: 1/M + l^2/I.
[[nodiscard]] inline double compliance(double mass, double inertia, double lever) {
  return 1.0 / mass + lever * lever * (1.0 / inertia);
}

/// Impulse (N s) of a single hit with restitution e: J = -(1+e) u / (1/M + l^2/I). Solves momentum
/// Eq. (4) with restitution Eq. (5), and Eqs. (6)-(9) for e = 1. In the limits I -> inf (a wall)
/// and l -> 0 (the joint pin), J = -(1+e) M u.
[[nodiscard]] inline double impact_impulse(double mass, double inertia, double lever, double u,
                                           double restitution) {
  return -(1.0 + restitution) * u / compliance(mass, inertia, lever);
}

/// The accelerations of body and beams by contact forces (N, along each touch's n). Given impulses,
/// the numbers are velocity changes; given shifts along n (kg m), they are shifts.
struct Push {
  double ax = 0.0, ay = 0.0;             // m/s^2
  std::array<double, 2> beta{0.0, 0.0};  // rad/s^2
  Push() = default;
  Push(const GateParams& p, const std::array<Touch, 2>& t, const std::array<double, 2>& force);
};

/// Applies impulses J (N s, along each touch's n) to the velocities, both beams at once, in an
/// order that a mirror image does not change.
void apply_impulses(const GateParams& p, const std::array<Touch, 2>& touch,
                    const std::array<double, 2>& impulse, GateState& s);

/// The symmetric 2 x 2 matrix W of both contacts: du = W J. The diagonal is 1/M + l^2/I, the
/// off-diagonal n_L.n_R / M.
struct Coupling {
  double left = 0.0, right = 0.0, cross = 0.0;  // 1/kg
};
[[nodiscard]] Coupling coupling(const GateParams& p, const std::array<Touch, 2>& touch);

/// Change of the kinetic energy (J) by impulses J (N s) at both contacts, from the gap rates u
/// before: J.u + J.W J / 2. For a single hit it equals -(1 - e^2)/2 u^2 / (1/M + l^2/I).
[[nodiscard]] inline double energy_gain(const Coupling& w, const std::array<double, 2>& u,
                                        const std::array<double, 2>& impulse) {
  const auto [l, r] = impulse;
  return l * (u[kLeft] + 0.5 * w.left * l) + r * (u[kRight] + 0.5 * w.right * r) +
         w.cross * (l * r);
}

/// Solves z >= 0, W z + b >= 0, z.(W z + b) = 0 over the contacts marked `active` (others: z = 0).
/// W is positive definite, so the solution is unique; cases find it, because W is 2 x 2.
[[nodiscard]] std::array<double, 2> unilateral_impulses(const Coupling& w,
                                                        const std::array<double, 2>& b,
                                                        const std::array<bool, 2>& active);

/// Solves W z = -b over the contacts marked `active` (others: z = 0); z may have either sign.
[[nodiscard]] std::array<double, 2> bilateral_impulses(const Coupling& w,
                                                       const std::array<double, 2>& b,
                                                       const std::array<bool, 2>& active);

/// Second derivative of the gap (m/s^2) without contact forces: Newton's law Eqs. (2), (3) inserted
/// in Eq. (11) or (13).
[[nodiscard]] double free_gap_acceleration(const GateParams& p, Side side, const Touch& t,
                                           const GateState& s, double force_x);

/// Contact forces (N, along n) that keep the `active` contacts from closing: Newton's law Eqs. (2),
/// (3) with the constraint Eq. (11) or (13). `solve` is unilateral_impulses or bilateral_impulses.
template <class Solve>
[[nodiscard]] std::array<double, 2> contact_forces(const GateParams& p, const GateState& s,
                                                   const std::array<Touch, 2>& touch,
                                                   double force_x,
                                                   const std::array<bool, 2>& active, Solve solve) {
  std::array<double, 2> b{};
  for (const Side side : {kLeft, kRight})
    if (active[side]) b[side] = free_gap_acceleration(p, side, touch[side], s, force_x);
  return solve(coupling(p, touch), b, active);
}

}  // namespace gatewalk::dynamics
