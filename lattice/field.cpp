#include "lattice/field.h"

#include <sstream>

namespace gatewalk::lattice {
namespace {

constexpr double kMostGatesOfReach = 3.0;

}  // namespace

void validate(const dynamics::GateParams& p, const FieldParams& field) {
  if (field.fidelity == Fidelity::active) return;
  std::ostringstream text;
  if (p.run.method != "moreau") {
    text
        << "field.fidelity = \"" << name_of(field.fidelity)
        << "\" is not permitted with run.method = \"" << p.run.method
        << "\": it is stepped by Moreau's scheme; run.method must be \"moreau\", or field.fidelity "
           "\"active\"";
    throw dynamics::InvalidParameter("field.fidelity", text.str());
  }
  const double reach = p.beams.length + p.body.radius;
  const double gate = std::fmin(2.0 * p.beams.joint_x, p.run.traverse_y);
  if (field.fidelity == Fidelity::all && !(reach <= kMostGatesOfReach * gate)) {
    text << "field.fidelity = \"all\" is not permitted with these gates: beams.length_m + "
            "body.radius_m = "
         << reach << " must not exceed " << kMostGatesOfReach
         << " times the smaller of 2 beams.joint_x_m and run.traverse_y_m, "
         << kMostGatesOfReach * gate;
    throw dynamics::InvalidParameter("field.fidelity", text.str());
  }
}

}  // namespace gatewalk::lattice
