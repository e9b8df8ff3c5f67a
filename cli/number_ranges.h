// SPDX-License-Identifier: MIT
#pragma once
/// Numbers of a scene of gates, or of a program that carries out cells, which vary, each over a
/// range: of analyze --over and fit --free.

#include <optional>
#include <string>
#include <vector>

#include "cli/source_options.h"
#include "lattice/scene/ranges.h"
#include "lattice/study/variance_shares.h"

namespace gatewalk::cli {

struct NumberRanges {
  std::vector<lattice::NumberRange> each;
  std::optional<lattice::RangedScene> scene{};  // of gates; else of a program
};

/// The source over the ranges of this option, at most so many; none without it. Throws UsageError
/// and SceneError.
[[nodiscard]] std::optional<NumberRanges> ranges_of(const Options& options,
                                                    const lattice::Source& s,
                                                    const TextsOption& option, int most);

/// The scene of gates at a point of the ranges, started where the source is and by the method that
/// was chosen for it.
[[nodiscard]] lattice::Scene scene_at(const NumberRanges& ranges, const lattice::Source& s,
                                      const std::vector<double>& point);
/// Types of cells: those that stand in the map, or all of the scene in their order.
enum class CellTypes { of_the_map, all };
/// The problem at each point of the ranges; what it is given must outlive it.
[[nodiscard]] lattice::ProblemAt problem_at(const NumberRanges& ranges, const lattice::Source& s,
                                            CellTypes types = CellTypes::of_the_map);

}  // namespace gatewalk::cli
