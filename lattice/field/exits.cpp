// SPDX-License-Identifier: MIT
#include "lattice/field/exits.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dynamics/base/share.h"
#include "lattice/field/field_trials.h"

namespace gatewalk::lattice {
namespace {

std::size_t place_on(std::size_t side, std::int64_t cell, std::int64_t columns) {
  return static_cast<std::size_t>(side == kFarSide ? cell % columns : cell / columns);
}

/// Number or share of bodies that left at each place, by kSides.
template <class Number>
std::array<std::vector<Number>, kSides.size()> by_place(const markov::Ends<Number>& ends) {
  const Eigen::Index columns = ends.final_cells.cols();
  std::array<std::vector<Number>, kSides.size()> places;
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    places[side].assign(
        static_cast<std::size_t>(side == kFarSide ? columns : ends.final_cells.rows()), Number{});
    for (const auto& c : ends.mixed_cells)
      places[side][place_on(side, c.cell, columns)] += c[kSides[side]];
  }
  return places;
}

/// Shares with intervals: interval_of(own share, the others' shares) for every place.
template <class IntervalOf>
FieldExits with_intervals(const ExitShares& own, const std::vector<ExitShares>& others,
                          IntervalOf interval_of) {
  FieldExits exits;
  for (std::size_t side = 0; side < kSides.size(); ++side)
    for (std::size_t i = 0; i < own[side].size(); ++i) {
      std::vector<double> shares;
      for (const ExitShares& o : others) shares.push_back(o[side][i]);
      exits[side].share.push_back(own[side][i]);
      exits[side].interval.push_back(interval_of(own[side][i], std::move(shares)));
    }
  return exits;
}

}  // namespace

std::vector<double> exit_bounds(double width, double length, const FieldParams& field,
                                std::size_t side) {
  std::vector<double> bounds;
  for (int i = 0; i <= (side == kFarSide ? field.columns : field.rows); ++i)
    bounds.push_back(side == kFarSide ? (i - field.start_column() - 0.5) * width : i * length);
  return bounds;
}

FieldExits exits_of(const FieldTally& trials) {
  FieldExits exits;
  const auto counts = by_place(trials);
  for (std::size_t side = 0; side < kSides.size(); ++side)
    for (const std::int64_t count : counts[side]) {
      exits[side].share.push_back(static_cast<double>(count) / static_cast<double>(trials.trials));
      exits[side].interval.push_back(dynamics::share_interval(count, trials.trials));
    }
  return exits;
}

FieldExits within_sides(FieldExits exits, const EndingShares& endings) {
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    const auto& of_side = endings.interval[static_cast<std::size_t>(kSides[side])];
    if (std::isnan(of_side[0])) continue;
    for (std::size_t i = 0; i < exits[side].share.size(); ++i) {
      auto& [low, high] = exits[side].interval[i];
      low = std::min(low, of_side[0]);
      high = std::min(high, of_side[1]);
      // A place where nobody leaves is bounded by trials alone; the side's bound holds for the
      // place too.
      if (exits[side].share[i] <= kShareRounding) high = std::min(high, of_side[1] - of_side[0]);
    }
  }
  return exits;
}

ExitShares exit_shares(const markov::FinalDistribution& d) { return by_place(d); }

FieldExits exits_of(const ExitShares& prediction, const std::vector<ExitShares>& resampled,
                    const Evidence& from) {
  return with_intervals(prediction, resampled, [&](double share, std::vector<double> drawn) {
    if (drawn.empty()) return std::array{std::nan(""), std::nan("")};
    return resampled_95(std::move(drawn), share, from);
  });
}

FieldExits with_unfinished(FieldExits exits, const markov::FinalDistribution& d) {
  for (SideExits& side : exits)
    for (std::size_t i = 0; i < side.share.size(); ++i)
      side.interval[i] = with_unfinished(side.interval[i], side.share[i], d.remainder, d.rounding);
  return exits;
}

FieldExits exits_of_groups(const ExitShares& prediction, const std::vector<ExitShares>& groups,
                           const Evidence& from) {
  return with_intervals(prediction, groups, [&](double share, const std::vector<double>& others) {
    return share_95(share, others, from);
  });
}

}  // namespace gatewalk::lattice
