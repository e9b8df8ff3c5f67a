// SPDX-License-Identifier: MIT
#include "lattice/statistics/paired_change.h"

#include <algorithm>

namespace gatewalk::lattice {

Sufficiency PairedChange::without_is() const {
  const double tv = apart.total_variation;
  if (tv + uncertainty() <= kSmallChange) return Sufficiency::enough;
  return tv - uncertainty() > kSmallChange ? Sufficiency::not_enough : Sufficiency::cannot_tell;
}

PairedChange paired_change(const FinalGatesOf& after, const FinalGatesOf& before,
                           std::uint64_t seed) {
  const auto trials = std::ssize(before.each);
  std::int64_t changed = 0;
  for (std::size_t i = 0; i < after.each.size(); ++i) changed += after.each[i] != before.each[i];
  const std::int64_t null_draws = std::clamp<std::int64_t>(100'000'000 / trials, 999, 9999);
  return {.trials = trials,
          .changed = static_cast<double>(changed) / static_cast<double>(trials),
          .apart = compare(after.counts, before.counts, null_draws, seed),
          .in_pairs = compare_pairs(after.each, before.each, static_cast<int>(before.counts.rows()),
                                    static_cast<int>(before.counts.cols()), null_draws, seed)};
}

}  // namespace gatewalk::lattice
