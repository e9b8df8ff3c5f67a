// SPDX-License-Identifier: MIT
#include "lattice/statistics/ending_shares.h"

#include <cmath>
#include <string>

#include "dynamics/base/share.h"
#include "lattice/statistics/matrix_noise.h"
#include "lattice/statistics/share_95.h"

namespace gatewalk::lattice {

std::optional<markov::Ending> ending_named(std::string_view name) {
  std::string small(name);
  for (char& c : small)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  for (const EndingName& e : kAllEndingNames)
    if (small == e.key || small == e.name) return e.ending;
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
  for (std::size_t e = 0; e < markov::kEndings; ++e) {
    if (noise.replicates() > 0) interval[e] = noise.interval_95(static_cast<markov::Ending>(e));
    interval[e] = with_unfinished(interval[e], share[e], prediction.remainder, prediction.rounding);
  }
  if (!std::isnan(interval.front()[0])) *this = with_limit(max_gates);
}

EndingShares EndingShares::with_limit(int max_gates) const {
  EndingShares shares = *this;
  if (max_gates == 0 && share[static_cast<std::size_t>(markov::Ending::cut_off)] == 0.0)
    shares.interval[static_cast<std::size_t>(markov::Ending::cut_off)] = {0.0, 0.0};
  return shares;
}

bool EndingShares::rules_out(markov::Ending ending) const {
  const auto at = static_cast<std::size_t>(ending);
  return ending == kWentBack.ending ? share[at] == 0.0 : interval[at] == std::array{0.0, 0.0};
}

}  // namespace gatewalk::lattice
