// SPDX-License-Identifier: MIT
#pragma once
/// Runs of method `stable` in vector lanes (Google Highway: the instruction set is chosen when the
/// program runs). Hundreds of runs are in flight; each round takes what they need next in full
/// registers, one kind after the other: free flight, held contacts, the search for hits, what is
/// left of a piece after a hit (wavefronts: Laine, Karras and Aila, Megakernels considered harmful,
/// High-Performance Graphics 2013). What is rare, and the step in which a body leaves, the plain
/// method does.
///
/// The plain method (methods/stable.h) is the reference: every run has its bits, and its health's,
/// with any instruction set and in any company.

#include "dynamics/disc/methods/stable.h"
#include "dynamics/disc/runs.h"

namespace gatewalk::dynamics {

/// As carry_out, by `method`; not more than `at_once` runs at a time.
void carry_out_in_lanes(const GateParams& p, const StableMethod& method, const NextRun& next,
                        std::int64_t most_work, std::int64_t at_once);

/// False on machines without vector registers, where the plain method is faster.
[[nodiscard]] bool lanes_pay_for_stable();

}  // namespace gatewalk::dynamics
