// SPDX-License-Identifier: MIT
#pragma once
/// Several statistics of the same data, judged together by the same draws of the null.

#include <cstdint>
#include <utility>
#include <vector>

#include "lattice/statistics/compare.h"

namespace gatewalk::lattice {

/// Mean, and what 95 % of the values do not exceed.
[[nodiscard]] std::pair<double, double> mean_and_95(std::vector<double> values);

/// What looking at several statistics finds.
struct MultipleTests {
  using Test = JointTest::Test;
  std::vector<Test> tests;
  double p = 1.0;  // of all together: the smallest adjusted one

  /// `all`: (draws + 1 x statistics) row by row, the null's draws and in the last row what was
  /// seen. Statistics grow with the difference.
  MultipleTests(const std::vector<double>& all, std::size_t statistics);

  /// The largest p-value of a single statistic that is found at `level` when all are looked at; 0:
  /// there are too few draws for any.
  [[nodiscard]] double single_level(double level) const;

 private:
  std::vector<std::int64_t> least_;  // (draws + 1) rank of each row, over its statistics; sorted
};

}  // namespace gatewalk::lattice
