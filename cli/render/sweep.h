// SPDX-License-Identifier: MIT
#pragma once
/// A sweep as a result, CSV, a table and a figure.

#include <string>
#include <vector>

#include "cli/fields/fields.h"
#include "cli/render/figure.h"
#include "cli/render/provenance.h"
#include "lattice/scene/study/sweep.h"

namespace gatewalk::cli {

/// The result of `sweep`.
struct SweepResult {
  std::vector<lattice::SweepAxis> axes;
  std::vector<lattice::SweepPoint> points;
  Provenance made_by;
};
void describe(Fields& out, const SweepResult& result);
[[nodiscard]] std::string csv_of(const SweepResult& result);
/// The first screen; and what --details adds to it.
[[nodiscard]] std::string answer_text(const SweepResult& result);
[[nodiscard]] std::string details_text(const SweepResult& result, const lattice::Scene& scene);

/// For one key, shares over its values; for two, a map of the share that traversed. Throws
/// std::invalid_argument for more keys.
[[nodiscard]] Figure figure_of(const std::vector<lattice::SweepAxis>& axes,
                               const std::vector<lattice::SweepPoint>& points);

}  // namespace gatewalk::cli
