// SPDX-License-Identifier: MIT
#pragma once
/// For tests of cells of one's own: does a cell keep what Cell promises?

#include <cstdint>
#include <string>
#include <vector>

#include "dynamics/cells/cell.h"

namespace gatewalk::dynamics {

struct CheckOptions {
  std::int64_t trials = 200;  // from the starts in turn
  int cells = 8;              // that a trial passes at most
  std::uint64_t seed = 1;
};

/// What is wrong with a cell, in words; none: nothing was found. Trials are carried out several
/// times, on one and on four threads, in batches of any and of small sizes, alone and in reverse
/// order, by a copy with the same numbers: the bits must be the same. Sections must be valid,
/// entries finite and by known faces, costs finite and the first of them a time > 0, nothing may
/// break, and a cell that says it is symmetric must send bodies from mirrored starts to the
/// mirrored faces as often. Throws std::invalid_argument without starts.
[[nodiscard]] std::vector<std::string> check_cell(const Cell& cell,
                                                  const std::vector<Entry>& starts,
                                                  const CheckOptions& options = {});

}  // namespace gatewalk::dynamics
