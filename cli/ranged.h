// SPDX-License-Identifier: MIT
#pragma once
/// A scene of gates whose numbers vary, each over a range: of analyze --over and fit --free.

#include <optional>
#include <string>

#include "cli/subject.h"
#include "lattice/scene/ranges.h"
#include "lattice/study/variance_shares.h"

namespace gatewalk::cli {

/// The scene over the ranges of this option, at most so many; none without it. Throws UsageError
/// and SceneError.
[[nodiscard]] std::optional<lattice::RangedScene> ranges_of(const Options& options,
                                                            const Subject& s,
                                                            const std::string& option, int most);

/// The scene at a point of the ranges, started where the subject is and by the method that was
/// chosen for it. What is given outlives it.
[[nodiscard]] lattice::Scene scene_at(const lattice::RangedScene& ranged, const Subject& s,
                                      const std::vector<double>& point);
[[nodiscard]] lattice::ProblemAt problem_at(const lattice::RangedScene& ranged, const Subject& s);

}  // namespace gatewalk::cli
