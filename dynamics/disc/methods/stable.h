// SPDX-License-Identifier: MIT
#pragma once
/// `stable`: hits are found within the step, both beams are resolved together, and constraints do
/// not drift.
///
/// Free motion is in closed form (flow.h). If the disc overlaps a beam at the end of a step, the
/// method finds the moment of the hit; the impact law acts there, and the step goes on. A hit
/// weaker than the threshold turns the contact into a constraint. Contact forces act at mid-step
/// (explicit midpoint, second order); then positions and velocities are projected onto the
/// constraint along the mass metric, so the constraint can neither drift nor add energy. Contact
/// forces only push: a contact whose force would pull is released.
///
/// A step that is too long is halved into pieces: for contact forces on stiff or damped beams, for
/// a held beam that turns fast, for a held contact that moves from a beam's side to its joint or
/// tip, and where disc or beam would move by more than half a radius, so that no hit is stepped
/// over.
///
/// This class is the plain method, one run at a time. It is the reference of its lanes
/// (stable_lanes.h), which have the same bits and call it in rare cases: change both together.
///
/// The impulse threshold shrinks with the step: contact.impulse_threshold_Ns holds for the paper's
/// step (0.004 units of time, see Scale). With a fixed threshold the error of a trajectory would
/// stop falling.

#include <vector>

#include "dynamics/disc/methods/hybrid.h"

namespace gatewalk::dynamics {

class StableMethod final : public Method {
 public:
  /// Throws InvalidParameter if the beams are so stiff or damped that a step would be halved more
  /// than 10 times.
  explicit StableMethod(const GateParams& p);

  double advance(GateState& s, double force_x, double duration, EnergyLedger& ledger,
                 Watch& watch) const override;

  /// The largest number of halvings of a step, for the fastest beam and for the distance moved in a
  /// piece.
  static constexpr int kMaxHalvings = 10;
  static constexpr int kUnits = 1 << kMaxHalvings;
  /// The progress within a step.
  struct Progress {
    int unit = 0;         // in units of the smallest piece, of which a step has kUnits
    int halved = 0;       // the next piece must be halved at least this often
    double passed = 0.0;  // s
    bool fast = false;    // disc or beam moved too far in one of the smallest pieces
  };
  /// Takes the rest of a step, up to the moment of leaving the gate.
  void finish_step(GateState& s, double force_x, double step, Progress& done, Watch& watch) const;
  /// The number of halvings of the step for the piece that begins at `unit`.
  [[nodiscard]] int level(const GateState& s, double step, int unit) const;
  /// The number of halvings that any piece may need; only where something moves too far are there
  /// more.
  [[nodiscard]] int finest() const { return finest_; }
  /// Records the largest deflection of a free light beam, which may swing out and back within a
  /// piece without hits.
  void watch_swing(Side side, const BeamState& before, double seconds, Watch& watch) const;

  /// The thresholds of all decisions. The lanes (stable_lanes.cpp) use the same ones.
  struct Limits {
    double threshold, tip_threshold;     // N s, weaker hits of side or tip become constraints
    double touching;                     // m, smaller gaps count as contact in a hit
    double rest;                         // m/s, contacts this slow count as not closing
    std::array<double, 2> swing{};       // 1/s^2, k/I
    std::array<double, 2> swing_root{};  // 1/s
    std::array<int, 2> halvings{};  // halvings of a step that each beam needs; 0 unless very stiff
    explicit Limits(const GateParams& p);
  };
  static constexpr double kMaxTurn = 0.05;  // rad, largest turn of a held beam in a piece
  static constexpr double kGuess = 1e3;     // tolerance of a hit's first guess, in `touching` gaps
  static constexpr int kNewtonSteps = 3;    // towards a hit, before a search that cannot fail
  [[nodiscard]] const Limits& limits() const { return limits_; }
  [[nodiscard]] const GateLaw& law() const { return law_; }
  /// The flow over run.step halved n times.
  [[nodiscard]] const GateFlow& flow(int n) const { return flows_[static_cast<std::size_t>(n)]; }

 private:
  /// The number of halvings of a step for the beams that matter in `s`.
  [[nodiscard]] int halvings(const GateState& s) const;
  /// Whether disc or beam tip may move by more than half a radius in dt (s). A beam out of the
  /// disc's reach does not count.
  [[nodiscard]] bool too_far(const GateState& s, double dt) const;
  /// A piece of a step, with the flows over the piece and over half of it; null for a piece of
  /// unusual length.
  struct Piece {
    double dt;  // s
    const GateFlow* flow = nullptr;
    const GateFlow* half_flow = nullptr;
  };
  [[nodiscard]] Piece piece(double step, int halvings) const;
  /// When substep() may ask for a shorter piece: at a `handover` of a held contact to another kind,
  /// or if a hit sends disc or beam too far within the rest of the piece (`travel`).
  struct MayHalve {
    bool handover, travel;
  };
  /// Advances `s` by a piece. Returns the time passed (s): piece.dt, or less if the body has left
  /// the gate; 0, with `s` unchanged, if the piece must be halved.
  double substep(GateState& s, double force_x, const Piece& piece, MayHalve may_halve,
                 Watch& watch) const;
  struct Glide {
    std::array<Touch, 2> shut;  // contact points of the held contacts at the end
    bool handover = false;      // a held contact changed its kind
  };
  /// Motion without new hits: closed-form flight, or mid-step contact forces on held beams.
  Glide glide(GateState& s, double force_x, const Piece& piece) const;
  Glide glide_held(GateState& s, double force_x, const GateFlow& flow,
                   const GateFlow& half_flow) const;
  /// Moves `s`, which is outside the gate, back to the moment of leaving. `before` is inside, dt
  /// (s) earlier, without hits since. Returns the time from `before` to that moment.
  double leave(const GateState& before, GateState& s, double dt) const;
  /// Moves `s` to the first moment in [0, dt] at which one of `hit` is reached, and returns that
  /// time.
  [[nodiscard]] double first_hit(GateState& s, double force_x, const GateState& end, double dt,
                                 std::array<bool, 2> hit, Watch& watch) const;

  const GateParams& p_;
  Limits limits_;
  int finest_;  // halvings that any piece may need
  GateLaw law_;
  std::vector<GateFlow> flows_;  // flows over the step halved 0 .. finest + 1 times
};

}  // namespace gatewalk::dynamics
