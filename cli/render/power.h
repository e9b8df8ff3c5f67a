// SPDX-License-Identifier: MIT
#pragma once
/// How many trials an experiment needs, as JSON and as tables.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/render/json_fwd.h"
#include "lattice/scene/scene.h"
#include "lattice/study/experiment.h"

namespace gatewalk::cli {

/// null for none.
[[nodiscard]] Json or_null(const std::optional<double>& x);
[[nodiscard]] Json or_null(const std::optional<std::int64_t>& x);
/// In percentage points: {"more", "fewer"}, null for none.
[[nodiscard]] Json to_json(const lattice::SmallestDifference& d);
/// "+17.1 / -8.2"
[[nodiscard]] std::string text_of(const lattice::SmallestDifference& d);

/// A plan, and what it was made for.
struct PlannedExperiment {
  const lattice::ExperimentOptions& options;
  const lattice::StartAnswer& prediction;
  const lattice::ExperimentPlan& plan;
  /// The other scene of --versus, or another group's recorded runs, if there is one.
  std::vector<std::string> versus{};
  std::optional<lattice::Scene> other_scene{};
  std::optional<lattice::StartAnswer> other{};
  std::optional<lattice::TwoScenesPlan> apart{};
};

/// Without "made_by".
[[nodiscard]] Json to_json(const PlannedExperiment& e);
[[nodiscard]] std::string table_of(const PlannedExperiment& e);

}  // namespace gatewalk::cli
