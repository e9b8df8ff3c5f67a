#pragma once
/// What commands do with recorded runs of cells that are not ours, and with matrices of them.

#include "cli/command.h"

namespace gatewalk::cli {

/// Declares --cell.
void add_cell(Options& options);

/// gatewalk build RUNS.csv --cell CELL.toml.
[[nodiscard]] int build_recorded(const Options& options);

/// Declares --cell-program and --cell-timeout.
void add_cell_program(Options& options);
/// gatewalk predict CELL.toml --cell-program COMMAND: runs are made by the program.
[[nodiscard]] int predict_program(const Options& options);

/// Of a matrix of such cells, in place of a scene's.
[[nodiscard]] int predict_recorded(const Options& options);

}  // namespace gatewalk::cli
