// SPDX-License-Identifier: MIT
#include "dynamics/disc/lanes.h"

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "dynamics/disc/methods/march.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dynamics/disc/lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "dynamics/base/wide-inl.h"

#ifndef GATEWALK_DYNAMICS_LANES_ONCE
#define GATEWALK_DYNAMICS_LANES_ONCE

namespace gatewalk::dynamics {

constexpr int kMostLanes = 16;
using Row = double[kMostLanes];

/// The bodies of all lanes, one number per lane; beams: left, right.
struct alignas(64) LaneBodies {
  Row x, y, vx, vy;
  Row theta[2], omega[2];
};

struct alignas(64) LaneSteps {
  Row force;  // N, along x
  Row left;   // steps to the end of the spell
  Row h, inv_mass, v_to_v, v_per_N;
  Row inv_inertia[2], w_to_w[2], w_per_rad[2];
};

/// The records of Watch and EnergyLedger for all lanes.
struct alignas(64) LaneWatches {
  Row y0, work, lowest, created;
  Row max_theta[2], penetration, speed_squared;
  Row steps, impacts, fast;
  Row counted[2];  // Watch::counted: 1 or 0
};

/// The runs in the lanes, and everything between two steps: spells of constant force and the ends
/// of runs.
class LaneRuns {
 public:
  LaneRuns(const GateParams& p, const NextRun& next, int lanes)
      : p_(p),
        next_(next),
        usual_(p, p.run.step),
        whole_hold_(p, 1.0 / p.forces.random_rate),
        nearly_over_(p.run.time_limit - 1e-6 * p.run.step) {
    runs_.reserve(static_cast<std::size_t>(lanes));
    for (int i = 0; i < lanes; ++i) {
      runs_.push_back(
          {RunSlot{-1, {}, RandomForce(p.forces, Random(Purpose::gate, {}))}, {}, whole_hold_});
      take(i, nullptr);
    }
  }

  [[nodiscard]] bool any() const { return busy_ > 0; }

  /// Ends the spell in lane i.
  void spell_over(int i) {
    Run& run = runs_[i];
    run.slot.force.pass(run.spell.duration);
    run.result.seconds += run.spell.duration;
    if (!begin_spell(i)) end(i, state(bodies, i));
  }

  /// Ends the run in lane i, whose body left the gate, or stopped being finite, in the step from
  /// `bodies` to `after`.
  void left(int i, const LaneBodies& after) {
    Run& run = runs_[i];
    const GateState before = state(bodies, i);
    GateState s = state(after, i);
    const double h = steps.h[i];
    double passed = h;
    if (std::isfinite(s.body.vx + s.body.vy)) {
      const auto beams = s.beams;
      passed = back_to_exit(p_, before, s, h);
      s.beams = mixed(before.beams, beams, passed / h);
    }
    watches.work[i] += steps.force[i] * (s.body.x - before.body.x);
    const double balance =
        energy(p_, s) - p_.forces.propulsion * (s.body.y - watches.y0[i]) - watches.work[i];
    watches.created[i] = std::max(watches.created[i], balance - watches.lowest[i]);
    Watch last;
    last.state(p_, s, h);
    watches.steps[i] += 1.0;
    watches.fast[i] += static_cast<double>(last.fast_steps);
    watches.penetration[i] = std::max(watches.penetration[i], last.max_penetration);
    watches.speed_squared[i] = std::max(watches.speed_squared[i], last.max_speed * last.max_speed);
    for (const Side side : {kLeft, kRight})
      watches.max_theta[side][i] = std::max(watches.max_theta[side][i], last.max_theta[side]);
    const double gone = static_cast<double>(run.spell.steps) - steps.left[i];
    const double seconds = gone * run.spell.step + passed;
    run.slot.force.pass(seconds);
    run.result.seconds += seconds;
    end(i, s);
  }

