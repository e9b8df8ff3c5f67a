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
[[nodiscard]] std::string table_of(const RangedShares& shares);

}  // namespace gatewalk::cli
