// SPDX-License-Identifier: MIT
#pragma once
/// Durations and other costs of trials through the field, by ending.

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <vector>

#include "lattice/field/field_trials.h"

namespace gatewalk::lattice {

/// Sums of costs over trials, in the order in which the trials are added.
class FieldCosts {
 public:
  /// `bin` (s): resolution to which durations, the first cost, are kept.
  explicit FieldCosts(double bin) : bin_(bin) {}

  /// Adds trials; those with a broken passage are left out.
  void add(const FieldTrials& trials);

  /// Sums over the trials with one ending, or with any.
  struct Sums : dynamics::CostSums {
    std::int64_t trials = 0;
    [[nodiscard]] double mean(std::size_t cost) const;  // of a cost of Section::costs
    [[nodiscard]] double sd(std::size_t cost) const;
  };
  [[nodiscard]] double bin() const { return bin_; }  // s
  [[nodiscard]] Sums all() const;
  [[nodiscard]] const Sums& of(markov::Ending e) const {
    return sums_[static_cast<std::size_t>(e)];
  }
  /// The cumulative number of trials by duration (s), in ascending order; for all endings or for
  /// one.
  struct Step {
    double seconds;
    std::int64_t trials;  // number of trials up to this duration
  };
  [[nodiscard]] std::vector<Step> durations() const;
  [[nodiscard]] std::vector<Step> durations(markov::Ending e) const;

 private:
  double bin_;  // s
  std::array<Sums, markov::kEndings> sums_{};
  std::array<std::map<std::int64_t, std::int64_t>, markov::kEndings> durations_{};  // by bin
};

/// The duration that a share `level` of the trials does not exceed; NaN without trials.
[[nodiscard]] double quantile(const std::vector<FieldCosts::Step>& durations, double level);

}  // namespace gatewalk::lattice