  /// Continues the run in lane i, whose body stays in the gate.
  void go_on(int i, const LaneBodies& after, double steps_left) {
    bodies.x[i] = after.x[i];
    bodies.y[i] = after.y[i];
    bodies.vx[i] = after.vx[i];
    bodies.vy[i] = after.vy[i];
    for (const Side side : {kLeft, kRight}) {
      bodies.theta[side][i] = after.theta[side][i];
      bodies.omega[side][i] = after.omega[side][i];
    }
    steps.left[i] = steps_left;
  }

  LaneBodies bodies{};
  LaneSteps steps{};
  LaneWatches watches{};

 private:
  struct Run {
    RunSlot slot;
    GateRun result;
    Spell spell;
  };

  static GateState state(const LaneBodies& b, int i) {
    GateState s{{b.x[i], b.y[i], b.vx[i], b.vy[i]}, {}};
    for (const Side side : {kLeft, kRight}) {
      s.beams[side].theta = b.theta[side][i];
      s.beams[side].omega = b.omega[side][i];
    }
    return s;
  }

  /// Begins the next spell. Returns false if the run's time is over.
  bool begin_spell(int i) {
    Run& run = runs_[i];
    if (run.result.seconds >= nearly_over_) return false;
    steps.force[i] = run.slot.force.value();
    const double seconds = std::min(run.slot.force.left(), p_.run.time_limit - run.result.seconds);
    run.spell = seconds == whole_hold_.duration ? whole_hold_ : Spell(p_, seconds);
    steps.left[i] = static_cast<double>(run.spell.steps);
    if (run.spell.step != steps.h[i])
      set_step(i, run.spell.usual ? usual_ : MoreauMethod::Step(p_, run.spell.step));
    return true;
  }

  void set_step(int i, const MoreauMethod::Step& s) {
    steps.h[i] = s.h;
    steps.inv_mass[i] = 1.0 / s.mass;
    steps.v_to_v[i] = s.v_to_v;
    steps.v_per_N[i] = s.v_per_N;
    for (const Side side : {kLeft, kRight}) {
      steps.inv_inertia[side][i] = 1.0 / s.inertia[side];
      steps.w_to_w[side][i] = s.w_to_w[side];
      steps.w_per_rad[side][i] = s.w_per_rad[side];
    }
  }

  void end(int i, const GateState& s) {
    GateRun& r = runs_[i].result;
    r.exit = s.body;
    const LaneWatches& w = watches;
    r.random_work = w.work[i];
    settle_energy(p_, runs_[i].slot.start, r);
    for (const Side side : {kLeft, kRight}) r.watch.max_theta[side] = w.max_theta[side][i];
    r.outcome = outcome_of(p_, s, r.watch);
    r.watch.max_penetration = w.penetration[i];
    r.watch.energy_created = w.created[i];
    r.watch.max_speed = std::sqrt(w.speed_squared[i]);
    r.watch.steps = static_cast<std::int64_t>(w.steps[i]);
    r.watch.evaluations = 3 * r.watch.steps;  // the forces and both gaps
    r.watch.impacts = static_cast<std::int64_t>(w.impacts[i]);
    r.watch.fast_steps = static_cast<std::int64_t>(w.fast[i]);
    --busy_;
    take(i, &r);
  }

  /// Puts the next run into lane i. Without one the lane rests: nothing moves in it.
  void take(int i, const GateRun* ended) {
    Run& run = runs_[i];
    while (next_(run.slot, ended)) {
      run.result = {};
      const BodyState& b = run.slot.start;
      put(i, {b, {}});
      if (!outside(p_, b) && begin_spell(i)) {
        ++busy_;
        return;
      }
      run.result.exit = b;
      run.result.outcome = outcome_of(p_, {b, {}}, run.result.watch);
      ended = &run.result;
    }
    put(i, {});
    steps.force[i] = 0.0;
    steps.left[i] = std::numeric_limits<double>::infinity();
    set_step(i, MoreauMethod::Step(p_, 0.0));
  }

