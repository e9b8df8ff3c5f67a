// SPDX-License-Identifier: MIT
#pragma once
/// What a chain must remember, as a result, a table and a figure.

#include <string>

#include "cli/fields/fields.h"
#include "cli/render/figure.h"
#include "cli/render/provenance.h"
#include "cli/render/recorded.h"
#include "lattice/study/order.h"

namespace gatewalk::cli {

/// The result of validate --order.
struct OrderResult {
  lattice::OrderStudy study;
  RecordedCounts recorded;  // of recorded or simulated bodies
  bool is_recorded = true;
  Provenance made_by;
};
void describe(Fields& out, const OrderResult& result);
/// Its keys but `recorded` and `made_by`.
void describe_order(Fields& out, const OrderResult& result);
/// What the screen shows first, and its details.
[[nodiscard]] std::string answer_text(const OrderResult& result);
[[nodiscard]] std::string details_text(const OrderResult& result);
/// The error of one half's prediction of the other against the order, and what more memory gains.
[[nodiscard]] Figure figure_of(const OrderResult& result);

}  // namespace gatewalk::cli
