// SPDX-License-Identifier: MIT
#pragma once
/// The best start of a body as JSON, as a table and as a picture.

#include <array>
#include <string>
#include <vector>

#include "cli/render/figure.h"
#include "cli/render/json_fwd.h"
#include "cli/render/shown_field.h"
#include "dynamics/cells/section.h"
#include "lattice/study/best_start.h"

namespace gatewalk::cli {

/// A best start, what it was looked for in, and the scene's own.
struct FoundStart {
  ShownField shown;
  dynamics::Entry own;
  std::vector<lattice::CoordinateRange> ranges;
  std::vector<int> columns;
  lattice::BestStart found;
  double seconds = 0.0;
};

[[nodiscard]] Json to_json(const FoundStart& f);
[[nodiscard]] std::string table_of(const FoundStart& f);
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
