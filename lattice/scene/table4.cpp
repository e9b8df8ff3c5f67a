// SPDX-License-Identifier: MIT
#include "lattice/scene/table4.h"

#include <cmath>
#include <stdexcept>

#include "dynamics/disc/disc_section.h"
#include "lattice/scene/bins.h"
#include "lattice/text/digits.h"

namespace gatewalk::lattice {
namespace {

bool starts_in_usual_cell(const FieldParams& field) {
  return field.start_row == 0 && field.start_column() == field.middle_column();
}

}  // namespace

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
  const dynamics::BodyState& own = scene.start;
  const double vy = starts.front().start.at[dynamics::kEntryVy];
  const bool the_papers = own.x == 0.0 && own.y == 0.0 && own.vx == 0.0 &&
                          std::abs(own.vy - vy) <= 1e-12 * vy && starts_in_usual_cell(scene.field);
  if (!the_papers || scene.terrain || !papers_field(scene)) starts.clear();
  return starts;
}

dynamics::Entry own_start(const Scene& scene) {
  if (!dynamics::on_boundary(scene.gate, scene.start))
    throw std::invalid_argument(
        "start.y_m = " + toml_float(scene.start.y) +
        " is not permitted for a chain: its states are entries, start.y_m must be 0, or start.x_m "
        "a side of the gate, -" +
        toml_float(scene.gate.beams.joint_x) + " or " + toml_float(scene.gate.beams.joint_x));
  return dynamics::entry_of(scene.gate, scene.start);
}

std::vector<dynamics::BodyState> bodies_at(const Scene& scene,
                                           const std::vector<dynamics::Entry>& entries) {
  std::vector<dynamics::BodyState> bodies;
  for (const dynamics::Entry& entry : entries)
    bodies.push_back(dynamics::entry_state(scene.gate, entry));
  return bodies;
}

void require_inside(const std::vector<dynamics::Entry>& starts, const Scene& scene) {
  const double side = scene.gate.beams.joint_x;
  const dynamics::Section section = dynamics::disc_section(scene.gate);
  for (const dynamics::Entry& s : starts) {
    const double d = s.at[dynamics::kEntryD], vx = s.at[dynamics::kEntryVx];
    if (s.face == dynamics::Boundary::enter) {
      if (!(std::abs(d) < side))
        throw std::invalid_argument("--start: d = " + toml_float(d) +
                                    " m must lie inside the gate, (-" + toml_float(side) + ", " +
                                    toml_float(side) + ")");
      continue;
    }
    const dynamics::Face& face = section.faces[static_cast<std::size_t>(s.face)];
    const auto& [low, high] = face.usual[dynamics::kEntryD];
    if (!(d >= low && d <= high))
      throw std::invalid_argument("--start: by face " + face.name + ", d = " + toml_float(d) +
                                  " m must lie in [" + toml_float(low) + ", " + toml_float(high) +
                                  "], where the disc is clear of the beams");
    if (!(vx * face.di_x > 0.0))
      throw std::invalid_argument("--start: by face " + face.name + ", vx = " + toml_float(vx) +
                                  " m/s must be " + (face.di_x > 0 ? "> 0" : "< 0") +
                                  ", into the gate");
  }
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
         scene.field.max_gates == field.max_gates && starts_in_usual_cell(scene.field);
}

}  // namespace gatewalk::lattice
