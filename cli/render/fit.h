// SPDX-License-Identifier: MIT
#pragma once
/// A posterior as a result, a table, CSV, a figure and InferenceData.

#include <optional>
#include <string>
#include <vector>

#include "cli/fields/fields.h"
#include "cli/render/figure.h"
#include "cli/render/provenance.h"
#include "lattice/field/field_params.h"
#include "lattice/scene/ranges.h"
#include "lattice/scene/settle.h"
#include "lattice/study/fit.h"

namespace gatewalk::cli {

/// The result of `fit`.
struct FittedScene {
  std::vector<lattice::NumberRange> ranges;
  lattice::FieldParams field;
  std::optional<lattice::Settled> method;  // chosen for the scene
  lattice::Fit fit;
  Provenance made_by;
};
void describe(Fields& out, const FittedScene& f);

/// What was observed and simulated: "trials" or "passages".
[[nodiscard]] std::string counted(const FittedScene& f);
/// The first screen; and what --details adds to it.
[[nodiscard]] std::string answer_text(const FittedScene& f);
[[nodiscard]] std::string details_text(const FittedScene& f);
/// CSV with a line for each draw: the numbers in their units, and the log likelihood.
[[nodiscard]] std::string draws_csv(const FittedScene& f);
/// The posterior of each number and of each pair.
[[nodiscard]] Figure figure_of(const FittedScene& f);
/// ArviZ's InferenceData as a NetCDF-4 file: posterior and sample_stats (chain, draw),
/// posterior_predictive (chain, draw, outcome), observed_data (outcome).
[[nodiscard]] std::string inference_data(const FittedScene& f);

/// Whether the runs showed no faults, the posterior has settled, and it explains the counts.
[[nodiscard]] bool is_clean(const FittedScene& f);
/// Reasons not to take the posterior at face value; empty if there are none.
[[nodiscard]] std::vector<std::string> warnings_of(const FittedScene& f);

}  // namespace gatewalk::cli
