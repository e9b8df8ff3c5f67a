#include "dynamics/lanes.h"

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "dynamics/methods/march.h"

// Registers whose length is not known when this is compiled hold no state here.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dynamics/lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef GATEWALK_DYNAMICS_LANES_ONCE
#define GATEWALK_DYNAMICS_LANES_ONCE

namespace gatewalk::dynamics {

constexpr int kMostLanes = 8;
using Row = double[kMostLanes];

/// One number per lane. Beams: left, right.
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

/// What Watch and EnergyLedger keep of a run.
struct alignas(64) LaneWatches {
  Row y0, work, lowest, created;
  Row max_theta[2], penetration, speed_squared;
  Row steps, evaluations, impacts, fast;
};

/// The runs in the lanes and all that happens between two steps: spells of constant force, ends.
class LaneRuns {
 public:
  LaneRuns(const GateParams& p, const NextRun& next, int lanes)
      : p_(p), next_(next), usual_(p, p.run.step), lanes_(lanes),
        nearly_over_(p.run.time_limit - 1e-6 * p.run.step) {
    runs_.reserve(static_cast<std::size_t>(lanes));
    for (int i = 0; i < lanes; ++i) {
      runs_.push_back({RunSlot{-1, {}, RandomForce(p.forces, Random(Purpose::gate, {}))}, {}, {}});
      take(i, nullptr);
    }
  }

  [[nodiscard]] bool any() const { return busy_ > 0; }

  /// The spell in lane i is over.
  void spell_over(int i) {
    Run& run = runs_[i];
    run.slot.force.pass(run.spell->duration);
    run.result.seconds += run.spell->duration;
    if (!begin_spell(i)) end(i, state(bodies, i));
  }

  /// The body in lane i has left the gate, or is no number, in the step from `bodies` to `after`.
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
    const double balance = energy(p_, s) - p_.forces.propulsion * (s.body.y - watches.y0[i]) -
                           (watches.work[i] + steps.force[i] * (s.body.x - before.body.x));
    watches.created[i] = std::max(watches.created[i], balance - watches.lowest[i]);
    Watch last;
    last.motion(p_, s, h);
    watches.steps[i] += 1.0;
    watches.fast[i] += static_cast<double>(last.fast_steps);
    watches.speed_squared[i] = std::max(watches.speed_squared[i], last.max_speed * last.max_speed);
    for (const Side side : {kLeft, kRight})
      watches.max_theta[side][i] = std::max(watches.max_theta[side][i], last.max_theta[side]);
    const double gone = static_cast<double>(run.spell->steps) - steps.left[i];
    const double seconds = gone * run.spell->step + passed;
    run.slot.force.pass(seconds);
    run.result.seconds += seconds;
    end(i, s);
  }

  LaneBodies bodies{};
  LaneSteps steps{};
  LaneWatches watches{};

 private:
  struct Run {
    RunSlot slot;
    GateRun result;
    std::optional<Spell> spell;
  };

  static GateState state(const LaneBodies& b, int i) {
    GateState s{{b.x[i], b.y[i], b.vx[i], b.vy[i]}, {}};
    for (const Side side : {kLeft, kRight}) {
      s.beams[side].theta = b.theta[side][i];
      s.beams[side].omega = b.omega[side][i];
    }
    return s;
  }

  /// False when there is none: the run's time is over.
  bool begin_spell(int i) {
    Run& run = runs_[i];
    if (run.result.seconds >= nearly_over_) return false;
    steps.force[i] = run.slot.force.value();
    run.spell.emplace(p_, std::min(run.slot.force.left(), p_.run.time_limit - run.result.seconds));
    steps.left[i] = static_cast<double>(run.spell->steps);
    if (run.spell->step != steps.h[i])
      set_step(i, run.spell->usual ? usual_ : MoreauMethod::Step(p_, run.spell->step));
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
    r.ending = ending(p_, s);
    const LaneWatches& w = watches;
    for (const Side side : {kLeft, kRight}) r.watch.max_theta[side] = w.max_theta[side][i];
    r.watch.max_penetration = w.penetration[i];
    r.watch.energy_created = w.created[i];
    r.watch.max_speed = std::sqrt(w.speed_squared[i]);
    r.watch.steps = static_cast<std::int64_t>(w.steps[i]);
    r.watch.evaluations = static_cast<std::int64_t>(w.evaluations[i]);
    r.watch.impacts = static_cast<std::int64_t>(w.impacts[i]);
    r.watch.fast_steps = static_cast<std::int64_t>(w.fast[i]);
    --busy_;
    take(i, &r);
  }

