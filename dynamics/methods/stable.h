#pragma once
/// `stable`: hits found inside the step, both beams resolved together, constraints without drift.
///
/// Free motion is closed-form (flow.h). A beam that the disc has run into by the end of a step is
/// followed back to the moment of the hit; the impact law acts there and the step goes on. A hit
/// weaker than the threshold turns the contact into a constraint: contact forces at mid-step
/// (explicit midpoint, second order), then positions and velocities are put back onto the
/// constraint, along the mass metric, so that it can neither drift nor add energy. Contact forces
/// only push: a contact whose force would pull is released.
///
/// A step is taken in pieces, halves of halves, where it is too long: for contact forces on stiff
/// or damped beams, for a held beam that turns fast, for a held contact that moves from a beam's
/// side to its joint or tip.
///
/// So is a piece in which disc or beam would move by more than half a radius: no hit is stepped
/// over.
///
/// The impulse threshold shrinks with the step: contact.impulse_threshold_Ns is that of the paper's
/// step (0.004 units of time, see Scale). With a fixed one the error of a trajectory stops falling.

#include <vector>

#include "dynamics/methods/hybrid.h"

namespace gatewalk::dynamics {

class StableMethod final : public Method {
 public:
  /// Throws InvalidParameter when the beams are so stiff or damped that a step would have to be
  /// halved more than 10 times.
  explicit StableMethod(const GateParams& p);

  double advance(GateState& s, double force_x, double duration, EnergyLedger& ledger,
                 Watch& watch) const override;

 private:
  /// How often a step must be halved for the beams that matter in `s`.
  [[nodiscard]] int halvings(const GateState& s) const;
  /// True when disc or beam tip may move by more than half a radius in dt; a beam out of the disc's
  /// reach does not count.
  [[nodiscard]] bool too_far(const GateState& s, double dt) const;
  /// Returns the time passed: flow.dt, or less when the body has left the gate; 0, and `s` as it
  /// was, when a piece is to be halved: at a `handover` of a contact, or after a hit that sends
  /// disc or beam too far within the rest of the piece and `travel`.
  struct MayHalve {
    bool handover, travel;
  };
  double substep(GateState& s, double force_x, const GateFlow& flow, const GateFlow& half_flow,
                 MayHalve may_halve, Watch& watch) const;
  struct Glide {
    std::array<Touch, 2> shut;  // where the held contacts are at the end
    bool handover = false;      // one of them changed its kind on the way
  };
  /// Motion without new hits: closed-form flight, or mid-step contact forces on held beams.
  Glide glide(GateState& s, double force_x, const GateFlow& flow, const GateFlow& half_flow) const;
  Glide glide(GateState& s, double force_x, double dt) const;
  Glide glide_held(GateState& s, double force_x, const GateFlow& flow,
                   const GateFlow& half_flow) const;
  /// Takes `s`, outside though `before`, dt earlier and without hits since, was not, back to the
  /// moment of leaving; returns how long after `before` that is.
  double leave(const GateState& before, GateState& s, double dt) const;
  /// Takes `s` to the first moment in [0, dt] at which one of `hit` is reached; returns that time.
  [[nodiscard]] double first_hit(GateState& s, double force_x, const GateState& end, double dt,
                                 std::array<bool, 2> hit, Watch& watch) const;

  const GateParams& p_;
  double threshold_;                    // N s
  double touching_;                     // m, gaps up to this count as contact at a moment of impact
  double rest_;                         // m/s, contacts this slow do not close
  std::array<double, 2> swing_{};       // 1/s^2, k/I
  std::array<double, 2> swing_root_{};  // 1/s
  std::array<int, 2> halvings_{};       // of a step that each beam needs, 0 unless it is very stiff
  int finest_;                          // halvings that any piece may need
  GateLaw law_;
  std::vector<GateFlow> flows_;  // over the step, halved 0 .. finest + 1 times
};

}  // namespace gatewalk::dynamics
