// SPDX-License-Identifier: MIT
#pragma once
/// The number of trials that an experiment needs, as a result and tables.

#include <optional>
#include <string>
#include <vector>

#include "cli/fields/fields.h"
#include "cli/render/provenance.h"
#include "dynamics/cells/health.h"
#include "lattice/scene/scene.h"
#include "lattice/scene/settle.h"
#include "lattice/study/experiment.h"

namespace gatewalk::cli {

/// The keys "more" and "fewer", in percentage points.
void describe(Fields& out, const lattice::SmallestDifference& d);
/// "+17.1 / -8.2"
[[nodiscard]] std::string text_of(const lattice::SmallestDifference& d);

/// The scene or group to be distinguished from the prediction.
struct PowerVersus {
  std::vector<std::string> set{};  // the values of --versus
  lattice::StartAnswer prediction{};
  lattice::TwoScenesPlan apart{};
  std::optional<lattice::Scene> scene{};  // none for another group's recorded runs
};

/// The result of `power`.
struct PowerResult {
  lattice::ExperimentOptions options{};
  lattice::StartAnswer prediction{};
  lattice::ExperimentPlan plan{};
  std::optional<PowerVersus> versus{};
  dynamics::Health health{};
  std::optional<lattice::Settled> method{};
  Provenance made_by{};
  bool recorded = false;  // whether the chain is of recorded bodies, to which none can be added
};
void describe(Fields& out, const PowerResult& result);
/// The first screen; and what --details adds to it.
[[nodiscard]] std::string answer_text(const PowerResult& result);
[[nodiscard]] std::string details_text(const PowerResult& result);

}  // namespace gatewalk::cli
