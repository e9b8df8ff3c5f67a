// SPDX-License-Identifier: MIT
#pragma once
/// What passages through cells take: time first, then what else a section names.

#include <array>
#include <cstddef>
#include <string>

namespace gatewalk::dynamics {

/// No more than are needed: a chain keeps two sums of each for every count (CostSums).
inline constexpr std::size_t kMostCosts = 5;

/// What a passage takes: its name in files, with the unit, and in words.
struct CostInfo {
  std::string key, unit, words;  // "time_s", "s", "duration"
  friend bool operator==(const CostInfo&, const CostInfo&) = default;
};

/// Of a passage, by Section::costs; 0 behind the last, NaN where nothing is known.
using Costs = std::array<double, kMostCosts>;

/// What passages took together, and the sum of the squares.
struct CostSums {
  Costs sum{}, squares{};
  void add(const Costs& costs);
  CostSums& operator+=(const CostSums& other);
  friend bool operator==(const CostSums&, const CostSums&) = default;
};

}  // namespace gatewalk::dynamics
