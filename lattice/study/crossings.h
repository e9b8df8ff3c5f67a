// SPDX-License-Identifier: MIT
#pragma once
/// Numbers of trials that crossed the field, gains over other trials under the same noise, and the
/// summary of a search for most crossings.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "lattice/field/field_trials.h"

namespace gatewalk::lattice {

/// Number of trials that crossed the field, and of all trials.
struct Crossings {
  std::int64_t crossed = 0, trials = 0;
  [[nodiscard]] double share() const {
    return static_cast<double>(crossed) / static_cast<double>(trials);
  }
  [[nodiscard]] std::array<double, 2> interval_95() const;  // Jeffreys interval
};
/// Counts the trials that crossed.
[[nodiscard]] Crossings crossings_of(const FieldTrials& trials);

/// Difference of two probabilities to cross, from the same trial numbers in both.
struct Gain {
  double difference = 0.0;
  std::array<double, 2> interval_95{};  // Bonett and Price 2012; NaN: none

  /// The gain over itself: 0, without an interval, because nothing is estimated.
  [[nodiscard]] static Gain over_itself() { return {0.0, {std::nan(""), std::nan("")}}; }
};
/// The gain of trials `with` a change over the same trials `without`.
[[nodiscard]] Gain gain_over(const FieldTrials& with, const FieldTrials& without);

/// One cost of trials, with 95 % intervals. `mean`: per trial, however it ends (no interval, NaN,
/// for fewer than kLeastRunsOfMean trials). `per_crossing`: cost of all trials per crossing, which
/// is the cost of trying until a body crosses (Fieller's interval, infinite upper end if too few
/// crossed; NaN if none did).
struct Spent {
  double mean = 0.0;
  std::array<double, 2> mean_95{};
  double per_crossing = 0.0;
  std::array<double, 2> per_crossing_95{};
};
/// Computes the cost `cost` of Section::costs. Throws std::invalid_argument for fewer than two
/// trials.
[[nodiscard]] Spent spent_by(const FieldTrials& trials, std::size_t cost);

/// Summary of a search: its rounds of choosing, and their trials.
struct ChoiceSummary {
  int rounds = 0;
  /// The last round gained less than half the accuracy, and less than sampling error.
  bool settled = false;
  std::int64_t gate_runs = 0;  // of all trials
  dynamics::Health health{};   // of all trials
};

}  // namespace gatewalk::lattice
