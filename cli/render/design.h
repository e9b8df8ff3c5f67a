// SPDX-License-Identifier: MIT
#pragma once
/// A field with changed gates as a result, a table and a figure.

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
  std::optional<lattice::Settled> method;  // chosen for the scene
  lattice::DesignedField design;
  double seconds = 0.0;
  Provenance made_by;
};
void describe(Fields& out, const DesignedScene& d);

/// The scene with these types of its terrain in its gates: (rows x columns), the near row first.
[[nodiscard]] lattice::Scene with_gates(lattice::Scene scene, std::vector<int> type_of_cell);

/// The first screen; and what --details adds to it.
[[nodiscard]] std::string answer_text(const DesignedScene& d);
[[nodiscard]] std::string details_text(const DesignedScene& d);
/// The effect of the best change of each gate alone, the changed gates, and how often bodies cross.
[[nodiscard]] Figure figure_of(const DesignedScene& d);

/// For each gate (near row first), the largest change in the probability to cross by replacing this
/// gate's type alone: by the chain, to first order. 0 if no change helps or no body comes there.
[[nodiscard]] std::vector<double> best_changes(const DesignedScene& d);

}  // namespace gatewalk::cli
