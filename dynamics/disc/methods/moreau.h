// SPDX-License-Identifier: MIT
#pragma once
/// `moreau`: Moreau-Jean time stepping with theta = 1/2 (Moreau 1988; Jean, Comput. Methods Appl.
/// Mech. Engrg. 177, 1999). Nothing is searched for within a step. Contacts that overlap at the
/// midpoint q + h v/2 are closed for the whole step and obey an impact law on velocities. n, l and
/// u are taken at the midpoint, u- from the velocity before the step, u+ from the velocity after
/// it:
///     u+ + e u- >= 0,  J >= 0,  J (u+ + e u-) = 0                             (both beams at once)
/// Springs, dampers and drag follow the midpoint rule, implicit and in closed form, so an impulse
/// acts on M + h D/2 and I + h d/2 + h^2 k/4. Then q+ = q + h (v + v+)/2.
///
/// Strengths. Any step is stable, for any stiffness. The work of the springs and of both forces is
/// exact: the energy changes only by the damping and by J (u+ + u-)/2. A step evaluates each beam
/// at most once, and many hits in a step cost no more than one. For e = 1 without damping the
/// motion is reversible.
///
/// Weaknesses. Hits act up to h late, so the gap is off by up to h |u|; an overlap lasts until the
/// next flight (Health counts deep ones). Sustained contact is an impulse in every step, and its u
/// decays as e^n with alternating sign. Against a force F, a contact of effective mass m that opens
/// slowly by itself, 0 < u- < h F / ((1 + e) m), is held back to -e u-, which can create the energy
/// (1 - e)/(8 (1 + e)) (h F)^2 / m. With different restitutions at the two contacts, the law itself
/// can create energy: sum J (u+ + u-)/2 may be positive if one contact opens already.
///
/// There is no constraint mode: contact.impulse_threshold has no effect and `held` stays false.
/// Watch::impacts counts each overlap in which an impulse acts, once.

#include "dynamics/disc/methods/method.h"

namespace gatewalk::dynamics {

class MoreauMethod final : public Method {
 public:
  explicit MoreauMethod(const GateParams& p) : p_(p), usual_(p, p.run.step) {}

  double advance(GateState& s, double force_x, double duration, EnergyLedger& ledger,
                 Watch& watch) const override;

  /// Coefficients of the midpoint rule for a step h: effective masses for impulses, and weights of
  /// the state at the step's start.
  struct Step {
    double h;                         // s
    double mass;                      // kg, M + h D/2: the mass that an impulse acts on
    std::array<double, 2> inertia;    // kg m^2, I + h d/2 + h^2 k/4
    double v_to_v;                    // free motion: v+ = v_to_v v + v_per_N F
    double v_per_N;                   // s/kg
    std::array<double, 2> w_to_w;     // omega+ = w_to_w omega - w_per_rad theta
    std::array<double, 2> w_per_rad;  // 1/s
    Step(const GateParams& p, double h);
  };

 private:
  void one_step(GateState& s, double force_x, const Step& step, Watch& watch) const;

  const GateParams& p_;
  Step usual_;
};

}  // namespace gatewalk::dynamics
