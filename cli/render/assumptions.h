// SPDX-License-Identifier: MIT
#pragma once
/// The checks of a chain's assumptions, as part of results and in words.

#include <string>
#include <vector>

#include "cli/fields/fields.h"
#include "lattice/pool/pooled_prediction.h"

namespace gatewalk::cli {

/// The key "assumptions".
void describe_assumptions(Fields& out, const std::vector<lattice::AssumptionCheck>& checks);
/// A line for each assumption; empty without checks.
[[nodiscard]] std::string assumptions_text(const std::vector<lattice::AssumptionCheck>& checks);
/// A sentence on the assumption that is wrong, with what to do, without its full stop; empty if
/// none is. And the same as a line of the first screen.
[[nodiscard]] std::string wrong_assumption_text(const std::vector<lattice::AssumptionCheck>& checks,
                                                bool is_recorded = false);
[[nodiscard]] std::string beware_of(const std::vector<lattice::AssumptionCheck>& checks,
                                    bool is_recorded = false);

}  // namespace gatewalk::cli
