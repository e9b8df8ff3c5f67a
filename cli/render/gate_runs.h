// SPDX-License-Identifier: MIT
#pragma once
/// How runs of one gate ended, as JSON and as a table.

#include <string>

#include "cli/render/figure.h"
#include "cli/render/json_fwd.h"
#include "dynamics/disc/ensemble.h"

namespace gatewalk::cli {

/// Counts, and 95 % intervals of their shares.
[[nodiscard]] Json to_json(const dynamics::GateTally& tally);
/// A line per outcome: count, share, 95 % interval.
[[nodiscard]] std::string table_of(const dynamics::GateTally& tally);
/// A bar per outcome.
[[nodiscard]] Figure figure_of(const dynamics::GateTally& tally);

}  // namespace gatewalk::cli
