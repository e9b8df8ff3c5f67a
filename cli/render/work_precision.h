// SPDX-License-Identifier: MIT
#pragma once
/// Speed against accuracy of the methods on scenes, as a result, CSV, a table and a figure.

#include <string>
#include <vector>

#include "cli/fields/fields.h"
#include "cli/render/figure.h"
#include "cli/render/provenance.h"
#include "dynamics/disc/study/work_precision.h"

namespace gatewalk::cli {

/// The result of `chart methods`: a chart of each scene, and what made it.
struct ChartResult {
  std::vector<dynamics::WorkPrecision> charts;
  std::vector<Provenance> made_by;
};
void describe(Fields& out, const ChartResult& result);
/// A scene's reference and settings.
void describe(Fields& out, const dynamics::WorkPrecision& chart);
/// A line for each setting of each scene.
[[nodiscard]] std::string csv_of(const std::vector<dynamics::WorkPrecision>& charts);
/// The first screen: the fastest setting that will do, and of one scene the defaults of the
/// methods. And what --details adds: the reference, and a line for each setting; `rounds` of
/// timing.
[[nodiscard]] std::string answer_text(const std::vector<dynamics::WorkPrecision>& charts);
[[nodiscard]] std::string details_text(const std::vector<dynamics::WorkPrecision>& charts,
                                       std::int64_t rounds);
/// A row for each scene: time against the error of the outcomes, and
/// against where trials end.
[[nodiscard]] Figure figure_of(const std::vector<dynamics::WorkPrecision>& charts);

}  // namespace gatewalk::cli
