// SPDX-License-Identifier: MIT
#pragma once
/// `moreau`: Moreau-Jean time stepping with theta = 1/2 (Moreau 1988; Jean, Comput. Methods Appl.
/// Mech. Engrg. 177, 1999). Nothing is searched for inside a step: contacts that overlap at the
/// midpoint q + h v/2 are closed for the whole step and obey an impact law on velocities, with n, l
/// and u taken there and u- from the velocity before the step, u+ from the one after it:
///     u+ + e u- >= 0,  J >= 0,  J (u+ + e u-) = 0                             (both beams at once)
/// Springs, dampers and drag follow the midpoint rule, implicit and in closed form, so that an
/// impulse acts on M + h D/2 and I + h d/2 + h^2 k/4; then q+ = q + h (v + v+)/2.
///
/// What it does well. Any step is stable, for any stiffness. The work of the springs and of both
/// forces is exact: the energy changes by the damping and by J (u+ + u-)/2 only. One step costs at
/// most one look at each beam, and many hits in one step cost no more than one. For e = 1 without
/// damping it retraces its path.
/// What it does not. Hits act up to h late, so the gap is off by up to h |u|, and it stays off:
/// nothing but the next flight brings an overlap back (Health counts deep ones). Sustained contact
/// is an impulse in every step; its u dies out as e^n, with alternating sign. Against a force F a
/// contact of effective mass m that opens slowly by itself, 0 < u- < h F / ((1 + e) m), is held
/// back to -e u-, which can create (1 - e)/(8 (1 + e)) (h F)^2 / m of energy. With different
/// restitutions at the two contacts the law itself, applied to both at once, can create energy: sum
/// J (u+ + u-)/2 need not be negative when one of them opens already.
///
/// There is no constraint mode: contact.impulse_threshold has no effect, `held` stays false.
/// Watch::impacts counts an overlap that, at its present speed, was not there a step ago.

#include "dynamics/disc/methods/method.h"

namespace gatewalk::dynamics {

class MoreauMethod final : public Method {
 public:
  explicit MoreauMethod(const GateParams& p) : p_(p), usual_(p, p.run.step) {}

  double advance(GateState& s, double force_x, double duration, EnergyLedger& ledger,
                 Watch& watch) const override;

  /// The midpoint rule for a step h: what an impulse acts on, and what the step's start weighs.
  struct Step {
    double h;                         // s
    double mass;                      // kg, M + h D/2
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
