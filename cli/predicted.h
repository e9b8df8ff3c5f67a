// SPDX-License-Identifier: MIT
#pragma once
/// Where bodies end, from runs that are added until an error bar is kept, or from a matrix as it
/// is: given out as gatewalk predict does.

#include <vector>

#include "cli/subject.h"
#include "lattice/scene/row_matrices.h"

namespace gatewalk::cli {

/// Until the error bar says enough, with the runs that there are already; of recorded runs with
/// these alone. The exit status.
[[nodiscard]] int predict_from_runs(const Options& options, Subject& s);

/// What infinitely many walks with a scene's matrix as it is would give; in some rows with others.
[[nodiscard]] int predict_from_matrix(const Options& options, const Subject& s,
                                      const std::vector<lattice::RowMatrix>& others);

}  // namespace gatewalk::cli
