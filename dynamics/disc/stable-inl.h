// SPDX-License-Identifier: MIT
// The glides, hits and impacts of `stable` in all lanes: the same operations in the same order as
// in methods/stable.cpp and methods/hybrid.{h,cpp}, so every lane has the bits of the plain method.
// Rare cases are left to the plain method: `failed` lanes have no result here.
#if defined(GATEWALK_DYNAMICS_STABLE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef GATEWALK_DYNAMICS_STABLE_INL_H_
#undef GATEWALK_DYNAMICS_STABLE_INL_H_
#else
#define GATEWALK_DYNAMICS_STABLE_INL_H_
#endif

#include <algorithm>

#include "dynamics/disc/contact-inl.h"
#include "dynamics/disc/methods/stable.h"

HWY_BEFORE_NAMESPACE();
namespace gatewalk::dynamics {
namespace HWY_NAMESPACE {

struct StableRules {
  LaneGate gate;
  bool equal_beams;
  const StableMethod& method;
  const StableMethod::Limits& limits;
  double step, traverse_y, restitution, tip_restitution;
  StableRules(const GateParams& p, const StableMethod& m)
      : gate(p),
        equal_beams(p.beams.stiffness_left == p.beams.stiffness_right),
        method(m),
        limits(m.limits()),
        step(p.run.step),
        traverse_y(p.run.traverse_y),
        restitution(p.contact.restitution),
        tip_restitution(p.contact.tip_restitution) {}
};

/// The lanes where flow_over() has the plain method's flow over any time up to dt (s).
HWY_INLINE WideMask in_series(const StableRules& r, Wide dt) {
  const GateLaw& law = r.method.law();
  return (law.drag * dt < all(BodyFlow::kSeries)) &
         (law.beams[kLeft].rate * dt < all(BeamLaw::kSeries)) &
         (law.beams[kRight].rate * dt < all(BeamLaw::kSeries));
}
HWY_INLINE WideFlow flow_over(const StableRules& r, Wide dt) {
  const GateLaw& law = r.method.law();
  const BeamFlowOf<Wide> left = beam_series(law.beams[kLeft], dt);
  return {body_series(law.drag, dt),
          {left, r.equal_beams ? left : beam_series(law.beams[kRight], dt)}};
}

HWY_INLINE WideMask outside(const StableRules& r, Wide x, Wide y) {
  const Wide joint = all(r.gate.joint_x);
  return (y > all(r.traverse_y)) | (x < -joint) | (x > joint);
}

template <int N>
HWY_INLINE void touches(const LaneGate& g, const Beams<N>& beams, const StateOf<N>& s,
                        const WideMask (&which)[N], const WideTouch (&nearby)[N],
                        WideTouch (&t)[N]) {
  for (int i = 0; i < N; ++i)
    nearest_wanted(g, which[i], beams.mirror[i], s.x, s.y, turned_to(nearby[i].beam, s.theta[i]),
                   t[i]);
}

template <int N>
HWY_INLINE Each<N> gap_rates(const StateOf<N>& s, const WideTouch (&t)[N]) {
  Each<N> u;
  for (int i = 0; i < N; ++i) u.of[i] = gap_rate(t[i], s.vx, s.vy, s.omega[i]);
  return u;
}

template <int N>
HWY_INLINE void apply_impulses(const LaneGate& g, WideMask where, const WideTouch (&t)[N],
                               const Each<N>& impulse, StateOf<N>& s) {
  const WidePush<N> by = push(g, t, impulse);
  s.vx = choose(where, s.vx + by.ax, s.vx);
  s.vy = choose(where, s.vy + by.ay, s.vy);
  for (int i = 0; i < N; ++i) s.omega[i] = choose(where, s.omega[i] + by.beta[i], s.omega[i]);
}

/// Projects `contacts` back onto their constraints. `touch` holds the contact points before, and
/// then after.
template <int N>
HWY_INLINE void put_back(const StableRules& r, const Beams<N>& beams, StateOf<N>& s,
                         const WideMask (&contacts)[N], WideTouch (&touch)[N]) {
  const LaneGate& g = r.gate;
  WideMask some = contacts[0];
  if constexpr (N == 2) some = some | contacts[1];
  const Wide near = all(1e-13 * g.radius);
  WideMask off = some;
  for (int iteration = 0; iteration < 12; ++iteration) {
    Each<N> gap;
    for (int i = 0; i < N; ++i) gap.of[i] = or_zero(contacts[i], touch[i].gap);
    Wide widest = abs(gap.of[0]);
    if constexpr (N == 2) widest = larger(widest, abs(gap.of[1]));
    off = off & (widest > near);
    if (!any(off)) break;
    const WidePush<N> by = push(g, touch, bilateral_impulses(coupling(g, touch), gap, contacts));
    s.x = choose(off, s.x + by.ax, s.x);
    s.y = choose(off, s.y + by.ay, s.y);
    for (int i = 0; i < N; ++i) s.theta[i] = choose(off, s.theta[i] + by.beta[i], s.theta[i]);
    WideTouch moved[N];
    touches(g, beams, s, contacts, touch, moved);
    for (int i = 0; i < N; ++i) {
      const WideTouch& m = moved[i];
      WideTouch& t = touch[i];
      t.gap = choose(off, m.gap, t.gap);
      t.nx = choose(off, m.nx, t.nx);
      t.ny = choose(off, m.ny, t.ny);
      t.lever = choose(off, m.lever, t.lever);
      t.beam.theta = m.beam.theta;
      t.beam.to.c = m.beam.to.c;
      t.beam.to.s = m.beam.to.s;
    }
  }
  const Each<N> rate = gap_rates(s, touch);
  apply_impulses(g, some, touch, bilateral_impulses(coupling(g, touch), rate, contacts), s);
}

/// Motion with held contacts. Returns the lanes with a handover; `gap` receives the gaps of the
/// contacts that are still held.
template <int N>
HWY_NOINLINE WideMask glide_held(const StableRules& r, const Beams<N>& beams, Wide force_x,
                                 const FlowOf<N>& flow, const FlowOf<N>& half_flow, StateOf<N>& s,
                                 Each<N>& gap) {
  const LaneGate& g = r.gate;
  WideMask held[N];
  WideTouch start[N], middle[N], end[N];
  for (int i = 0; i < N; ++i) {
    held[i] = s.held[i];
    nearest_wanted(g, held[i], beams.mirror[i], s.x, s.y, towards(s.theta[i]), start[i]);
  }
  StateOf<N> mid = s;
  fly(g, half_flow, force_x, push(g, start, contact_forces(g, beams, s, start, force_x, held)),
      mid);
  touches(g, beams, mid, held, start, middle);
  const Each<N> force = contact_forces(g, beams, mid, middle, force_x, held);
  fly(g, flow, force_x, push(g, middle, force), s);

  touches(g, beams, s, held, middle, end);
  WideMask handover = nowhere();
  for (int i = 0; i < N; ++i) {
    s.held[i] = held[i] & ~((force.of[i] == all(0.0)) & (end[i].gap >= all(0.0)));
    const auto differs = [&](const WideTouch& t) HWY_ATTR {
      return (t.interior ^ start[i].interior) | (t.tip ^ start[i].tip);
    };
    handover = handover | (held[i] & (differs(middle[i]) | differs(end[i])));
  }
  put_back(r, beams, s, s.held, end);
  for (int i = 0; i < N; ++i) gap.of[i] = end[i].gap;
  return handover;
}

struct Glided {
  WideMask handover;
  WideMask left;  // the only held contact is the left one
  Each<2> gap;    // of the held contacts
};

HWY_INLINE Glided no_contacts() { return {nowhere(), nowhere(), {all(0.0), all(0.0)}}; }

/// Motion without new hits of lanes with N held contacts each.
template <int N>
HWY_INLINE Glided glide(const StableRules& r, Wide force_x, const WideFlow& flow,
                        const WideFlow& half_flow, WideState& s) {
  Glided done;
  done.left = s.held[kLeft];
  if constexpr (N == 2) {
    done.handover = glide_held(r, both_beams(r.gate), force_x, flow, half_flow, s, done.gap);
  } else {
    // The held beam moves with the body, whichever side it is on; the other beam flies.
    const WideMask left = done.left;
    const auto of = [&](const Wide(&x)[2]) HWY_ATTR { return choose(left, x[kLeft], x[kRight]); };
    const auto one_of = [&](const WideFlow& f) HWY_ATTR {
      FlowOf<1> one{f.body, {f.beams[kLeft]}};
      if (!r.equal_beams) {
        const BeamFlowOf<Wide>&l = f.beams[kLeft], &right = f.beams[kRight];
        one.beams[0] = {choose(left, l.tt, right.tt), choose(left, l.tw, right.tw),
                        choose(left, l.wt, right.wt), choose(left, l.ww, right.ww),
                        choose(left, l.ta, right.ta), choose(left, l.wa, right.wa)};
      }
      return one;
    };
    const Beams<2> both = both_beams(r.gate);
    const Beams<1> beam{{of(both.mirror)}, {of(both.stiffness)}};
    StateOf<1> one;
    one.x = s.x;
    one.y = s.y;
    one.vx = s.vx;
    one.vy = s.vy;
    one.theta[0] = of(s.theta);
    one.omega[0] = of(s.omega);
    one.held[0] = s.held[kLeft] | s.held[kRight];
    Each<1> gap;
    done.handover = glide_held(r, beam, force_x, one_of(flow), one_of(half_flow), one, gap);
    s.x = one.x;
    s.y = one.y;
    s.vx = one.vx;
    s.vy = one.vy;
    for (const Side side : {kLeft, kRight}) {
      const WideMask own = s.held[side];
      fly(flow.beams[side], all(-0.0), s.theta[side], s.omega[side]);
      s.theta[side] = choose(own, one.theta[0], s.theta[side]);
      s.omega[side] = choose(own, one.omega[0], s.omega[side]);
      s.held[side] = own & one.held[0];
      done.gap.of[side] = gap.of[0];
    }
  }
  return done;
}
/// Motion without new hits over any dt within the series. In lanes where the plain method uses its
/// flow `kept`, the zeros of no push are added as there.
template <int N>
HWY_INLINE Glided glide(const StableRules& r, Wide force_x, Wide dt, WideMask kept, WideState& s) {
  const WideFlow flow = flow_over(r, dt);
  if constexpr (N > 0) return glide<N>(r, force_x, flow, flow_over(r, 0.5 * dt), s);
  const Wide ax = force_x / all(r.gate.mass);
  fly(flow.body, choose(kept, ax + all(0.0), ax), all(r.gate.acceleration), s);
  for (const Side side : {kLeft, kRight}) {
    Wide theta = s.theta[side], omega = s.omega[side];
    const WideMask at_rest = (theta == all(0.0)) & (omega == all(0.0)) & ~kept;
    fly(flow.beams[side], all(0.0), theta, omega);
    s.theta[side] = choose(at_rest, s.theta[side], theta);
    s.omega[side] = choose(at_rest, s.omega[side], omega);
  }
  return no_contacts();
}

/// The end of a piece.
struct Arrival {
  WideMask hit[2];
  Wide overlap;   // m
  WideMask lost;  // outside the gate, or not finite
};
template <int N>
HWY_INLINE Arrival arrive(const StableRules& r, const WideState& end, const Glided& glided) {
  Arrival a;
  a.overlap = all(0.0);
  // With one held contact, its beam comes first, because it is seldom free now.
  const WideMask in_order = N == 1 ? glided.left : ~nowhere();
  WideMask hit[2];
  for (const int i : {0, 1}) {
    const auto of = [&](auto left, auto right) HWY_ATTR {
      return N == 1 ? choose(in_order, i == 0 ? left : right, i == 0 ? right : left)
                    : (i == 0 ? left : right);
    };
    const Wide mirror = of(mirror_of(kLeft), mirror_of(kRight));
    const Wide theta = of(end.theta[kLeft], end.theta[kRight]);
    WideMask looked = ~out_of_reach(r.gate, mirror, end.x, end.y, theta, all(0.0)), free = looked;
    Wide gap = all(0.0);
    if constexpr (N > 0) {
      const WideMask held = of(end.held[kLeft], end.held[kRight]);
      looked = looked | held;
      free = free & ~held;
      gap = glided.gap.of[i];
    }
    if (any(free))
      gap = choose(free, reach(r.gate, mirror, end.x, end.y, direction_of(theta)).gap, gap);
    hit[i] = free & (gap < all(-r.limits.touching));
    a.overlap = choose(looked, larger(a.overlap, -gap), a.overlap);
  }
  for (const Side side : {kLeft, kRight}) a.hit[side] = choose(in_order, hit[side], hit[1 - side]);
  // Direction::of uses the C library beyond kMostAngle.
  const Wide most = all(Direction::kMostAngle);
  const Wide sum = (end.x + end.y) + (end.vx + end.vy) + (end.omega[kLeft] + end.omega[kRight]);
  a.lost = outside(r, end.x, end.y) | ~finite(sum) |
           ~((abs(end.theta[kLeft]) < most) & (abs(end.theta[kRight]) < most));
  return a;
}

HWY_INLINE WideMask too_far(const StableRules& r, const WideState& s, Wide dt) {
  const LaneGate& g = r.gate;
  const Wide most = all(0.5 * g.radius);
  Wide turns = all(0.0);
  for (const Side side : {kLeft, kRight})
    turns = larger(turns, abs(s.omega[side]) + r.limits.swing_root[side] * abs(s.theta[side]));
  const WideMask near = (abs(s.vx) + abs(s.vy) + g.length * turns) * dt <= most;
  if (!any(~near)) return ~near;
  const Wide disc = sqrt(s.vx * s.vx + s.vy * s.vy) * dt;
  WideMask far = disc > most;
  for (const Side side : {kLeft, kRight}) {
    const Wide theta = s.theta[side], omega = s.omega[side];
    const Wide turn = sqrt(omega * omega + r.limits.swing[side] * theta * theta);
    const Wide tip = g.length * turn * dt, way = disc + tip;
    far = far | ((way > most) & ~out_of_reach(g, mirror_of(side), s.x, s.y, theta, way));
  }
  return ~near & far;
}

/// 2^-n.
HWY_INLINE Wide halving(Wide n) {
  Wide power = all(1.0);
  for (int i = 0; i < StableMethod::kMaxHalvings; ++i) {
    const WideMask more = n > all(i);
    if (!any(more)) break;
    power = choose(more, 0.5 * power, power);
  }
  return power;
}

/// StableMethod::level as far as it depends on the beams and on the place in the step. `plain`
/// marks lanes where it may be larger, because something turns or moves too far.
HWY_INLINE Wide level_of(const StableRules& r, const WideState& s, Wide step, Wide unit,
                         WideMask& plain) {
  const auto& halvings = r.limits.halvings;
  Wide level = all(0.0), turning = all(0.0);
  for (const Side side : {kLeft, kRight})
    turning = larger(turning, or_zero(s.held[side], abs(s.omega[side])));
  plain = plain | (r.step * turning > all(StableMethod::kMaxTurn));
  if (halvings[kLeft] + halvings[kRight] > 0) {
    const Wide speed = sqrt(s.vx * s.vx + s.vy * s.vy);
    for (const Side side : {kLeft, kRight}) {
      const Wide theta = s.theta[side], omega = s.omega[side];
      const Wide turn = sqrt(omega * omega + r.limits.swing[side] * theta * theta);
      const Wide approach = r.step * (speed + r.gate.length * turn);
      const WideMask near = ~out_of_reach(r.gate, mirror_of(side), s.x, s.y, theta, approach);
      level = max(level, or_zero(s.held[side] | near, all(halvings[side])));
    }
  }
  if (any(unit > all(0.0))) {  // a piece begins at a multiple of its own length
    Wide pieces = 1.0 / StableMethod::kUnits * unit;
    for (int n = 0; n < StableMethod::kMaxHalvings; ++n) {
      const WideMask astride = (level == all(n)) & ~(pieces == rounded(pieces));
      level = choose(astride, all(n + 1), level);
      pieces = pieces + pieces;
    }
  }
  plain = plain | too_far(r, s, step * halving(level));
  return level;
}

/// crossing() of methods/stable.cpp. `gap` also counts its evaluations, in the lanes that it
/// receives.
template <class Gap>
HWY_INLINE Wide crossing(WideMask lanes, Wide dt, Wide start, Wide end, WideMask from_zero,
                         Wide tolerance, Gap gap) {
  Wide a = all(0.0), fa = start, b = dt, fb = choose(from_zero, end / dt, end);
  Wide kept = all(0.0), when = b;
  const Wide margin = 1e-15 * dt, one = all(1.0);
  for (int i = 0; i < 100; ++i) {
    const WideMask closed = b - a <= 4.0 * margin;
    when = choose(lanes & closed, b, when);
    lanes = lanes & ~closed;
    if (!any(lanes)) return when;
    const Wide between = b - fb * (b - a) / (fb - fa);
    const Wide low = a + margin, high = b - margin;
    const Wide t = choose(between < low, low, choose(high < between, high, between));
    const Wide value = gap(t, lanes);
    const WideMask found = abs(value) <= tolerance;
    when = choose(lanes & found, t, when);
    lanes = lanes & ~found;
    const Wide f = choose(from_zero, value / t, value);
    const WideMask below = f < all(0.0);
    fa = choose(below, choose(kept == -one, 0.5 * fa, fa), f);
    fb = choose(below, f, choose(kept == one, 0.5 * fb, fb));
    a = choose(below, a, t);
    b = choose(below, t, b);
    kept = choose(below, -one, one);
  }
  return choose(lanes, b, when);
}

/// The moment in [0, dt] at which one beam is hit, and the state there.
struct WideHit {
  Wide when;
  WideState there;
  WideMask failed;
};
/// Finds a hit of the left beam where `mirror` is 1, of the right beam where it is -1; `end` is dt
/// after `s`.
template <int N>
HWY_NOINLINE WideHit find_hit(const StableRules& r, const WideState& s, const WideState& end,
                              Wide force_x, Wide dt, Wide mirror, WideMask lanes,
                              Wide& evaluations) {
  const LaneGate& g = r.gate;
  const double touching = r.limits.touching;
  const WideMask left = mirror > all(0.0);
  const auto of_beam = [&](const Wide(&x)[2])
                           HWY_ATTR { return choose(left, x[kLeft], x[kRight]); };
  const auto count = [&](WideMask m) HWY_ATTR { evaluations = evaluations + or_zero(m, all(1.0)); };
  const Wide theta0 = of_beam(s.theta), omega0 = of_beam(s.omega);
  const Wide theta1 = of_beam(end.theta), omega1 = of_beam(end.omega);
  WideTouch now;
  nearest(g, mirror, s.x, s.y, towards(theta0), now);
  const Wide rate = gap_rate(now, s.vx, s.vy, omega0);
  const WideMask from_contact = now.gap <= all(touching);
  const WideMask at_once = from_contact & (rate <= all(0.0));
  const Wide level = or_zero(from_contact, now.gap);
  const Wide start = choose(from_contact, rate, now.gap);
  count(lanes);
  const auto gap_of = [&](Wide x, Wide y, Wide theta) HWY_ATTR {
    return reach(g, mirror, x, y, turned_to(now.beam, theta).to).gap - level;
  };
  count(lanes);
  const Wide end_gap = gap_of(end.x, end.y, theta1);

  // interpolated() of methods/method.cpp, for positions only.
  const auto gap_between = [&](Wide t, WideMask where) HWY_ATTR {
    const Wide z = t / dt, z2 = z * z, z3 = z2 * z;
    const Wide wb = 3.0 * z2 - 2.0 * z3, da = dt * (z - 2.0 * z2 + z3), db = dt * (z3 - z2);
    const auto mix = [&](Wide xa, Wide va, Wide xb, Wide vb)
                         HWY_ATTR { return xa + wb * (xb - xa) + da * va + db * vb; };
    count(where);
    return gap_of(mix(s.x, s.vx, end.x, end.vx), mix(s.y, s.vy, end.y, end.vy),
                  mix(theta0, omega0, theta1, omega1));
  };
  const Wide guess = choose(from_contact, all(10 * touching), all(StableMethod::kGuess * touching));
  WideHit hit;
  hit.when = crossing(lanes & ~at_once, dt, start, end_gap, from_contact, guess, gap_between);
  hit.there = s;
  glide<N>(r, force_x, hit.when, nowhere(), hit.there);
  const Wide exact = all(1e-3 * touching), near = all(0.1 * touching);
  WideMask off = lanes & ~at_once, bad = at_once;
  for (int i = 0;; ++i) {
    const Wide theta = of_beam(hit.there.theta), omega = of_beam(hit.there.omega);
    WideTouch t;
    nearest(g, mirror, hit.there.x, hit.there.y, turned_to(now.beam, theta), t);
    count(off);
    const Wide gap = t.gap - level;
    bad = choose(off, ~(abs(gap) <= near), bad);
    off = off & ~(abs(gap) <= exact);
    if (i == StableMethod::kNewtonSteps) break;
    const Wide falling = gap_rate(t, hit.there.vx, hit.there.vy, omega);
    const Wide next = hit.when - gap / falling;
    off = off & (falling < all(0.0)) & (next > all(0.0)) & (next <= dt);
    if (!any(off)) break;
    hit.when = choose(off, next, hit.when);
    // The other lanes repeat their result.
    hit.there = s;
    glide<N>(r, force_x, hit.when, nowhere(), hit.there);
  }
  hit.failed = lanes & (bad | ~(hit.when < dt));
  return hit;
}

/// resolve_hits() with the limits of `stable`, in lanes without accumulated hits. Returns the lanes
/// that are not done after some rounds.
HWY_NOINLINE WideMask resolve_hits(const StableRules& r, WideMask lanes, WideState& s,
                                   Wide& impacts) {
  constexpr int kRounds = 8;
  const LaneGate& g = r.gate;
  const Wide zero = all(0.0), touching = all(r.limits.touching), rest = all(r.limits.rest);
  WideTouch touch[2];
  for (const Side side : {kLeft, kRight})
    nearest(g, mirror_of(side), s.x, s.y, towards(s.theta[side]), touch[side]);
  const WideCoupling<2> w = coupling(g, touch);
  for (int round = 0; round < kRounds; ++round) {
    const Each<2> u = gap_rates(s, touch);
    Each<2> b, rebound, threshold;
    WideMask active[2], closing = nowhere();
    for (const Side side : {kLeft, kRight}) {
      const WideTouch& t = touch[side];
      active[side] = s.held[side] | ((t.gap <= touching) & (u.of[side] < -rest));
      const Wide e = choose(t.tip, all(r.tip_restitution), all(r.restitution));
      rebound.of[side] = choose(s.held[side], zero, -e * u.of[side]);
      b.of[side] = u.of[side] - rebound.of[side];
      threshold.of[side] = choose(t.tip, all(r.limits.tip_threshold), all(r.limits.threshold));
      closing = closing | (active[side] & ~(u.of[side] >= -rest));
    }
    lanes = lanes & closing;
    if (!any(lanes)) return lanes;

    const auto ends_bouncing = [&](Side side, Wide impulse, Wide speed) HWY_ATTR {
      return (impulse < threshold.of[side]) | (speed <= rest);
    };
    Each<2> impulse = unilateral_impulses(w, b, active);
    for (const Side side : {kLeft, kRight}) {
      const WideMask ends = active[side] & ~s.held[side] & lanes &
                            ends_bouncing(side, impulse.of[side], rebound.of[side]);
      s.held[side] = s.held[side] | ends;
      b.of[side] = choose(ends, u.of[side], b.of[side]);
    }
    impulse = unilateral_impulses(w, b, active);
    for (const Side side : {kLeft, kRight}) {
      const Wide opens = b.of[side] + w.cross * impulse.of[1 - side];
      const WideMask thrown =
          lanes & active[side] & s.held[side] & ~(impulse.of[side] > zero) & ~(opens <= zero);
      if (!any(thrown)) continue;
      const WideMask back = thrown & ends_bouncing(side, opens / w.own[side], opens);
      const Each<2> shut = bilateral_impulses(w, b, active);
      for (const Side either : {kLeft, kRight})
        impulse.of[either] = choose(back, shut.of[either], impulse.of[either]);
      s.held[side] = s.held[side] & ~(thrown & ~back);
    }
    apply_impulses(g, lanes, touch, impulse, s);
    for (const Side side : {kLeft, kRight})
      impacts = impacts + or_zero(lanes & active[side], all(1.0));
  }
  return lanes;
}

}  // namespace HWY_NAMESPACE
}  // namespace gatewalk::dynamics
HWY_AFTER_NAMESPACE();

#endif
