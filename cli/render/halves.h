// SPDX-License-Identifier: MIT
#pragma once
/// One half of recorded bodies against the other, as a result, a table and a figure.

#include <string>
#include <vector>

#include "cli/render/fields.h"
#include "cli/render/figure.h"
#include "cli/render/provenance.h"
#include "cli/render/recorded.h"
#include "cli/render/shown_field.h"
#include "lattice/study/body_memory.h"
#include "lattice/study/halves.h"

namespace gatewalk::cli {

/// The result of `validate` of recorded runs.
struct HalvesResult {
  lattice::HalvesValidation halves;
  lattice::BodyMemory memory;
  dynamics::Section section;
  RecordedCounts recorded;
  Provenance made_by;
};
void describe(Fields& out, const HalvesResult& result);
/// Of each chain whose endings leave something out (rest_warning).
[[nodiscard]] std::vector<std::string> rest_warnings(const lattice::HalvesValidation& v);
[[nodiscard]] std::string table_of(const HalvesResult& result);
[[nodiscard]] Figure figure_of(const lattice::HalvesValidation& v, const ShownField& shown);

}  // namespace gatewalk::cli
