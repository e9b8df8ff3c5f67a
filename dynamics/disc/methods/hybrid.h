// SPDX-License-Identifier: MIT
#pragma once
/// Common parts of the methods that treat free motion, hits and constraints separately (`stable`,
/// `event`): the laws at the moment of impact and the projection onto a constraint.

#include "dynamics/disc/flow.h"
#include "dynamics/disc/methods/method.h"

namespace gatewalk::dynamics {

/// The speed (m/s) below which a contact counts as not closing.
[[nodiscard]] inline double rest_speed(const GateParams& p) { return 1e-12 * scale_of(p).speed(); }

/// The restitution of the surface at a contact of this kind.
[[nodiscard]] inline double restitution_of(const GateParams& p, ContactKind kind) {
  return kind == ContactKind::tip ? p.contact.tip_restitution : p.contact.restitution;
}

/// The factor on the threshold below which a weak hit ends the bouncing: 1 up to a restitution e of
/// 0.95, smaller beyond. The remaining bounces after a hit take a time proportional to its speed /
/// (1 - e); the factor keeps that time from growing beyond its value at 0.95. It is 0 for e = 1,
/// whose bounces never end.
///
/// Forces that press a body onto a gate bring it to all surfaces, so e is the smaller of both
/// restitutions. Without propulsion and random force nothing presses for long: e is then that of
/// the surface hit, and the factor is 0 beyond 0.95.
[[nodiscard]] inline double weak_hits(const GateParams& p, ContactKind kind) {
  constexpr double kElastic = 0.95;
  const bool pressed = p.forces.propulsion != 0.0 || p.forces.random != 0.0;
  if (!pressed) return restitution_of(p, kind) > kElastic ? 0.0 : 1.0;
  const double e = std::min(p.contact.restitution, p.contact.tip_restitution);
  return std::min(1.0, (1.0 - e) / (1.0 - kElastic));
}

/// The contact points of the `wanted` beams; the contact of another beam has no direction and no
/// lever.
[[nodiscard]] std::array<Touch, 2> touches(const GateParams& p, const GateState& s,
                                           std::array<bool, 2> wanted);

/// The contact points of the `wanted` beams for a state shortly before or after one with known
/// contact points `nearby`; those of other beams need not be known.
[[nodiscard]] std::array<Touch, 2> touches(const GateParams& p, const GateState& s,
                                           std::array<bool, 2> wanted,
                                           const std::array<Touch, 2>& nearby);

[[nodiscard]] inline std::array<bool, 2> held_of(const GateState& s) {
  return {s.beams[kLeft].held, s.beams[kRight].held};
}

[[nodiscard]] inline bool at_rest(const BeamState& beam) {
  return beam.theta == 0.0 && beam.omega == 0.0;
}

/// Free motion over flow.dt under the random force (N) and constant accelerations by pushes.
void fly(const GateParams& p, const GateFlow& flow, double force_x, const Push& push, GateState& s);

/// Free motion over any dt (s); beams at rest cost nothing.
void fly(const GateParams& p, const GateLaw& law, double dt, double force_x, GateState& s);

/// Projects `contacts` back to gap = 0 and u = 0 by shifting positions and velocities along the
/// mass metric. `touch` holds the contact points of `s`; the result holds them after the shift. To
/// second order the projection removes energy or keeps it.
std::array<Touch, 2> put_back(const GateParams& p, GateState& s, std::array<bool, 2> contacts,
                              std::array<Touch, 2> touch);

/// Applies the impact law at every closing contact (gap up to `touching`, m, faster than `rest`,
/// m/s), to both beams together, until no contact closes. `ends_bouncing(side, touch, impulse,
/// rebound)` tells whether a hit of that impulse (N s), which rebounds with the gap rate `rebound`
/// (m/s), is so weak that the contact becomes a constraint instead.
template <class EndsBouncing>
void resolve_hits(const GateParams& p, GateState& s, double touching, double rest, Watch& watch,
                  EndsBouncing ends_bouncing) {
  constexpr int kRounds = 20;  // the last round is perfectly inelastic
  const auto touch = touches(p, s, {true, true});
  watch.evaluations += 2;
  const Coupling w = coupling(p, touch);
  for (int round = 0; round < kRounds; ++round) {
    std::array<double, 2> u{}, b{}, rebound{};
    std::array<bool, 2> active{};
    for (const Side side : {kLeft, kRight}) {
      const bool held = s.beams[side].held;
      u[side] = gap_rate(touch[side], s.body, s.beams[side]);
      // Only closing contacts take part. The other contact's restitution must not push a contact
      // that opens, because energy could appear. If the contact closes after this round, it takes
      // part in the next.
      active[side] = held || (touch[side].gap <= touching && u[side] < -rest);
      const double e = restitution_of(p, touch[side].kind);
      const bool elastic = !held && round < kRounds - 1;
      rebound[side] = elastic ? -e * u[side] : 0.0;
      b[side] = u[side] - rebound[side];
    }
    const auto done = [&](Side side) { return !active[side] || u[side] >= -rest; };
    if (done(kLeft) && done(kRight)) return;

    auto impulse = unilateral_impulses(w, b, active);
    // A weak hit ends the bouncing: it is perfectly inelastic, then the contact is a constraint.
    // Both contacts are tested before either is held, because the test may depend on the other
    // beam, and a mirror image must give the same answer.
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
    // A held beam that the other side's hit throws off is released, unless it would be back at
    // once: the two contacts would then release each other without end, so both stay closed.
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
