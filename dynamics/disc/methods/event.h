// SPDX-License-Identifier: MIT
#pragma once
/// `event`: event-driven. Motion is cut at events only: a change of the random force, a hit, the
/// end of a contact, the way out of the gate.
///
/// Free motion is closed-form, so a spell of constant force costs one evaluation when nothing is
/// near. Hits are found by conservative advancement: from gap, its rate and a bound on how fast
/// that can fall, a time is computed before which there is no contact; the state goes there and
/// looks again. No graze is stepped over, and the steps shrink quadratically towards a hit.
///
/// A hit whose rebound would rise less than the tolerance ends the bouncing (Zeno): the contact
/// becomes a constraint, whose equations of motion an embedded Runge-Kutta pair integrates with
/// error control, projected back onto the constraint after every step. It is released at the moment
/// its force would start to pull.
///
/// run.step_s and contact.impulse_threshold_Ns have no effect; run.event_tolerance_m sets the error
/// per step: of places and beam tips, and of velocities times the scene's unit of time.

#include "dynamics/disc/methods/hybrid.h"

namespace gatewalk::dynamics {

class EventMethod final : public Method {
 public:
  /// Throws InvalidParameter when the beams move much faster than the random force is held: then
  /// their vibrations, not events, would take all the time.
  explicit EventMethod(const GateParams& p);

  double advance(GateState& s, double force_x, double duration, EnergyLedger& ledger,
                 Watch& watch) const override;

 private:
  /// Both move `s` by at most `duration`, up to and through the next event; they return the time.
  double fly_on(GateState& s, double force_x, double duration, Watch& watch) const;
  double slide_on(GateState& s, double force_x, double duration, Watch& watch) const;

  /// How soon a contact that is not held could close, seen from `s`.
  struct Outlook {
    double safe = 0.0;  // s, no contact before this
    bool hit = false;   // one closes now
  };
  /// `surface`: the gap (m) at which each contact counts as shut: 0, or less where the bodies
  /// overlapped when first looked at; NaN before that.
  [[nodiscard]] Outlook look_ahead(const GateState& s, std::array<double, 2>& surface,
                                   double force_x, const Push& push, double horizon,
                                   Watch& watch) const;
  void resolve(GateState& s, double force_x, Watch& watch) const;
  /// |theta| (rad) of a beam where it turned between the two states `dt` apart, 0 if it did not.
  [[nodiscard]] double swing(Side side, const GateState& before, const GateState& s,
                             double dt) const;
  /// Takes `s`, outside dt after `start` in free flight, back to the moment of leaving; returns how
  /// long after `start` that is.
  double leave(const GateState& start, GateState& s, double force_x, double dt) const;
  [[nodiscard]] GateState flown(const GateState& s, double force_x, double dt) const;

  const GateParams& p_;
  double touching_;   // m, gaps up to this count as contact
  double rise_;       // m, rebounds lower than this are not flown
  double tolerance_;  // m, error per Runge-Kutta step
  double time_;       // s, what makes an error in m/s one in m: the scene's unit
  double rest_;       // m/s, contacts this slow do not close
  bool loose_;        // the tolerance suits an integrator of low order
  double hold_;       // s, between two changes of the random force
  GateLaw law_;
  GateFlow flow_;  // over a whole hold
};

}  // namespace gatewalk::dynamics
