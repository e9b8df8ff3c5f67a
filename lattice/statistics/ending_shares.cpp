// SPDX-License-Identifier: MIT
#include "lattice/statistics/ending_shares.h"

#include <algorithm>
#include <cmath>

#include "dynamics/base/share.h"

namespace gatewalk::lattice {

std::optional<markov::Ending> ending_named(std::string_view name) {
  for (const EndingName& e : kAllEndingNames)
    if (name == e.key || name == e.name) return e.ending;
  return {};
}

EndingShares::EndingShares(const std::array<double, markov::kEndings>& shares) : share(shares) {
  interval.fill({std::nan(""), std::nan("")});
}

EndingShares::EndingShares(const std::array<std::int64_t, markov::kEndings>& counts,
                           std::int64_t trials) {
  for (std::size_t e = 0; e < markov::kEndings; ++e) {
    share[e] = static_cast<double>(counts[e]) / static_cast<double>(trials);
    interval[e] = dynamics::share_interval(counts[e], trials);
  }
}

EndingShares::EndingShares(const markov::FinalDistribution& prediction, const MatrixNoise& noise,
                           int max_gates)
    : EndingShares(prediction.endings) {
  if (noise.replicates() == 0) return;
  constexpr double kRounding = 1e-12;
  for (std::size_t e = 0; e < markov::kEndings; ++e) {
    interval[e] = noise.interval_95(static_cast<markov::Ending>(e));
    // Where no resampled matrix shows a spread: what the runs of the row that all walks begin in
    // can rule out.
    if (interval[e][1] - interval[e][0] <= kRounding)
      interval[e] = dynamics::interval_of_share(std::clamp(share[e], 0.0, 1.0),
                                                static_cast<double>(noise.runs()));
    // No narrower than if each gate run were a trial, as share_95 has it.
    if (noise.of_small_rows() > 0) {
      const auto [low, high] = dynamics::interval_of_share(
          std::clamp(share[e], 0.0, 1.0), static_cast<double>(noise.of_small_rows()));
      interval[e] = {std::min(interval[e][0], low), std::max(interval[e][1], high)};
    }
  }
  *this = with_limit(max_gates);
}

EndingShares EndingShares::with_limit(int max_gates) const {
  EndingShares shares = *this;
  if (max_gates == 0)
    shares.interval[static_cast<std::size_t>(markov::Ending::cut_off)] = {0.0, 0.0};
  return shares;
}

bool EndingShares::rules_out(markov::Ending ending) const {
  const auto at = static_cast<std::size_t>(ending);
  return ending == kWentBack.ending ? share[at] == 0.0 : interval[at] == std::array{0.0, 0.0};
}

}  // namespace gatewalk::lattice
