// SPDX-License-Identifier: MIT
#pragma once
/// The places along the field's sides at which bodies leave.

#include <array>
#include <cstdint>
#include <vector>

#include "lattice/field/field_params.h"
#include "lattice/statistics/ending_shares.h"
#include "lattice/statistics/share_95.h"
#include "markov/predict.h"

namespace gatewalk::lattice {

struct FieldTally;

/// Bounds of the places along side number `side` of kSides, in m (places + 1 values), for cells of
/// this width and length (m). Zero is the middle of the start's column on the far side, and the
/// near end of the field on the other sides.
[[nodiscard]] std::vector<double> exit_bounds(double width, double length, const FieldParams& field,
                                              std::size_t side);

/// Shares of trials by place of exit, with Jeffreys intervals.
[[nodiscard]] FieldExits exits_of(const FieldTally& trials);

/// Cuts each place's interval to the interval of its side's ending, because a part of a side is
/// never more than the side. A place's own interval may be wider where few runs inform it.
[[nodiscard]] FieldExits within_sides(FieldExits exits, const EndingShares& endings);

using ExitShares = std::array<std::vector<double>, kSides.size()>;  // by kSides (places)
/// Predicted shares by place of exit, without intervals.
[[nodiscard]] ExitShares exit_shares(const markov::FinalDistribution& prediction);
/// Predicted shares by place of exit, with intervals from predictions of resampled matrices
/// (resampled_95); no intervals without any resampled matrix.
[[nodiscard]] FieldExits exits_of(const ExitShares& prediction,
                                  const std::vector<ExitShares>& resampled, const Evidence& from);
/// Widens each interval by the walks that were not followed to their end (with_unfinished()).
[[nodiscard]] FieldExits with_unfinished(FieldExits exits,
                                         const markov::FinalDistribution& prediction);
/// Predicted shares by place of exit, with intervals from predictions of groups of the trials
/// (share_95).
[[nodiscard]] FieldExits exits_of_groups(const ExitShares& prediction,
                                         const std::vector<ExitShares>& groups,
                                         const Evidence& from);

}  // namespace gatewalk::lattice
