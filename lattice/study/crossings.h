// SPDX-License-Identifier: MIT
#pragma once
/// How many trials crossed the field, and how many more than others under the same noise.

#include <array>
#include <cstdint>

#include "lattice/reference.h"

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
  std::array<double, 2> interval_95{};  // Bonett and Price 2012
};
[[nodiscard]] Gain gain_over(const FieldTrials& with, const FieldTrials& without);

}  // namespace gatewalk::lattice
