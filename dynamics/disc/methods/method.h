// SPDX-License-Identifier: MIT
#pragma once
/// The interface of time-stepping methods: a method advances a gate's state through a spell of
/// constant force. Each method has its own file; `make_method` is the only list of them.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>

#include "dynamics/disc/contact.h"

namespace gatewalk::dynamics {

/// The record of a run: the largest deflections, which decide between left and right, and the
/// evidence of numerical faults.
struct Watch {
  std::array<double, 2> max_theta{0.0, 0.0};  // rad, largest |theta| of each beam
  double max_penetration = 0.0;               // m
  double energy_created = 0.0;                // J, largest rise of (energy - work of the forces)
  double max_speed = 0.0;                     // m/s
  std::int64_t steps = 0;                     // time steps
  std::int64_t evaluations = 0;               // evaluations of a gap or of the forces: the cost
  std::int64_t impacts = 0;                   // resolved hits
  std::int64_t forced_holds = 0;  // steps in which accumulating hits were forced into constraints
  std::int64_t undefined_contacts = 0;  // contacts for which the method has no formula
  std::int64_t fast_steps = 0;          // steps so long that hits may have been missed
  std::int64_t unstable_steps = 0;      // steps beyond the method's stability bound for free beams
  // Whether `impacts` already counts the present overlap with each beam: an overlap can last for
  // many steps of `moreau` and `penalty`.
  std::array<bool, 2> counted{};
  // The next members are for traces. Runs in vector lanes do not set them, nor does `penalty`, in
  // which contacts are not hits.
  std::array<double, 2> impulse{};  // N s, of the hits on each beam, along the contact's normal
  double hit_loss = 0.0;            // J, energy lost in hits

  /// Call this after every step: it records motion and penetration of the state. `dt` (s) is the
  /// time between two checks for contact.
  void state(const GateParams& p, const GateState& s, double dt) {
    motion(p, s, dt);
    penetration(p, s);
  }
  /// The two halves of state(), for methods that know between steps that nothing overlaps.
  void motion(const GateParams& p, const GateState& s, double dt);
  void penetration(const GateParams& p, const GateState& s);
};

/// Tracks the energy less the work of propulsion and random force, which may only fall, during one
/// run.
class EnergyLedger {
 public:
  /// A step as reported to Follow: the state after it, the random force (N) and duration (s) of the
  /// step, and the work of propulsion and random force (J) since the run began.
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
  /// Call this after every step, with the random force during the step, its duration (s), and the
  /// energy that the method keeps outside the state (J, in contact springs).
  void step(const GateState& s, double force_x, double seconds, Watch& w, double stored = 0.0) {
    random_work_ += force_x * (s.body.x - x_);
    x_ = s.body.x;
    const double now = balance(s) + stored;
    w.energy_created = std::max(w.energy_created, now - lowest_);
    lowest_ = std::min(lowest_, now);
    if (follow_)
      follow_({s, force_x, seconds, p_.forces.propulsion * (s.body.y - y0_), random_work_, w});
  }

  [[nodiscard]] double random_work() const { return random_work_; }  // J, since the run began

 private:
  [[nodiscard]] double balance(const GateState& s) const;
  const GateParams& p_;
  double x_, y0_;
  double random_work_ = 0.0;
  double lowest_ = 0.0;
  Follow follow_;
};

/// Total energy (J): kinetic energy of body and beams, elastic energy of the joints (Eq. (14)).
[[nodiscard]] double energy(const GateParams& p, const GateState& s);

/// Whether the body has left the gate.
[[nodiscard]] inline bool outside(const GateParams& p, const BodyState& b) {
  return b.y > p.run.traverse_y || b.x < -p.beams.joint_x || b.x > p.beams.joint_x;
}

/// The state at time t by cubic Hermite interpolation between two states dt apart; flags as in `b`.
[[nodiscard]] GateState interpolated(const GateState& a, const GateState& b, double dt, double t);

/// The beams a fraction of the way from `a` to `b`, by linear interpolation. It is of first order,
/// but its energy never exceeds the larger of the two, however often the beams swing in between.
/// Flags as in `b`.
[[nodiscard]] std::array<BeamState, 2> mixed(const std::array<BeamState, 2>& a,
                                             const std::array<BeamState, 2>& b, double fraction);

/// Moves `s`, in which the body is outside the gate, back to the moment of leaving, by cubic
/// interpolation from `before`, dt earlier, in which the body is inside. Returns the time from
/// `before` to that moment, in (0, dt].
[[nodiscard]] double back_to_exit(const GateParams& p, const GateState& before, GateState& s,
                                  double dt);

class Method {
 public:
  virtual ~Method() = default;

  /// Advances `s` by at most `duration` seconds under the lateral force `force_x` (N), and stops at
  /// the first step after which the body is outside or the state is not finite. Returns the seconds
  /// advanced, > 0.
  virtual double advance(GateState& s, double force_x, double duration, EnergyLedger& ledger,
                         Watch& watch) const = 0;
};

/// Makes the method named by params.run.method. Throws InvalidParameter if the method cannot run
/// the scene. `params` must outlive the method.
[[nodiscard]] std::unique_ptr<Method> make_method(const GateParams& params);

}  // namespace gatewalk::dynamics