  /// The next run into lane i; without one the lane rests: nothing moves in it.
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
      run.result.ending = ending(p_, {b, {}});
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
    w.steps[i] = w.evaluations[i] = w.impacts[i] = w.fast[i] = 0.0;
    for (const Side side : {kLeft, kRight})
      bodies.theta[side][i] = bodies.omega[side][i] = w.max_theta[side][i] = 0.0;
  }

  const GateParams& p_;
  const NextRun& next_;
  MoreauMethod::Step usual_;
  int lanes_, busy_ = 0;
  double nearly_over_;
  std::vector<Run> runs_;
};

}  // namespace gatewalk::dynamics

#endif  // GATEWALK_DYNAMICS_LANES_ONCE

HWY_BEFORE_NAMESPACE();
namespace gatewalk::dynamics {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, kMostLanes>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

HWY_INLINE V all(double x) { return hn::Set(D(), x); }
HWY_INLINE V of(const Row& row) { return hn::Load(D(), row); }
HWY_INLINE void put(V v, Row& row) { hn::Store(v, D(), row); }
/// c[0] + c[1] z + ...
template <std::size_t N>
HWY_INLINE V series(V z, const double (&c)[N]) {
  V sum = all(c[N - 1]);
  for (std::size_t i = N - 1; i-- > 0;) sum = hn::Add(hn::Mul(sum, z), all(c[i]));
  return sum;
}

struct Direction2 {
  V c, s;
};

/// cos and sin to 1 or 2 units in the last place for |angle| < 10^6: reduced to [-pi/4, pi/4] by three
/// parts of pi/2, the first two short enough for exact products; then Taylor's series, next terms
/// below 6e-17 of the sum.
HWY_INLINE Direction2 direction_of(V angle) {
  const V quarter = hn::Round(hn::Mul(angle, all(0x1.45f306dc9c883p-1)));  // 2/pi
  V r = hn::Sub(angle, hn::Mul(quarter, all(0x1.921fb54p+0)));
  r = hn::Sub(r, hn::Mul(quarter, all(0x1.10b46118p-30)));
  r = hn::Sub(r, hn::Mul(quarter, all(0x1.313198a2e0370p-61)));
  const V z = hn::Mul(r, r);
  constexpr double kSin[] = {-1.0 / 6,           1.0 / 120,           -1.0 / 5040,
                             1.0 / 362880,       -1.0 / 39916800,     1.0 / 6227020800.0,
                             -1.0 / 1307674368000.0};
  constexpr double kCos[] = {-1.0 / 2,         1.0 / 24,           -1.0 / 720,
                             1.0 / 40320,      -1.0 / 3628800,     1.0 / 479001600.0,
                             -1.0 / 87178291200.0, 1.0 / 20922789888000.0};
  const V sine = hn::Add(r, hn::Mul(hn::Mul(r, z), series(z, kSin)));
  const V cosine = hn::Add(all(1.0), hn::Mul(z, series(z, kCos)));
  // quarter modulo 4: 0 (c, s), 1 (-s, c), 2 (-c, -s), 3 (s, -c).
  const V turn = hn::Sub(quarter, hn::Mul(all(4.0), hn::Floor(hn::Mul(quarter, all(0.25)))));
  const M odd = hn::Or(hn::Eq(turn, all(1.0)), hn::Eq(turn, all(3.0)));
  const M minus_c = hn::Or(hn::Eq(turn, all(1.0)), hn::Eq(turn, all(2.0)));
  const M minus_s = hn::Ge(turn, all(2.0));
  const V c = hn::IfThenElse(odd, sine, cosine), s = hn::IfThenElse(odd, cosine, sine);
  return {hn::IfThenElse(minus_c, hn::Neg(c), c), hn::IfThenElse(minus_s, hn::Neg(s), s)};
}

/// nearest() of contact.h, in all lanes.
struct Touches {
  V nx, ny, gap, lever;
  M tip;
};
HWY_INLINE Touches touch_of(const GateParams& p, Side side, V px, V py, V theta) {
  const auto [c, s] = direction_of(theta);
  const V radius = all(p.body.radius), zero = hn::Zero(D());
  const V along = hn::Add(hn::Mul(px, c), hn::Mul(py, s));
  const V across = hn::Sub(hn::Mul(c, py), hn::Mul(s, px));
  const M beyond_joint = hn::Gt(along, zero);
  const M interior = hn::And(beyond_joint, hn::Lt(along, all(p.beams.length)));
  const V sign = hn::IfThenElse(hn::Lt(across, zero), all(-1.0), all(1.0));
  // End points: joint or tip.
  const V r = hn::IfThenElse(beyond_joint, all(p.beams.length), zero);
  const V qx = hn::Sub(px, hn::Mul(r, c)), qy = hn::Sub(py, hn::Mul(r, s));
  const V dist = hn::Sqrt(hn::Add(hn::Mul(qx, qx), hn::Mul(qy, qy)));
  const M degenerate = hn::Lt(dist, all(std::numeric_limits<double>::min()));
  const V over = hn::Div(all(1.0), dist);
  const V ex = hn::IfThenElse(degenerate, hn::Neg(s), hn::Mul(qx, over));
  const V ey = hn::IfThenElse(degenerate, c, hn::Mul(qy, over));
  const V nx = hn::IfThenElse(interior, hn::Neg(hn::Mul(sign, s)), ex);
  const V ny = hn::IfThenElse(interior, hn::Mul(sign, c), ey);
  const V end_lever = hn::Mul(r, hn::Sub(hn::Mul(c, ey), hn::Mul(s, ex)));
  return {side == kLeft ? nx : hn::Neg(nx), ny,
          hn::Sub(hn::IfThenElse(interior, hn::Abs(across), dist), radius),
          hn::IfThenElse(interior, hn::Mul(sign, along), end_lever),
          hn::AndNot(interior, beyond_joint)};
}

/// True where the disc cannot touch the beam (out_of_reach of contact.h) does not hold.
HWY_INLINE M in_reach(const GateParams& p, V px, V py, V theta) {
  const double reach = p.beams.length + p.body.radius;
  const V far_sq = hn::Add(hn::Mul(px, px), hn::Mul(py, py));
  const V rise = hn::Mul(all(p.beams.length), theta), zero = hn::Zero(D()), radius = all(p.body.radius);
  const M below = hn::Lt(hn::Add(py, radius), hn::Min(zero, rise));
  const M above = hn::Gt(hn::Sub(py, radius), hn::Max(zero, rise));
  const M turned = hn::Gt(hn::Abs(theta), all(3.0));
  const M near = hn::Not(hn::Gt(far_sq, all(reach * reach)));
  return hn::And(near, hn::Or(turned, hn::Not(hn::Or(below, above))));
}

/// One step in every lane (MoreauMethod::one_step), then the ends of spells and runs.
void carry_out(const GateParams& p, const NextRun& next) {
  const D d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  LaneRuns runs(p, next, lanes);
  LaneBodies after{};
  const V zero = hn::Zero(d), one = all(1.0), half_unit = all(0.5);
  while (runs.any()) {
    const LaneBodies& b = runs.bodies;
    LaneSteps& k = runs.steps;
    LaneWatches& w = runs.watches;
    const V h = of(k.h), half = hn::Mul(half_unit, h), force = of(k.force);
    const V x0 = of(b.x), y0 = of(b.y), vx0 = of(b.vx), vy0 = of(b.vy);
    const V x = hn::Add(x0, hn::Mul(half, vx0)), y = hn::Add(y0, hn::Mul(half, vy0));
    const V decay = of(k.v_to_v), per_N = of(k.v_per_N);
    V vx = hn::Add(hn::Mul(decay, vx0), hn::Mul(per_N, force));
    V vy = hn::Add(hn::Mul(decay, vy0), hn::Mul(per_N, all(p.forces.propulsion)));
    const V theta0[2] = {of(b.theta[0]), of(b.theta[1])};
    const V omega0[2] = {of(b.omega[0]), of(b.omega[1])};
    V theta[2], omega[2], px[2];
    const V py = hn::Sub(y, all(p.beams.joint_y));
    M near[2], active[2];
    for (const Side side : {kLeft, kRight}) {
      theta[side] = hn::Add(theta0[side], hn::Mul(half, omega0[side]));
      omega[side] = hn::Sub(hn::Mul(of(k.w_to_w[side]), omega0[side]),
                            hn::Mul(of(k.w_per_rad[side]), theta0[side]));
      px[side] = side == kLeft ? hn::Add(x, all(p.beams.joint_x)) : hn::Sub(all(p.beams.joint_x), x);
      near[side] = in_reach(p, px[side], py, theta[side]);
    }
    V evaluations = hn::Add(of(w.evaluations), one), impacts = of(w.impacts);
    V deepest = of(w.penetration);
    if (!hn::AllFalse(d, hn::Or(near[kLeft], near[kRight]))) {
      Touches t[2];
      for (const Side side : {kLeft, kRight}) {
        t[side] = touch_of(p, side, px[side], py, theta[side]);
        evaluations = hn::Add(evaluations, hn::IfThenElseZero(near[side], one));
        active[side] = hn::And(near[side], hn::Le(t[side].gap, zero));
        deepest = hn::IfThenElse(near[side], hn::Max(deepest, hn::Neg(t[side].gap)), deepest);
      }
      if (!hn::AllFalse(d, hn::Or(active[kLeft], active[kRight]))) {
        const V inv_mass = of(k.inv_mass);
        V before[2], rate[2], give[2];  // give: 1/M + l^2/I
        for (const Side side : {kLeft, kRight}) {
          const Touches& c = t[side];
          const V e = hn::IfThenElse(c.tip, all(p.contact.tip_restitution), all(p.contact.restitution));
          const auto gap_rate = [&](V ux, V uy, V turning) HWY_ATTR {
            return hn::Sub(hn::Add(hn::Mul(c.nx, ux), hn::Mul(c.ny, uy)), hn::Mul(c.lever, turning));
          };
          before[side] = gap_rate(vx0, vy0, omega0[side]);
          rate[side] = hn::Add(gap_rate(vx, vy, omega[side]), hn::Mul(e, before[side]));
          give[side] = hn::Add(inv_mass, hn::Mul(hn::Mul(c.lever, c.lever), of(k.inv_inertia[side])));
        }
        // push_only of contact.h: one alone if that leaves the other open, else both.
        const V cross = hn::Mul(hn::Add(hn::Mul(t[kLeft].nx, t[kRight].nx), hn::Mul(t[kLeft].ny, t[kRight].ny)), inv_mass);
        M alone[2], need[2];
        V single[2];
        for (const Side side : {kLeft, kRight}) {
          need[side] = hn::And(active[side], hn::Lt(rate[side], zero));
          single[side] = hn::Neg(hn::Div(rate[side], give[side]));
        }
        for (const Side side : {kLeft, kRight}) {
          const int other = 1 - side;
          const M open = hn::Ge(hn::Add(rate[other], hn::Mul(cross, single[side])), zero);
          alone[side] = hn::And(need[side], hn::Or(hn::Not(active[other]), open));
        }
        const V product = hn::Mul(give[kLeft], give[kRight]);
        const V det = hn::Sub(product, hn::Mul(cross, cross));
        const M same = hn::Le(det, hn::Mul(all(1e-14), product));
        const V shared = hn::Neg(hn::Div(hn::Add(rate[kLeft], rate[kRight]),
                                         hn::Add(hn::Add(give[kLeft], give[kRight]), hn::Mul(all(2.0), cross))));
        const V over = hn::Div(one, det);
        const M both = hn::AndNot(hn::Or(alone[kLeft], alone[kRight]), hn::Or(need[kLeft], need[kRight]));
        V jx = zero, jy = zero;
        for (const Side side : {kLeft, kRight}) {
          const int other = 1 - side;
          const V pair = hn::Mul(hn::Sub(hn::Mul(rate[other], cross), hn::Mul(rate[side], give[other])), over);
          const V joint = hn::Max(zero, hn::IfThenElse(same, shared, pair));
          const M one_only = side == kLeft ? alone[kLeft] : hn::AndNot(alone[kLeft], alone[kRight]);
          const V impulse = hn::IfThenElse(one_only, single[side], hn::IfThenElseZero(both, joint));
          jx = hn::Add(jx, hn::Mul(impulse, t[side].nx));
          jy = hn::Add(jy, hn::Mul(impulse, t[side].ny));
          omega[side] = hn::Sub(omega[side], hn::Mul(hn::Mul(impulse, t[side].lever), of(k.inv_inertia[side])));
          const M new_hit = hn::And(hn::Gt(impulse, zero), hn::Gt(t[side].gap, hn::Mul(h, before[side])));
          impacts = hn::Add(impacts, hn::IfThenElseZero(new_hit, one));
        }
        vx = hn::Add(vx, hn::Mul(jx, inv_mass));
        vy = hn::Add(vy, hn::Mul(jy, inv_mass));
      }
    }
    const V x1 = hn::Add(x, hn::Mul(half, vx)), y1 = hn::Add(y, hn::Mul(half, vy));
    put(x1, after.x);
    put(y1, after.y);
    put(vx, after.vx);
    put(vy, after.vy);
    put(evaluations, w.evaluations);
    put(impacts, w.impacts);
    put(deepest, w.penetration);
    const V speed_sq = hn::Add(hn::Mul(vx, vx), hn::Mul(vy, vy));
    V elastic = zero, spin = zero, fastest = zero;
    for (const Side side : {kLeft, kRight}) {
      theta[side] = hn::Add(theta[side], hn::Mul(half, omega[side]));
      put(theta[side], after.theta[side]);
      put(omega[side], after.omega[side]);
      elastic = hn::Add(elastic, hn::Mul(all(p.beams.stiffness(side)), hn::Mul(theta[side], theta[side])));
      spin = hn::Add(spin, hn::Mul(omega[side], omega[side]));
      fastest = hn::Max(fastest, hn::Abs(omega[side]));
    }
    const V y_max = all(p.run.traverse_y), side_x = all(p.beams.joint_x);
    const M gone = hn::Or(hn::Or(hn::Gt(y1, y_max), hn::Gt(hn::Abs(x1), side_x)),
                          hn::Not(hn::IsFinite(hn::Add(vx, vy))));

    // Watch::motion and EnergyLedger::step, but for the runs that end in this step.
    const M stays = hn::Not(gone);
    const V work = hn::Add(of(w.work), hn::Mul(force, hn::Sub(x1, x0)));
    const V kinetic = hn::Add(hn::Mul(all(p.body.mass), speed_sq), hn::Mul(all(p.beams.inertia()), spin));
    const V balance = hn::Sub(hn::Sub(hn::Mul(half_unit, hn::Add(kinetic, elastic)),
                                      hn::Mul(all(p.forces.propulsion), hn::Sub(y1, of(w.y0)))), work);
    const V lowest = of(w.lowest), created = of(w.created);
    const auto keep = [&](V value, V old, Row& row) HWY_ATTR { put(hn::IfThenElse(stays, value, old), row); };
    keep(work, of(w.work), w.work);
    keep(hn::Max(created, hn::Sub(balance, lowest)), created, w.created);
    keep(hn::Min(lowest, balance), lowest, w.lowest);
    const V speeds = of(w.speed_squared);
    keep(hn::Max(speeds, speed_sq), speeds, w.speed_squared);
    for (const Side side : {kLeft, kRight}) {
      const V most = of(w.max_theta[side]);
      keep(hn::Max(most, hn::Abs(theta[side])), most, w.max_theta[side]);
    }
    const V steps = of(w.steps), fasts = of(w.fast);
    keep(hn::Add(steps, one), steps, w.steps);
    // (v + L |omega|) h > R/2, without a root
    const V rest = hn::Sub(all(0.5 * p.body.radius), hn::Mul(hn::Mul(fastest, all(p.beams.length)), h));
    const M too_fast = hn::Or(hn::Lt(rest, zero), hn::Gt(hn::Mul(speed_sq, hn::Mul(h, h)), hn::Mul(rest, rest)));
    keep(hn::Add(fasts, hn::IfThenElseZero(too_fast, one)), fasts, w.fast);

    const bool some_gone = !hn::AllFalse(d, gone);
    if (HWY_UNLIKELY(some_gone)) {
      Row flag;
      hn::StoreU(hn::IfThenElseZero(gone, one), d, flag);
      for (int i = 0; i < lanes; ++i) {
        if (flag[i] == 0.0) continue;
        runs.left(i, after);
        // The next run starts from `bodies`, which become the old ones.
        after.x[i] = runs.bodies.x[i];
        after.y[i] = runs.bodies.y[i];
        after.vx[i] = runs.bodies.vx[i];
        after.vy[i] = runs.bodies.vy[i];
        for (const Side side : {kLeft, kRight})
          after.theta[side][i] = after.omega[side][i] = 0.0;
        k.left[i] += 1.0;  // has not taken this step
      }
    }
    runs.bodies = after;
    const V left = hn::Sub(of(k.left), one);
    put(left, k.left);
    const M over = hn::Le(left, zero);
    if (!hn::AllFalse(d, over)) {
      for (int i = 0; i < lanes; ++i)
        if (k.left[i] <= 0.0) runs.spell_over(i);
    }
  }
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
