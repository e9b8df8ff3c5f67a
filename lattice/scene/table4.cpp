// SPDX-License-Identifier: MIT
#include "lattice/scene/table4.h"

#include <cmath>
#include <stdexcept>

#include "lattice/scene/bins.h"
#include "lattice/text/digits.h"

namespace gatewalk::lattice {
namespace {

/// Table IV's starts, in the scene's own units.
std::vector<PaperStart> table_iv(const dynamics::GateParams& p) {
  std::vector<PaperStart> starts{{0, 0, 15, 0.914, 1.018},
                                 {23, -11, 16, 0.9097, 1.133},
                                 {4, 5, 10, 0.8929, 1.252},
                                 {-17, 13, 12, 0.9026, 0.9813}};
  const dynamics::Scale unit = dynamics::scale_of(p);
  for (PaperStart& s : starts) {
    s.d *= unit.length;
    s.vx *= unit.speed();
    s.vy *= unit.speed();
  }
  return starts;
}

}  // namespace

PaperStart own_start(const Scene& scene) {
  const dynamics::BodyState& own = scene.start;
  return {own.x, own.vx, own.vy, {}, {}, own.y};
}

std::vector<PaperStart> usual_starts(const Scene& scene) {
  const std::vector<PaperStart> papers = table_iv(scene.gate);
  const dynamics::BodyState &own = scene.start, first = papers.front().body();
  const bool the_papers = own.x == 0.0 && own.y == 0.0 && own.vx == 0.0 &&
                          std::abs(own.vy - first.vy) <= 1e-12 * first.vy;
  if (the_papers && !scene.terrain && papers_field(scene)) return papers;
  return {own_start(scene)};
}

dynamics::Entry PaperStart::entry() const {
  if (y != 0.0)
    throw std::invalid_argument(
        "start.y_m = " + toml_float(y) +
        " is not permitted for a chain: its states are entries from below, start.y_m must be 0");
  return dynamics::entry_of(body());
}

std::vector<dynamics::Entry> entries_at(const std::vector<PaperStart>& starts) {
  std::vector<dynamics::Entry> entries;
  for (const PaperStart& s : starts) entries.push_back(s.entry());
  return entries;
}

std::vector<dynamics::BodyState> bodies_at(const std::vector<PaperStart>& starts) {
  std::vector<dynamics::BodyState> bodies;
  for (const PaperStart& s : starts) bodies.push_back(s.body());
  return bodies;
}

void require_inside(const std::vector<PaperStart>& starts, const Scene& scene) {
  const double side = scene.gate.beams.joint_x;
  for (const PaperStart& s : starts)
    if (!(std::abs(s.d) < side))
      throw std::invalid_argument("--start: d = " + toml_float(s.d) +
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
