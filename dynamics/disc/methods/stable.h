// SPDX-License-Identifier: MIT
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
/// This is the plain method, one run at a time, and the reference of its lanes (stable_lanes.h),
/// which have the same bits and leave to it what is rare: a change here is one there.
///
/// The impulse threshold shrinks with the step: contact.impulse_threshold_Ns is that of the paper's
/// step (0.004 units of time, see Scale). With a fixed one the error of a trajectory stops falling.

#include <vector>

#include "dynamics/disc/methods/hybrid.h"

namespace gatewalk::dynamics {

class StableMethod final : public Method {
 public:
  /// Throws InvalidParameter when the beams are so stiff or damped that a step would have to be
  /// halved more than 10 times.
  explicit StableMethod(const GateParams& p);

  double advance(GateState& s, double force_x, double duration, EnergyLedger& ledger,
                 Watch& watch) const override;

  /// How far a step has come: in units of the smallest piece, kUnits of them, and in s; how often
  /// the next piece must be halved at least. `fast`: disc or beam went too far in one of the
  /// smallest pieces.
  static constexpr int kMaxHalvings = 10;  // for the fastest beam, and for the way in a piece
  static constexpr int kUnits = 1 << kMaxHalvings;
  struct Progress {
    int unit = 0;
    int halved = 0;
    double passed = 0.0;
    bool fast = false;
  };
  /// Takes what is left of a step, up to the moment of leaving the gate.
  void finish_step(GateState& s, double force_x, double step, Progress& done, Watch& watch) const;
  /// How often the step must be halved for the piece that begins at `unit`.
  [[nodiscard]] int level(const GateState& s, double step, int unit) const;
  /// More often only where something moves too far.
  [[nodiscard]] int finest() const { return finest_; }
  /// Largest deflection of a free light beam that may swing out and back in a piece without hits.
  void watch_swing(Side side, const BeamState& before, double seconds, Watch& watch) const;

  /// What decides, with units; the lanes (stable_lanes.cpp) decide alike.
  struct Limits {
    double threshold, tip_threshold;     // N s, weaker hits of beam or tip end in constraints
    double touching;                     // m, gaps up to this count as contact when bodies hit
    double rest;                         // m/s, contacts this slow do not close
    std::array<double, 2> swing{};       // 1/s^2, k/I
    std::array<double, 2> swing_root{};  // 1/s
    std::array<int, 2> halvings{};       // of a step that each beam needs, 0 unless very stiff
    explicit Limits(const GateParams& p);
  };
  static constexpr double kMaxTurn = 0.05;  // rad that a held beam may turn in a piece
  static constexpr double kGuess = 1e3;     // touching gaps, of the interpolated motion
  static constexpr int kNewtonSteps = 3;    // towards a hit, then a search that cannot fail
  [[nodiscard]] const Limits& limits() const { return limits_; }
  [[nodiscard]] const GateLaw& law() const { return law_; }
  /// Over run.step halved n times.
  [[nodiscard]] const GateFlow& flow(int n) const { return flows_[static_cast<std::size_t>(n)]; }

 private:
  /// How often a step must be halved for the beams that matter in `s`.
  [[nodiscard]] int halvings(const GateState& s) const;
  /// True when disc or beam tip may move by more than half a radius in dt; a beam out of the disc's
  /// reach does not count.
  [[nodiscard]] bool too_far(const GateState& s, double dt) const;
  /// A piece of a step; `flow` over it and half of it, unless it is of an unusual length.
  struct Piece {
    double dt;  // s
    const GateFlow* flow = nullptr;
    const GateFlow* half_flow = nullptr;
  };
  [[nodiscard]] Piece piece(double step, int halvings) const;
  /// Returns the time passed: piece.dt, or less when the body has left the gate; 0, and `s` as it
  /// was, when a piece is to be halved: at a `handover` of a contact, or after a hit that sends
  /// disc or beam too far within the rest of the piece and `travel`.
  struct MayHalve {
    bool handover, travel;
  };
  double substep(GateState& s, double force_x, const Piece& piece, MayHalve may_halve,
                 Watch& watch) const;
  struct Glide {
    std::array<Touch, 2> shut;  // where the held contacts are at the end
    bool handover = false;      // one of them changed its kind on the way
  };
  /// Motion without new hits: closed-form flight, or mid-step contact forces on held beams.
  Glide glide(GateState& s, double force_x, const Piece& piece) const;
  Glide glide_held(GateState& s, double force_x, const GateFlow& flow,
                   const GateFlow& half_flow) const;
  /// Takes `s`, outside though `before`, dt earlier and without hits since, was not, back to the
  /// moment of leaving; returns how long after `before` that is.
  double leave(const GateState& before, GateState& s, double dt) const;
  /// Takes `s` to the first moment in [0, dt] at which one of `hit` is reached; returns that time.
  [[nodiscard]] double first_hit(GateState& s, double force_x, const GateState& end, double dt,
                                 std::array<bool, 2> hit, Watch& watch) const;

  const GateParams& p_;
  Limits limits_;
  int finest_;  // halvings that any piece may need
  GateLaw law_;
  std::vector<GateFlow> flows_;  // over the step, halved 0 .. finest + 1 times
};

}  // namespace gatewalk::dynamics
