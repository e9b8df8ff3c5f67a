// SPDX-License-Identifier: MIT
#pragma once
/// The counts of an experiment beside the model, as part of a result and as a table.

#include <cstdint>
#include <string>
#include <vector>

#include "cli/fields/fields.h"
#include "cli/render/figure.h"
#include "lattice/study/observed.h"
#include "lattice/study/validation.h"

namespace gatewalk::cli {

/// The files of counts.
struct ObservedFiles {
  std::vector<std::string> paths;
  std::int64_t went_back = 0;  // trials that are left out
};
/// The key "observed". `v` is the model's side of the comparison.
void describe_observed(Fields& out, const lattice::ObservedComparison& c,
                       const lattice::StartValidation& v, const ObservedFiles& files);
[[nodiscard]] std::string answer_text(const lattice::ObservedComparison& c,
                                      const lattice::StartValidation& v);
[[nodiscard]] std::string details_text(const lattice::ObservedComparison& c,
                                       const lattice::StartValidation& v);

/// The endings and the most frequent final gates: observed, by the dynamics and by the chain, each
/// with its 95 % interval. The chain's gates have no intervals.
[[nodiscard]] Figure figure_of(const lattice::ObservedComparison& c,
                               const lattice::StartValidation& v,
                               const lattice::FieldParams& field);

/// Warnings before any run: of trials that are left out because the body went back, and of too few
/// trials. Empty if there is nothing to warn of.
[[nodiscard]] std::string who_went_back(const lattice::Observed& observed);
[[nodiscard]] std::string too_few_observed(const lattice::Observed& observed);

/// A warning that the table of counts does not list endings that the model has, so that they count
/// as 0. Empty if it lists all.
[[nodiscard]] std::string endings_not_listed(const lattice::Observed& observed,
                                             const lattice::StartValidation& v);

}  // namespace gatewalk::cli
