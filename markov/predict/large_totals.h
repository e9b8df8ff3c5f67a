// SPDX-License-Identifier: MIT
#pragma once
/// Totals of walks through large fields (markov/totals.h), and helpers shared by all totals.

#include <cstddef>
#include <cstdint>
#include <optional>

#include "markov/totals.h"

namespace gatewalk::markov {

inline constexpr int kMostSteps = 100'000;

/// A uniform number in (0, 1).
[[nodiscard]] inline double uniform(std::uint64_t word) {
  return (static_cast<double>(word >> 12) + 0.5) * 0x1p-52;
}

/// The number of quantities. Throws std::invalid_argument for rewards of another chain.
[[nodiscard]] std::size_t quantities_of(const FieldChain& chain, const Rewards& rewards);

/// The totals without a limit of cells, as walk_totals describes them for large fields. Returns
/// nullopt if a row has cells of several types, or walks stay in rows for long.
[[nodiscard]] std::optional<WalkTotals> totals_of_large(const FieldChain& chain, const Field& field,
                                                        const Start& start, const Rewards& rewards,
                                                        const EachState& each,
                                                        const WalkTolerance& tolerance,
                                                        std::uint64_t seed);

}  // namespace gatewalk::markov
