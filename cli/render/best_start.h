// SPDX-License-Identifier: MIT
#pragma once
/// The best start of a body as a result, a table and a figure.

#include <optional>
#include <string>
#include <vector>

#include "cli/fields/fields.h"
#include "cli/render/figure.h"
#include "cli/render/provenance.h"
#include "cli/render/shown_field.h"
#include "dynamics/cells/section.h"
#include "lattice/scene/settle.h"
#include "lattice/study/best_start.h"

namespace gatewalk::cli {

/// The result of `plan` for a scene without actions: the best start, the ranges that were searched,
/// and the scene's own start.
struct FoundStart {
  ShownField shown;
  dynamics::Entry own;
  std::vector<lattice::CoordinateRange> ranges;
  std::vector<int> columns;
  lattice::BestStart found;
  double seconds = 0.0;
  std::optional<lattice::Settled> method{};
  Provenance made_by{};
};
void describe(Fields& out, const FoundStart& f);
/// The first screen; and what --details adds to it.
[[nodiscard]] std::string answer_text(const FoundStart& f);
[[nodiscard]] std::string details_text(const FoundStart& f);
/// The probability to cross by start in the best column, and in full trials from the best and from
/// the scene's own start.
[[nodiscard]] Figure figure_of(const FoundStart& f);

/// The probability to cross by the chain for starts in one column: (second range x first range), at
/// the middles of equal parts. Other coordinates are those of the best start.
struct StartMap {
  std::vector<double> across, up;
  std::vector<double> chance;
};
[[nodiscard]] StartMap map_of(const FoundStart& f, int column);

}  // namespace gatewalk::cli
