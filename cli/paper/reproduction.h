// SPDX-License-Identifier: MIT
#pragma once
/// Everything of the paper, made again in a folder.

#include <string>

#include "cli/paper/report.h"

namespace gatewalk::cli {

struct ReproductionOptions {
  std::string folder;  // is made if there is none
  bool quick = false;  // fewer trials
  bool talk = true;    // progress, and which studies were done before
  bool each = false;   // a line on standard output for every study
  bool force = false;  // also in a folder with files of others
};

/// Runs the studies that are not done yet, inside the folder, and writes the figures, claims.csv,
/// report.json and report.html; the working folder of the program is then that folder, because the
/// studies are commands whose files are recorded as they are named in it. Throws UsageError for a
/// folder that holds something of the user's own or a full report that --quick would replace,
/// std::runtime_error when a study fails or another program works in the folder, Interrupted.
[[nodiscard]] Report reproduce(const ReproductionOptions& options);

}  // namespace gatewalk::cli
