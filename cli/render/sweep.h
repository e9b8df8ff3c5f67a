// SPDX-License-Identifier: MIT
#pragma once
/// A sweep as JSON, CSV and table.

#include <string>
#include <vector>

#include "cli/render/figure.h"
#include "cli/render/json_fwd.h"
#include "lattice/scene/sweep.h"

namespace gatewalk::cli {

/// Without "made_by".
[[nodiscard]] Json to_json(const std::vector<lattice::SweepAxis>& axes,
                           const std::vector<lattice::SweepPoint>& points);
[[nodiscard]] std::string csv_of(const std::vector<lattice::SweepAxis>& axes,
                                 const std::vector<lattice::SweepPoint>& points);
[[nodiscard]] std::string table_of(const lattice::Scene& scene,
                                   const std::vector<lattice::SweepAxis>& axes,
                                   const std::vector<lattice::SweepPoint>& points);

/// Of one key: shares over its values; of two: a map of the traversed. Throws std::invalid_argument
/// for more.
[[nodiscard]] Figure figure_of(const std::vector<lattice::SweepAxis>& axes,
                               const std::vector<lattice::SweepPoint>& points);

}  // namespace gatewalk::cli
