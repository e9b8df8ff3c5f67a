// SPDX-License-Identifier: MIT
#include "dynamics/disc/disc_section.h"

#include <fmt/core.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace gatewalk::dynamics {
namespace {

std::vector<Bins> table3_bins(const GateParams& p) {
  const double w = p.beams.joint_x, y = p.beams.joint_y, r = p.body.radius;
  if (!(p.run.traverse_y > y + r))
    throw InvalidParameter("run.traverse_y_m",
                           "run.traverse_y_m = " + fmt::format("{:f}", p.run.traverse_y) +
                               " is not permitted for a chain or a field: it must exceed "
                               "beams.joint_y_m + body.radius_m = " +
                               fmt::format("{:f}", y + r));
  const double unit = scale_of(p).speed();
  const auto speeds = [unit](std::vector<double> edges) {  // edges of Table III, in m/s
    for (double& v : edges) v *= unit;
    return edges;
  };
  const auto leftward = speeds({-30, -20, -10, 0}), rightward = speeds({0, 10, 20, 30});
  const auto side_vy = speeds({-20, -10, 0, 10, 20, 30});
  const std::vector<double> below{r, (r + y) / 2, y}, above{r, p.run.traverse_y - y};
  return {Bins{{{{-w, -0.6 * w, -0.2 * w, 0.2 * w, 0.6 * w, w},
                 speeds({-25, -15, -5, 5, 15, 25}),
                 speeds({10, 20})}}},
          Bins{{below, leftward, side_vy}}, Bins{{below, rightward, side_vy}},
          Bins{{above, speeds({-30, 0}), speeds({-20, 30})}},
          Bins{{above, speeds({0, 30}), speeds({-20, 30})}}};
}

}  // namespace

const Section& disc_section() {
  static const Section section = [] {
    Section s{.faces = {{"EN", 0, 1, enter, 0b011, "from below"},
                        {"RD", -1, 0, left_deflect, 0b010, "from the right"},
                        {"LD", 1, 0, right_deflect, 0b010, "from the left"},
                        {"RT", -1, 0, left_traverse, 0b010, "from the right"},
                        {"LT", 1, 0, right_traverse, 0b010, "from the left"}},
              .coordinates = {{"d", "d_m", "m", "distance along the boundary"},
                              {"vx", "vx_m_per_s", "m s-1", "lateral velocity"},
                              {"vy", "vy_m_per_s", "m s-1", "forward velocity"}},
              .costs = {}};
    for (const CostName& c : kCostNames)
      s.costs.push_back({std::string(c.key), std::string(c.unit), std::string(c.words)});
    return s;
  }();
  return section;
}

Section disc_section(const GateParams& p) {
  Section section = disc_section();
  const Scale scale = scale_of(p);
  section.coordinates[kEntryD].scale = scale.length;
  section.coordinates[kEntryVx].scale = section.coordinates[kEntryVy].scale = scale.speed();
  const std::vector<Bins> bins = table3_bins(p);
  for (int f = 0; f < kBoundaries; ++f)
    for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis)
      section.faces[f].usual[axis] = {bins[f].edges[axis].front(), bins[f].edges[axis].back()};
  return section;
}

StateSpace table3_space(const GateParams& p) { return {disc_section(p), table3_bins(p)}; }

bool symmetric(const GateParams& p) { return p.beams.stiffness_left == p.beams.stiffness_right; }

Entry crossing_of(const GateParams& p, Outcome outcome, const BodyState& exit) {
  const bool below = exit.y < p.beams.joint_y;
  const double from_joint = std::abs(exit.y - p.beams.joint_y);
  if (is_traversed(outcome)) return {Boundary::enter, {exit.x, exit.vx, exit.vy}};
  if (outcome == Outcome::exited_left)
    return {below ? Boundary::right_deflect : Boundary::right_traverse,
            {from_joint, exit.vx, exit.vy}};
  if (outcome == Outcome::exited_right)
    return {below ? Boundary::left_deflect : Boundary::left_traverse,
            {from_joint, exit.vx, exit.vy}};
  throw std::logic_error("this run did not leave its gate");
}

bool on_boundary(const GateParams& p, const BodyState& b) {
  return b.y == 0.0 || std::abs(b.x) == p.beams.joint_x;
}

Entry entry_of(const GateParams& p, const BodyState& b) {
  if (std::abs(b.x) != p.beams.joint_x) return entry_of(b);
  return crossing_of(p, b.x < 0.0 ? Outcome::exited_right : Outcome::exited_left, b);
}

BodyState entry_state(const GateParams& p, const Entry& entry) {
  const double d = entry.at[kEntryD];
  BodyState b{0.0, 0.0, entry.at[kEntryVx], entry.at[kEntryVy]};
  switch (entry.face) {
    case Boundary::enter:
      b.x = d;
      return b;
    case Boundary::right_deflect:
      b.x = p.beams.joint_x;
      b.y = p.beams.joint_y - d;
      return b;
    case Boundary::left_deflect:
      b.x = -p.beams.joint_x;
      b.y = p.beams.joint_y - d;
      return b;
    case Boundary::right_traverse:
      b.x = p.beams.joint_x;
      b.y = p.beams.joint_y + d;
      return b;
    case Boundary::left_traverse:
      b.x = -p.beams.joint_x;
      b.y = p.beams.joint_y + d;
      return b;
  }
  throw std::logic_error("no such boundary");
}

BodyState shifted_into_next(const GateParams& p, Outcome outcome, BodyState exit) {
  const double width = p.gate_width();
  if (is_traversed(outcome)) exit.y -= p.run.traverse_y;
  if (outcome == Outcome::exited_left) exit.x += width;
  if (outcome == Outcome::exited_right) exit.x -= width;
  return exit;
}

}  // namespace gatewalk::dynamics
