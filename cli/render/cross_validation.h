// SPDX-License-Identifier: MIT
#pragma once
/// Cross-validation of recorded bodies, one half against the other, as a result, a table and a
/// figure.

#include <cstdint>
#include <string>
#include <vector>

#include "cli/fields/fields.h"
#include "cli/render/figure.h"
#include "cli/render/provenance.h"
#include "cli/render/recorded.h"
#include "cli/render/shown_field.h"
#include "lattice/study/cross_validation.h"
#include "lattice/study/memory.h"

namespace gatewalk::cli {

/// With fewer bodies than this p may be too small (measured in results/tracks).
inline constexpr std::int64_t kBodiesForP = 200;

/// The result of `validate` for recorded runs.
struct CrossValidationResult {
  lattice::CrossValidation validation;
  lattice::Independence memory;
  dynamics::Section section;
  RecordedCounts recorded;
  Provenance made_by;
};
void describe(Fields& out, const CrossValidationResult& result);
/// Its keys but `recorded` and `made_by`.
void describe_halves(Fields& out, const CrossValidationResult& result);
/// The rest_warning() of each half's chain whose endings leave something out.
[[nodiscard]] std::vector<std::string> rest_warnings(const lattice::CrossValidation& v);
/// What the screen shows first, and its details.
[[nodiscard]] std::string answer_text(const CrossValidationResult& result);
[[nodiscard]] std::string details_text(const CrossValidationResult& result);
[[nodiscard]] Figure figure_of(const lattice::CrossValidation& v, const ShownField& shown);

}  // namespace gatewalk::cli
