// SPDX-License-Identifier: MIT
#pragma once
/// How long trials through the field took, and what work, by how they ended.

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <vector>

#include "lattice/field/field_trials.h"

namespace gatewalk::lattice {

/// Sums over trials, in the order in which they are added.
class FieldCosts {
 public:
  /// Durations, the first cost, are kept to `bin` (s).
  explicit FieldCosts(double bin) : bin_(bin) {}

  /// Trials that broke are left out.
  void add(const FieldTrials& trials);

  /// Of trials with these endings.
  struct Sums : dynamics::CostSums {
    std::int64_t trials = 0;
    [[nodiscard]] double mean(std::size_t cost) const;  // by Section::costs
    [[nodiscard]] double sd(std::size_t cost) const;
  };
  [[nodiscard]] double bin() const { return bin_; }  // s
  [[nodiscard]] Sums all() const;
  [[nodiscard]] const Sums& of(markov::Ending e) const {
    return sums_[static_cast<std::size_t>(e)];
  }
  /// How many ended by each duration (s): ascending; all endings, or one.
  struct Step {
    double seconds;
    std::int64_t trials;  // so far
  };
  [[nodiscard]] std::vector<Step> durations() const;
  [[nodiscard]] std::vector<Step> durations(markov::Ending e) const;

 private:
  double bin_;  // s
  std::array<Sums, markov::kEndings> sums_{};
  std::array<std::map<std::int64_t, std::int64_t>, markov::kEndings> durations_{};  // by bin
};

/// The duration that a part `level` of the trials does not exceed; NaN without trials.
[[nodiscard]] double quantile(const std::vector<FieldCosts::Step>& durations, double level);

}  // namespace gatewalk::lattice
