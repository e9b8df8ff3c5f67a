// SPDX-License-Identifier: MIT
#pragma once
/// The effect of a change on the final gates of the same trials under the same noise.

#include <cstdint>
#include <vector>

#include "lattice/statistics/compare.h"

namespace gatewalk::lattice {

/// A change is small if it makes no more total variation than this: the accuracy asked of a good
/// chain.
inline constexpr double kSmallChange = 0.03;
/// Whether a model is good enough without the part that makes a change.
enum class Sufficiency { enough, cannot_tell, not_enough };

/// The change that a variant of the model makes in the final gates of the same trials.
struct PairedChange {
  std::int64_t trials = 0;
  double changed = 0.0;   // share of the trials whose final gate changes
  Comparison apart{};     // as if the two samples were independent
  Comparison in_pairs{};  // trial by trial

  /// 95 % bound on the distance between the observed total variation and that of infinitely many
  /// trials. It is the sampling error of the pairs that differ (triangle inequality), plus 3 / N,
  /// which N trials without any change would leave open.
  [[nodiscard]] double uncertainty() const {
    return in_pairs.floor_total_variation_95 + 3.0 / static_cast<double>(trials);
  }
  /// enough: the total variation plus uncertainty() is within kSmallChange; not_enough: the total
  /// variation minus uncertainty() is beyond it.
  [[nodiscard]] Sufficiency without_is() const;
};

/// Final gates of trials: of each trial (row * columns + column), and as counts.
struct FinalGatesOf {
  const std::vector<std::int32_t>& each;  // (trials)
  const markov::CellCounts& counts;
};
/// Compares the final gates of the same trials after a change and before it.
[[nodiscard]] PairedChange paired_change(const FinalGatesOf& after, const FinalGatesOf& before,
                                         std::uint64_t seed);

}  // namespace gatewalk::lattice
