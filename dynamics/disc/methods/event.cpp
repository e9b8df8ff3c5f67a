// SPDX-License-Identifier: MIT
#include "dynamics/disc/methods/event.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>

namespace gatewalk::dynamics {
namespace {

constexpr double kMaxHoldPhase = 1000.0;  // rad or e-folds of a beam per hold of the random force
constexpr int kMostPieces = 2000;         // events in a hold before contact is forced
constexpr int kMostLooks = 100000;        // checks for contact in one flight
constexpr int kMostAttempts = 100;        // Runge-Kutta attempts for an accepted step

constexpr std::array<double, 2> kNotSeen{std::numeric_limits<double>::quiet_NaN(),
                                         std::numeric_limits<double>::quiet_NaN()};

/// Positions and velocities of body and beams, for the integrator.
using Vector = std::array<double, 8>;

Vector pack(const GateState& s) {
  return {s.body.x,  s.body.y,  s.beams[kLeft].theta, s.beams[kRight].theta,
          s.body.vx, s.body.vy, s.beams[kLeft].omega, s.beams[kRight].omega};
}

GateState unpacked(const Vector& y, const GateState& flags) {
  GateState s = flags;
  s.body = {y[0], y[1], y[4], y[5]};
  for (const Side side : {kLeft, kRight}) {
    s.beams[side].theta = y[2 + side];
    s.beams[side].omega = y[6 + side];
  }
  return s;
}

/// Equations (2), (3) with the contact forces of Eqs. (11), (13) on the held beams.
struct Motion {
  std::array<Touch, 2> touch;
  std::array<double, 2> force;  // N, < 0: would pull
  Push push;
  Vector rate;

