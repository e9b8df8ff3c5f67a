// SPDX-License-Identifier: MIT
#include "lattice/gates/gates.h"

#include <fmt/core.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "dynamics/disc/disc_cell.h"

namespace gatewalk::lattice {
namespace {

constexpr double kMostGatesOfReach = 3.0;

}  // namespace

void validate(const dynamics::GateParams& p, const FieldParams& field) {
  if (field.fidelity == Fidelity::active) return;
  if (p.run.method != "moreau")
    throw dynamics::InvalidParameter(
        "field.fidelity",
        fmt::format("field.fidelity = \"{}\" is not permitted with run.method = \"{}\": it is "
                    "stepped by Moreau's scheme; run.method must be \"moreau\", or field.fidelity "
                    "\"active\"",
                    name_of(field.fidelity), p.run.method));
  const double reach = p.beams.length + p.body.radius;
  const double gate = std::fmin(p.gate_width(), p.run.traverse_y);
  if (field.fidelity == Fidelity::all && !(reach <= kMostGatesOfReach * gate))
    throw dynamics::InvalidParameter(
        "field.fidelity",
        fmt::format("field.fidelity = \"all\" is not permitted with these gates: beams.length_m + "
                    "body.radius_m = {:.6g} must not exceed {:.6g} times the smaller of 2 "
                    "beams.joint_x_m and run.traverse_y_m, {:.6g}",
                    reach, kMostGatesOfReach, kMostGatesOfReach * gate));
}

FieldGates::FieldGates(dynamics::GateParams everywhere) : types_{std::move(everywhere)} {}

FieldGates FieldGates::by_cell(std::vector<dynamics::GateParams> types, int columns,
                               std::vector<int> type_of_cell) {
  if (types.empty()) throw std::invalid_argument("field: no type of gate is given");
  if (types.size() > 256) throw std::invalid_argument("field: more than 256 types of gates");
  const dynamics::GateParams& first = types.front();
  for (const dynamics::GateParams& p : types)
    if (p.body.mass != first.body.mass || p.body.radius != first.body.radius ||
        p.gate_width() != first.gate_width() || p.gate_length() != first.gate_length() ||
        p.beams.joint_y != first.beams.joint_y)
      throw std::invalid_argument(
          "field: gates of other size, with other joints or for another body cannot share a field");
  if (columns < 1 || type_of_cell.empty() || std::ssize(type_of_cell) % columns != 0)
    throw std::invalid_argument("field: types of " + std::to_string(type_of_cell.size()) +
                                " cells do not fill rows of " + std::to_string(columns));
  for (const int type : type_of_cell)
    if (type < 0 || type >= std::ssize(types))
      throw std::invalid_argument("field: a cell is given type " + std::to_string(type) + " of " +
                                  std::to_string(types.size()));
  FieldGates gates(first);
  gates.types_ = std::move(types);
  gates.columns_ = columns;
  gates.type_of_cell_ = std::move(type_of_cell);
  return gates;
}

dynamics::CellMap FieldGates::map() const {
  dynamics::CellMap map{dynamics::disc_section(types_.front()), {}, columns_, type_of_cell_};
  for (const dynamics::GateParams& p : types_) map.types.push_back({dynamics::symmetric(p)});
  return map;
}

dynamics::CellField FieldGates::cells() const {
  dynamics::CellField field{map(), {}};
  for (const dynamics::GateParams& p : types_)
    field.cells.push_back(std::make_shared<dynamics::DiscCell>(p));
  return field;
}

}  // namespace gatewalk::lattice
