// SPDX-License-Identifier: MIT
#pragma once
/// Shares of trials with their intervals.

#include <array>
#include <cstdint>

namespace gatewalk::dynamics {

/// 95 % of a normal distribution lie within so many standard deviations of its mean.
inline constexpr double kNormal95 = 1.959963984540054;

/// What share of all trials a count of some stands for, with 95 %: Jeffreys' interval (Brown, Cai
/// and DasGupta, Interval estimation for a binomial proportion, Statist. Sci. 16, 2001). [low,
/// high]; low is 0 for no trial, high 1 for all of them.
[[nodiscard]] std::array<double, 2> share_interval(std::int64_t part, std::int64_t whole);
/// The same for a share that varies as that of so many independent trials would; it contains the
/// share. Of less than one trial low is 0, of less than one that is not, high 1: so little may as
/// well be none.
[[nodiscard]] std::array<double, 2> interval_of_share(double share, double equivalent_trials);

}  // namespace gatewalk::dynamics
