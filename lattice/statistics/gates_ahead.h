// SPDX-License-Identifier: MIT
#pragma once
/// The Chapman-Kolmogorov test on plain walks: where they are k gates ahead, against the k-th power
/// of the kernel of their own runs. The null keeps every state's outcomes and deals them out anew
/// among its visits: walks of a chain with the same counts, without memory.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lattice/statistics/multiple_tests.h"

namespace gatewalk::lattice {

/// Walks from state to state, one behind the other; any number of them, each of one run at least.
struct StateWalks {
  static constexpr std::int32_t kTrapped = -1;

  int ways = 0;                     // coarse ways in which a state is entered
  std::vector<std::int32_t> way;    // (states) in [0, ways)
  std::vector<std::int32_t> state;  // (runs) in which each run begins
  /// (runs) The state entered next, or kTrapped. A walk that ends otherwise than trapped has been
  /// stopped: its last run enters a state that it does not run in.
  std::vector<std::int32_t> next;
  std::vector<std::int64_t> passed;  // (walks) runs of each walk and of those before it

  [[nodiscard]] std::int64_t walks() const { return std::ssize(passed); }
  [[nodiscard]] std::int64_t begin(std::int64_t walk) const {
    return walk == 0 ? 0 : passed[static_cast<std::size_t>(walk - 1)];
  }
  /// Appends a walk of these states; `end`: what its last run enters, or kTrapped. None for no
  /// state.
  void add(std::span<const std::int32_t> states, std::int32_t end);
  /// Throws std::invalid_argument unless all of it fits together.
  void validate() const;
};

inline constexpr int kMostGatesAhead = 8;

/// Where walks are some gates after each of their runs has begun: trapped before, or by which way
/// they enter that gate; told apart by the way in which the run's own gate was entered. (All runs
/// together would say little: they are what the kernel was made of.) Walks that were stopped
/// go on by the kernel from where they were stopped.
struct GatesAhead {
  struct Step {
    int gates = 0;                                   // ahead
    std::vector<double> seen, predicted;             // (ways x ways + 1) shares of all runs, by the
                                                     // way now and the way then; last: trapped
    std::vector<std::array<double, 2>> excess_95{};  // of seen - predicted; chance as in the null
    MultipleTests::Test total_variation;             // of the two
    double chance = 0.0, chance_95 = 0.0;  // the null's total variation: mean, and 95 % of it
    /// Implied time scales -k / ln |eigenvalue| of where walks are k = `gates` later by where they
    /// are now (way by way, the longest first), in gates; 95 % of the null's about the prediction.
    std::vector<double> seen_scales{}, predicted_scales{};
    std::vector<std::array<double, 2>> scales_95{};
  };
  std::int64_t runs = 0;
  std::vector<Step> steps;  // 2, 3, ... gates; one gate ahead there is nothing to see
  double p = 1.0;           // of all steps together
  std::int64_t null_draws = 0;

  /// The step that exceeds what 95 % of chance makes by most, or comes closest to it.
  [[nodiscard]] const Step& largest() const;
};

/// `most` from 2 to kMostGatesAhead. The same for any number of threads. Throws
/// std::invalid_argument for walks that do not fit together, none, and for no draws.
[[nodiscard]] GatesAhead gates_ahead(const StateWalks& walks, int most, std::int64_t null_draws,
                                     std::uint64_t seed);

}  // namespace gatewalk::lattice
