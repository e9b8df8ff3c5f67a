// SPDX-License-Identifier: MIT
#pragma once
/// Variance-based sensitivity analysis: the part of an outcome's variance that each of several
/// numbers explains when all of them vary. First-order and total indices (Sobol' 2001; Saltelli et
/// al. 2010, "Variance based sensitivity analysis of model output").

#include <cstdint>
#include <vector>

#include "dynamics/base/points.h"
#include "lattice/statistics/group_spread.h"

namespace gatewalk::lattice {

/// Each number takes two dimensions of the points.
inline constexpr int kMostVaried = static_cast<int>(dynamics::kPointDimensions) / 2;

/// The design: points of the unit cube at which the outcome is computed. A row consists of two
/// points A and B and, for each number, A with this number taken from B. Rows alternate between
/// kTrialGroups independent scrambles of Sobol points.
class IndexDesign {
 public:
  /// `numbers`: 1 to kMostVaried; throws std::invalid_argument otherwise.
  IndexDesign(int numbers, std::uint64_t seed);
  [[nodiscard]] int numbers() const { return numbers_; }
  [[nodiscard]] std::int64_t points_of_row() const { return numbers_ + 2; }
  /// Point i, (numbers) in (0, 1). The points of a row are consecutive: A, B, A with the first
  /// number of B, ...
  [[nodiscard]] std::vector<double> point(std::int64_t i) const;

 private:
  int numbers_;
  std::vector<dynamics::ScrambledPoints> scrambles_;
};

/// Sobol indices. Intervals come from the delete-a-group jackknife over the scrambles; NaN if all
/// scrambles agree, which no number of answers makes certain. All indices are NaN if the variance
/// cannot be distinguished from 0.
struct SobolIndices {
  Mean95 mean, variance;  // of the expected outcome, over all numbers
  double noise = 0.0;     // mean variance of one answer at a point
  /// By number: first-order index (its own effect), and total index (with all interactions).
  std::vector<Mean95> first, total;
};

/// `one` and `other`: answers at the design's first points, with independent noise. Only products
/// of one with the other are used, so that noise adds no variance. Within `one`, answers at the
/// points of a row may share noise, which helps; answers of two rows may not. Throws
/// std::invalid_argument unless both have the same whole number of rows, a power of two per
/// scramble.
[[nodiscard]] SobolIndices sobol_indices(const IndexDesign& design, const std::vector<double>& one,
                                         const std::vector<double>& other);

}  // namespace gatewalk::lattice
