// SPDX-License-Identifier: MIT
// The functions of contact.h and the free motion of hybrid.h in all lanes: the same operations in
// the same order, so every lane has the bits of the plain function of the same name.
#if defined(GATEWALK_DYNAMICS_CONTACT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef GATEWALK_DYNAMICS_CONTACT_INL_H_
#undef GATEWALK_DYNAMICS_CONTACT_INL_H_
#else
#define GATEWALK_DYNAMICS_CONTACT_INL_H_
#endif

#include <limits>

#include "dynamics/disc/flow-inl.h"

HWY_BEFORE_NAMESPACE();
namespace gatewalk::dynamics {
namespace HWY_NAMESPACE {

/// The numbers of a scene, prepared for the lanes.
struct LaneGate {
  double joint_x, joint_y, length, radius, mass, inertia, stiffness[2], damping, propulsion, drag;
  double per_mass, per_inertia;  // 1/M, 1/I
  double acceleration;           // m/s^2, by the propulsion
  explicit LaneGate(const GateParams& p)
      : joint_x(p.beams.joint_x),
        joint_y(p.beams.joint_y),
        length(p.beams.length),
        radius(p.body.radius),
        mass(p.body.mass),
        inertia(p.beams.inertia()),
        stiffness{p.beams.stiffness_left, p.beams.stiffness_right},
        damping(p.beams.damping),
        propulsion(p.forces.propulsion),
        drag(p.forces.drag),
        per_mass(1.0 / mass),
        per_inertia(1.0 / inertia),
        acceleration(propulsion / mass) {}
};

/// The state of a body and N beams: left and right, or one beam whose side differs from lane to
/// lane.
template <int N>
struct StateOf {
  Wide x, y, vx, vy;
  Wide theta[N], omega[N];
  WideMask held[N];

