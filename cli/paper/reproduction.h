// SPDX-License-Identifier: MIT
#pragma once
/// Everything of the paper, made again in a folder.

#include <string>
#include <vector>

#include "cli/paper/claims.h"
#include "cli/render/json.h"

namespace gatewalk::cli {

struct ReproductionOptions {
  std::string folder;  // is made if there is none
  bool quick = false;  // fewer trials
  bool talk = true;    // a line on standard output for every study
  bool force = false;  // also in a folder with files of others
};

struct Reproduction {
  Json report;  // page.h
  std::vector<Claim> claims;
  double seconds = 0.0;  // of all studies

  /// "18 reproduced, 9 agree, 0 cannot be told, 9 differ"
  [[nodiscard]] std::string tally() const;
};

/// Runs the studies that are not done yet, inside the folder, and writes the figures, claims.csv,
/// report.json and report.html; the working folder of the program is then that folder, because the
/// studies are commands whose files are recorded as they are named in it. Throws UsageError for a
/// folder that holds something of the user's own or a full report that --quick would replace,
/// std::runtime_error when a study fails or another program works in the folder, Interrupted.
[[nodiscard]] Reproduction reproduce(const ReproductionOptions& options);

}  // namespace gatewalk::cli
