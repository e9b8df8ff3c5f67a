// SPDX-License-Identifier: MIT
#pragma once
/// Speed against accuracy of the methods, as a result, CSV, a table and a figure.

#include <string>
#include <vector>

#include "cli/fields/fields.h"
#include "cli/render/figure.h"
#include "cli/render/provenance.h"
#include "dynamics/disc/study/work_precision.h"

namespace gatewalk::cli {

/// The result of `chart methods`: a chart for each scene, and its provenance.
struct ChartResult {
  std::vector<dynamics::WorkPrecision> charts;
  std::vector<Provenance> made_by;
};
void describe(Fields& out, const ChartResult& result);
/// A scene's reference and settings.
void describe(Fields& out, const dynamics::WorkPrecision& chart);
/// CSV with a line for each setting of each scene.
[[nodiscard]] std::string csv_of(const std::vector<dynamics::WorkPrecision>& charts);
/// The first screen: the fastest setting that is good enough and, for a single scene, the methods'
/// defaults; and what --details adds: the reference, and a line for each setting. `rounds` are
/// those of timing.
[[nodiscard]] std::string answer_text(const std::vector<dynamics::WorkPrecision>& charts);
[[nodiscard]] std::string details_text(const std::vector<dynamics::WorkPrecision>& charts,
                                       std::int64_t rounds);
/// A row for each scene: time against the error of the outcomes, and against the error of the
/// places where trials end.
[[nodiscard]] Figure figure_of(const std::vector<dynamics::WorkPrecision>& charts);

}  // namespace gatewalk::cli
