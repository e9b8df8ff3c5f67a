// SPDX-License-Identifier: MIT
#pragma once
/// The chain against the full dynamics, as a result, tables and a figure.

#include <optional>
#include <string>
#include <vector>

#include "cli/fields/fields.h"
#include "cli/render/figure.h"
#include "cli/render/memory.h"
#include "cli/render/observed.h"
#include "cli/render/provenance.h"
#include "cli/render/shown_field.h"
#include "cli/render/states.h"
#include "dynamics/cells/transitions.h"
#include "lattice/scene/settle.h"
#include "lattice/scene/table4.h"
#include "lattice/study/validation.h"

namespace gatewalk::cli {

/// The matrices of the chain to validate, one for each type of gate, with the record of their file
/// or of their making.
struct ValidatedMatrix {
  std::vector<dynamics::Transitions> matrices{};
  std::string path{};    // empty: built for this validation
  double seconds = 0.0;  // to build or read it
  std::optional<dynamics::Health> health{};
  std::optional<lattice::Settled> method{};
  std::optional<StateRecord> states{};
};

/// The result of `validate`.
struct ValidateResult {
  lattice::Validation validation{};
  ValidatedMatrix matrix{};
  ShownField shown;
  std::vector<lattice::PaperStart> papers{};  // of Table IV, if the starts are its starts
  bool like_table4 = false;                   // show Table IV's values beside ours
  ObservedFiles observed{};
  Provenance made_by{};
};
void describe(Fields& out, const ValidateResult& result);
/// What the screen shows first, and its details.
[[nodiscard]] std::string answer_text(const ValidateResult& result);
[[nodiscard]] std::string details_text(const ValidateResult& result);
/// The verdict alone: "The chain agrees with the full dynamics ... (p = 0.870)."
[[nodiscard]] std::string chain_verdict(const lattice::StartValidation& r);

/// A sentence on whether the chain agrees with the dynamics from one start.
[[nodiscard]] std::string verdict(const lattice::StartValidation& r);

/// The time of a trial of the full dynamics divided by the time of a walk through the chain.
[[nodiscard]] double trial_over_walk(const lattice::StartValidation& r);
/// The totals of all types. For trees the record gives the runs, because leaves share runs and hold
/// mirror images.
[[nodiscard]] dynamics::Transitions::Totals totals_of(const ValidatedMatrix& matrix);
/// For a disc: crossings through the sides above the joints.
[[nodiscard]] std::int64_t traverse_sides(const lattice::Validation& v);

/// Maps of the final gates, a row for each start: dynamics, chain and their difference; then the
/// Chapman-Kolmogorov test. Throws std::invalid_argument for more than kMostValidated starts.
inline constexpr std::size_t kMostValidated = 8;
[[nodiscard]] Figure figure_of(const lattice::Validation& v, const ShownField& shown);

}  // namespace gatewalk::cli
