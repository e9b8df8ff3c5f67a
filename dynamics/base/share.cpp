// SPDX-License-Identifier: MIT
#include "dynamics/base/share.h"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>

namespace gatewalk::dynamics {
namespace {

/// One trial, less the rounding error of trials * share.
constexpr double kOneTrial = 1.0 - 1e-9;

std::array<double, 2> jeffreys(double part, double others) {
  return {part < kOneTrial ? 0.0 : boost::math::ibeta_inv(part + 0.5, others + 0.5, 0.025),
          others < kOneTrial ? 1.0 : boost::math::ibeta_inv(part + 0.5, others + 0.5, 0.975)};
}

}  // namespace

std::array<double, 2> share_interval(std::int64_t part, std::int64_t whole) {
  return jeffreys(static_cast<double>(part), static_cast<double>(whole - part));
}

std::array<double, 2> interval_of_share(double share, double equivalent_trials) {
  constexpr double kMostTrials = 1e9;  // beyond this the quantiles may not converge
  const double trials = std::min(equivalent_trials, kMostTrials);
  const auto [low, high] = jeffreys(trials * share, trials * std::max(0.0, 1.0 - share));
  return {std::min(low, share), std::max(high, share)};
}

}  // namespace gatewalk::dynamics
