// SPDX-License-Identifier: MIT
#pragma once
/// State spaces from entries that were seen: bins at their quantiles. Also how well a state space
/// resolves such entries, whatever it was made from.
/// Edges are data or midpoints of data: a scene whose lengths, times and masses are multiplied by
/// powers of 4 gets the same bins times these powers, bit for bit.

#include <array>
#include <cstdint>
#include <vector>

#include "dynamics/cells/state_space.h"

namespace gatewalk::dynamics {

/// Appends the mirror image of every entry.
void add_mirror_images(const Section& section, std::vector<Entry>& entries);

/// At least so many entries are seen for each state that quantile_space makes.
inline constexpr std::int64_t kEntriesPerState = 10;

/// An open space of about `states` bins, at most one for kEntriesPerState entries, and `points`.
/// Each face gets its share of them by the entries seen there, along all coordinates as many, with
/// edges at the quantiles of these entries (fewer where entries coincide). Mirror-symmetric if
/// `seen` is. A face where nothing was seen gets one bin, what is usual there. Throws
/// std::invalid_argument unless 1 <= states <= kMostStates.
[[nodiscard]] StateSpace quantile_space(const Section& section, const std::vector<Entry>& seen,
                                        int states, const std::vector<Entry>& points);

/// How well a state space tells entries apart.
struct Resolution {
  std::int64_t entries = 0;
  std::int64_t clamped = 0;  // outside every bin
  int states_entered = 0;    // states that any entry fell into
  int states_of_90 = 0;      // the fewest states that hold 90 % of the entries
  /// Variance of each coordinate within the states over that within the faces, both summed over the
  /// entries: 0 where states tell all apart, 1 where they tell nothing, 0 without any variance.
  std::array<double, kMostCoordinates> unresolved{};

  /// States tell too little of where and how fast bodies enter for a chain to be trusted: most
  /// entries lie outside the bins, or less than a tenth of the variance of a coordinate is
  /// resolved.
  [[nodiscard]] bool poor() const;
};
[[nodiscard]] Resolution resolution_of(const StateSpace& space, const std::vector<Entry>& seen);

}  // namespace gatewalk::dynamics
