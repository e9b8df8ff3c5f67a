// SPDX-License-Identifier: MIT
#pragma once
/// Where trials through the field of a scene start: its own start, or the four of the paper's
/// Table IV.

#include <vector>

#include "lattice/scene/scene.h"

namespace gatewalk::lattice {

/// A start with what Table IV prints of it.
struct PaperStart {
  dynamics::Entry start;
  double corrcoef = 0.0, rmse = 0.0;
};
/// The four starts of Table IV, in the scene's own units, where field and start are the paper's;
/// none in other scenes.
[[nodiscard]] std::vector<PaperStart> table_iv_starts(const Scene& scene);
/// The scene's start. Throws std::invalid_argument for one inside the gate: a chain's states are
/// entries.
[[nodiscard]] dynamics::Entry own_start(const Scene& scene);
/// That of a body that enters so from below.
[[nodiscard]] dynamics::BodyState body_at(const dynamics::Entry& entry);
[[nodiscard]] std::vector<dynamics::BodyState> bodies_at(
    const std::vector<dynamics::Entry>& entries);
/// Throws std::invalid_argument unless all of them lie between the sides of the scene's gates.
void require_inside(const std::vector<dynamics::Entry>& starts, const Scene& scene);

/// Body, beams, drag and field of the paper's Table IV, whatever the forces (it does not print
/// them): only then do its numbers belong beside these.
[[nodiscard]] bool like_table4(const Scene& scene);

}  // namespace gatewalk::lattice
