// SPDX-License-Identifier: MIT
#include "dynamics/disc/methods/stable.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "dynamics/disc/methods/march.h"

namespace gatewalk::dynamics {
namespace {

constexpr double kMaxSubstepPhase = 0.5;  // rad or e-folds of a beam per piece
// Halvings for a held beam that turns fast or changes its kind of contact.
constexpr int kContactHalvings = 4;
constexpr int kMaxHits = 50;  // hits in a piece, after which hits become constraints

/// The number of halvings, at most `limit`, after which `phase` does not exceed `most`.
int halvings_for(double phase, double most, int limit) {
  int n = 0;
  for (; phase > most && n < limit; phase *= 0.5) ++n;
  return n;
}

double halved(double step, int n) { return n == 0 ? step : std::ldexp(step, -n); }

void refuse_too_fast(const GateParams& p) {
  const double k = std::max(p.beams.stiffness_left, p.beams.stiffness_right);
  const double inertia = p.beams.inertia();
  const double rate = std::max(std::sqrt(k / inertia), p.beams.damping / inertia);
  const double longest = std::ldexp(kMaxSubstepPhase, StableMethod::kMaxHalvings) / rate;  // s
  if (p.run.step <= longest) return;
  throw InvalidParameter(
      "run.step_s",
      fmt::format("run.step_s = {:.6g} is not permitted for these beams: their fastest rate, from "
                  "beams.stiffness_left_Nm_per_rad, beams.stiffness_right_Nm_per_rad, "
                  "beams.damping_Nms_per_rad and beams.mass_kg, is {:.6g} 1/s; method stable "
                  "permits at most {:.6g} s",
                  p.run.step, rate, longest));
}

/// The time at which `gap(t)` falls through zero on (0, dt]: regula falsi, Illinois variant, which
/// keeps a bracket and is superlinear on smooth functions. The search stops at |gap| <= tolerance.
/// gap(0) = start > 0 and gap(dt) = end < 0; or, with `from_zero`, gap(0) = 0 and `start` is its
/// rate > 0: the search then uses gap/t, whose sign is safe from rounding near t = 0.
template <class Gap>
double crossing(double dt, double start, double end, bool from_zero, double tolerance, Gap gap) {
  double a = 0.0, fa = start, b = dt, fb = from_zero ? end / dt : end;
  int kept = 0;  // end that stayed in the last round: -1 a, +1 b
  for (int i = 0; i < 100; ++i) {
    const double margin = 1e-15 * dt;
    if (b - a <= 4 * margin) break;
    const double t = std::clamp(b - fb * (b - a) / (fb - fa), a + margin, b - margin);
    const double value = gap(t);
    if (std::abs(value) <= tolerance) return t;
    const double f = from_zero ? value / t : value;
    if (f < 0.0) {
      b = t;
      fb = f;
      if (kept == -1) fa *= 0.5;
      kept = -1;
    } else {
      a = t;
      fa = f;
      if (kept == +1) fb *= 0.5;
      kept = +1;
    }
  }
  return b;
}

/// The impulse (N s) below which a hit of that part of a beam is weak.
double weak_impulse(const GateParams& p, ContactKind kind) {
  return p.contact.impulse_threshold * p.run.step / (kPaperStep * scale_of(p).time) *
         weak_hits(p, kind);
}

}  // namespace

StableMethod::Limits::Limits(const GateParams& p)
    : threshold(weak_impulse(p, ContactKind::interior)),
      tip_threshold(weak_impulse(p, ContactKind::tip)),
      touching(1e-10 * p.body.radius),
      rest(rest_speed(p)) {
  const double inertia = p.beams.inertia();
  for (const Side side : {kLeft, kRight}) {
    // The explicit contact force must resolve both rates of a held beam.
    swing[side] = p.beams.stiffness(side) / inertia;
    swing_root[side] = std::sqrt(swing[side]);
    const double rate = std::max(swing_root[side], p.beams.damping / inertia);
    halvings[side] = halvings_for(p.run.step * rate, kMaxSubstepPhase, kMaxHalvings);
  }
}

StableMethod::StableMethod(const GateParams& p) : p_(p), limits_(p), law_(p) {
  refuse_too_fast(p);
  finest_ = std::max({kContactHalvings, limits_.halvings[kLeft], limits_.halvings[kRight]});
  for (int n = 0; n <= finest_ + 1; ++n) flows_.push_back(law_.over(std::ldexp(p.run.step, -n)));
}

double StableMethod::advance(GateState& s, double force_x, double duration, EnergyLedger& ledger,
                             Watch& watch) const {
  const Spell spell(p_, duration);
  for (long i = 0; i < spell.steps; ++i) {
    Progress done;
    finish_step(s, force_x, spell.step, done, watch);
    ledger.step(s, force_x, done.passed, watch);
    watch.motion(p_, s, 0.0);
    watch.fast_steps += done.fast;
    if (outside(p_, s.body) || !std::isfinite(s.body.vx + s.body.vy))
      return static_cast<double>(i) * spell.step + done.passed;
  }
  return duration;
}

void StableMethod::finish_step(GateState& s, double force_x, double step, Progress& done,
                               Watch& watch) const {
  // Pieces are halves, quarters, ... of the step, each beginning at a multiple of its own length.
  while (done.unit < kUnits && !outside(p_, s.body)) {
    int n = std::max(level(s, step, done.unit), std::exchange(done.halved, 0));
    double time = 0.0;
    const auto beams = s.beams;
    const std::int64_t impacts = watch.impacts;
    for (;; ++n) {
      time = substep(s, force_x, piece(step, n), {n < finest_, n < kMaxHalvings}, watch);
      if (time != 0.0) break;
    }
    if (watch.impacts == impacts)
      for (const Side side : {kLeft, kRight}) watch_swing(side, beams[side], time, watch);
    done.fast |= n == kMaxHalvings && too_far(s, halved(step, n));
    done.passed += time;
    done.unit += kUnits >> n;
  }
}

int StableMethod::level(const GateState& s, double step, int unit) const {
  int n = halvings(s);
  while (n < kMaxHalvings && too_far(s, halved(step, n))) ++n;
  while (unit % (kUnits >> n) != 0) ++n;
  return n;
}

void StableMethod::watch_swing(Side side, const BeamState& before, double seconds,
                               Watch& watch) const {
  if (limits_.halvings[side] == 0 || before.held) return;
  // The beam's energy bounds its swing.
  const double far =
      before.theta * before.theta + before.omega * before.omega / limits_.swing[side];
  if (far * (1 + 1e-9) <= watch.max_theta[side] * watch.max_theta[side]) return;
  watch.max_theta[side] = std::max(watch.max_theta[side], law_.beams[side].swing(before, seconds));
}

StableMethod::Piece StableMethod::piece(double step, int halvings) const {
  const double dt = halved(step, halvings);
  if (step != p_.run.step || halvings > finest_) return {dt};
  return {dt, &flow(halvings), &flow(halvings + 1)};
}

bool StableMethod::too_far(const GateState& s, double dt) const {
  const double most = 0.5 * p_.body.radius;
  // Usually a bound without roots suffices.
  double turns = 0.0;
  for (const Side side : {kLeft, kRight})
    turns = std::max(turns, std::abs(s.beams[side].omega) +
                                limits_.swing_root[side] * std::abs(s.beams[side].theta));
  if ((std::abs(s.body.vx) + std::abs(s.body.vy) + p_.beams.length * turns) * dt <= most)
    return false;
  const double disc = std::sqrt(s.body.vx * s.body.vx + s.body.vy * s.body.vy) * dt;
  if (disc > most) return true;
  for (const Side side : {kLeft, kRight}) {
    const BeamState& beam = s.beams[side];
    // The beam's energy falls between hits, which bounds its angular velocity.
    const double turn =
        std::sqrt(beam.omega * beam.omega + limits_.swing[side] * beam.theta * beam.theta);
    const double tip = p_.beams.length * turn * dt;
    if (disc + tip > most && !out_of_reach(p_, side, s.body, beam.theta, disc + tip)) return true;
  }
  return false;
}

int StableMethod::halvings(const GateState& s) const {
  int most = 0;
  double turning = 0.0;  // rad/s
  for (const Side side : {kLeft, kRight}) {
    const BeamState& beam = s.beams[side];
    if (beam.held) turning = std::max(turning, std::abs(beam.omega));
    if (limits_.halvings[side] <= most) continue;
    if (!beam.held) {
      // A free beam moves in closed form, but within a step it could hit and be gone again, or
      // become held.
      const double speed = std::sqrt(s.body.vx * s.body.vx + s.body.vy * s.body.vy);
      const double turn =
          std::sqrt(beam.omega * beam.omega + limits_.swing[side] * beam.theta * beam.theta);
      const double approach = (speed + p_.beams.length * turn) * p_.run.step;
      if (out_of_reach(p_, side, s.body, beam.theta, approach)) continue;
    }
    most = limits_.halvings[side];
  }
  // A light beam that a heavy disc holds near the joint may turn too fast for any piece.
  return std::max(most, halvings_for(p_.run.step * turning, kMaxTurn, finest_));
}

StableMethod::Glide StableMethod::glide(GateState& s, double force_x, const Piece& piece) const {
  const double dt = piece.dt;
  if (s.beams[kLeft].held || s.beams[kRight].held)
    return piece.flow != nullptr ? glide_held(s, force_x, *piece.flow, *piece.half_flow)
                                 : glide_held(s, force_x, law_.over(dt), law_.over(0.5 * dt));
  if (piece.flow != nullptr)
    fly(p_, *piece.flow, force_x, {}, s);
  else
    fly(p_, law_, dt, force_x, s);
  return {};
}

StableMethod::Glide StableMethod::glide_held(GateState& s, double force_x, const GateFlow& flow,
                                             const GateFlow& half_flow) const {
  const auto held = held_of(s);
  // Explicit midpoint rule: forces at the start move the state to mid-step; forces there move it
  // over the whole step.
  const auto start = touches(p_, s, held);
  const Push first(p_, start, contact_forces(p_, s, start, force_x, held, unilateral_impulses));
  GateState mid = s;
  fly(p_, half_flow, force_x, first, mid);
  const auto middle = touches(p_, mid, held, start);
  const auto force = contact_forces(p_, mid, middle, force_x, held, unilateral_impulses);
  const Push second(p_, middle, force);
  fly(p_, flow, force_x, second, s);

  // Contacts only push: without force at mid-step the contact is over, unless the bodies still
  // overlap.
  std::array<bool, 2> keep = held;
  const auto end = touches(p_, s, held, middle);
  bool handover = false;
  for (const Side side : {kLeft, kRight}) {
    if (held[side] && force[side] == 0.0 && end[side].gap >= 0.0) {
      keep[side] = false;
      s.beams[side].held = false;
    }
    const ContactKind kind = start[side].kind;
    handover |= held[side] && (middle[side].kind != kind || end[side].kind != kind);
  }
  return {put_back(p_, s, keep, end), handover};
}

double StableMethod::substep(GateState& s, double force_x, const Piece& piece, MayHalve may_halve,
                             Watch& watch) const {
  GateState begin;  // before the first hit
  Watch seen;
  double left = piece.dt;
  for (int hits = 0;; ++hits) {
    GateState end = s;
    const Glide glided = glide(end, force_x, hits == 0 ? piece : Piece{left});

    // A body that leaves the gate counts until it leaves.
    const bool leaves = outside(p_, end.body);
    const double span = leaves ? leave(s, end, left) : left;
    std::array<bool, 2> hit{false, false};
    double overlap = 0.0;  // m
    for (const Side side : {kLeft, kRight}) {
      const BeamState& beam = end.beams[side];
      if (!beam.held && out_of_reach(p_, side, end.body, beam.theta)) continue;
      const double gap =
          beam.held ? glided.shut[side].gap : nearest(p_, side, end.body, beam.theta).gap;
      hit[side] = !beam.held && gap < -limits_.touching;
      overlap = std::max(overlap, -gap);
    }
    watch.evaluations += 2 + 3 * s.beams[kLeft].held + 3 * s.beams[kRight].held;
    // The contact force jumps where a contact changes its kind; only a short piece may cross the
    // jump.
    if (hits == 0 && glided.handover && may_halve.handover) return 0.0;
    const double start = piece.dt - left;
    if (!hit[kLeft] && !hit[kRight]) {
      s = end;
      watch.max_penetration = std::max(watch.max_penetration, overlap);
      return leaves ? start + span : piece.dt;
    }
    // Hits accumulate faster than the step resolves them: from here on each hit ends in a
    // constraint.
    watch.forced_holds += hits == kMaxHits;
    // Constraints do not help either: finish the piece with all hit beams held.
    if (hits == 2 * kMaxHits) {
      s = end;
      for (const Side side : {kLeft, kRight}) s.beams[side].held |= hit[side];
      put_back(p_, s, held_of(s), touches(p_, s, held_of(s)));
      watch.penetration(p_, s);
      return leaves ? start + span : piece.dt;
    }
    if (hits == 0 && may_halve.travel) {
      begin = s;
      seen = watch;
    }
    const double when = first_hit(s, force_x, end, span, hit, watch);
    if (outside(p_, s.body)) return start + when;
    resolve_hits(p_, s, limits_.touching, limits_.rest, watch,
                 [&](Side, const Touch& touch, double impulse, double rebound) {
                   const double threshold =
                       touch.kind == ContactKind::tip ? limits_.tip_threshold : limits_.threshold;
                   // A hit without rebound becomes a contact.
                   return impulse < threshold || rebound <= limits_.rest || hits >= kMaxHits;
                 });
    left -= when;
    if (left <= 1e-15 * piece.dt) return piece.dt;
    if (may_halve.travel && too_far(s, left)) {
      s = begin;
      watch = seen;
      return 0.0;
    }
  }
}

double StableMethod::leave(const GateState& before, GateState& s, double dt) const {
  const double when = back_to_exit(p_, before, s, dt);
  // A free beam may swing many times in a step, which no cubic follows; use its closed form.
  for (const Side side : {kLeft, kRight}) {
    if (before.beams[side].held) continue;
    s.beams[side] = before.beams[side];
    law_.beams[side].over(when).apply(s.beams[side], 0.0);
  }
  return when;
}

double StableMethod::first_hit(GateState& s, double force_x, const GateState& end, double dt,
                               std::array<bool, 2> hit, Watch& watch) const {
  double earliest = dt;
  GateState at_hit = end;
  for (const Side side : {kLeft, kRight}) {
    if (!hit[side]) continue;
    const Touch now = nearest(p_, side, s.body, s.beams[side].theta);
    const double rate = gap_rate(now, s.body, s.beams[side]);
    // From contact, the next hit is where the gap returns to its present value; with u <= 0 the hit
    // is now.
    const bool from_contact = now.gap <= limits_.touching;
    if (from_contact && rate <= 0.0) return 0.0;
    const double level = from_contact ? now.gap : 0.0;
    ++watch.evaluations;
    const auto touch_of = [&](const GateState& g) {
      ++watch.evaluations;
      return nearest(p_, side, g.body, now.beam.turned_to(g.beams[side].theta));
    };
    const auto gap_of = [&](const GateState& g) { return touch_of(g).gap - level; };
    const auto moved = [&](double t) {
      GateState g = s;
      glide(g, force_x, Piece{t});
      return g;
    };
    const double start = from_contact ? rate : now.gap;

    // The first guess comes from the interpolated motion, which is cheap. Newton's method on the
    // exact motion follows while the gap closes. If it does not reach the contact, a safe search
    // does. Near contact, where the hit may be at once, the first guess must be good.
    const double guess = (from_contact ? 10 : kGuess) * limits_.touching;
    double when = crossing(dt, start, gap_of(end), from_contact, guess,
                           [&](double t) { return gap_of(interpolated(s, end, dt, t)); });
    GateState there = moved(when);
    Touch t = touch_of(there);
    const double exact = 1e-3 * limits_.touching, near = 0.1 * limits_.touching;
    for (int i = 0; i < kNewtonSteps && !(std::abs(t.gap - level) <= exact); ++i) {
      const double falling = gap_rate(t, there.body, there.beams[side]);
      const double next = when - (t.gap - level) / falling;
      if (!(falling < 0.0 && next > 0.0 && next <= dt)) break;
      when = next;
      there = moved(when);
      t = touch_of(there);
    }
    if (!(std::abs(t.gap - level) <= near)) {
      when = crossing(dt, start, gap_of(end), from_contact, 0.01 * limits_.touching,
                      [&](double time) { return gap_of(moved(time)); });
      there = moved(when);
    }
    if (when < earliest) {
      earliest = when;
      at_hit = there;
    }
  }
  s = at_hit;
  return earliest;
}

}  // namespace gatewalk::dynamics
