// SPDX-License-Identifier: MIT
#include "lattice/study/crossings.h"

#include <algorithm>
#include <cmath>

#include "dynamics/base/share.h"

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

}  // namespace gatewalk::lattice