  Motion(const GateParams& p, const GateState& s, double force_x)
      : touch(touches(p, s, held_of(s))),
        force(contact_forces(p, s, touch, force_x, held_of(s), bilateral_impulses)),
        push(p, touch, force) {
    const double inertia = p.beams.inertia();
    const auto beta = [&](Side side, double k) {
      return (-k * s.beams[side].theta - p.beams.damping * s.beams[side].omega) / inertia +
             push.beta[side];
    };
    rate = {s.body.vx,
            s.body.vy,
            s.beams[kLeft].omega,
            s.beams[kRight].omega,
            (force_x - p.forces.drag * s.body.vx) / p.body.mass + push.ax,
            (p.forces.propulsion - p.forces.drag * s.body.vy) / p.body.mass + push.ay,
            beta(kLeft, p.beams.stiffness_left),
            beta(kRight, p.beams.stiffness_right)};
  }
};

/// Bogacki and Shampine (1989), order 3 with an embedded order 2; cheap at loose tolerances.
struct BogackiShampine {
  static constexpr int kStages = 4;
  static constexpr double kOrder = 3.0;
  static constexpr double a[kStages][kStages] = {
      {}, {1.0 / 2}, {0, 3.0 / 4}, {2.0 / 9, 1.0 / 3, 4.0 / 9}};
  static constexpr double e[kStages] = {2.0 / 9 - 7.0 / 24, 1.0 / 3 - 1.0 / 4, 4.0 / 9 - 1.0 / 3,
                                        -1.0 / 8};
};

/// Dormand and Prince (1980), order 5 with an embedded order 4.
struct DormandPrince {
  static constexpr int kStages = 7;
  static constexpr double kOrder = 5.0;
  static constexpr double a[kStages][kStages] = {
      {},
      {1.0 / 5},
      {3.0 / 40, 9.0 / 40},
      {44.0 / 45, -56.0 / 15, 32.0 / 9},
      {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
      {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
      {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}};
  static constexpr double e[kStages] = {35.0 / 384 - 5179.0 / 57600,
                                        0,
                                        500.0 / 1113 - 7571.0 / 16695,
                                        125.0 / 192 - 393.0 / 640,
                                        -2187.0 / 6784 + 92097.0 / 339200,
                                        11.0 / 84 - 187.0 / 2100,
                                        -1.0 / 40};
};

struct Step {
  GateState end;
  Motion motion;  // at the end: the last stage is the new state's derivative
  double error;   // largest error estimate, m
};

template <class Pair>
Step integrated(const GateParams& p, const GateState& s, const Motion& start, double force_x,
                double h, double time) {
  std::array<Vector, Pair::kStages> k;
  k[0] = start.rate;
  const Vector y0 = pack(s);
  GateState state = s;
  Motion motion = start;
  for (int i = 1; i < Pair::kStages; ++i) {
    Vector y = y0;
    for (int c = 0; c < 8; ++c) {
      double sum = 0.0;
      for (int j = 0; j < i; ++j) sum += Pair::a[i][j] * k[j][c];
      y[c] += h * sum;
    }
    state = unpacked(y, s);
    motion = Motion(p, state, force_x);
    k[i] = motion.rate;
  }
  // Errors in m: a velocity counts as the distance in the scene's unit of time, an angle as the
  // distance of the tip or as the disc's distance at the same energy.
  const double length = p.beams.length, mass = p.body.mass;
  const double spin = std::max(length, std::sqrt(p.beams.inertia() / mass));
  const Vector weight{1.0,
                      1.0,
                      std::max(length, time * std::sqrt(p.beams.stiffness_left / mass)),
                      std::max(length, time * std::sqrt(p.beams.stiffness_right / mass)),
                      time,
                      time,
                      time * spin,
                      time * spin};
  double worst = 0.0;
  for (int c = 0; c < 8; ++c) {
    double sum = 0.0;
    for (int j = 0; j < Pair::kStages; ++j) sum += Pair::e[j] * k[j][c];
    worst = std::max(worst, std::abs(h * sum) * weight[c]);
    if (std::isnan(sum)) worst = std::numeric_limits<double>::infinity();
  }
  return {state, motion, worst};
}

/// The first time at which gap + rate t - fall t^2 / 2 can be zero; infinite if never.
double first_zero(double gap, double rate, double fall) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  if (fall <= 0.0) return rate < 0.0 ? gap / -rate : kNever;
  const double root = std::sqrt(rate * rate + 2.0 * fall * gap);
  return rate < 0.0 ? 2.0 * gap / (root - rate) : (rate + root) / fall;
}

}  // namespace

EventMethod::EventMethod(const GateParams& p)
    : p_(p),
      touching_(1e-14 * p.body.radius),
      rise_(std::fmax(p.run.event_tolerance, 1e3 * touching_)),
      tolerance_(p.run.event_tolerance),
      time_(scale_of(p).time),
      rest_(rest_speed(p)),
      loose_(tolerance_ > 1e-5 * scale_of(p).length),
      hold_(1.0 / p.forces.random_rate),
      law_(p),
      flow_(law_.over(hold_)) {
  const double k = std::max(p.beams.stiffness_left, p.beams.stiffness_right);
  const double inertia = p.beams.inertia();
  const double rate = std::max(std::sqrt(k / inertia), p.beams.damping / inertia);
  if (!(rate * hold_ <= kMaxHoldPhase))
    throw InvalidParameter(
        "run.method",
        fmt::format("run.method = \"event\" is not permitted for these beams: their fastest rate, "
                    "from beams.stiffness_left_Nm_per_rad, beams.stiffness_right_Nm_per_rad, "
                    "beams.damping_Nms_per_rad and beams.mass_kg, is {:.6g} 1/s; at most {:.6g} "
                    "1/s ({:.6g} times forces.random_rate_Hz)",
                    rate, kMaxHoldPhase / hold_, kMaxHoldPhase));
}

double EventMethod::advance(GateState& s, double force_x, double duration, EnergyLedger& ledger,
                            Watch& watch) const {
  double passed = 0.0;
  for (int pieces = 0; duration - passed > 1e-12 * duration; ++pieces) {
    const double left = duration - passed;
    if (pieces == 10 * kMostPieces) {
      s.body.vx = std::numeric_limits<double>::quiet_NaN();  // stuck: mark the run as broken
      return duration;
    }
    if (pieces > 0 && pieces % kMostPieces == 0) {
      // Events accumulate, for example between an elastic tip and a disc pressed onto it: hold
      // every contact.
      ++watch.forced_holds;
      const auto t = touches(p_, s, {true, true});
      for (const Side side : {kLeft, kRight}) s.beams[side].held |= t[side].gap <= rise_;
      put_back(p_, s, held_of(s), touches(p_, s, held_of(s)));
    }
    const bool held = s.beams[kLeft].held || s.beams[kRight].held;
    const GateState before = s;
    const double piece = held ? slide_on(s, force_x, left, watch) : fly_on(s, force_x, left, watch);
    passed += piece;
    for (const Side side : {kLeft, kRight})
      watch.max_theta[side] = std::fmax(watch.max_theta[side], swing(side, before, s, piece));
    ledger.step(s, force_x, piece, watch);
    watch.motion(p_, s, 0.0);
    if (!std::isfinite(s.body.vx + s.body.vy) || outside(p_, s.body)) break;
  }
  watch.penetration(p_, s);
  return outside(p_, s.body) ? std::fmin(passed, duration) : duration;
}

GateState EventMethod::flown(const GateState& s, double force_x, double dt) const {
  GateState g = s;
  if (dt == hold_)
    fly(p_, flow_, force_x, {}, g);
  else
    fly(p_, law_, dt, force_x, g);
  return g;
}

double EventMethod::swing(Side side, const GateState& before, const GateState& s, double dt) const {
  const double from = before.beams[side].omega, to = s.beams[side].omega;
  if (!before.beams[side].held) return law_.beams[side].swing(before.beams[side], dt);
  return from * to < 0.0
             ? std::abs(interpolated(before, s, dt, dt * from / (from - to)).beams[side].theta)
             : 0.0;
}

EventMethod::Outlook EventMethod::look_ahead(const GateState& s, std::array<double, 2>& surface,
                                             double force_x, const Push& push, double horizon,
                                             Watch& watch) const {
  Outlook out{std::numeric_limits<double>::infinity(), false};
  const BodyState& b = s.body;
  const double drag = p_.forces.drag / p_.body.mass;
  const double fx = force_x / p_.body.mass + push.ax;
  const double fy = p_.forces.propulsion / p_.body.mass + push.ay;
  const double force = std::sqrt(fx * fx + fy * fy);
  const double v = std::sqrt(b.vx * b.vx + b.vy * b.vy) + force * horizon;  // m/s, drag only slows
  const double a = force + drag * v;                                        // m/s^2
  for (const Side side : {kLeft, kRight}) {
    const BeamState& beam = s.beams[side];
    if (beam.held) continue;
    const double L = p_.beams.length, inertia = p_.beams.inertia();
    const double k = p_.beams.stiffness(side) / inertia;
    const double d = p_.beams.damping / inertia;
    // The energy of a free beam only falls, which bounds its angular velocity for all later times.
    const double w = std::sqrt(beam.omega * beam.omega + k * beam.theta * beam.theta);
    const double px = from_joint(p_, side, b.x);
    const double py = b.y - p_.beams.joint_y;
    const double reach = L + p_.body.radius + v * horizon;
    if (px * px + py * py > reach * reach) continue;

    const double closing = v + L * w;  // m/s, no gap changes faster
    const double span = p_.body.radius + closing * horizon;
    if (std::abs(beam.theta) < 3.0 &&
        (px - span > L || py + span < std::fmin(0.0, L * beam.theta) ||
         py - span > std::fmax(0.0, L * beam.theta)))
      continue;

    const Touch t = nearest(p_, side, b, beam.theta);
    ++watch.evaluations;
    const double u = gap_rate(t, b, beam);
    if (std::isnan(surface[side])) surface[side] = std::fmin(0.0, t.gap);
    const double gap = t.gap - surface[side];
    if (gap <= touching_ && u < -rest_) {
      out.hit = true;
      return out;
    }
    if (gap > closing * horizon) continue;

    // The derivatives of the beam obey the same equation, so the same bound holds for them.
    const double beta = -k * beam.theta - d * beam.omega, jerk = -k * beam.omega - d * beta;
    const double w1 = std::sqrt(beta * beta + k * beam.omega * beam.omega);
    const double w2 = std::sqrt(jerk * jerk + k * beta * beta);
    // gap'' >= now - steepest * time. `now` excludes the curvature of motion around tip and pin,
    // which is positive. If the contact may move onto the interior, `now` includes the terms that
    // act there. `steepest` bounds every term of d/dt (n.a - l beta + bias) on interior, tip and
    // pin.
    const double dist = t.gap + p_.body.radius, far = dist + closing * horizon;
    const double turn = w + closing / p_.body.radius;  // rad/s, turning of n relative to the beam
    double now = free_gap_acceleration(p_, side, t, s, force_x) + t.nx * push.ax + t.ny * push.ay;
    if (t.kind != ContactKind::interior) {
      const double curvature = curvature_term(p_, side, t, b, beam);
      now -= curvature;
      if (std::abs(t.bend) <= turn * horizon)
        now -= 2.0 * w * std::sqrt(curvature * dist) + w * w * dist;
    }
    const double steepest = a * turn + drag * a + v * w1 + L * (w2 + turn * w1) +
                            2.0 * (w1 * v + w * (a + w * v)) + 2.0 * w * w1 * far +
                            w * w * closing + L * w * (2.0 * w1 + w * turn);
    // From rest no safe time can be proved; a margin lets a body leave.
    const double room = std::fmax(gap, 0.0) + (u < -rest_ ? 0.0 : 2.0 * touching_);
    double safe = 0.0;
    for (double ahead = horizon; ahead > 0.0;) {  // a shorter horizon has tighter bounds
      const double zero = first_zero(room, u, steepest * ahead - now);
      if (zero >= ahead) {
        safe = ahead == horizon ? std::numeric_limits<double>::infinity() : ahead;
        break;
      }
      safe = std::fmax(safe, zero);
      if (4.0 * zero >= ahead) break;
      ahead = 4.0 * zero;
    }
    out.safe = std::fmin(out.safe, safe);
  }
  return out;
}

double EventMethod::leave(const GateState& start, GateState& s, double force_x, double dt) const {
  // A cubic over a whole hold is inaccurate with strong drag; a cubic over a hundredth of a hold is
  // accurate.
  GateState end = s;
  const double about = back_to_exit(p_, start, end, dt);
  const double from = std::fmax(0.0, about - 0.005 * dt), to = std::fmin(dt, about + 0.005 * dt);
  const GateState before = flown(start, force_x, from), after = flown(start, force_x, to);
  double when = about;
  if (!outside(p_, before.body) && outside(p_, after.body)) {
    end = after;
    when = from + back_to_exit(p_, before, end, to - from);
  }
  // The position must be beyond the border to the last bit; all else is in closed form.
  s = flown(start, force_x, when);
  s.body.x = end.body.x;
  s.body.y = end.body.y;
  return when;
}

void EventMethod::resolve(GateState& s, double force_x, Watch& watch) const {
  resolve_hits(
      p_, s, touching_, rest_, watch, [&](Side side, const Touch& t, double, double rebound) {
        // The acceleration that drives the contact back: of all forces, including the other
        // contact's if it is held.
        double back = free_gap_acceleration(p_, side, t, s, force_x);
        if (s.beams[1 - side].held) {
          const Motion m(p_, s, force_x);
          if (m.force[1 - side] > 0.0) back += t.nx * m.push.ax + t.ny * m.push.ay;
        }
        // For nearly elastic hits the limit is lower, but not below what rounding can tell from
        // contact.
        const double part = weak_hits(p_, t.kind);
        const double rise = part > 0.0 ? std::fmax(part * tolerance_, 1e3 * touching_) : 0.0;
        return back < 0.0 && rebound * rebound <= 2.0 * -back * rise;
      });
}

double EventMethod::fly_on(GateState& s, double force_x, double duration, Watch& watch) const {
  const GateState start = s;
  std::array<double, 2> surface = kNotSeen;
  double t = 0.0;
  for (int looks = 0; looks < kMostLooks; ++looks) {
    const Outlook ahead = look_ahead(s, surface, force_x, {}, duration - t, watch);
    if (ahead.hit) {
      resolve(s, force_x, watch);
      return t;
    }
    const bool over = ahead.safe >= duration - t;
    t = over ? duration : t + ahead.safe;
    s = flown(start, force_x, t);
    if (!outside(p_, s.body)) {
      // The body may leave and return in one flight: check the points where it turns.
      const bool turns_x = start.body.vx * s.body.vx < 0.0,
                 turns_y = start.body.vy * s.body.vy < 0.0;
      for (const bool x : {true, false}) {
        if (!(x ? turns_x : turns_y)) continue;
        const double v0 = x ? start.body.vx : start.body.vy, v1 = x ? s.body.vx : s.body.vy;
        const double when = t * v0 / (v0 - v1);
        GateState there = flown(start, force_x, when);
        if (outside(p_, there.body)) {
          s = there;
          return leave(start, s, force_x, when);
        }
      }
    } else {
      return leave(start, s, force_x, t);
    }
    if (over || !std::isfinite(s.body.vx + s.body.vy)) return t;
  }
  // No progress is possible: mark the run as broken.
  s.body.vx = std::numeric_limits<double>::quiet_NaN();
  return duration;
}

double EventMethod::slide_on(GateState& s, double force_x, double duration, Watch& watch) const {
  Motion start(p_, s, force_x);
  ++watch.evaluations;
  if (start.force[kLeft] < 0.0 || start.force[kRight] < 0.0) {
    const auto force = contact_forces(p_, s, start.touch, force_x, held_of(s), unilateral_impulses);
    for (const Side side : {kLeft, kRight}) s.beams[side].held &= force[side] > 0.0;
    if (!s.beams[kLeft].held && !s.beams[kRight].held) return 0.0;
    start = Motion(p_, s, force_x);
  }
  const auto held = held_of(s);
  double h = duration;
  std::array<double, 2> surface = kNotSeen;
  if (!held[kLeft] || !held[kRight]) {
    const Outlook ahead = look_ahead(s, surface, force_x, start.push, h, watch);
    if (ahead.hit) {
      resolve(s, force_x, watch);
      return 0.0;
    }
    h = std::fmin(h, ahead.safe);
  }

  for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
    Step step = loose_ ? integrated<BogackiShampine>(p_, s, start, force_x, h, time_)
                       : integrated<DormandPrince>(p_, s, start, force_x, h, time_);
    watch.evaluations += loose_ ? 3 : 6;
    if (!(step.error <= tolerance_)) {
      const double order = loose_ ? BogackiShampine::kOrder : DormandPrince::kOrder;
      const double shrink = 0.9 * std::pow(tolerance_ / step.error, 1.0 / order);
      h *= std::clamp(shrink, 0.1, 0.9);
      continue;
    }
    // look_ahead assumed constant contact forces. If they were not constant, take a shorter step.
    bool overlap = false;
    for (const Side side : {kLeft, kRight}) {
      if (held[side] || std::isnan(surface[side])) continue;
      const BeamState& beam = step.end.beams[side];
      if (out_of_reach(p_, side, step.end.body, beam.theta)) continue;
      ++watch.evaluations;
      overlap |= nearest(p_, side, step.end.body, beam.theta).gap < surface[side] - 2.0 * touching_;
    }
    if (overlap) {
      h *= 0.5;
      continue;
    }
    // A contact force became a pull: go back to where it was zero, within the tolerance.
    double release = 1.0;
    std::array<bool, 2> keep = held;
    for (const Side side : {kLeft, kRight}) {
      if (!held[side]) continue;
      const double f0 = start.force[side], f1 = step.motion.force[side];
      if (f1 >= 0.0) continue;
      const double slope = (f0 - f1) / h;
      if (-f1 <= std::sqrt(2.0 * (tolerance_ / time_) * slope * p_.body.mass)) {
        keep[side] = false;
      } else {
        release = std::fmin(release, f0 / (f0 - f1));
      }
    }
    if (release < 1.0) {
      h *= std::fmax(release, 1e-3);
      continue;
    }
    const GateState before = s;
    s = step.end;
    for (const Side side : {kLeft, kRight}) s.beams[side].held = keep[side];
    put_back(p_, s, held, step.motion.touch);
    if (outside(p_, s.body)) return back_to_exit(p_, before, s, h);
    return h;
  }
  // No step is small enough: mark the run as broken.
  s.body.vx = std::numeric_limits<double>::quiet_NaN();
  return duration;
}

}  // namespace gatewalk::dynamics
