// SPDX-License-Identifier: MIT
#pragma once
/// The best start of a body as a result, as a table and as a picture.

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

/// The result of `plan` for a scene without actions: a best start, what it was looked for in, and
/// the scene's own.
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
/// The first screen, and what --details adds to it.
[[nodiscard]] std::string answer_text(const FoundStart& f);
[[nodiscard]] std::string details_text(const FoundStart& f);
/// The chance to cross by start in the best column, and in full from the best and the own one.
[[nodiscard]] Figure figure_of(const FoundStart& f);

/// Of a column, the chance to cross by the chain over the first two ranges: (second x first), at
/// the middles of as many parts of each; other numbers are those of the best start.
struct StartMap {
  std::vector<double> across, up;
  std::vector<double> chance;
};
[[nodiscard]] StartMap map_of(const FoundStart& f, int column);

}  // namespace gatewalk::cli