  // Copied number by number: g++ copies the whole block with string instructions, many times
  // slower.
  StateOf() = default;
  HWY_INLINE StateOf(const StateOf& o) { *this = o; }
  HWY_INLINE StateOf& operator=(const StateOf& o) {
    x = o.x;
    y = o.y;
    vx = o.vx;
    vy = o.vy;
    for (int i = 0; i < N; ++i) {
      theta[i] = o.theta[i];
      omega[i] = o.omega[i];
      held[i] = o.held[i];
    }
    return *this;
  }
};
using WideState = StateOf<2>;

HWY_INLINE WideState choose(WideMask m, const WideState& yes, const WideState& no) {
  WideState s;
  s.x = choose(m, yes.x, no.x);
  s.y = choose(m, yes.y, no.y);
  s.vx = choose(m, yes.vx, no.vx);
  s.vy = choose(m, yes.vy, no.vy);
  for (const Side side : {kLeft, kRight}) {
    s.theta[side] = choose(m, yes.theta[side], no.theta[side]);
    s.omega[side] = choose(m, yes.omega[side], no.omega[side]);
    s.held[side] = choose(m, yes.held[side], no.held[side]);
  }
  return s;
}

/// 1 for the left beam, -1 for the right: converts x from the gate's frame to the beam's own.
HWY_INLINE Wide mirror_of(Side side) { return all(side == kLeft ? 1.0 : -1.0); }

HWY_INLINE WideMask nowhere() { return all(1.0) < all(0.0); }
HWY_INLINE WideMask operator^(WideMask x, WideMask y) {
  return {hn::Xor(x.a, y.a), hn::Xor(x.b, y.b)};
}
/// std::max(x, y), with the same bits also for NaN.
HWY_INLINE Wide larger(Wide x, Wide y) { return choose(x < y, y, x); }

struct WideDirection {
  Wide theta;
  Direction2<Wide> to;  // unit vector
};
HWY_INLINE WideDirection towards(Wide theta) { return {theta, direction_of(theta)}; }
HWY_INLINE WideDirection turned_to(const WideDirection& from, Wide theta) {
  const Wide d = theta - from.theta;
  const WideMask nearby = abs(d) < all(Direction::kNearby);
  Direction2<Wide> to = turned_by(d, from.to);
  if (HWY_UNLIKELY(any(~nearby))) {
    const Direction2<Wide> afresh = direction_of(theta);
    to = {choose(nearby, to.c, afresh.c), choose(nearby, to.s, afresh.s)};
  }
  return {theta, to};
}

struct WideTouch {
  WideMask interior, tip;  // neither: the pin
  Wide gap, nx, ny, lever, bend;
  WideDirection beam;
};

/// The part of nearest() that its gap needs.
struct Reach {
  Wide along, across, r, qx, qy, distance;
  WideMask interior;
  Wide gap;
};
HWY_INLINE Reach reach(const LaneGate& g, Wide mirror, Wide x, Wide y,
                       const Direction2<Wide>& beam) {
  const auto [c, s] = beam;
  const Wide px = all(g.joint_x) + mirror * x, py = y - all(g.joint_y);
  const Wide length = all(g.length);
  Reach t;
  t.along = px * c + py * s;
  t.across = c * py - s * px;
  const WideMask beyond_joint = t.along > all(0.0);
  t.interior = beyond_joint & (t.along < length);
  t.r = or_zero(beyond_joint, length);
  t.qx = px - t.r * c;
  t.qy = py - t.r * s;
  t.distance = sqrt(t.qx * t.qx + t.qy * t.qy);
  t.gap = choose(t.interior, abs(t.across), t.distance) - all(g.radius);
  return t;
}
HWY_INLINE void nearest(const LaneGate& g, Wide mirror, Wide x, Wide y, const WideDirection& beam,
                        WideTouch& touch) {
  const auto [c, s] = beam.to;
  const Reach t = reach(g, mirror, x, y, beam.to);
  const WideMask backward = t.across < all(0.0);
  Wide nx = choose(backward, s, -s), ny = choose(backward, -c, c);
  Wide lever = choose(backward, -t.along, t.along), bend = all(0.0);
  if (any(~t.interior)) {
    const WideMask degenerate = t.distance < all(std::numeric_limits<double>::min());
    const Wide over = all(1.0) / t.distance;
    const Wide ex = choose(degenerate, -s, t.qx * over), ey = choose(degenerate, c, t.qy * over);
    nx = choose(t.interior, nx, ex);
    ny = choose(t.interior, ny, ey);
    lever = choose(t.interior, lever, t.r * (c * ey - s * ex));
    bend = choose(t.interior, bend, ex * c + ey * s);
  }
  touch.interior = t.interior;
  touch.tip = ~t.interior & (t.r > all(0.0));
  touch.gap = t.gap;
  touch.nx = mirror * nx;
  touch.ny = ny;
  touch.lever = lever;
  touch.bend = bend;
  touch.beam.theta = beam.theta;
  touch.beam.to.c = c;
  touch.beam.to.s = s;
}
/// nearest() in the wanted lanes, Touch{} in the others.
HWY_INLINE void nearest_wanted(const LaneGate& g, WideMask wanted, Wide mirror, Wide x, Wide y,
                               const WideDirection& beam, WideTouch& t) {
  nearest(g, mirror, x, y, beam, t);
  for (Wide* number : {&t.gap, &t.nx, &t.ny, &t.lever, &t.bend}) *number = or_zero(wanted, *number);
}

HWY_INLINE WideMask out_of_reach(const LaneGate& g, Wide mirror, Wide x, Wide y, Wide theta,
                                 Wide margin) {
  const Wide px = all(g.joint_x) + mirror * x, py = y - all(g.joint_y);
  const Wide radius = all(g.radius) + margin, far = all(g.length) + radius;
  const Wide tip = g.length * theta;
  const WideMask beside = (py + radius < min(all(0.0), tip)) | (py - radius > max(all(0.0), tip));
  return (px * px + py * py > far * far) | (beside & (abs(theta) <= all(3.0)));
}

HWY_INLINE Wide gap_rate(const WideTouch& t, Wide vx, Wide vy, Wide omega) {
  return (t.nx * vx + t.ny * vy) - t.lever * omega;
}

HWY_INLINE Wide gap_rate_bias(const LaneGate& g, Wide mirror, const WideTouch& t, Wide body_vx,
                              Wide vy, Wide w) {
  const Wide vx = mirror * body_vx, nx = mirror * t.nx;
  const WideMask backward = t.lever < all(0.0);
  const Wide v_along = choose(backward, -t.ny, t.ny) * vx - choose(backward, -nx, nx) * vy;
  const Wide distance = t.gap + all(g.radius);
  const Wide twice = choose(backward, all(2.0), all(-2.0));
  Wide bias = twice * w * v_along - w * w * distance;
  if (any(~t.interior)) {
    const Wide tip_speed = g.length * w;
    const Wide rx = choose(t.tip, vx + tip_speed * t.beam.to.s, vx);
    const Wide ry = choose(t.tip, vy - tip_speed * t.beam.to.c, vy);
    const Wide across = rx * t.ny - ry * nx;
    const WideMask degenerate = distance < all(std::numeric_limits<double>::min());
    const Wide curvature = choose(degenerate, all(0.0), across * across / distance);
    bias = choose(t.interior, bias, curvature + or_zero(t.tip, tip_speed * w * t.bend));
  }
  return bias;
}

// Numbers of one contact or of both. With one contact, the other contributes zeros to sums, as in
// the plain code.

template <int N>
struct Each {
  Wide of[N];
};
template <int N>
struct Beams {
  Wide mirror[N], stiffness[N];
};
HWY_INLINE Beams<2> both_beams(const LaneGate& g) {
  return {{mirror_of(kLeft), mirror_of(kRight)},
          {all(g.stiffness[kLeft]), all(g.stiffness[kRight])}};
}

template <int N>
struct WideCoupling {
  Wide own[N], cross;
};
template <int N>
HWY_INLINE WideCoupling<N> coupling(const LaneGate& g, const WideTouch (&t)[N]) {
  WideCoupling<N> w;
  for (int i = 0; i < N; ++i)
    w.own[i] = all(g.per_mass) + t[i].lever * t[i].lever * all(g.per_inertia);
  if constexpr (N == 2) w.cross = (t[0].nx * t[1].nx + t[0].ny * t[1].ny) * all(g.per_mass);
  return w;
}

/// bilateral_impulses() for lanes in which both contacts are active.
HWY_INLINE Each<2> both_impulses(const WideCoupling<2>& w, const Each<2>& b) {
  const Wide sign = choose(w.cross < all(0.0), all(-1.0), all(1.0)), a = sign * w.cross;
  const Wide e[2] = {w.own[0] - a, w.own[1] - a};
  const Wide det = e[0] * e[1] + a * (e[0] + e[1]);
  const WideMask same = det <= 1e-14 * (w.own[0] * w.own[1]);
  Each<2> z;
  for (const int i : {0, 1})
    z.of[i] = -(b.of[i] * e[1 - i] + a * (b.of[i] - sign * b.of[1 - i])) / det;
  if (HWY_UNLIKELY(any(same))) {
    const Wide shared = -(b.of[0] + b.of[1]) / (w.own[0] + w.own[1] + 2.0 * w.cross);
    for (const int i : {0, 1}) z.of[i] = choose(same, shared, z.of[i]);
  }
  return z;
}
template <int N>
HWY_INLINE Each<N> bilateral_impulses(const WideCoupling<N>& w, const Each<N>& b,
                                      const WideMask (&active)[N]) {
  Each<N> z;
  for (int i = 0; i < N; ++i) z.of[i] = or_zero(active[i], -b.of[i] / w.own[i]);
  if constexpr (N == 2) {
    const WideMask both = active[0] & active[1];
    if (any(both)) {
      const Each<2> pair = both_impulses(w, b);
      for (const int i : {0, 1}) z.of[i] = choose(both, pair.of[i], z.of[i]);
    }
  }
  return z;
}
template <int N>
HWY_INLINE Each<N> unilateral_impulses(const WideCoupling<N>& w, const Each<N>& b,
                                       const WideMask (&active)[N]) {
  const Wide zero = all(0.0);
  Each<N> z;
  WideMask need[N], alone[N];
  for (int i = 0; i < N; ++i) {
    need[i] = alone[i] = active[i] & (b.of[i] < zero);
    z.of[i] = -b.of[i] / w.own[i];
  }
  if constexpr (N == 2) {
    for (const int i : {0, 1})
      alone[i] = need[i] & (~active[1 - i] | (b.of[1 - i] + w.cross * z.of[i] >= zero));
    alone[1] = alone[1] & ~alone[0];
  }
  for (int i = 0; i < N; ++i) z.of[i] = or_zero(alone[i], z.of[i]);
  if constexpr (N == 2) {
    const WideMask both = (need[0] | need[1]) & ~(alone[0] | alone[1]);
    if (any(both)) {
      const Each<2> pair = both_impulses(w, b);
      for (const int i : {0, 1}) z.of[i] = choose(both, larger(zero, pair.of[i]), z.of[i]);
    }
  }
  return z;
}

/// contact_forces() with unilateral_impulses; touches that are not `active` must be Touch{}.
template <int N>
HWY_INLINE Each<N> contact_forces(const LaneGate& g, const Beams<N>& beams, const StateOf<N>& s,
                                  const WideTouch (&touch)[N], Wide force_x,
                                  const WideMask (&active)[N]) {
  const Wide per_mass = all(g.per_mass), per_inertia = all(g.per_inertia);
  const Wide ax = (force_x - g.drag * s.vx) * per_mass;
  const Wide ay = (all(g.propulsion) - g.drag * s.vy) * per_mass;
  Each<N> b;
  for (int i = 0; i < N; ++i) {
    const WideTouch& t = touch[i];
    const Wide omega = s.omega[i];
    const Wide beta = (-beams.stiffness[i] * s.theta[i] - g.damping * omega) * per_inertia;
    const Wide own = (t.nx * ax + t.ny * ay) - t.lever * beta;
    const Wide bias = gap_rate_bias(g, beams.mirror[i], t, s.vx, s.vy, omega);
    b.of[i] = or_zero(active[i], own + bias);
  }
  return unilateral_impulses(coupling(g, touch), b, active);
}

template <int N>
struct WidePush {
  Wide ax, ay, beta[N];
};
template <int N>
HWY_INLINE WidePush<N> push(const LaneGate& g, const WideTouch (&t)[N], const Each<N>& force) {
  const Wide per_mass = all(g.per_mass), per_inertia = all(g.per_inertia);
  const Wide& f = force.of[0];
  WidePush<N> a;
  if constexpr (N == 2) {
    a.ax = (f * t[0].nx + force.of[1] * t[1].nx) * per_mass;
    a.ay = (f * t[0].ny + force.of[1] * t[1].ny) * per_mass;
  } else {
    a.ax = (f * t[0].nx + all(0.0)) * per_mass;
    a.ay = (f * t[0].ny + all(0.0)) * per_mass;
  }
  for (int i = 0; i < N; ++i) a.beta[i] = -t[i].lever * force.of[i] * per_inertia;
  return a;
}

template <int N>
struct FlowOf {
  BodyFlowOf<Wide> body;
  BeamFlowOf<Wide> beams[N];
};
using WideFlow = FlowOf<2>;

template <int N>
HWY_INLINE void fly(const BodyFlowOf<Wide>& flow, Wide ax, Wide ay, StateOf<N>& s) {
  s.x = s.x + (flow.rise * s.vx + flow.fall * ax);
  s.y = s.y + (flow.rise * s.vy + flow.fall * ay);
  s.vx = flow.decay * s.vx + flow.rise * ax;
  s.vy = flow.decay * s.vy + flow.rise * ay;
}
HWY_INLINE void fly(const BeamFlowOf<Wide>& flow, Wide a, Wide& theta, Wide& omega) {
  const Wide turned = flow.tt * theta + flow.tw * omega + flow.ta * a;
  omega = flow.wt * theta + flow.ww * omega + flow.wa * a;
  theta = turned;
}
template <int N>
HWY_INLINE void fly(const LaneGate& g, const FlowOf<N>& flow, Wide force_x, const WidePush<N>& by,
                    StateOf<N>& s) {
  fly(flow.body, force_x / all(g.mass) + by.ax, all(g.acceleration) + by.ay, s);
  for (int i = 0; i < N; ++i) fly(flow.beams[i], by.beta[i], s.theta[i], s.omega[i]);
}

}  // namespace HWY_NAMESPACE
}  // namespace gatewalk::dynamics
HWY_AFTER_NAMESPACE();

#endif
