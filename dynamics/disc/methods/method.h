// SPDX-License-Identifier: MIT
#pragma once
/// What every time-stepping method is: something that carries a gate's state through a spell of
/// constant force. One file per method; `make_method` is the only list of them.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>

#include "dynamics/disc/contact.h"

namespace gatewalk::dynamics {

/// Kept during a run: what decides left or right, and the evidence that the numbers can be trusted.
struct Watch {
  std::array<double, 2> max_theta{0.0, 0.0};  // rad, largest deflection of each beam, either way
  double max_penetration = 0.0;               // m
  double energy_created = 0.0;    // J, largest rise of (energy - work done by the forces) ever seen
  double max_speed = 0.0;         // m/s
  std::int64_t steps = 0;         // time steps
  std::int64_t evaluations = 0;   // evaluations of a gap or of the forces: the work done
  std::int64_t impacts = 0;       // resolved hits
  std::int64_t forced_holds = 0;  // steps in which hits piled up and were turned into constraints
  std::int64_t undefined_contacts = 0;  // contacts for which the method has no formula
  std::int64_t fast_steps = 0;  // steps in which disc or beam moved so far that hits can be missed
  std::int64_t unstable_steps = 0;  // steps longer than the method's stability bound for free beams
  // For traces; runs in vector lanes leave them out, and penalty, in which contact is no hit, too.
  std::array<double, 2> impulse{};  // N s, of the hits on each beam, along the contact's normal
  double hit_loss = 0.0;            // J, that hits took

  /// To be called after every step, looks at the state from outside the method; `dt` is the time
  /// between two looks for contact.
  void state(const GateParams& p, const GateState& s, double dt) {
    motion(p, s, dt);
    penetration(p, s);
  }
  /// Its two halves, for methods that know between steps that nothing overlaps.
  void motion(const GateParams& p, const GateState& s, double dt);
  void penetration(const GateParams& p, const GateState& s);
};

/// Energy less the work of propulsion and random force: it may only fall. Follows one run.
class EnergyLedger {
 public:
  /// Told of every step: where it has led, under which random force (N), how long it took (s), and
  /// what propulsion and random force have done (J) since the run began.
  struct Step {
    const GateState& state;
    double force_x, seconds;
    double propulsion_work, random_work;
    const Watch& watch;
  };
  using Follow = std::function<void(const Step&)>;

  EnergyLedger(const GateParams& p, const GateState& s, Follow follow = {})
      : p_(p), x_(s.body.x), y0_(s.body.y), follow_(std::move(follow)) {
    lowest_ = balance(s);
  }
  /// To be called after every step with the random force that acted during it, the seconds it took,
  /// and the energy that the method keeps outside the state (J, in contact springs).
  void step(const GateState& s, double force_x, double seconds, Watch& w, double stored = 0.0) {
    random_work_ += force_x * (s.body.x - x_);
    x_ = s.body.x;
    const double now = balance(s) + stored;
    w.energy_created = std::max(w.energy_created, now - lowest_);
    lowest_ = std::min(lowest_, now);
    if (follow_)
      follow_({s, force_x, seconds, p_.forces.propulsion * (s.body.y - y0_), random_work_, w});
  }

  [[nodiscard]] double random_work() const { return random_work_; }  // J, so far

 private:
  [[nodiscard]] double balance(const GateState& s) const;
  const GateParams& p_;
  double x_, y0_;
  double random_work_ = 0.0;
  double lowest_ = 0.0;
  Follow follow_;
};

/// Total energy (J): kinetic of body and beams, elastic of the joints (Eq. (14)).
[[nodiscard]] double energy(const GateParams& p, const GateState& s);

/// True once the body has left the gate.
[[nodiscard]] inline bool outside(const GateParams& p, const BodyState& b) {
  return b.y > p.run.traverse_y || b.x < -p.beams.joint_x || b.x > p.beams.joint_x;
}

/// Cubic Hermite interpolation between two states dt apart, at t; flags as in `b`.
[[nodiscard]] GateState interpolated(const GateState& a, const GateState& b, double dt, double t);

/// Beams a fraction of the way from `a` to `b`, mixed linearly: first order, but their energy is
/// never more than the larger of the two, however often they swing between. Flags as in `b`.
[[nodiscard]] std::array<BeamState, 2> mixed(const std::array<BeamState, 2>& a,
                                             const std::array<BeamState, 2>& b, double fraction);

/// Takes `s`, in which the body is outside though it was not in `before`, dt earlier, back to the
/// moment of leaving, by cubic interpolation; returns how long after `before` that is, in (0, dt].
[[nodiscard]] double back_to_exit(const GateParams& p, const GateState& before, GateState& s,
                                  double dt);

class Method {
 public:
  virtual ~Method() = default;

  /// Advances `s` by at most `duration` seconds under lateral force `force_x` (N), stopping at the
  /// first step after which the body is outside or not finite. Returns the seconds advanced, > 0.
  virtual double advance(GateState& s, double force_x, double duration, EnergyLedger& ledger,
                         Watch& watch) const = 0;
};

/// The method named by params.run.method. Throws InvalidParameter when the scene cannot be run by
/// it. `params` must outlive the method.
[[nodiscard]] std::unique_ptr<Method> make_method(const GateParams& params);

}  // namespace gatewalk::dynamics
