// SPDX-License-Identifier: MIT
#pragma once
/// What gatewalk fit looks at before any work.

#include <cstdint>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/ranged.h"
#include "cli/subject.h"
#include "lattice/study/fit_data.h"

namespace gatewalk::cli {

/// Files of so many scenes beside that of -o: "best-1.toml", ... Throws UsageError where one is
/// read by the command, or another output of it.
[[nodiscard]] std::vector<std::string> files_of_draws(const Options& options, std::int64_t count);

/// The types of cells that a table of passages names, or those of the map.
[[nodiscard]] CellTypes types_in(const std::vector<std::string>& paths);
/// What an experiment saw, from tables of counts or of trials, as lattice::read_observed, or one of
/// passages; and warns of what it leaves out. `at`: with types_in(paths). Throws UsageError, and
/// std::invalid_argument.
[[nodiscard]] lattice::FitData data_to_fit(const Options& options, const Subject& s,
                                           const Ranged& ranged, const lattice::ProblemAt& at,
                                           const std::vector<std::string>& paths,
                                           std::int64_t trials);

}  // namespace gatewalk::cli
