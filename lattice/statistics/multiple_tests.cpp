// SPDX-License-Identifier: MIT
#include "lattice/statistics/multiple_tests.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gatewalk::lattice {
namespace {

/// For statistic t: in how many rows it is at least as large as in each row. NaN counts as the
/// smallest value.
std::vector<std::int64_t> ranks(const std::vector<double>& all, std::size_t statistics,
                                std::size_t t) {
  std::vector<double> values;
  for (std::size_t at = t; at < all.size(); at += statistics)
    values.push_back(std::isnan(all[at]) ? -1.0 : all[at]);
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::int64_t> rank;
  for (const double x : values)  // results that differ only by rounding count as equal
    rank.push_back(sorted.end() -
                   std::lower_bound(sorted.begin(), sorted.end(), x - 1e-12 * std::abs(x)));
  return rank;
}

}  // namespace

std::pair<double, double> mean_and_95(std::vector<double> values) {
  const auto n = std::ssize(values);
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(n);
  const auto at_95 = values.begin() + (95 * n + 99) / 100 - 1;
  std::nth_element(values.begin(), at_95, values.end());
  return {mean, *at_95};
}

MultipleTests::MultipleTests(const std::vector<double>& all, std::size_t statistics) {
  const std::size_t rows = all.size() / statistics;
  const auto of_all = static_cast<double>(rows);
  std::vector<std::int64_t> of_seen;
  least_.assign(rows, static_cast<std::int64_t>(rows));
  for (std::size_t t = 0; t < statistics; ++t) {
    const std::vector<std::int64_t> rank = ranks(all, statistics, t);
    for (std::size_t k = 0; k < rows; ++k) least_[k] = std::min(least_[k], rank[k]);
    of_seen.push_back(rank.back());
  }
  std::sort(least_.begin(), least_.end());
  for (std::size_t t = 0; t < statistics; ++t) {
    Test test{.seen = all[(rows - 1) * statistics + t]};
    if (std::isnan(test.seen)) {
      test.p = test.p_adjusted = test.seen;
    } else {
      const auto as_small = std::upper_bound(least_.begin(), least_.end(), of_seen[t]);
      test.p = static_cast<double>(of_seen[t]) / of_all;
      test.p_adjusted = static_cast<double>(as_small - least_.begin()) / of_all;
      p = std::min(p, test.p_adjusted);
    }
    tests.push_back(test);
  }
}

double MultipleTests::single_level(double level) const {
  const auto of_all = static_cast<double>(least_.size());
  const auto beyond = static_cast<std::size_t>(level * of_all);  // ranks that may be significant
  const std::int64_t rank =
      beyond >= least_.size() ? std::ssize(least_) : std::max<std::int64_t>(least_[beyond] - 1, 0);
  return static_cast<double>(rank) / of_all;
}

std::vector<double> holm(const std::vector<double>& p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  std::vector<double> adjusted(p.size());
  double largest = 0.0;
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const auto not_smaller = static_cast<double>(order.size() - rank);
    largest = std::max(largest, p[order[rank]] * not_smaller);
    adjusted[order[rank]] = std::min(1.0, largest);
  }
  return adjusted;
}

}  // namespace gatewalk::lattice
