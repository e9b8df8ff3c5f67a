// SPDX-License-Identifier: MIT
#pragma once
/// Runs of method `moreau` side by side in the lanes of vector registers (Google Highway: the
/// instruction set is chosen when the program runs). A lane whose run has ended takes the next one
/// at once.
///
/// The plain reference is MoreauMethod (methods/moreau.h): the same steps in the same order under
/// the same random force, to the last digits; cos, sin and divisions are rounded in their own way.
/// The same bits for any instruction set and any company in the other lanes: no fused multiply-add,
/// no sums over lanes. Two things differ in what is seen: penetration at the end of a step is taken
/// from the gap and its rate in mid-step, off by (v h)^2 / R at most; and every step looks at both
/// beams, in reach or not.

#include "dynamics/disc/methods/moreau.h"
#include "dynamics/disc/runs.h"

namespace gatewalk::dynamics {

/// As carry_out, for params.run.method "moreau".
void carry_out_in_lanes(const GateParams& p, const NextRun& next);

/// That a run can take: those of its steps, of which a hold of the random force may add one.
[[nodiscard]] inline double most_evaluations_in_lanes(const GateParams& p) {
  return 3.0 * p.run.time_limit * (1.0 / p.run.step + p.forces.random_rate);
}

}  // namespace gatewalk::dynamics
