// SPDX-License-Identifier: MIT
#pragma once
/// What gatewalk fit looks at before any work.

#include <cstdint>
#include <string>
#include <vector>

#include "cli/command.h"
#include "lattice/study/observed.h"

namespace gatewalk::cli {

/// Files of so many scenes beside that of -o: "best-1.toml", ... Throws UsageError where one is
/// read by the command, or another output of it.
[[nodiscard]] std::vector<std::string> files_of_draws(const Options& options, std::int64_t count);

/// Endings that the table has no row of count as 0; empty if it has all.
[[nodiscard]] std::string not_listed(const lattice::Observed& observed,
                                     const lattice::FieldParams& field);

}  // namespace gatewalk::cli
