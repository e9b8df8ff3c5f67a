// SPDX-License-Identifier: MIT
#pragma once
/// `penalty`: what most simulation engines do. A spring and a damper in every contact, each by
/// itself, and semi-implicit (symplectic) Euler for all motion: velocities from the forces at the
/// step's start, then positions from the new velocities. While the gap is negative a contact pushes
///     f = max(0, -m (w^2 gap + 2 zeta w u)),   m = 1 / (1/M + l^2/I)              (N)
///
/// There is no key for w: a contact's full period is kContactSteps steps, so that run.step sets
/// every error: hits last 10 steps instead of no time, overlaps are u kContactSteps h / (2 pi)
/// deep. zeta follows from the restitution of a contact that only pushes and so lets go before the
/// gap is back at zero (Schwager and Poeschel, Granular Matter 9, 2007): with zeta = sin(a),
///     -ln e = tan(a) (pi - 2 a).
/// (The usual pi tan(a) is for one that also pulls; it gives 0.81 for 0.8 and 0.40 for 0.3.) Both
/// coefficients are then changed for the step, so that the positions in a lasting overlap are those
/// of the spring and damper themselves.
///
/// What it does well. Cheap, simple, and each hit has the right restitution on average over where
/// in the step it begins. What it does not. Contacts are soft and slow, both by O(h); the
/// restitution of one hit is off by up to 0.05 with its phase in the step, whatever the step (there
/// are always 10 steps to a hit); e below 0.015 counts as 0.015; hits of both beams share no
/// equation; stiff or damped beams need short steps.
///
/// There is no constraint mode: contact.impulse_threshold has no effect, `held` stays false.
/// Watch::impacts counts an overlap that, at its present speed, was not there a step ago. Energy in
/// the contacts' springs is known to the ledger.

#include "dynamics/disc/methods/method.h"

namespace gatewalk::dynamics {

/// The longest step (s) with which semi-implicit Euler cannot blow up, in whatever contacts.
///
/// With damping explicit, v+ = v - h (K q + C v), q+ = q + h v+, a mode of frequency^2 K and
/// damping C (1/s) grows unless h^2 K + 2 h C <= 4: its multipliers z have product 1 - h C and sum
/// 2 - h^2 K - h C, and z = -1 is the border. A sum of springs and dampers does not grow when the
/// sum of their largest h^2 K + 2 h C stays below 4. That is the larger of the stiffer beam's (k/I,
/// d/I) and the drag's (0, D/M), plus that of two contacts, which does not depend on h.
[[nodiscard]] double penalty_bound(const GateParams& p);

class PenaltyMethod final : public Method {
 public:
  /// Steps in a full period of a contact's spring; a hit takes half of it.
  static constexpr double kContactSteps = 20.0;

  /// Throws InvalidParameter when the step is longer than penalty_bound.
  explicit PenaltyMethod(const GateParams& p);

  double advance(GateState& s, double force_x, double duration, EnergyLedger& ledger,
                 Watch& watch) const override;

 private:
  /// Spring and damper of a contact, for a unit of effective mass.
  struct Spring {
    double stiffness;  // 1/s^2
    double damping;    // 1/s
  };
  struct Springs {
    Spring side, tip;
    Springs(const GateParams& p, double h);
    [[nodiscard]] const Spring& of(const Touch& t) const {
      return t.kind == ContactKind::tip ? tip : side;
    }
  };
  [[nodiscard]] static Spring spring(double restitution, double w, double h);
  friend double penalty_bound(const GateParams& p);

  const GateParams& p_;
  Springs usual_;
};

}  // namespace gatewalk::dynamics
