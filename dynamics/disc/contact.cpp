// SPDX-License-Identifier: MIT
#include "dynamics/disc/contact.h"

#include <limits>

#include "dynamics/base/wide-inl.h"

namespace gatewalk::dynamics {

Direction Direction::of(double theta) {
  if (!(std::abs(theta) < kMostAngle)) return {theta, std::cos(theta), std::sin(theta)};
  const auto [c, s] = HWY_NAMESPACE::direction_of(theta);
  return {theta, c, s};
}

Direction Direction::turned_to(double angle) const {
  const double d = angle - theta;
  if (!(std::abs(d) < kNearby)) return of(angle);
  const auto to = HWY_NAMESPACE::turned_by(d, {c, s});
  return {angle, to.c, to.s};
}

Touch nearest(const GateParams& p, Side side, const BodyState& body, const Direction& beam) {
  // The disc's centre relative to the joint, in the beam's own frame.
  const double px = from_joint(p, side, body.x);
  const double py = body.y - p.beams.joint_y;
  const double c = beam.c, s = beam.s;
  const double along = px * c + py * s;
  Touch t;
  t.beam = beam;
  double nx, ny;
  if (along > 0.0 && along < p.beams.length) {
    const double across = c * py - s * px;  // > 0: the centre is ahead of the beam
    const double sign = across < 0.0 ? -1.0 : 1.0;
    nx = -sign * s;
    ny = sign * c;
    t.kind = ContactKind::interior;
    t.gap = std::abs(across) - p.body.radius;
    t.lever = sign * along;
  } else {
    const double r = along > 0.0 ? p.beams.length : 0.0;  // contact point's distance from the joint
    const double qx = px - r * c, qy = py - r * s;
    const double dist = std::sqrt(qx * qx + qy * qy);
    const bool degenerate = dist < std::numeric_limits<double>::min();
    const double over = 1.0 / dist;
    nx = degenerate ? -s : qx * over;
    ny = degenerate ? c : qy * over;
    t.kind = r > 0.0 ? ContactKind::tip : ContactKind::pin;
    t.gap = dist - p.body.radius;
    t.lever = r * (c * ny - s * nx);
    t.bend = nx * c + ny * s;
  }
  t.nx = side == kLeft ? nx : -nx;
  t.ny = ny;
  return t;
}

double curvature_term(const GateParams& p, Side side, const Touch& t, const BodyState& body,
                      const BeamState& beam) {
  if (t.kind == ContactKind::interior) return 0.0;
  const double nx = side == kLeft ? t.nx : -t.nx;  // into the beam's own frame
  double rx = side == kLeft ? body.vx : -body.vx, ry = body.vy;
  if (t.kind == ContactKind::tip) {
    rx += p.beams.length * beam.omega * t.beam.s;
    ry -= p.beams.length * beam.omega * t.beam.c;
  }
  const double across = rx * t.ny - ry * nx;
  const double dist = t.gap + p.body.radius;
  return dist < std::numeric_limits<double>::min() ? 0.0 : across * across / dist;
}

double gap_rate_bias(const GateParams& p, Side side, const Touch& t, const BodyState& body,
                     const BeamState& beam) {
  const double w = beam.omega;
  if (t.kind == ContactKind::interior) {
    const double vx = side == kLeft ? body.vx : -body.vx;  // into the beam's own frame
    const double nx = side == kLeft ? t.nx : -t.nx;
    const double vy = body.vy, ny = t.ny;
    // n = sign * (-sin, cos), l = sign * r: differentiate u = n.v - l w along the motion.
    const double sign = t.lever < 0.0 ? -1.0 : 1.0;
    const double v_along =
        (sign * ny) * vx - (sign * nx) * vy;  // beam = (cos, sin) = sign*(ny, -nx)
    return -2.0 * sign * w * v_along - w * w * (t.gap + p.body.radius);
  }
  const double centripetal = p.beams.length * w * w * t.bend;
  return curvature_term(p, side, t, body, beam) + (t.kind == ContactKind::tip ? centripetal : 0.0);
}

double free_gap_acceleration(const GateParams& p, Side side, const Touch& t, const GateState& s,
                             double force_x) {
  const double per_mass = 1.0 / p.body.mass, per_inertia = 1.0 / p.beams.inertia();
  const double ax = (force_x - p.forces.drag * s.body.vx) * per_mass;
  const double ay = (p.forces.propulsion - p.forces.drag * s.body.vy) * per_mass;
  const double k = p.beams.stiffness(side);
  const BeamState& beam = s.beams[side];
  const double beta = (-k * beam.theta - p.beams.damping * beam.omega) * per_inertia;
  return (t.nx * ax + t.ny * ay) - t.lever * beta + gap_rate_bias(p, side, t, s.body, beam);
}

Push::Push(const GateParams& p, const std::array<Touch, 2>& t, const std::array<double, 2>& force) {
  const double per_mass = 1.0 / p.body.mass, per_inertia = 1.0 / p.beams.inertia();
  ax = (force[kLeft] * t[kLeft].nx + force[kRight] * t[kRight].nx) * per_mass;
  ay = (force[kLeft] * t[kLeft].ny + force[kRight] * t[kRight].ny) * per_mass;
  for (const Side side : {kLeft, kRight}) beta[side] = -t[side].lever * force[side] * per_inertia;
}

void apply_impulses(const GateParams& p, const std::array<Touch, 2>& touch,
                    const std::array<double, 2>& impulse, GateState& s) {
  const Push by(p, touch, impulse);
  s.body.vx += by.ax;
  s.body.vy += by.ay;
  for (const Side side : {kLeft, kRight}) s.beams[side].omega += by.beta[side];
}

Coupling coupling(const GateParams& p, const std::array<Touch, 2>& touch) {
  const Touch &l = touch[kLeft], &r = touch[kRight];
  const double inertia = p.beams.inertia();
  return {compliance(p.body.mass, inertia, l.lever), compliance(p.body.mass, inertia, r.lever),
          (l.nx * r.nx + l.ny * r.ny) * (1.0 / p.body.mass)};
}

std::array<double, 2> bilateral_impulses(const Coupling& w, const std::array<double, 2>& b,
                                         const std::array<bool, 2>& active) {
  if (active[kLeft] && active[kRight]) {
    // With a = |cross| and s its sign: z = -(b e' + a (b - s b')) / det, where e = w - a and a
    // prime marks the other side. This form has no cancellation if heavy beams make W nearly
    // singular.
    const double s = w.cross < 0.0 ? -1.0 : 1.0, a = s * w.cross;
    const double left = w.left - a, right = w.right - a;
    const double det = left * right + a * (left + right);
    // det > 0 unless both contacts coincide (two pins in one place); then both share the impulse
    // equally.
    if (det <= 1e-14 * (w.left * w.right)) {
      const double z = -(b[kLeft] + b[kRight]) / ((w.left + w.right) + 2.0 * w.cross);
      return {z, z};
    }
    return {-(b[kLeft] * right + a * (b[kLeft] - s * b[kRight])) / det,
            -(b[kRight] * left + a * (b[kRight] - s * b[kLeft])) / det};
  }
  if (active[kLeft]) return {-b[kLeft] / w.left, 0.0};
  if (active[kRight]) return {0.0, -b[kRight] / w.right};
  return {0.0, 0.0};
}

std::array<double, 2> unilateral_impulses(const Coupling& w, const std::array<double, 2>& b,
                                          const std::array<bool, 2>& active) {
  const bool need_left = active[kLeft] && b[kLeft] < 0.0;
  const bool need_right = active[kRight] && b[kRight] < 0.0;
  if (!need_left && !need_right) return {0.0, 0.0};
  // One contact alone, if its impulse leaves the other open.
  if (need_left) {
    const double z = -b[kLeft] / w.left;
    if (!active[kRight] || b[kRight] + w.cross * z >= 0.0) return {z, 0.0};
  }
  if (need_right) {
    const double z = -b[kRight] / w.right;
    if (!active[kLeft] || b[kLeft] + w.cross * z >= 0.0) return {0.0, z};
  }
  const auto z = bilateral_impulses(w, b, {true, true});
  return {std::max(0.0, z[kLeft]), std::max(0.0, z[kRight])};
}

}  // namespace gatewalk::dynamics
