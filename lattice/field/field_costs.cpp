// SPDX-License-Identifier: MIT
#include "lattice/field/field_costs.h"

#include <algorithm>
#include <cmath>

namespace gatewalk::lattice {

void FieldCosts::add(const FieldTrials& trials) {
  for (std::size_t i = 0; i < trials.costs.size(); ++i) {
    if (!trials.endings[i]) continue;
    const auto e = static_cast<std::size_t>(*trials.endings[i]);
    Sums& s = sums_[e];
    ++s.trials;
    s.add(trials.costs[i]);
    const double seconds = trials.costs[i].front();
    ++durations_[e][std::llround(seconds / bin_)];
  }
}

double FieldCosts::Sums::mean(std::size_t cost) const {
  return sum[cost] / static_cast<double>(trials);
}
double FieldCosts::Sums::sd(std::size_t cost) const {
  const double m = mean(cost);
  const double square = squares[cost] / static_cast<double>(trials);
  return std::sqrt(std::max(square - m * m, 0.0));  // NaN stays NaN
}

FieldCosts::Sums FieldCosts::all() const {
  Sums all;
  for (const Sums& s : sums_) {
    all.trials += s.trials;
    all += s;
  }
  return all;
}

namespace {

std::vector<FieldCosts::Step> steps_of(const std::map<std::int64_t, std::int64_t>& counts,
                                       double bin) {
  std::vector<FieldCosts::Step> steps;
  std::int64_t sum = 0;
  for (const auto& [at, n] : counts) steps.push_back({static_cast<double>(at) * bin, sum += n});
  return steps;
}

}  // namespace

std::vector<FieldCosts::Step> FieldCosts::durations() const {
  std::map<std::int64_t, std::int64_t> all;
  for (const auto& counts : durations_)
    for (const auto& [at, n] : counts) all[at] += n;
  return steps_of(all, bin_);
}
std::vector<FieldCosts::Step> FieldCosts::durations(markov::Ending e) const {
  return steps_of(durations_[static_cast<std::size_t>(e)], bin_);
}

double quantile(const std::vector<FieldCosts::Step>& durations, double level) {
  if (durations.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double wanted = level * static_cast<double>(durations.back().trials);
  return std::find_if(
             durations.begin(), durations.end() - 1,
             [&](const FieldCosts::Step& s) { return static_cast<double>(s.trials) >= wanted; })
      ->seconds;
}

}  // namespace gatewalk::lattice
