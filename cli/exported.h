// SPDX-License-Identifier: MIT
#pragma once
/// What gatewalk export writes, by the ending of its file's name.

#include <string>

#include "cli/command.h"
#include "cli/render/files.h"

namespace gatewalk::cli {

enum class ExportForm { umb, drn, prism, matrix_market, csv, npz, trajectories };

/// Throws UsageError naming the endings that there are.
[[nodiscard]] ExportForm export_form(const std::string& output);
/// Throws UsageError where a file that is written beside it is an input or another output, or
/// cannot be written.
void check_files_beside(const Options& options, ExportForm form);

/// What was written, and in words.
struct Exported {
  ExportResult result;
  std::string text;
};
[[nodiscard]] Exported export_field(const Options& options, ExportForm form);
[[nodiscard]] Exported export_gate(const Options& options, ExportForm form);
[[nodiscard]] Exported export_trials(const Options& options);

}  // namespace gatewalk::cli
