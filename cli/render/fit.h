// SPDX-License-Identifier: MIT
#pragma once
/// A posterior as a result, as a table, as CSV, as a picture, and as InferenceData.

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
  std::optional<lattice::Settled> method;  // that was chosen
  lattice::Fit fit;
  Provenance made_by;
};
void describe(Fields& out, const FittedScene& f);

/// What was seen and run: "trials", or "passages".
[[nodiscard]] std::string counted(const FittedScene& f);
/// The first screen, and what --details adds to it.
[[nodiscard]] std::string answer_text(const FittedScene& f);
[[nodiscard]] std::string details_text(const FittedScene& f);
/// A line for each draw: the numbers in their units, and the log likelihood.
[[nodiscard]] std::string draws_csv(const FittedScene& f);
/// Each number's posterior, and that of each pair.
[[nodiscard]] Figure figure_of(const FittedScene& f);
/// ArviZ's InferenceData as a NetCDF-4 file: posterior and sample_stats (chain, draw),
/// posterior_predictive (chain, draw, outcome), observed_data (outcome).
[[nodiscard]] std::string inference_data(const FittedScene& f);

/// Nothing went wrong in the runs, the posterior is settled, and it explains the counts.
[[nodiscard]] bool is_clean(const FittedScene& f);
/// What keeps the posterior from being taken at face value; empty if nothing does.
[[nodiscard]] std::vector<std::string> warnings_of(const FittedScene& f);

}  // namespace gatewalk::cli
