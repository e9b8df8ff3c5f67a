// SPDX-License-Identifier: MIT
#pragma once
/// A check for your own cells: does a cell keep the promises of Cell?

#include <cstdint>
#include <string>
#include <vector>

#include "dynamics/cells/cell.h"

namespace gatewalk::dynamics {

/// Options of check_cell().
struct CheckOptions {
  std::int64_t trials = 200;  // number of trials; the starts take turns
  int cells = 8;              // largest number of cells that a trial passes
  std::uint64_t seed = 1;
};

/// Checks a cell and returns one sentence for each fault found; an empty result means that no fault
/// was found. The check repeats the trials on one and four threads, in batches of any and of small
/// size, alone in reverse order, and with copies that have the same parameters: the bits must be
/// the same. The section must be valid, entries finite and on known faces, costs finite and the
/// first cost a time > 0. No passage may break. A symmetric cell must send bodies from mirrored
/// starts to the mirrored faces equally often. Throws std::invalid_argument without starts.
[[nodiscard]] std::vector<std::string> check_cell(const Cell& cell,
                                                  const std::vector<Entry>& starts,
                                                  const CheckOptions& options = {});

}  // namespace gatewalk::dynamics
