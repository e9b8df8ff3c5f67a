// SPDX-License-Identifier: MIT
#pragma once
/// How much of the variance of a chance each number makes, as a result and as a table.

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
/// What each number makes of the variance, and behind --details what that rests on.
[[nodiscard]] std::string answer_text(const RangedShares& shares);
[[nodiscard]] std::string details_text(const RangedShares& shares);

}  // namespace gatewalk::cli
