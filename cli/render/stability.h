// SPDX-License-Identifier: MIT
#pragma once
/// Maps of where methods break, as a result, CSV, a table and figures.

#include <span>
#include <string>
#include <vector>

#include "cli/fields/fields.h"
#include "cli/render/figure.h"
#include "cli/render/provenance.h"
#include "dynamics/disc/study/stability.h"

namespace gatewalk::cli {

/// The result of `stability`.
struct StabilityResult {
  std::vector<dynamics::FinishedMap> maps;
  Provenance made_by;
};
void describe(Fields& out, const StabilityResult& result);
/// A line for each point.
[[nodiscard]] std::string csv_of(const std::vector<dynamics::FinishedMap>& maps);
/// How many points of each map got each verdict.
[[nodiscard]] std::string table_of(const std::vector<dynamics::FinishedMap>& maps);

/// "step_stiffness.svg"
[[nodiscard]] std::string figure_name(const dynamics::StabilityMap& map);
/// The maps of each kind side by side, at most five, one kind below the other.
[[nodiscard]] Figure figure_of(std::span<const dynamics::FinishedMap> maps);

}  // namespace gatewalk::cli
