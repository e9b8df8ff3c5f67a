// SPDX-License-Identifier: MIT
#pragma once
/// Where along its sides bodies leave the field.

#include <array>
#include <cstdint>
#include <vector>

#include "lattice/field/field_params.h"
#include "lattice/statistics/ending_shares.h"
#include "lattice/statistics/share_95.h"
#include "markov/predict.h"

namespace gatewalk::lattice {

struct FieldTally;

/// Bounds of the places along side number `side` of kSides, m (places + 1): along the far one from
/// the middle of the start's column, along the others from the near end of the field. Of cells of
/// this width and length (m).
[[nodiscard]] std::vector<double> exit_bounds(double width, double length, const FieldParams& field,
                                              std::size_t side);

/// With Jeffreys' intervals.
[[nodiscard]] FieldExits exits_of(const FieldTally& trials);

/// A part of a side is never more than the side: no place's interval reaches beyond that of its
/// ending. Alone it may: where few tell of a place, or nothing but the number of trials does.
[[nodiscard]] FieldExits within_sides(FieldExits exits, const EndingShares& endings);

using ExitShares = std::array<std::vector<double>, kSides.size()>;  // by kSides (places)
[[nodiscard]] ExitShares exit_shares(const markov::FinalDistribution& prediction);
/// What is predicted, with intervals from predictions of resampled matrices (resampled_95). Without
/// any resampled: none.
[[nodiscard]] FieldExits exits_of(const ExitShares& prediction,
                                  const std::vector<ExitShares>& resampled, const Evidence& from);
/// By with_unfinished() of each share.
[[nodiscard]] FieldExits with_unfinished(FieldExits exits,
                                         const markov::FinalDistribution& prediction);
/// The same from predictions of groups of the trials, by share_95.
[[nodiscard]] FieldExits exits_of_groups(const ExitShares& prediction,
                                         const std::vector<ExitShares>& groups,
                                         const Evidence& from);

}  // namespace gatewalk::lattice
