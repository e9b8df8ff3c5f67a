// SPDX-License-Identifier: MIT
#pragma once
/// `paper`: the paper's scheme as its text gives it, faults included. Explicit Euler; overlapping
/// and closing contacts get the collision law, left beam first, then right; a hit with |dP| below
/// epsilon turns the contact into a constraint on accelerations (Eqs. (11), (13)), which is
/// integrated like everything else and therefore drifts. The joint has no formula in the paper:
/// such overlaps are counted in Watch::undefined_contacts and nothing is done.

#include "dynamics/disc/methods/method.h"

namespace gatewalk::dynamics {

/// The longest step (s) with which explicit Euler does not blow up a free beam: d/k of the stiffer
/// beam while it swings (d^2 < 4 k I), 2 / (fastest rate), about 2 I/d, when it creeps.
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
