#include "dynamics/params.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>

namespace gatewalk::dynamics {
namespace {

using P = GateParams;

// key, place, lowest, highest, lowest itself not permitted, meaning
constexpr ParamInfo kTable[] = {
    {"body.mass_kg", [](P& p) -> double& { return p.body.mass; },
     0.0, 1e6, true, "mass M of the disc"},
    {"body.radius_m", [](P& p) -> double& { return p.body.radius; },
     0.0, 1e6, true, "radius R of the disc"},
    {"beams.length_m", [](P& p) -> double& { return p.beams.length; },
     0.0, 1e6, true, "length L of a beam"},
    {"beams.mass_kg", [](P& p) -> double& { return p.beams.mass; },
     0.0, 1e6, true, "mass m of a beam"},
    {"beams.stiffness_left_Nm_per_rad", [](P& p) -> double& { return p.beams.stiffness_left; },
     0.0, 1e12, false, "torsional stiffness k_L of the left joint"},
    {"beams.stiffness_right_Nm_per_rad", [](P& p) -> double& { return p.beams.stiffness_right; },
     0.0, 1e12, false, "torsional stiffness k_R of the right joint"},
    {"beams.damping_Nms_per_rad", [](P& p) -> double& { return p.beams.damping; },
     0.0, 1e12, false, "torsional damping d of either joint"},
    {"beams.joint_x_m", [](P& p) -> double& { return p.beams.joint_x; },
     0.0, 1e6, true, "distance of a joint from the gate's middle line"},
    {"beams.joint_y_m", [](P& p) -> double& { return p.beams.joint_y; },
     0.0, 1e6, true, "distance of the joints from the gate's entrance"},
    {"forces.propulsion_N", [](P& p) -> double& { return p.forces.propulsion; },
     0.0, 1e6, false, "propulsive force F_prop along +y"},
    {"forces.random_N", [](P& p) -> double& { return p.forces.random; },
     0.0, 1e6, false, "magnitude Rm of the random force along x"},
    {"forces.random_rate_Hz", [](P& p) -> double& { return p.forces.random_rate; },
     0.0, 1e6, true, "draws of the random force per second"},
    {"forces.drag_Ns_per_m", [](P& p) -> double& { return p.forces.drag; },
     0.0, 1e12, false, "viscous drag D between body and ground"},
    {"contact.restitution", [](P& p) -> double& { return p.contact.restitution; },
     0.0, 1.0, false, "restitution on a beam's side and on a joint"},
    {"contact.tip_restitution", [](P& p) -> double& { return p.contact.tip_restitution; },
     0.0, 1.0, false, "restitution on a beam's free end"},
    {"contact.impulse_threshold_Ns", [](P& p) -> double& { return p.contact.impulse_threshold; },
     0.0, 1e6, false, "impulse below which contact is a constraint"},
    {"run.step_s", [](P& p) -> double& { return p.run.step; },
     0.0, 1.0, true, "time step"},
    {"run.time_limit_s", [](P& p) -> double& { return p.run.time_limit; },
     0.0, 1e6, true, "a body that is still inside after this is trapped"},
    {"run.traverse_y_m", [](P& p) -> double& { return p.run.traverse_y; },
     0.0, 1e6, true, "a body beyond this has traversed"},
    {"run.event_tolerance_m", [](P& p) -> double& { return p.run.event_tolerance; },
     1e-13, 1.0, false, "method event: local error, and lowest rebound that is flown"},
    {"run.tolerance", [](P& p) -> double& { return p.run.tolerance; },
     1e-4, 1.0, false, "method auto: total variation of the outcomes that it may cost"},
};

/// The shortest digits that read back as `v`, or `digits` significant ones.
std::string text(double v, int digits = 0) {
  std::array<char, 32> buffer;
  char* const begin = buffer.data();
  char* const end = begin + buffer.size();
  const auto result = digits == 0
                          ? std::to_chars(begin, end, v)
                          : std::to_chars(begin, end, v, std::chars_format::general, digits);
  return {begin, result.ptr};
}

[[noreturn]] void refuse(std::string_view key, const std::string& value,
                         const std::string& reason) {
  std::string what(key);
  what += " = " + value + " is not permitted: " + reason;
  throw InvalidParameter(std::string(key), what);
}

const ParamInfo& info(std::string_view key) {
  return *std::find_if(std::begin(kTable), std::end(kTable),
                       [key](const ParamInfo& i) { return i.key == key; });
}

}  // namespace

std::string ParamInfo::range() const {
  return std::string(low_open ? "(" : "[") + text(low) + ", " + text(high) + "]";
}

std::span<const ParamInfo> gate_param_table() { return kTable; }

Scale scale_of(const GateParams& p) {
  Scale scale{p.body.radius / 10.0, p.body.mass, 50.0 / p.forces.random_rate};
  const double force = std::max(p.forces.propulsion, p.forces.random);
  if (force > 0.0) {
    const double own = std::sqrt(p.body.mass * p.body.radius / force);  // s
    scale.time = std::clamp(scale.time, own / 4.0, own * 4.0);
  }
  return scale;
}

double default_step(std::string_view method, double random_rate) {
  const double wanted = method == "stable" || method == "auto" ? Run{}.step : kPaperStep;
  return 1.0 / (random_rate * std::ceil(1.0 / (random_rate * wanted) - 1e-9));
}

int steps_per_hold(const GateParams& params) {
  constexpr int kMost = std::numeric_limits<int>::max();
  const double rate = params.forces.random_rate;
  const double step = params.run.step;
  const double steps = 1.0 / (rate * step);
  if (!(steps < kMost)) {
    refuse("run.step_s", text(step),
           "forces.random_rate_Hz = " + text(rate) + " would hold a draw for " + text(steps, 6)
               + " steps; at most " + std::to_string(kMost) + " are supported");
  }
  const double whole = std::round(steps);
  if (whole >= 1.0 && std::abs(steps - whole) <= 1e-6 * whole) return static_cast<int>(whole);

  // The nearest steps that do fit, one longer and one shorter, where the table permits them.
  std::string nearest;
  for (const double n : {std::floor(steps), std::floor(steps) + 1.0}) {
    const double fit = 1.0 / (rate * n);  // inf for n = 0
    if (!info("run.step_s").permits(fit)) continue;
    nearest += (nearest.empty() ? "" : " and ") + text(fit, 9);
  }
  refuse("run.step_s", text(step),
         "must fit a whole number of times into the " + text(1.0 / rate, 9)
             + " s that one draw of the random force is held (forces.random_rate_Hz = " + text(rate)
             + "); nearest permitted: " + nearest);
}

void validate(const GateParams& params) {
  for (const ParamInfo& i : gate_param_table()) {
    if (!i.permits(i.get(params))) refuse(i.key, text(i.get(params)), "must lie in " + i.range());
  }

  const auto methods = method_names();
  if (std::find(methods.begin(), methods.end(), params.run.method) == methods.end()) {
    std::string names;
    for (const std::string_view name : methods) {
      names += (names.empty() ? "\"" : ", \"") + std::string(name) + "\"";
    }
    refuse("run.method", "\"" + params.run.method + "\"", "must be one of " + names);
  }

  const double joint_y = params.beams.joint_y;
  if (!(params.body.radius < joint_y)) {
    refuse("body.radius_m", text(params.body.radius),
           "must be less than beams.joint_y_m = " + text(joint_y)
               + ", or a body that enters at y = 0 is already in the beams");
  }
  if (!(params.run.traverse_y > joint_y)) {
    refuse("run.traverse_y_m", text(params.run.traverse_y),
           "must be more than beams.joint_y_m = " + text(joint_y));
  }

  (void)steps_per_hold(params);  // refuses a step that does not fit
  constexpr int kMostSteps = std::numeric_limits<int>::max();
  if (const double steps = params.run.time_limit / params.run.step; !(steps < kMostSteps)) {
    refuse("run.time_limit_s", text(params.run.time_limit),
           "is " + text(steps, 6) + " steps of run.step_s = " + text(params.run.step) + "; at most "
               + std::to_string(kMostSteps) + " are supported");
  }
}

}  // namespace gatewalk::dynamics
