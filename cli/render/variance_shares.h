// SPDX-License-Identifier: MIT
#pragma once
/// The shares of numbers in the variance of a probability, as a result and a table.

#include <string>
#include <vector>

#include "cli/fields/fields.h"
#include "lattice/scene/ranges.h"
#include "lattice/study/variance_shares.h"

namespace gatewalk::cli {

struct RangedShares {
  std::vector<lattice::NumberRange> ranges{};
  markov::Ending target{};
  lattice::VarianceShares found{};
};
void describe(Fields& out, const RangedShares& shares);
/// The share of each number in the variance; and with --details how it was computed.
[[nodiscard]] std::string answer_text(const RangedShares& shares);
[[nodiscard]] std::string details_text(const RangedShares& shares);

}  // namespace gatewalk::cli
