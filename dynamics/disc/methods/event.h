// SPDX-License-Identifier: MIT
#pragma once
/// `event`: event-driven simulation without a time step. Motion is interrupted only by events: a
/// change of the random force, a hit, the end of a contact, the exit from the gate.
///
/// Free motion is in closed form, so a spell of constant force costs one evaluation if nothing is
/// near. Conservative advancement finds hits: the gap, its rate and a bound on how fast the rate
/// can fall give a time before which there is no contact; the state advances to that time and the
/// search repeats. No graze is stepped over, and the steps shrink quadratically towards a hit.
///
/// A hit whose rebound would rise less than the tolerance ends the bouncing (Zeno). The contact
/// becomes a constraint, whose equations of motion are integrated by an embedded Runge-Kutta pair
/// with error control and projected back onto the constraint after every step. The contact is
/// released when its force would start to pull.
///
/// run.step_s and contact.impulse_threshold_Ns have no effect. run.event_tolerance_m is the error
/// per step of positions and beam tips, and of velocities times the scene's unit of time.

#include "dynamics/disc/methods/hybrid.h"

namespace gatewalk::dynamics {

class EventMethod final : public Method {
 public:
  /// Throws InvalidParameter if the beams move much faster than the random force is held: the
  /// vibrations of the beams, not events, would then take all the time.
  explicit EventMethod(const GateParams& p);

  double advance(GateState& s, double force_x, double duration, EnergyLedger& ledger,
                 Watch& watch) const override;

 private:
  /// fly_on (no held contact) and slide_on (held contacts) advance `s` by at most `duration` (s),
  /// up to and through the next event. They return the time advanced.
  double fly_on(GateState& s, double force_x, double duration, Watch& watch) const;
  double slide_on(GateState& s, double force_x, double duration, Watch& watch) const;

  /// The earliest time at which a contact that is not held could close, seen from `s`.
  struct Outlook {
    double safe = 0.0;  // s, time before which no contact closes
    bool hit = false;   // a contact closes now
  };
  /// Computes the outlook. `surface` is the gap (m) at which each contact counts as closed: 0, or
  /// less if the bodies overlapped when first evaluated; NaN before the first evaluation.
  [[nodiscard]] Outlook look_ahead(const GateState& s, std::array<double, 2>& surface,
                                   double force_x, const Push& push, double horizon,
                                   Watch& watch) const;
  void resolve(GateState& s, double force_x, Watch& watch) const;
  /// |theta| (rad) at which a beam turned back between the two states, which are `dt` apart; 0 if
  /// it did not turn.
  [[nodiscard]] double swing(Side side, const GateState& before, const GateState& s,
                             double dt) const;
  /// Moves `s`, which is outside the gate `dt` after `start` in free flight, back to the moment of
  /// leaving. Returns the time from `start` to that moment.
  double leave(const GateState& start, GateState& s, double force_x, double dt) const;
  [[nodiscard]] GateState flown(const GateState& s, double force_x, double dt) const;

  const GateParams& p_;
  double touching_;   // m, smaller gaps count as contact
  double rise_;       // m, lower rebounds are not simulated
  double tolerance_;  // m, error per Runge-Kutta step
  double time_;       // s, the scene's unit of time, which converts errors from m/s to m
  double rest_;       // m/s, contacts this slow count as not closing
  bool loose_;        // the tolerance is coarse enough for an integrator of low order
  double hold_;       // s, time between two changes of the random force
  GateLaw law_;
  GateFlow flow_;  // flow over a whole hold
};

}  // namespace gatewalk::dynamics
