// SPDX-License-Identifier: MIT
#pragma once
/// Does what a body did before matter beyond how it enters? Of recorded runs, body by body.

#include <cstdint>

#include "lattice/pool/run_pool.h"
#include "lattice/problem.h"
#include "lattice/statistics/multiple_tests.h"

namespace gatewalk::lattice {

/// Runs of the same state and type are told apart by the face of the cell before. "More often than
/// expected": than if the face before and the outcome had nothing to do with each other in any
/// state.
struct BodyMemory {
  static constexpr double kLevel = 0.05;

  std::int64_t runs = 0, states = 0;  // that can tell: two faces before and two outcomes were seen
  MultipleTests::Test
      together;  // squared differences over their variances, of all faces and outcomes
  MultipleTests::Test
      strongest;  // the largest difference over its standard deviation, and whose it is
  int face = -1, outcome = -1;  // outcome: a face, or behind them trapped; -1: there is none
  double more = 0.0;  // share of that face's runs by which that outcome is more often than expected
  double p = 1.0;     // of both
  std::int64_t null_draws = 0;

  [[nodiscard]] bool remembers() const { return p <= kLevel; }
};

/// Differences are summed over the states, body by body; chance: each body's sum changes its sign
/// or not, so runs of one body stay together. Throws std::invalid_argument for no draws.
[[nodiscard]] BodyMemory body_memory(const Problem& problem, const RunPool& pool, int per_leaf,
                                     std::int64_t null_draws, std::uint64_t seed);

}  // namespace gatewalk::lattice
