// SPDX-License-Identifier: MIT
#pragma once
/// State spaces of bins at the quantiles of observed entries, and a measure of how well any state
/// space resolves such entries. Edges are data or midpoints of data, so a scene whose lengths,
/// times and masses are multiplied by powers of 4 gets the same bins times these powers, bit for
/// bit.

#include <array>
#include <cstdint>
#include <vector>

#include "dynamics/cells/state_space.h"

namespace gatewalk::dynamics {

/// Appends the mirror image of every entry.
void add_mirror_images(const Section& section, std::vector<Entry>& entries);

/// The least number of observed entries for each state that quantile_space makes.
inline constexpr std::int64_t kEntriesPerState = 10;

/// Makes an open space of about `states` bins, with at least kEntriesPerState entries for each, and
/// `points`. Each face gets bins in proportion to its observed entries, equally many along each
/// coordinate, with edges at the quantiles (fewer where entries coincide). The space is
/// mirror-symmetric if `seen` is. A face without entries gets one bin with its usual range. Throws
/// std::invalid_argument unless 1 <= states <= kMostStates.
[[nodiscard]] StateSpace quantile_space(const Section& section, const std::vector<Entry>& seen,
                                        int states, const std::vector<Entry>& points);

/// How well a state space resolves observed entries.
struct Resolution {
  std::int64_t entries = 0;
  std::int64_t clamped = 0;  // outside every bin
  int states_entered = 0;    // states that contain an entry
  int states_of_90 = 0;      // the fewest states that hold 90 % of the entries
  /// For each coordinate, the variance within the states divided by the variance within the faces,
  /// both summed over the entries: 0 if the states resolve the coordinate fully, 1 if not at all. 0
  /// where there is no variance.
  std::array<double, kMostCoordinates> unresolved{};

  /// Whether the states are too coarse for a chain to be trusted: over half of the entries lie
  /// outside the bins, or less than a tenth of a coordinate's variance is resolved.
  [[nodiscard]] bool poor() const;
};
[[nodiscard]] Resolution resolution_of(const StateSpace& space, const std::vector<Entry>& seen);

}  // namespace gatewalk::dynamics
