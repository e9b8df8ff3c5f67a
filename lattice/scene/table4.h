// SPDX-License-Identifier: MIT
#pragma once
/// Starts of trials through a scene's field: the scene's own start, or the four starts of the
/// paper's Table IV.

#include <vector>

#include "lattice/scene/scene.h"

namespace gatewalk::lattice {

/// A start of Table IV, with the corrcoef and RMSE printed there.
struct PaperStart {
  dynamics::Entry start;
  double corrcoef = 0.0, rmse = 0.0;
};
/// The four starts of Table IV, in the scene's own units, if field and start are the paper's; else
/// empty.
[[nodiscard]] std::vector<PaperStart> table_iv_starts(const Scene& scene);
/// The scene's start as an entry, from below or by a side. Throws std::invalid_argument for a start
/// inside the gate, because a chain's states are entries.
[[nodiscard]] dynamics::Entry own_start(const Scene& scene);
/// The bodies that enter the scene's first gate by these entries.
[[nodiscard]] std::vector<dynamics::BodyState> bodies_at(
    const Scene& scene, const std::vector<dynamics::Entry>& entries);
/// Throws std::invalid_argument unless all starts lie on their face, clear of the beams at rest,
/// and those by a side move into the gate.
void require_inside(const std::vector<dynamics::Entry>& starts, const Scene& scene);

/// True if body, beams, drag and field are those of the paper's Table IV, whatever the forces,
/// which Table IV does not print: only then can its numbers be compared.
[[nodiscard]] bool like_table4(const Scene& scene);

}  // namespace gatewalk::lattice
