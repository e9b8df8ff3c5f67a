// SPDX-License-Identifier: MIT
#pragma once
/// Where trials through the field start: the four starts of the paper's Table IV, or others.

#include <optional>
#include <vector>

#include "lattice/scene/scene.h"

namespace gatewalk::lattice {

/// d, vx, vy (m, m/s) of a start, at y = 0 but for a scene's own; corrcoef and RMSE as Table IV
/// prints them.
struct PaperStart {
  double d = 0.0, vx = 0.0, vy = 0.0;
  std::optional<double> corrcoef{}, rmse{};
  double y = 0.0;  // m

  [[nodiscard]] dynamics::BodyState body() const { return {d, y, vx, vy}; }
  /// Throws std::invalid_argument for a start inside the gate: a chain's states are entries.
  [[nodiscard]] dynamics::Entry entry() const;
};

/// That of a body that enters so from below.
[[nodiscard]] inline PaperStart start_at(const dynamics::Entry& entry) {
  return {entry.at[dynamics::kEntryD], entry.at[dynamics::kEntryVx], entry.at[dynamics::kEntryVy]};
}
/// The scene's start.
[[nodiscard]] PaperStart own_start(const Scene& scene);
/// The same, or those of Table IV, in the scene's own units, in the paper's field with the
/// paper's start.
[[nodiscard]] std::vector<PaperStart> usual_starts(const Scene& scene);
/// Those of starts of a chain. Throws as PaperStart::entry.
[[nodiscard]] std::vector<dynamics::Entry> entries_at(const std::vector<PaperStart>& starts);
[[nodiscard]] std::vector<dynamics::BodyState> bodies_at(const std::vector<PaperStart>& starts);
/// Throws std::invalid_argument unless all of them lie between the sides of the scene's gates.
void require_inside(const std::vector<PaperStart>& starts, const Scene& scene);

/// Body, beams, drag and field of the paper's Table IV, whatever the forces (it does not print
/// them): only then do its numbers belong beside these.
[[nodiscard]] bool like_table4(const Scene& scene);

}  // namespace gatewalk::lattice
