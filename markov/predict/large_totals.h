// SPDX-License-Identifier: MIT
#pragma once
/// What walks through a large field add up (markov/totals.h), and what all totals share.

#include <cstddef>
#include <cstdint>
#include <optional>

#include "markov/totals.h"

namespace gatewalk::markov {

inline constexpr int kMostSteps = 100'000;

/// Uniform in (0, 1).
[[nodiscard]] inline double uniform(std::uint64_t word) {
  return (static_cast<double>(word >> 12) + 0.5) * 0x1p-52;
}

/// How many quantities there are. Throws std::invalid_argument for rewards of another chain.
[[nodiscard]] std::size_t quantities_of(const FieldChain& chain, const Rewards& rewards);

/// Without limit of cells, as walk_totals says it of large fields. None where rows are not of one
/// type each, or walks stay in them for long.
[[nodiscard]] std::optional<WalkTotals> totals_of_large(const FieldChain& chain, const Field& field,
                                                        const Start& start, const Rewards& rewards,
                                                        const EachState& each,
                                                        const WalkTolerance& tolerance,
                                                        std::uint64_t seed);

}  // namespace gatewalk::markov
