// SPDX-License-Identifier: MIT
#pragma once
/// How long walks stay in a row of the field, which determines the cost of sums over moves.

#include <algorithm>
#include <cmath>
#include <vector>

namespace gatewalk::markov {

/// An upper bound of the share of walks that stay in the row per move, over many moves: the largest
/// share that stays for k moves from any state, to the power 1/k. (For a single move the share is
/// often 1: a state with few runs, all of which went sideways.) `each(use)` calls use(from, to, p)
/// for all moves within the row.
template <class Each>
[[nodiscard]] double staying_per_move(int inputs, Each each) {
  constexpr int kMostMoves = 64;
  constexpr double kNearlyAllLeft = 1e-3;
  std::vector<double> stay(static_cast<std::size_t>(inputs), 1.0), next(stay.size());
  double bound = 1.0;
  for (int k = 1; k <= kMostMoves; ++k) {
    std::fill(next.begin(), next.end(), 0.0);
    each([&](int from, int to, double p) {
      next[static_cast<std::size_t>(from)] += p * stay[static_cast<std::size_t>(to)];
    });
    stay.swap(next);
    const double largest = *std::max_element(stay.begin(), stay.end());
    bound = std::min(bound, std::pow(largest, 1.0 / k));
    if (largest <= kNearlyAllLeft) break;
  }
  return bound;
}

}  // namespace gatewalk::markov
