// SPDX-License-Identifier: MIT
#pragma once
/// How many trials crossed the field, and how many more than others under the same noise; and how a
/// search for what crosses most went.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "lattice/field/field_trials.h"

namespace gatewalk::lattice {

/// Trials that crossed the field, of so many.
struct Crossings {
  std::int64_t crossed = 0, trials = 0;
  [[nodiscard]] double share() const {
    return static_cast<double>(crossed) / static_cast<double>(trials);
  }
  [[nodiscard]] std::array<double, 2> interval_95() const;  // Jeffreys'
};
[[nodiscard]] Crossings crossings_of(const FieldTrials& trials);

/// By how much one chance is above another, of the same trials in both.
struct Gain {
  double difference = 0.0;
  std::array<double, 2> interval_95{};  // Bonett and Price 2012; NaN: none

  /// What is compared with itself gains nothing, and that is no estimate.
  [[nodiscard]] static Gain over_itself() { return {0.0, {std::nan(""), std::nan("")}}; }
};
[[nodiscard]] Gain gain_over(const FieldTrials& with, const FieldTrials& without);

/// What trials take of one cost, with 95 % intervals: a trial's mean, however it ends (NaN: of
/// fewer than kLeastRunsOfMean); and that of
/// all trials for each that crossed, which is what it takes to try until a body crosses (Fieller's
/// interval, whose end is infinite where too few crossed; NaN where none did).
struct Spent {
  double mean = 0.0;
  std::array<double, 2> mean_95{};
  double per_crossing = 0.0;
  std::array<double, 2> per_crossing_95{};
};
/// `cost`: by Section::costs. Throws std::invalid_argument for fewer than two trials.
[[nodiscard]] Spent spent_by(const FieldTrials& trials, std::size_t cost);

/// How a search for the best of something went: rounds of trials, and of choosing again.
struct ChoiceSummary {
  int rounds = 0;
  bool settled = false;  // the last round gained less than half of the accuracy, and than chance
  std::int64_t gate_runs = 0;  // of all trials
  dynamics::Health health{};   // of the same
};

}  // namespace gatewalk::lattice
