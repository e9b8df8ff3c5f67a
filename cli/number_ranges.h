// SPDX-License-Identifier: MIT
#pragma once
/// Numbers that vary, each over a range, for analyze --over and fit --free: numbers of a scene of
/// gates, or parameters of a program that simulates cells.

#include <optional>
#include <string>
#include <vector>

#include "cli/source_options.h"
#include "lattice/scene/ranges.h"
#include "lattice/study/variance_shares.h"

namespace gatewalk::cli {

struct NumberRanges {
  std::vector<lattice::NumberRange> each;
  std::optional<lattice::RangedScene> scene{};  // for gates; none for a program
};

/// The ranges that `option` gives, at most `most`; none without the option. Throws UsageError and
/// SceneError.
[[nodiscard]] std::optional<NumberRanges> ranges_of(const Options& options,
                                                    const lattice::Source& s,
                                                    const TextsOption& option, int most);

/// The scene of gates at a point of the ranges, with the source's start and the method that was
/// chosen for the source.
[[nodiscard]] lattice::Scene scene_at(const NumberRanges& ranges, const lattice::Source& s,
                                      const std::vector<double>& point);
/// Which types of gates a problem has: those in the map, or all of the scene in their order.
enum class CellTypes { of_the_map, all };
/// A function that gives the problem at a point of the ranges. `ranges` and `s` must outlive that
/// function.
[[nodiscard]] lattice::ProblemAt problem_at(const NumberRanges& ranges, const lattice::Source& s,
                                            CellTypes types = CellTypes::of_the_map);

}  // namespace gatewalk::cli
