// SPDX-License-Identifier: MIT
#pragma once
/// What the methods share that follow free motion, hits and constraints apart (`stable`, `event`):
/// the laws at a moment of impact and the way back onto a constraint.

#include "dynamics/disc/flow.h"
#include "dynamics/disc/methods/method.h"

namespace gatewalk::dynamics {

/// A contact this slow (m/s) does not close.
[[nodiscard]] inline double rest_speed(const GateParams& p) { return 1e-12 * scale_of(p).speed(); }

/// Restitution of the surface that a contact of this kind hits.
[[nodiscard]] inline double restitution_of(const GateParams& p, ContactKind kind) {
  return kind == ContactKind::tip ? p.contact.tip_restitution : p.contact.restitution;
}

/// Factor of the threshold below which a weak hit ends the bouncing. Up to a restitution e of 0.95
/// it is 1. The bounces left after a hit take a time in proportion to its speed / (1 - e), so
/// beyond 0.95 the factor is as small as keeps that time: 0 for e = 1, whose bounces never end. A
/// body that forces press onto a gate reaches all of its surfaces: e is the least of them. Without
/// propulsion and random force nothing presses bodies together for long: there e is that of the
/// surface that is hit, and the factor 0 beyond 0.95.
[[nodiscard]] inline double weak_hits(const GateParams& p, ContactKind kind) {
  constexpr double kElastic = 0.95;
  const bool pressed = p.forces.propulsion != 0.0 || p.forces.random != 0.0;
  if (!pressed) return restitution_of(p, kind) > kElastic ? 0.0 : 1.0;
  const double e = std::min(p.contact.restitution, p.contact.tip_restitution);
  return std::min(1.0, (1.0 - e) / (1.0 - kElastic));
}

/// Contact points of the wanted beams; an unwanted one has no direction and no lever.
[[nodiscard]] std::array<Touch, 2> touches(const GateParams& p, const GateState& s,
                                           std::array<bool, 2> wanted);

/// The same for a state soon before or after one whose contact points are known; those not wanted
/// need not be.
[[nodiscard]] std::array<Touch, 2> touches(const GateParams& p, const GateState& s,
                                           std::array<bool, 2> wanted,
                                           const std::array<Touch, 2>& nearby);

[[nodiscard]] inline std::array<bool, 2> held_of(const GateState& s) {
  return {s.beams[kLeft].held, s.beams[kRight].held};
}

[[nodiscard]] inline bool at_rest(const BeamState& beam) {
  return beam.theta == 0.0 && beam.omega == 0.0;
}

/// Free motion over flow.dt under the random force (N) and constant pushes.
void fly(const GateParams& p, const GateFlow& flow, double force_x, const Push& push, GateState& s);

/// Free motion over any dt; beams at rest cost nothing.
void fly(const GateParams& p, const GateLaw& law, double dt, double force_x, GateState& s);

/// Puts `contacts` back to gap = 0 and u = 0, positions and velocities shifted along the mass
/// metric; `touch` is where they are in `s`, the result where they are then. Removes energy or
/// leaves it, to second order.
std::array<Touch, 2> put_back(const GateParams& p, GateState& s, std::array<bool, 2> contacts,
                              std::array<Touch, 2> touch);

/// Impact law at every contact that closes (gap up to `touching`, m, faster than `rest`, m/s), both
/// beams together, until none does. `ends_bouncing(side, touch, impulse, rebound)` says whether a
/// hit of that impulse (N s), which leaves with the gap rate `rebound` (m/s), is so weak that the
/// contact is a constraint instead.
template <class EndsBouncing>
void resolve_hits(const GateParams& p, GateState& s, double touching, double rest, Watch& watch,
                  EndsBouncing ends_bouncing) {
  constexpr int kRounds = 20;  // the last one is plastic
  const auto touch = touches(p, s, {true, true});
  watch.evaluations += 2;
  const Coupling w = coupling(p, touch);
  for (int round = 0; round < kRounds; ++round) {
    std::array<double, 2> u{}, b{}, rebound{};
    std::array<bool, 2> active{};
    for (const Side side : {kLeft, kRight}) {
      const bool held = s.beams[side].held;
      u[side] = gap_rate(touch[side], s.body, s.beams[side]);
      // Only contacts that close take part. A contact that opens must not be pushed by the other's
      // restitution, that could create energy; if it closes after this round, it takes the next.
      active[side] = held || (touch[side].gap <= touching && u[side] < -rest);
      const double e = restitution_of(p, touch[side].kind);
      const bool elastic = !held && round < kRounds - 1;
      rebound[side] = elastic ? -e * u[side] : 0.0;
      b[side] = u[side] - rebound[side];
    }
    const auto done = [&](Side side) { return !active[side] || u[side] >= -rest; };
    if (done(kLeft) && done(kRight)) return;

    auto impulse = unilateral_impulses(w, b, active);
    // A weak hit ends the bouncing: perfectly inelastic, then a constraint. Asked of both before
    // either is held: the answer may look at the other beam, and a mirror image must not change it.
    std::array<bool, 2> ends{};
    for (const Side side : {kLeft, kRight})
      ends[side] = active[side] && !s.beams[side].held &&
                   ends_bouncing(side, touch[side], impulse[side], rebound[side]);
    for (const Side side : {kLeft, kRight}) {
      if (!ends[side]) continue;
      s.beams[side].held = true;
      b[side] = u[side];
    }
    impulse = unilateral_impulses(w, b, active);
    // A held beam that the other side's hit throws off is free again; but not if it would be back
    // at once: two contacts would free each other without end. Then both stay shut.
    for (const Side side : {kLeft, kRight}) {
      if (!active[side] || !s.beams[side].held || impulse[side] > 0.0) continue;
      const double opens = b[side] + w.cross * impulse[1 - side];
      if (opens <= 0.0) continue;
      const double stop = opens / (side == kLeft ? w.left : w.right);
      if (ends_bouncing(side, touch[side], stop, opens))
        impulse = bilateral_impulses(w, b, active);
      else
        s.beams[side].held = false;
    }
    apply_impulses(p, touch, impulse, s);
    watch.impacts += active[kLeft] + active[kRight];
    watch.hit_loss -= energy_gain(w, u, impulse);
    for (const Side side : {kLeft, kRight}) watch.impulse[side] += impulse[side];
  }
}

}  // namespace gatewalk::dynamics
