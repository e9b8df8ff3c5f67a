// SPDX-License-Identifier: MIT
#include "lattice/scene/table4.h"

#include <cmath>
#include <stdexcept>

#include "dynamics/disc/disc_section.h"
#include "lattice/scene/bins.h"
#include "lattice/text/digits.h"

namespace gatewalk::lattice {
std::vector<PaperStart> table_iv_starts(const Scene& scene) {
  std::vector<PaperStart> starts{{{0, {0, 0, 15}}, 0.914, 1.018},
                                 {{0, {23, -11, 16}}, 0.9097, 1.133},
                                 {{0, {4, 5, 10}}, 0.8929, 1.252},
                                 {{0, {-17, 13, 12}}, 0.9026, 0.9813}};
  const dynamics::Scale unit = dynamics::scale_of(scene.gate);
  for (PaperStart& s : starts) {
    s.start.at[dynamics::kEntryD] *= unit.length;
    s.start.at[dynamics::kEntryVx] *= unit.speed();
    s.start.at[dynamics::kEntryVy] *= unit.speed();
  }
  const dynamics::BodyState &own = scene.start, first = body_at(starts.front().start);
  const bool the_papers = own.x == 0.0 && own.y == 0.0 && own.vx == 0.0 &&
                          std::abs(own.vy - first.vy) <= 1e-12 * first.vy;
  if (!the_papers || scene.terrain || !papers_field(scene)) starts.clear();
  return starts;
}

dynamics::Entry own_start(const Scene& scene) {
  if (scene.start.y != 0.0)
    throw std::invalid_argument(
        "start.y_m = " + toml_float(scene.start.y) +
        " is not permitted for a chain: its states are entries from below, start.y_m must be 0");
  return dynamics::entry_of(scene.start);
}

dynamics::BodyState body_at(const dynamics::Entry& entry) {
  return {entry.at[dynamics::kEntryD], 0.0, entry.at[dynamics::kEntryVx],
          entry.at[dynamics::kEntryVy]};
}

std::vector<dynamics::BodyState> bodies_at(const std::vector<dynamics::Entry>& entries) {
  std::vector<dynamics::BodyState> bodies;
  for (const dynamics::Entry& entry : entries) bodies.push_back(body_at(entry));
  return bodies;
}

void require_inside(const std::vector<dynamics::Entry>& starts, const Scene& scene) {
  const double side = scene.gate.beams.joint_x;
  for (const dynamics::Entry& s : starts)
    if (const double d = s.at[dynamics::kEntryD]; !(std::abs(d) < side))
      throw std::invalid_argument("--start: d = " + toml_float(d) +
                                  " m must lie inside the gate, (-" + toml_float(side) + ", " +
                                  toml_float(side) + ")");
}

bool like_table4(const Scene& scene) {
  if (scene.terrain) return false;
  const dynamics::GateParams paper;
  for (const dynamics::ParamInfo& info : dynamics::gate_param_table()) {
    const bool free = info.key == "forces.propulsion_N" || info.key == "forces.random_N" ||
                      info.key.substr(0, 4) == "run.";
    if (!free && info.get(scene.gate) != info.get(paper)) return false;
  }
  const FieldParams field;
  return scene.gate.run.time_limit == paper.run.time_limit &&
         scene.gate.run.traverse_y == paper.run.traverse_y &&
         scene.field.columns == field.columns && scene.field.rows == field.rows &&
         scene.field.max_gates == field.max_gates;
}

}  // namespace gatewalk::lattice
