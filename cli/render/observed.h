// SPDX-License-Identifier: MIT
#pragma once
/// An experiment's counts beside the model, as a part of a result and as a table.

#include <cstdint>
#include <string>
#include <vector>

#include "cli/fields/fields.h"
#include "cli/render/figure.h"
#include "lattice/study/observed.h"
#include "lattice/study/validation.h"

namespace gatewalk::cli {

/// Which counts are held against the model.
struct ObservedFiles {
  std::vector<std::string> paths;
  std::int64_t went_back = 0;  // trials that are left out
};
/// The key "observed". `v`: the model's side of it.
void describe_observed(Fields& out, const lattice::ObservedComparison& c,
                       const lattice::StartValidation& v, const ObservedFiles& files);
[[nodiscard]] std::string answer_text(const lattice::ObservedComparison& c,
                                      const lattice::StartValidation& v);
[[nodiscard]] std::string details_text(const lattice::ObservedComparison& c,
                                       const lattice::StartValidation& v);

/// The endings and the gates in which most end, as they were observed, by the dynamics and by the
/// chain, each with its 95 % interval (but the chain's gates, whose intervals are not known).
[[nodiscard]] Figure figure_of(const lattice::ObservedComparison& c,
                               const lattice::StartValidation& v,
                               const lattice::FieldParams& field);

/// Before any run: trials that `observed` leaves out; and that so few show little. Empty if it is
/// not so.
[[nodiscard]] std::string who_went_back(const lattice::Observed& observed);
[[nodiscard]] std::string too_few_observed(const lattice::Observed& observed);

/// Endings that the table of counts has no row of, and the model has: they count as 0. Empty if
/// there are none.
[[nodiscard]] std::string endings_not_listed(const lattice::Observed& observed,
                                             const lattice::StartValidation& v);

}  // namespace gatewalk::cli
