// SPDX-License-Identifier: MIT
#pragma once
/// Runs of method `stable` in vector lanes (Google Highway: the instruction set is chosen when the
/// program runs). Hundreds of runs are in flight. Each round collects runs that need the same work
/// and does it in full registers, one kind after the other: free flight, held contacts, the search
/// for hits, the rest of a piece after a hit (wavefronts: Laine, Karras and Aila, Megakernels
/// considered harmful, High-Performance Graphics 2013). The plain method does rare work and the
/// step in which a body leaves.
///
/// The plain method (methods/stable.h) is the reference: every run and its health have the same
/// bits, with any instruction set and any other runs in flight.

#include "dynamics/disc/methods/stable.h"
#include "dynamics/disc/runs.h"

namespace gatewalk::dynamics {

/// Carries out runs as carry_out does, by `method`, at most `at_once` at a time.
void carry_out_in_lanes(const GateParams& p, const StableMethod& method, const NextRun& next,
                        std::int64_t most_work, std::int64_t at_once);

/// Whether the lanes are faster than the plain method: false on machines without vector registers.
[[nodiscard]] bool lanes_pay_for_stable();

}  // namespace gatewalk::dynamics
