// SPDX-License-Identifier: MIT
#pragma once
/// A field whose gates were changed as a result, as a table and as a picture.

#include <optional>
#include <string>
#include <vector>

#include "cli/fields/fields.h"
#include "cli/render/figure.h"
#include "cli/render/provenance.h"
#include "lattice/scene/scene.h"
#include "lattice/scene/settle.h"
#include "lattice/study/design.h"

namespace gatewalk::cli {

/// The result of `design`.
struct DesignedScene {
  lattice::Scene before, after;
  dynamics::Section section;
  std::optional<dynamics::Entry> start;
  lattice::FieldDesignOptions options;
  std::optional<lattice::Settled> method;  // that was chosen
  lattice::DesignedField design;
  double seconds = 0.0;
  Provenance made_by;
};
void describe(Fields& out, const DesignedScene& d);

/// The scene with gates of these types of its terrain: (rows x columns), the near row first.
[[nodiscard]] lattice::Scene with_gates(lattice::Scene scene, std::vector<int> type_of_cell);

/// The first screen, and what --details adds to it.
[[nodiscard]] std::string answer_text(const DesignedScene& d);
[[nodiscard]] std::string details_text(const DesignedScene& d);
/// What the best change of each gate alone does, which are changed, and how often bodies cross.
[[nodiscard]] Figure figure_of(const DesignedScene& d);

/// By gate (near row first), of the types it may become: what a change to the best of these alone
/// does to the chance to cross, by the chain and to first order; 0 where no change helps, and where
/// nobody comes.
[[nodiscard]] std::vector<double> best_changes(const DesignedScene& d);

}  // namespace gatewalk::cli
