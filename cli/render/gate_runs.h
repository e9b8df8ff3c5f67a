// SPDX-License-Identifier: MIT
#pragma once
/// How runs of one gate ended, as a result, a table and a figure.

#include <optional>
#include <string>

#include "cli/fields/fields.h"
#include "cli/render/figure.h"
#include "cli/render/provenance.h"
#include "dynamics/disc/ensemble.h"
#include "lattice/scene/settle.h"

namespace gatewalk::cli {

/// Counts with their 95 % intervals.
void describe(Fields& out, const dynamics::GateTally& tally);

/// The result of `gate`.
struct GateResult {
  dynamics::GateTally tally;
  std::optional<lattice::Settled> method;
  Provenance made_by;
};
void describe(Fields& out, const GateResult& result);
/// A line for each outcome: count, share, 95 % interval.
[[nodiscard]] std::string table_of(const dynamics::GateTally& tally);
/// A bar for each outcome.
[[nodiscard]] Figure figure_of(const dynamics::GateTally& tally);

}  // namespace gatewalk::cli
