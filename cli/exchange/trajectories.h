// SPDX-License-Identifier: MIT
#pragma once
/// Trials as sequences of a matrix's states.

#include "cli/exchange/sparse_table.h"
#include "dynamics/cells/state_space.h"
#include "lattice/pool/run_pool.h"

namespace gatewalk::cli {

/// One for each trial: the state in which it started, that of each cell that it entered, and at the
/// end, if it was trapped, the number of states. Runs that broke, and bodies that were lost from
/// sight, end theirs.
[[nodiscard]] Trajectories trajectories_of(const lattice::RunPool& pool,
                                           const dynamics::StateSpace& space);

}  // namespace gatewalk::cli
