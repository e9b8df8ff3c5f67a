// SPDX-License-Identifier: MIT
#pragma once
/// How much of the variance of an outcome each of several numbers makes, when all of them vary
/// freely: first-order and total indices (Sobol' 2001; Saltelli et al. 2010, "Variance based
/// sensitivity analysis of model output").

#include <cstdint>
#include <vector>

#include "dynamics/base/points.h"
#include "lattice/statistics/group_spread.h"

namespace gatewalk::lattice {

/// Each number takes two dimensions of the points.
inline constexpr int kMostVaried = static_cast<int>(dynamics::kPointDimensions) / 2;

/// Where the outcome is asked for: points of the unit cube. A row is two points A and B, and for
/// each number A with this number of B. Rows take turns among kTrialGroups scrambles of Sobol's
/// points that do not depend on each other.
class IndexDesign {
 public:
  /// 1 to kMostVaried numbers; throws std::invalid_argument for others.
  IndexDesign(int numbers, std::uint64_t seed);
  [[nodiscard]] int numbers() const { return numbers_; }
  [[nodiscard]] std::int64_t points_of_row() const { return numbers_ + 2; }
  /// (numbers) in (0, 1); the points of a row are neighbours: A, B, A with the first of B, ...
  [[nodiscard]] std::vector<double> point(std::int64_t i) const;

 private:
  int numbers_;
  std::vector<dynamics::ScrambledPoints> scrambles_;
};

/// Intervals are by the delete-a-group jackknife over the scrambles; NaN where all of these are
/// alike, which no number of answers makes certain. Where the variance cannot be
/// told from none, all indices are NaN.
struct SobolIndices {
  Mean95 mean, variance;             // of the expected outcome, over all numbers
  double noise = 0.0;                // variance of one answer at a point, on average
  std::vector<Mean95> first, total;  // by number: of its own; and with all that it does together
                                     // with others
};

/// `one` and `other`: answers at the design's first points, whose noise does not depend on each
/// other's. Only products of one and the other are used, so that noise makes no variance; those of
/// one at the points of a row may share theirs, which helps, those of two rows may not. Throws
/// std::invalid_argument unless they are of as many whole rows, a power of two for each scramble.
[[nodiscard]] SobolIndices sobol_indices(const IndexDesign& design, const std::vector<double>& one,
                                         const std::vector<double>& other);

}  // namespace gatewalk::lattice
