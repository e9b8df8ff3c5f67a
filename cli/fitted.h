// SPDX-License-Identifier: MIT
#pragma once
/// What gatewalk fit looks at before any work.

#include <cstdint>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/subject.h"
#include "lattice/study/fit_data.h"

namespace gatewalk::cli {

/// Files of so many scenes beside that of -o: "best-1.toml", ... Throws UsageError where one is
/// read by the command, or another output of it.
[[nodiscard]] std::vector<std::string> files_of_draws(const Options& options, std::int64_t count);

/// What an experiment saw of the subject, from a table of counts, of trials, or of passages; and
/// warns of what it leaves out. `problem`: of the subject, with all types of cells if it is of
/// passages (is_table_of_runs). Throws UsageError, and std::invalid_argument.
[[nodiscard]] lattice::FitData data_to_fit(const Options& options, const Subject& s,
                                           const lattice::Problem& problem,
                                           const std::string& path);

}  // namespace gatewalk::cli
