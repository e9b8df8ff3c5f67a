// SPDX-License-Identifier: MIT
#pragma once
/// Where methods fail near the numbers of a scene, as a result, CSV, a table and figures.

#include <span>
#include <string>
#include <vector>

#include "cli/fields/fields.h"
#include "cli/render/figure.h"
#include "cli/render/provenance.h"
#include "dynamics/disc/study/limits.h"

namespace gatewalk::cli {

/// The result of `chart limits`.
struct LimitsResult {
  std::string label;                     // name of the scene
  std::vector<std::string> other_types;  // types of gates that are not charted
  dynamics::LimitScene scene;
  std::vector<dynamics::FinishedMap> maps;
  std::vector<dynamics::MethodLimits> limits;
  Provenance made_by;
};
void describe(Fields& out, const LimitsResult& result);
/// CSV with a line for each point.
[[nodiscard]] std::string csv_of(const std::vector<dynamics::FinishedMap>& maps);
/// The first screen: the nearest fault of each method, its sign, and what to do; and what --details
/// adds: how far each method is from the faults of every number.
[[nodiscard]] std::string answer_text(const LimitsResult& result);
[[nodiscard]] std::string details_text(const LimitsResult& result);

/// "stiffness.svg"
[[nodiscard]] std::string figure_name(dynamics::LimitNumber number);
/// The maps of each number side by side, at most five; one number below the other.
[[nodiscard]] Figure figure_of(const dynamics::LimitScene& scene,
                               std::span<const dynamics::FinishedMap> maps);

}  // namespace gatewalk::cli
