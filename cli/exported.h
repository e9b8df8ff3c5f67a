// SPDX-License-Identifier: MIT
#pragma once
/// What gatewalk export writes, by the ending of its file's name.

#include <string>

#include "cli/command.h"
#include "cli/render/json_fwd.h"

namespace gatewalk::cli {

enum class ExportForm { umb, drn, prism, matrix_market, csv, npz, trajectories };

/// Throws UsageError naming the endings that there are.
[[nodiscard]] ExportForm export_form(const std::string& output);
/// Throws UsageError where a file that is written beside it is an input or another output, or
/// cannot be written.
void check_files_beside(const Options& options, ExportForm form);

/// Writes the files, and says in `json` and the text what they hold.
[[nodiscard]] std::string export_field(const Options& options, ExportForm form, Json& json);
[[nodiscard]] std::string export_gate(const Options& options, ExportForm form, Json& json);
[[nodiscard]] std::string export_trials(const Options& options, Json& json);

}  // namespace gatewalk::cli
