// SPDX-License-Identifier: MIT
#pragma once
/// Shares of trials with 95 % intervals.

#include <array>
#include <cstdint>

namespace gatewalk::dynamics {

/// Half-width of the 95 % interval of a normal distribution, in standard deviations.
inline constexpr double kNormal95 = 1.959963984540054;

/// Jeffreys' 95 % interval [low, high] of a share of which `part` of `whole` independent trials
/// were counted (Brown, Cai and DasGupta, Interval estimation for a binomial proportion, Statist.
/// Sci. 16, 2001). low is 0 if part is 0; high is 1 if part equals whole.
[[nodiscard]] std::array<double, 2> share_interval(std::int64_t part, std::int64_t whole);
/// Jeffreys' 95 % interval of a share that varies like the share in `equivalent_trials` independent
/// trials. The interval contains the share. low is 0 if share * equivalent_trials is below 1; high
/// is 1 if (1 - share) * equivalent_trials is below 1.
[[nodiscard]] std::array<double, 2> interval_of_share(double share, double equivalent_trials);

}  // namespace gatewalk::dynamics
