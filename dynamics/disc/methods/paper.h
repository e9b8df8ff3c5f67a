// SPDX-License-Identifier: MIT
#pragma once
/// `paper`: the scheme as the paper's text gives it, faults included. Explicit Euler. Overlapping
/// and closing contacts get the collision law, the left beam first, then the right. A hit with |dP|
/// below epsilon turns the contact into a constraint on accelerations (Eqs. (11), (13)), which is
/// integrated like everything else and therefore drifts. For the joint the paper has no formula:
/// such overlaps are counted in Watch::undefined_contacts and otherwise ignored.

#include "dynamics/disc/methods/method.h"

namespace gatewalk::dynamics {

/// The longest step (s) for which explicit Euler is stable for a free beam: d/k of the stiffer beam
/// if it swings (d^2 < 4 k I); 2 / (fastest rate), about 2 I/d, if it creeps.
[[nodiscard]] double euler_bound(const GateParams& p);

class PaperMethod final : public Method {
 public:
  explicit PaperMethod(const GateParams& p) : p_(p), beyond_bound_(p.run.step > euler_bound(p)) {}

  double advance(GateState& s, double force_x, double duration, EnergyLedger& ledger,
                 Watch& watch) const override;

 private:
  void collide(GateState& s, Watch& watch) const;
  void euler(GateState& s, double force_x, double dt, Watch& watch) const;
  const GateParams& p_;
  bool beyond_bound_;
};

}  // namespace gatewalk::dynamics
