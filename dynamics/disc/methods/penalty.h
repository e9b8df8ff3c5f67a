// SPDX-License-Identifier: MIT
#pragma once
/// `penalty`: the method of most simulation engines. Every contact has a spring and a damper of its
/// own, and semi-implicit (symplectic) Euler integrates all motion: velocities from the forces at
/// the step's start, then positions from the new velocities. While the gap is negative, a contact
/// pushes with
///     f = max(0, -m (w^2 gap + 2 zeta w u)),   m = 1 / (1/M + l^2/I)              (N)
///
/// w has no key: the full period of a contact is kContactSteps steps, so run.step sets every error.
/// A hit lasts 10 steps instead of no time, and overlaps are u kContactSteps h / (2 pi) deep. zeta
/// follows from the restitution of a contact that only pushes, and so lets go before the gap is
/// back at zero (Schwager and Poeschel, Granular Matter 9, 2007). With zeta = sin(a),
///     -ln e = tan(a) (pi - 2 a).
/// (The usual formula, pi tan(a), holds for a contact that also pulls; it gives 0.81 for 0.8 and
/// 0.40 for 0.3.) Both coefficients are then adjusted to the step, so that positions in a lasting
/// overlap are those of the exact spring and damper.
///
/// Strengths: cheap and simple; each hit has the right restitution on average over its phase in the
/// step. Weaknesses: contacts are soft and slow, both by O(h); the restitution of a single hit is
/// off by up to 0.05 with its phase, for any step (a hit always has 10 steps); e below 0.015 counts
/// as 0.015; hits of both beams are not solved together; stiff or damped beams need short steps.
///
/// There is no constraint mode: contact.impulse_threshold has no effect and `held` stays false.
/// Watch::impacts counts each overlap once. The energy ledger includes the energy in the contact
/// springs.

#include "dynamics/disc/methods/method.h"

namespace gatewalk::dynamics {

/// The longest step (s) for which semi-implicit Euler is stable in any contacts.
///
/// With explicit damping, v+ = v - h (K q + C v), q+ = q + h v+, a mode of frequency^2 K and
/// damping C (1/s) grows unless h^2 K + 2 h C <= 4: its multipliers z have the product 1 - h C and
/// the sum 2 - h^2 K - h C, and z = -1 is the border. A sum of springs and dampers is stable while
/// the sum of their largest h^2 K + 2 h C stays below 4. This sum is the larger of the stiffer
/// beam's (k/I, d/I) and the drag's (0, D/M), plus the term of two contacts, which does not depend
/// on h.
[[nodiscard]] double penalty_bound(const GateParams& p);

class PenaltyMethod final : public Method {
 public:
  /// The number of steps in a full period of a contact's spring; a hit takes half of them.
  static constexpr double kContactSteps = 20.0;

  /// Throws InvalidParameter if the step is longer than penalty_bound.
  explicit PenaltyMethod(const GateParams& p);

  double advance(GateState& s, double force_x, double duration, EnergyLedger& ledger,
                 Watch& watch) const override;

 private:
  /// The spring and damper of a contact, per unit of effective mass.
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
