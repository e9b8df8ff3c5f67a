// SPDX-License-Identifier: MIT
#pragma once
/// One disc among the beams of many gates: the full dynamics without the paper's simplification
/// that only the active gate moves.
///
/// Moreau-Jean time stepping (theta = 1/2) for any number of beams. Positions half a step ahead
/// decide which contacts are active (gap <= 0) and where they touch. The implicit midpoint rule
/// integrates springs, dampers and drag, and keeps the energy of a free beam exactly. Over the step
/// every active contact obeys u+ + e u- >= 0, J >= 0, with one of the two zero, all contacts
/// together (complementarity.h). There are no held contacts, and no search for the time of a hit.
///
/// field.fidelity sets which gates take part. A gate that takes no part sleeps: its beams swing
/// freely, and are updated in closed form when they are next needed.
///
/// A mirror image of field, beams, start and force gives the mirror image of the motion, to the
/// last bit (for an odd number of columns): sums over three or more contacts are taken in both
/// orders.

#include <vector>

#include "dynamics/disc/flow.h"
#include "dynamics/disc/gate.h"
#include "dynamics/disc/methods/moreau.h"
#include "lattice/field/field_params.h"

namespace gatewalk::lattice {

class FieldStepper {
 public:
  /// Puts the body into the field's start gate, with all beams at rest. `p` must outlive the
  /// stepper.
  FieldStepper(const dynamics::GateParams& p, const FieldParams& field,
               const dynamics::BodyState& start);

  /// Runs until the body leaves its gate, or for run.time_limit_s: as dynamics::run_gate, but with
  /// all beams that the fidelity includes. The stepper's clock continues from gate to gate.
  [[nodiscard]] dynamics::GateRun run_gate(dynamics::RandomForce& force);

  /// Moves the body into the neighbouring gate, after a run that left its gate. That neighbour must
  /// exist.
  void go_on(dynamics::Outcome outcome);

  /// Advances by at most `duration` seconds under lateral force `force_x` (N). Stops exactly where
  /// the body leaves its gate, or when a value becomes non-finite. Returns the seconds advanced, >
  /// 0, as dynamics::Method::advance.
  double advance(double force_x, double duration, dynamics::Watch& watch);

  /// In the frame of the body's gate.
  [[nodiscard]] const dynamics::BodyState& body() const { return body_; }
  [[nodiscard]] int column() const { return gates_[current_].column; }
  [[nodiscard]] int row() const { return gates_[current_].row; }
  [[nodiscard]] double seconds() const { return now_; }

  /// The current beams of any gate.
  [[nodiscard]] std::array<dynamics::BeamState, 2> beams(int column, int row) const;
  /// Sets the beams of a gate at this moment, for scenes that begin with beams in motion.
  void set_beams(int column, int row, const std::array<dynamics::BeamState, 2>& beams);
  /// Number of gates that take part now.
  [[nodiscard]] std::size_t awake() const { return awake_.size(); }
  /// Current energy (J) of the body and of all beams of the field.
  [[nodiscard]] double energy() const;

 private:
  struct Gate {
    int column = 0, row = 0;
    std::array<dynamics::BeamState, 2> beams;
    double time = 0.0;    // s, on the stepper's clock: time of `beams`, if the gate sleeps
    double energy = 0.0;  // J, of `beams`, if the gate sleeps
  };
  using Step = dynamics::MoreauMethod::Step;
  struct Contact {
    std::size_t gate;
    dynamics::Side side;
    dynamics::Touch touch;
    double before, free;  // m/s, u at the start of the step, and at its end without impulses
    double impulse;       // N s
  };

  /// `body`, given in the current gate's frame, in the frame of `gate`.
  [[nodiscard]] dynamics::BodyState seen_from(const Gate& gate, dynamics::BodyState body) const;
  [[nodiscard]] bool in_reach(const Gate& gate, double slack) const;
  /// Index of a gate; a gate that was not met before is added, at rest.
  [[nodiscard]] std::size_t find(int column, int row);
  [[nodiscard]] std::array<dynamics::BeamState, 2> beams_now(const Gate& gate) const;
  [[nodiscard]] double beam_energy(const std::array<dynamics::BeamState, 2>& beams) const;
  /// Chooses the gates that take part in a step of length h (s) from here.
  void choose_awake(double h);
  void step(const Step& k, double force_x, dynamics::Watch& watch);
  void resolve(const Step& k, double& vx, double& vy);
  /// Takes everything back to the moment of leaving. Returns the time of that moment after
  /// `before`, s.
  [[nodiscard]] double back_to_exit(const dynamics::BodyState& before, double h);
  void watch_all(const dynamics::BodyState& before, double force_x, double h,
                 dynamics::Watch& watch);
  [[nodiscard]] bool finite() const;

  const dynamics::GateParams& p_;
  FieldParams field_;
  Step usual_;
  dynamics::BodyState body_;
  double now_ = 0.0;                       // s since the start
  std::vector<Gate> gates_;                // every gate met so far
  std::size_t current_ = 0;                // the gate the body is in
  std::size_t last_ = 0;                   // the gate the body came from; current_ in the beginning
  std::vector<std::size_t> awake_, next_;  // awake_[0] is current_
  std::vector<std::array<dynamics::BeamState, 2>> before_;  // awake beams at the start of a step
  std::vector<Contact> contacts_;
  double work_ = 0.0;           // J, done by propulsion and random force so far
  double asleep_energy_ = 0.0;  // J, of all sleeping gates when they fell asleep
  double lowest_ = 0.0;         // J, lowest value so far of energy minus work, which may only fall
};

}  // namespace gatewalk::lattice
