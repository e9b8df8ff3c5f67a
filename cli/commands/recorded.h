// SPDX-License-Identifier: MIT
#pragma once
/// gatewalk build of cells that are not ours.

#include "cli/command.h"

namespace gatewalk::cli {

/// Declares --cell.
void add_cell(Options& options);

/// gatewalk build RUNS.csv --cell CELL.toml.
[[nodiscard]] int build_recorded(const Options& options);
/// gatewalk build CELL.toml --cell-program COMMAND.
[[nodiscard]] int build_program(const Options& options);

}  // namespace gatewalk::cli
