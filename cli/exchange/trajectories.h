// SPDX-License-Identifier: MIT
#pragma once
/// Trials as sequences of a matrix's states.

#include "cli/exchange/sparse_table.h"
#include "dynamics/cells/state_space.h"
#include "lattice/pool/run_pool.h"

namespace gatewalk::cli {

/// A sequence for each trial: the state at the start, the state in which each cell is entered, and
/// at the end, for a trapped body, the number of states. A run that broke and a body that was lost
/// from sight end their sequence.
[[nodiscard]] Trajectories trajectories_of(const lattice::RunPool& pool,
                                           const dynamics::StateSpace& space);

}  // namespace gatewalk::cli
