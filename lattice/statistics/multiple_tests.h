// SPDX-License-Identifier: MIT
#pragma once
/// Several test statistics of the same data, judged together with the same draws of the null.

#include <cstdint>
#include <utility>
#include <vector>

#include "lattice/statistics/compare.h"

namespace gatewalk::lattice {

/// Mean and 95 % quantile of the values.
[[nodiscard]] std::pair<double, double> mean_and_95(std::vector<double> values);

/// p-values of several statistics, single and adjusted for testing all of them.
struct MultipleTests {
  using Test = JointTest::Test;
  std::vector<Test> tests;
  double p = 1.0;  // overall: the smallest adjusted p-value

  /// `all`: (draws + 1 x statistics), row by row: the null's draws, and in the last row the
  /// observed values. Statistics must grow with the difference.
  MultipleTests(const std::vector<double>& all, std::size_t statistics);

  /// The largest p-value of a single statistic that is significant at `level` when all are tested;
  /// 0 if the draws are too few for any.
  [[nodiscard]] double single_level(double level) const;

 private:
  /// (draws + 1) smallest rank of each row over its statistics; sorted
  std::vector<std::int64_t> least_;
};

/// p-values adjusted for all of them together (Holm, Scand. J. Statist. 6, 1979), in their order.
[[nodiscard]] std::vector<double> holm(const std::vector<double>& p);

}  // namespace gatewalk::lattice