  void put(int i, const GateState& s) {
    bodies.x[i] = s.body.x;
    bodies.y[i] = s.body.y;
    bodies.vx[i] = s.body.vx;
    bodies.vy[i] = s.body.vy;
    LaneWatches& w = watches;
    w.y0[i] = s.body.y;
    w.lowest[i] = energy(p_, s);
    w.work[i] = w.created[i] = w.penetration[i] = w.speed_squared[i] = 0.0;
    w.steps[i] = w.impacts[i] = w.fast[i] = 0.0;
    for (const Side side : {kLeft, kRight}) {
      bodies.theta[side][i] = bodies.omega[side][i] = 0.0;
      w.max_theta[side][i] = w.counted[side][i] = 0.0;
    }
  }

  const GateParams& p_;
  const NextRun& next_;
  MoreauMethod::Step usual_;
  Spell whole_hold_;
  double nearly_over_;
  int busy_ = 0;
  std::vector<Run> runs_;
};

}  // namespace gatewalk::dynamics

#endif  // GATEWALK_DYNAMICS_LANES_ONCE

HWY_BEFORE_NAMESPACE();
namespace gatewalk::dynamics {
namespace HWY_NAMESPACE {

/// The first part of nearest() (contact.h) in all lanes, which shows whether disc and beam touch.
struct Look {
  Wide c, s, along, across;
  // Nearer end point, joint or tip: distance from the joint; vector from it to the disc; squared
  // distance.
  Wide r, qx, qy, distance_sq;
  WideMask interior, touches;
};
HWY_INLINE Look look_at(const GateParams& p, Wide px, Wide py, Wide theta) {
  const auto [c, s] = direction_of(theta);
  const Wide length = all(p.beams.length);
  const Wide along = px * c + py * s, across = c * py - s * px;
  const WideMask beyond_joint = along > all(0.0), interior = beyond_joint & (along < length);
  const Wide r = or_zero(beyond_joint, length);
  const Wide qx = px - r * c, qy = py - r * s;
  const Wide distance_sq = qx * qx + qy * qy;
  const Wide away_sq = choose(interior, across * across, distance_sq);
  return {c,  s,  along,       across,   r,
          qx, qy, distance_sq, interior, away_sq <= all(p.body.radius * p.body.radius)};
}

/// The second part of nearest() in all lanes: the contact point, where disc and beam touch.
struct Touches {
  Wide nx, ny, gap, lever;
  WideMask tip;
};
HWY_INLINE Touches touch_of(const GateParams& p, Side side, const Look& at) {
  const Wide radius = all(p.body.radius);
  const Wide distance = sqrt(at.distance_sq), over = all(1.0) / distance;
  const WideMask degenerate = distance < all(std::numeric_limits<double>::min());
  const Wide ex = choose(degenerate, -at.s, at.qx * over),
             ey = choose(degenerate, at.c, at.qy * over);
  const Wide sign = choose(at.across < all(0.0), all(-1.0), all(1.0));
  const Wide nx = choose(at.interior, -(sign * at.s), ex);
  return {side == kLeft ? nx : -nx, choose(at.interior, sign * at.c, ey),
          choose(at.interior, abs(at.across), distance) - radius,
          choose(at.interior, sign * at.along, at.r * (at.c * ey - at.s * ex)),
          ~at.interior & (at.r > all(0.0))};
}

/// Takes one step in every lane (MoreauMethod::one_step), then handles the ends of spells and runs.
HWY_INLINE void step(const GateParams& p, LaneRuns& runs) {
  LaneBodies& b = runs.bodies;
  LaneSteps& k = runs.steps;
  LaneWatches& w = runs.watches;
  const Wide zero = all(0.0), one = all(1.0);
  const Wide h = load(k.h), half = 0.5 * h, force = load(k.force);
  const Wide x0 = load(b.x), y0 = load(b.y), vx0 = load(b.vx), vy0 = load(b.vy);
  const Wide x = x0 + half * vx0, y = y0 + half * vy0, py = y - all(p.beams.joint_y);
  const Wide decay = load(k.v_to_v), per_N = load(k.v_per_N);
  Wide vx = decay * vx0 + per_N * force, vy = decay * vy0 + p.forces.propulsion * per_N;
  const Wide omega0[2] = {load(b.omega[kLeft]), load(b.omega[kRight])};
  Wide theta[2], omega[2];
  Touches t[2];
  WideMask active[2];
  for (const Side side : {kLeft, kRight}) {
    const Wide theta0 = load(b.theta[side]);
    theta[side] = theta0 + half * omega0[side];
    omega[side] = load(k.w_to_w[side]) * omega0[side] - load(k.w_per_rad[side]) * theta0;
    const Wide px = side == kLeft ? x + all(p.beams.joint_x) : all(p.beams.joint_x) - x;
    const Look at = look_at(p, px, py, theta[side]);
    active[side] = at.touches;
    t[side] = touch_of(p, side, at);
  }

  // Both beams at once, as in unilateral_impulses of contact.h: one contact alone if its impulse
  // leaves the other open, else both.
  const Wide inv_mass = load(k.inv_mass);
  Wide before[2], rate[2], give[2], impulse[2];  // give: 1/M + l^2/I
  WideMask need[2], alone[2];
  for (const Side side : {kLeft, kRight}) {
    const Touches& c = t[side];
    const Wide e = choose(c.tip, all(p.contact.tip_restitution), all(p.contact.restitution));
    before[side] = c.nx * vx0 + c.ny * vy0 - c.lever * omega0[side];
    rate[side] = c.nx * vx + c.ny * vy - c.lever * omega[side] + e * before[side];
    give[side] = inv_mass + c.lever * c.lever * load(k.inv_inertia[side]);
    need[side] = active[side] & (rate[side] < zero);
    impulse[side] = -(rate[side] / give[side]);
  }
  const Wide cross = (t[kLeft].nx * t[kRight].nx + t[kLeft].ny * t[kRight].ny) * inv_mass;
  for (const Side side : {kLeft, kRight}) {
    const int other = 1 - side;
    const WideMask open = rate[other] + cross * impulse[side] >= zero;
    alone[side] = need[side] & (~active[other] | open);
  }
  alone[kRight] = alone[kRight] & ~alone[kLeft];
  const WideMask both = (need[kLeft] | need[kRight]) & ~(alone[kLeft] | alone[kRight]);
  for (const Side side : {kLeft, kRight}) impulse[side] = or_zero(alone[side], impulse[side]);
  if (HWY_UNLIKELY(any(both))) {
    const Wide product = give[kLeft] * give[kRight], det = product - cross * cross;
    const WideMask same = det <= 1e-14 * product;
    const Wide shared =
        -((rate[kLeft] + rate[kRight]) / (give[kLeft] + give[kRight] + 2.0 * cross));
    const Wide over = one / det;
    for (const Side side : {kLeft, kRight}) {
      const int other = 1 - side;
      const Wide pair = (rate[other] * cross - rate[side] * give[other]) * over;
      impulse[side] = choose(both, max(zero, choose(same, shared, pair)), impulse[side]);
    }
  }
  Wide jx = zero, jy = zero, impacts = load(w.impacts);
  for (const Side side : {kLeft, kRight}) {
    jx = jx + impulse[side] * t[side].nx;
    jy = jy + impulse[side] * t[side].ny;
    omega[side] = omega[side] - impulse[side] * t[side].lever * load(k.inv_inertia[side]);
    const WideMask pushed = impulse[side] > zero,
                   counted = active[side] & (load(w.counted[side]) > zero);
    impacts = impacts + or_zero(pushed & ~counted, one);
    store(or_zero(pushed | counted, one), w.counted[side]);
  }
  store(impacts, w.impacts);
  vx = vx + jx * inv_mass;
  vy = vy + jy * inv_mass;

  const Wide x1 = x + half * vx, y1 = y + half * vy;
  const Wide speed_sq = vx * vx + vy * vy;
  Wide elastic = zero, spin = zero, fastest = zero;
  for (const Side side : {kLeft, kRight}) {
    theta[side] = theta[side] + half * omega[side];
    elastic = elastic + p.beams.stiffness(side) * (theta[side] * theta[side]);
    spin = spin + omega[side] * omega[side];
    fastest = max(fastest, abs(omega[side]));
  }
  const WideMask gone =
      (y1 > all(p.run.traverse_y)) | (abs(x1) > all(p.beams.joint_x)) | ~finite(vx + vy);

  // Watch::motion and EnergyLedger::step, except for runs that end in this step.
  const Wide work = load(w.work) + force * (x1 - x0);
  const Wide kinetic = p.body.mass * speed_sq + p.beams.inertia() * spin;
  const Wide balance = 0.5 * (kinetic + elastic) - p.forces.propulsion * (y1 - load(w.y0)) - work;
  const auto keep = [&](Wide value, Row& row)
                        HWY_ATTR { store(choose(gone, load(row), value), row); };
  keep(work, w.work);
  keep(max(load(w.created), balance - load(w.lowest)), w.created);
  keep(min(load(w.lowest), balance), w.lowest);
  keep(max(load(w.speed_squared), speed_sq), w.speed_squared);
  for (const Side side : {kLeft, kRight})
    keep(max(load(w.max_theta[side]), abs(theta[side])), w.max_theta[side]);
  // Penetration at the end of the step, from the gap in mid-step and its rate.
  Wide deepest = load(w.penetration);
  for (const Side side : {kLeft, kRight}) {
    const Touches& c = t[side];
    deepest = max(deepest, -(c.gap + half * (c.nx * vx + c.ny * vy - c.lever * omega[side])));
  }
  keep(deepest, w.penetration);
  keep(load(w.steps) + one, w.steps);
  // Tests (v + L |omega|) h > R/2 without a square root.
  const Wide rest = all(0.5 * p.body.radius) - p.beams.length * fastest * h;
  const WideMask too_fast = (rest < zero) | (speed_sq * (h * h) > rest * rest);
  keep(load(w.fast) + or_zero(too_fast, one), w.fast);

  const auto store_to = [&](LaneBodies& to) HWY_ATTR {
    store(x1, to.x);
    store(y1, to.y);
    store(vx, to.vx);
    store(vy, to.vy);
    for (const Side side : {kLeft, kRight}) {
      store(theta[side], to.theta[side]);
      store(omega[side], to.omega[side]);
    }
  };
  const Wide left = load(k.left) - one;
  const int lanes = static_cast<int>(width());
  if (HWY_LIKELY(!any(gone))) {
    store_to(b);
    store(left, k.left);
  } else {
    LaneBodies after;
    Row flag, spell_left;
    store_to(after);
    store(left, spell_left);
    store(or_zero(gone, one), flag);
    for (int i = 0; i < lanes; ++i) {
      if (std::isinf(spell_left[i])) continue;  // a resting lane has no run
      if (flag[i] == 0.0) {
        runs.go_on(i, after, spell_left[i]);
      } else {
        runs.left(i, after);
      }
    }
  }
  if (any(load(k.left) <= zero)) {
    for (int i = 0; i < lanes; ++i)
      if (k.left[i] <= 0.0) runs.spell_over(i);
  }
}

void carry_out(const GateParams& p, const NextRun& next) {
  LaneRuns runs(p, next, static_cast<int>(width()));
  while (runs.any()) step(p, runs);
}

}  // namespace HWY_NAMESPACE
}  // namespace gatewalk::dynamics
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gatewalk::dynamics {
HWY_EXPORT(carry_out);

void carry_out_in_lanes(const GateParams& p, const NextRun& next) {
  validate(p);
  HWY_DYNAMIC_DISPATCH(carry_out)(p, next);
}

}  // namespace gatewalk::dynamics
#endif
