// SPDX-License-Identifier: MIT
#pragma once
/// Runs of method `moreau` in the lanes of vector registers (Google Highway: the instruction set is
/// chosen when the program runs). A lane whose run has ended takes the next run at once.
///
/// The plain reference is MoreauMethod (methods/moreau.h). The lanes take the same steps in the
/// same order under the same random force and agree to the last digits; cos, sin and divisions are
/// rounded differently. Results have the same bits for any instruction set and any runs in the
/// other lanes: there is no fused multiply-add and no sum over lanes. Two records differ. The
/// penetration at the end of a step is estimated from the gap and its rate in mid-step, off by (v
/// h)^2 / R at most. Every step evaluates both beams, in reach or not.

#include "dynamics/disc/methods/moreau.h"
#include "dynamics/disc/runs.h"

namespace gatewalk::dynamics {

/// Carries out runs as carry_out does, for params.run.method "moreau".
void carry_out_in_lanes(const GateParams& p, const NextRun& next);

/// The largest number of evaluations that a run can take. A hold of the random force may add one
/// step.
[[nodiscard]] inline double most_evaluations_in_lanes(const GateParams& p) {
  return 3.0 * p.run.time_limit * (1.0 / p.run.step + p.forces.random_rate);
}

}  // namespace gatewalk::dynamics
