// SPDX-License-Identifier: MIT
#pragma once
/// The effect of memory and neighbours on the final gates, as a result, CSV, a table and a figure.

#include <string>
#include <vector>

#include "cli/fields/fields.h"
#include "cli/render/figure.h"
#include "cli/render/provenance.h"
#include "lattice/scene/study/fidelity.h"

namespace gatewalk::cli {

/// The result of `chart field`.
struct FidelityResult {
  lattice::FidelityStudy study;
  Provenance made_by;
};
void describe(Fields& out, const FidelityResult& result);
/// A line for each start and variant.
[[nodiscard]] std::string csv_of(const lattice::FidelityStudy& study);
/// The first screen: for each start, whether `active` is enough; and what --details adds: a line
/// for each start and variant.
[[nodiscard]] std::string answer_text(const lattice::FidelityStudy& study);
[[nodiscard]] std::string details_text(const lattice::FidelityStudy& study);
/// A sentence for each variant with numerical faults.
[[nodiscard]] std::vector<std::string> complaints(const lattice::FidelityStudy& study);
/// Total variation against `active`, and the cost of a trial, start by start.
[[nodiscard]] Figure figure_of(const lattice::FidelityStudy& study);

}  // namespace gatewalk::cli
