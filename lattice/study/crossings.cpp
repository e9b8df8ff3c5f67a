// SPDX-License-Identifier: MIT
#include "lattice/study/crossings.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "dynamics/base/share.h"
#include "lattice/statistics/group_spread.h"

namespace gatewalk::lattice {
namespace {

bool crossed(const std::optional<markov::Ending>& ending) {
  return ending == markov::Ending::far_edge;
}

}  // namespace

std::array<double, 2> Crossings::interval_95() const {
  return dynamics::share_interval(crossed, trials);
}

Crossings crossings_of(const FieldTrials& trials) {
  return {std::count_if(trials.endings.begin(), trials.endings.end(), crossed),
          std::ssize(trials.endings)};
}

Gain gain_over(const FieldTrials& with, const FieldTrials& without) {
  double more = 0.0, less = 0.0;
  for (std::size_t i = 0; i < with.endings.size(); ++i) {
    more += crossed(with.endings[i]) && !crossed(without.endings[i]);
    less += crossed(without.endings[i]) && !crossed(with.endings[i]);
  }
  const auto n = static_cast<double>(with.endings.size());
  const double p = (more + 1.0) / (n + 2.0), q = (less + 1.0) / (n + 2.0),
               half = dynamics::kNormal95 * std::sqrt((p + q - (p - q) * (p - q)) / (n + 2.0));
  return {(more - less) / n, {p - q - half, p - q + half}};
}

Spent spent_by(const FieldTrials& trials, std::size_t cost) {
  const auto n = static_cast<double>(trials.costs.size());
  if (n < 2.0) throw std::invalid_argument("what trials take: two of them at least");
  double share = 0.0, mean = 0.0;
  for (std::size_t i = 0; i < trials.costs.size(); ++i) {
    share += crossed(trials.endings[i]) ? 1.0 / n : 0.0;
    mean += trials.costs[i][cost] / n;
  }
  double cc = 0.0, cp = 0.0;
  for (std::size_t i = 0; i < trials.costs.size(); ++i) {
    const double off = trials.costs[i][cost] - mean;
    cc += off * off / (n - 1.0);
    cp += off * (crossed(trials.endings[i]) ? 1.0 : 0.0) / (n - 1.0);
  }
  const double z = dynamics::kNormal95, pp = share * (1.0 - share) * n / (n - 1.0);
  const double half = z * std::sqrt(cc / n);
  const double never = std::numeric_limits<double>::infinity(), unknown = std::nan("");
  Spent spent{.mean = mean, .mean_95 = {mean - half, mean + half}};
  if (n < kLeastRunsOfMean) spent.mean_95 = {unknown, unknown};
  spent.per_crossing = share > 0.0 ? mean / share : unknown;
  // All r for which mean - r share may be 0: a r^2 - 2 b r + c <= 0.
  const double a = share * share - z * z * pp / n, b = mean * share - z * z * cp / n,
               c = mean * mean - z * z * cc / n, root = std::sqrt(std::max(0.0, b * b - a * c));
  if (share == 0.0)
    spent.per_crossing_95 = {unknown, unknown};
  else if (a > 0.0)
    spent.per_crossing_95 = {(b - root) / a, (b + root) / a};
  else
    spent.per_crossing_95 = {b + root > 0.0 ? c / (b + root) : unknown, never};
  return spent;
}

}  // namespace gatewalk::lattice
