// SPDX-License-Identifier: MIT
#pragma once
/// Reproduces everything in the paper, in a folder.

#include <string>

#include "cli/paper/report.h"

namespace gatewalk::cli {

struct ReproductionOptions {
  std::string folder;  // made if missing
  bool quick = false;  // fewer trials
  bool talk = true;    // shows progress, and which studies were done before
  bool each = false;   // prints a line for every study
  bool force = false;  // allows a folder that holds other files
};

/// Runs the studies that are not done yet and writes the figures, claims.csv, report.json and
/// report.html into the folder. Meanwhile the folder is the program's working folder, so that the
/// recorded commands work inside it. Throws UsageError for a folder with files of the user's own or
/// with a full report that --quick would replace, std::runtime_error when a study fails or another
/// program works in the folder, and Interrupted.
[[nodiscard]] Report reproduce(const ReproductionOptions& options);

}  // namespace gatewalk::cli
