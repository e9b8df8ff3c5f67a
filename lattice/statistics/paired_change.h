// SPDX-License-Identifier: MIT
#pragma once
/// What a change does to the final gates of the same trials under the same noise.

#include <cstdint>
#include <vector>

#include "lattice/statistics/compare.h"

namespace gatewalk::lattice {

/// A change is small enough while the total variation that it makes is no more than this: what is
/// asked of a good chain.
inline constexpr double kSmallChange = 0.03;
/// What trials say about doing without what makes the change.
enum class Sufficiency { enough, cannot_tell, not_enough };

/// What a variant changes, of the final gates of the same trials.
struct PairedChange {
  std::int64_t trials = 0;
  double changed = 0.0;   // share of the trials whose final gate is another one
  Comparison apart{};     // as if the noise were not shared
  Comparison in_pairs{};  // trial by trial

  /// How far the total variation seen may be from that of infinitely many trials, at 95 %: as much
  /// as chance makes of the pairs that differ (triangle inequality), and what 3 of N trials change
  /// when none of N shows it.
  [[nodiscard]] double uncertainty() const {
    return in_pairs.floor_total_variation_95 + 3.0 / static_cast<double>(trials);
  }
  /// Whether the total variation is within kSmallChange with the uncertainty added, or beyond it
  /// with that taken off.
  [[nodiscard]] Sufficiency without_is() const;
};

/// Of trials' final gates after a change against those of the same trials before: of each trial
/// (row * columns + column), and counted.
struct FinalGatesOf {
  const std::vector<std::int32_t>& each;  // (trials)
  const markov::CellCounts& counts;
};
[[nodiscard]] PairedChange paired_change(const FinalGatesOf& after, const FinalGatesOf& before,
                                         std::uint64_t seed);

}  // namespace gatewalk::lattice
