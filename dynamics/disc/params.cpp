// SPDX-License-Identifier: MIT
#include "dynamics/disc/params.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>

namespace gatewalk::dynamics {
namespace {

using P = GateParams;

// The largest permitted value in SI units: any unit will do as long as nothing overflows
// (require_computable).
constexpr double kHuge = 1e100;
// The largest permitted own unit of a scene, and the largest value in such units.
constexpr double kHugeUnit = 1e60;
constexpr double kFar = 1e18;

// Columns: key, place, lowest, highest, whether the lowest itself is refused, meaning.
constexpr ParamInfo kTable[] = {
    {"body.mass_kg", [](P& p) -> double& { return p.body.mass; }, 0.0, kHuge, true,
     "mass M of the body"},
    {"body.radius_m", [](P& p) -> double& { return p.body.radius; }, 0.0, kHuge, true,
     "radius R of the body, a disc"},
    {"beams.length_m", [](P& p) -> double& { return p.beams.length; }, 0.0, kHuge, true,
     "length L of a beam"},
    {"beams.mass_kg", [](P& p) -> double& { return p.beams.mass; }, 0.0, kHuge, true,
     "mass m of a beam"},
    {"beams.stiffness_left_Nm_per_rad", [](P& p) -> double& { return p.beams.stiffness_left; }, 0.0,
     kHuge, false, "torsional stiffness k_L of the left joint"},
    {"beams.stiffness_right_Nm_per_rad", [](P& p) -> double& { return p.beams.stiffness_right; },
     0.0, kHuge, false, "torsional stiffness k_R of the right joint"},
    {"beams.damping_Nms_per_rad", [](P& p) -> double& { return p.beams.damping; }, 0.0, kHuge,
     false, "torsional damping d of each joint"},
    {"beams.joint_x_m", [](P& p) -> double& { return p.beams.joint_x; }, 0.0, kHuge, true,
     "distance of a joint from the gate's middle line"},
    {"beams.joint_y_m", [](P& p) -> double& { return p.beams.joint_y; }, 0.0, kHuge, true,
     "distance of the joints from the gate's entrance"},
    {"forces.propulsion_N", [](P& p) -> double& { return p.forces.propulsion; }, 0.0, kHuge, false,
     "propulsive force F_prop along +y"},
    {"forces.random_N", [](P& p) -> double& { return p.forces.random; }, 0.0, kHuge, false,
     "magnitude Rm of the random force along x"},
    {"forces.random_rate_Hz", [](P& p) -> double& { return p.forces.random_rate; }, 0.0, kHuge,
     true, "how often a second the random force is drawn anew"},
    {"forces.drag_Ns_per_m", [](P& p) -> double& { return p.forces.drag; }, 0.0, kHuge, false,
     "viscous drag D between body and ground"},
    {"contact.restitution", [](P& p) -> double& { return p.contact.restitution; }, 0.0, 1.0, false,
     "restitution of a hit on a beam's side or on a joint"},
    {"contact.tip_restitution", [](P& p) -> double& { return p.contact.tip_restitution; }, 0.0, 1.0,
     false, "restitution of a hit on a beam's free end"},
    {"contact.impulse_threshold_Ns", [](P& p) -> double& { return p.contact.impulse_threshold; },
     0.0, kHuge, false, "a weaker hit does not rebound: the contact is held"},
    {"run.step_s", [](P& p) -> double& { return p.run.step; }, 0.0, kHuge, true, "time step"},
    {"run.time_limit_s", [](P& p) -> double& { return p.run.time_limit; }, 0.0, kHuge, true,
     "a body that is still in the gate after this time is trapped"},
    {"run.traverse_y_m", [](P& p) -> double& { return p.run.traverse_y; }, 0.0, kHuge, true,
     "y beyond which a body has traversed the gate"},
    {"run.event_tolerance_m", [](P& p) -> double& { return p.run.event_tolerance; }, 0.0, kHuge,
     true, "method event: local error, and the lowest rebound that is simulated"},
    {"run.tolerance", [](P& p) -> double& { return p.run.tolerance; }, 1e-4, 1.0, false,
     "method auto: error in the outcomes (total variation) that it accepts"},
};

/// Formats `v` with the shortest digits that read back as `v`, or with `digits` significant digits.
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

/// Refuses units so large or small, and values so many units away, that products could overflow or
/// vanish. require_units checks the units, require_computable both.
void require_units(const GateParams& p) {
  const Scale u = scale_of(p);
  for (const double unit :
       {u.length, u.mass, u.time, u.speed(), u.force(), u.impulse(), u.energy()})
    if (!(unit >= 1.0 / kHugeUnit && unit <= kHugeUnit))
      refuse("body.mass_kg", text(p.body.mass),
             "with body.radius_m = " + text(p.body.radius) +
                 " and the forces given, the scene's units of length, "
                 "mass, time, force or energy leave [1e-60, 1e+60]");
}

void require_computable(const GateParams& p) {
  require_units(p);
  const Scale u = scale_of(p);
  struct Measured {
    std::string_view key;
    double unit;
    bool positive;
  };
  const double torque = u.energy();
  const Measured all[] = {{"beams.length_m", u.length, true},
                          {"beams.mass_kg", u.mass, true},
                          {"beams.stiffness_left_Nm_per_rad", torque, false},
                          {"beams.stiffness_right_Nm_per_rad", torque, false},
                          {"beams.damping_Nms_per_rad", torque * u.time, false},
                          {"beams.joint_x_m", u.length, true},
                          {"beams.joint_y_m", u.length, true},
                          {"forces.drag_Ns_per_m", u.mass / u.time, false},
                          {"contact.impulse_threshold_Ns", u.impulse(), false},
                          {"run.time_limit_s", u.time, true},
                          {"run.traverse_y_m", u.length, true}};
  for (const Measured& m : all) {
    const double low = m.positive ? m.unit / kFar : 0.0, high = m.unit * kFar;
    const double value = info(m.key).get(p);
    if (!(value >= low && value <= high))
      refuse(m.key, text(value),
             "beside body.mass_kg = " + text(p.body.mass) +
                 ", body.radius_m = " + text(p.body.radius) + " and the forces it must lie in [" +
                 text(low, 6) + ", " + text(high, 6) + "]");
  }
  // The tolerance must lie between rounding error and a tenth of a radius.
  const double least = 1e-14 * p.body.radius, most = 0.1 * p.body.radius,
               given = p.run.event_tolerance;
  if (p.run.method == "event" && !(given >= least && given <= most))
    refuse("run.event_tolerance_m", text(given),
           "must lie in [" + text(least, 6) + ", " + text(most, 6) +
               "], 1e-14 to 0.1 of body.radius_m");
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

double default_step(const GateParams& p) {
  const bool stable = p.run.method == "stable" || p.run.method == "auto";
  const double wanted = (stable ? RunParams{}.step : kPaperStep) * scale_of(p).time;
  return 1.0 / (p.forces.random_rate * std::ceil(1.0 / (p.forces.random_rate * wanted) - 1e-9));
}

namespace {

/// The factor on the tolerances of hits, below 1 if little force presses a body onto a beam: the
/// impulse threshold is at most three times the impulse of that force in the paper's step. 1 in the
/// paper's scenes.
double gentleness(const GateParams& p) {
  const Scale scale = scale_of(p);
  const double force =
      // The random force acts for a hold only.
      std::max(p.forces.propulsion, 0.1 * p.forces.random);
  const double usual = ContactParams{}.impulse_threshold * scale.impulse();
  return force > 0.0 ? std::min(1.0, 3.0 * force * (kPaperStep * scale.time) / usual) : 1.0;
}

}  // namespace

double default_impulse_threshold(const GateParams& p) {
  return ContactParams{}.impulse_threshold * scale_of(p).impulse() * gentleness(p);
}

double default_event_tolerance(const GateParams& p) {
  return RunParams{}.event_tolerance * scale_of(p).length * gentleness(p);
}

namespace {

/// The time (s) that the propulsion takes from rest through an open gate: the time without drag
/// plus the time with drag alone. Infinite without propulsion.
double opening_time(const GateParams& p) {
  const double gate = p.run.traverse_y, force = p.forces.propulsion;
  return std::sqrt(2.0 * gate * p.body.mass / force) + gate * p.forces.drag / force;
}

}  // namespace

std::vector<std::string_view> fill_in(GateParams& p, BodyState& start, const IsNamed& named) {
  std::vector<std::string_view> filled;
  const auto fill = [&](std::string_view key, double& place, double value) {
    if (named(key)) return;
    place = value;
    filled.push_back(key);
  };
  const GateParams paper;
  const bool own_body = named("body.mass_kg") || named("body.radius_m");
  Scale u;  // units that replace the paper's 1 m, 1 kg, 1 s
  if (own_body) {
    if (named("body.radius_m"))
      u.length = p.body.radius / paper.body.radius;
    else if (named("beams.length_m"))
      u.length = p.beams.length / paper.beams.length;
    else if (named("beams.joint_x_m"))
      u.length = p.beams.joint_x / paper.beams.joint_x;
    else if (named("beams.joint_y_m"))
      u.length = p.beams.joint_y / paper.beams.joint_y;
    if (named("body.mass_kg"))
      u.mass = p.body.mass / paper.body.mass;
    else if (named("beams.mass_kg"))
      u.mass = p.beams.mass / paper.beams.mass;
    const auto time_by = [&](std::string_view key, double value, double papers,
                             double per_second_squared) {
      if (!named(key) || !(value > 0.0)) return false;
      u.time = std::sqrt(papers * per_second_squared / value);
      return true;
    };
    const double ml = u.mass * u.length;
    if (!time_by("forces.propulsion_N", p.forces.propulsion, paper.forces.propulsion, ml) &&
        !time_by("forces.random_N", p.forces.random, paper.forces.random, ml) &&
        !time_by("beams.stiffness_left_Nm_per_rad", p.beams.stiffness_left,
                 paper.beams.stiffness_left, ml * u.length) &&
        !time_by("beams.stiffness_right_Nm_per_rad", p.beams.stiffness_right,
                 paper.beams.stiffness_right, ml * u.length) &&
        named("forces.random_rate_Hz"))
      u.time = paper.forces.random_rate / p.forces.random_rate;
    fill("body.mass_kg", p.body.mass, paper.body.mass * u.mass);
    fill("body.radius_m", p.body.radius, paper.body.radius * u.length);
    const double length = p.beams.length, joint_x = p.beams.joint_x;
    const double left = p.beams.stiffness_left, right = p.beams.stiffness_right;
    // By default the tips meet and the beams are alike.
    fill("beams.length_m", p.beams.length,
         named("beams.joint_x_m") ? joint_x : paper.beams.length * u.length);
    fill("beams.mass_kg", p.beams.mass, paper.beams.mass * u.mass);
    fill("beams.stiffness_left_Nm_per_rad", p.beams.stiffness_left,
         named("beams.stiffness_right_Nm_per_rad") ? right
                                                   : paper.beams.stiffness_left * u.energy());
    fill(
        "beams.stiffness_right_Nm_per_rad", p.beams.stiffness_right,
        named("beams.stiffness_left_Nm_per_rad") ? left : paper.beams.stiffness_right * u.energy());
    fill("beams.damping_Nms_per_rad", p.beams.damping, paper.beams.damping * (u.energy() * u.time));
    fill("beams.joint_x_m", p.beams.joint_x,
         named("beams.length_m") ? length : paper.beams.joint_x * u.length);
    fill("beams.joint_y_m", p.beams.joint_y,
         paper.beams.joint_y / paper.body.radius * p.body.radius);
    fill("forces.propulsion_N", p.forces.propulsion, paper.forces.propulsion * u.force());
    fill("forces.random_N", p.forces.random, paper.forces.random * u.force());
    fill("forces.random_rate_Hz", p.forces.random_rate, paper.forces.random_rate / u.time);
    fill("forces.drag_Ns_per_m", p.forces.drag, paper.forces.drag * (u.mass / u.time));
    fill("run.traverse_y_m", p.run.traverse_y, 2.0 * p.beams.joint_y);
    fill("run.time_limit_s", p.run.time_limit,
         paper.run.time_limit *
             (p.forces.propulsion > 0.0 ? opening_time(p) / opening_time(paper) : u.time));
    fill("start.vy_m_per_s", start.vy, start.vy * u.speed());
  }
  if (!own_body && named("beams.joint_y_m"))
    fill("run.traverse_y_m", p.run.traverse_y, 2.0 * p.beams.joint_y);
  require_units(p);
  fill("contact.impulse_threshold_Ns", p.contact.impulse_threshold, default_impulse_threshold(p));
  fill("run.event_tolerance_m", p.run.event_tolerance, default_event_tolerance(p));
  fill("run.step_s", p.run.step, default_step(p));
  return filled;
}

int steps_per_hold(const GateParams& params) {
  constexpr int kMost = std::numeric_limits<int>::max();
  const double rate = params.forces.random_rate;
  const double step = params.run.step;
  const double steps = 1.0 / (rate * step);
  if (!(steps < kMost)) {
    refuse("run.step_s", text(step),
           "forces.random_rate_Hz = " + text(rate) + " would hold a draw for " + text(steps, 6) +
               " steps; at most " + std::to_string(kMost) + " are supported");
  }
  const double whole = std::round(steps);
  if (whole >= 1.0 && std::abs(steps - whole) <= 1e-6 * whole) return static_cast<int>(whole);

  // The nearest longer and shorter steps that fit, if the table permits them.
  std::string nearest;
  for (const double n : {std::floor(steps), std::floor(steps) + 1.0}) {
    const double fit = 1.0 / (rate * n);  // inf for n = 0
    if (!info("run.step_s").permits(fit)) continue;
    nearest += (nearest.empty() ? "" : " and ") + text(fit, 9);
  }
  refuse("run.step_s", text(step),
         "must fit a whole number of times into the " + text(1.0 / rate, 9) +
             " s that one draw of the random force is held (forces.random_rate_Hz = " + text(rate) +
             "); nearest permitted: " + nearest);
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

  require_computable(params);

  const double joint_y = params.beams.joint_y;
  if (!(params.body.radius < joint_y)) {
    refuse("body.radius_m", text(params.body.radius),
           "must be less than beams.joint_y_m = " + text(joint_y) +
               ", or a body that enters at y = 0 is already in the beams");
  }
  if (!(params.run.traverse_y > joint_y)) {
    refuse("run.traverse_y_m", text(params.run.traverse_y),
           "must be more than beams.joint_y_m = " + text(joint_y));
  }

  (void)steps_per_hold(params);  // refuses a step that does not fit
  constexpr int kMostSteps = std::numeric_limits<int>::max();
  if (const double steps = params.run.time_limit / params.run.step; !(steps < kMostSteps)) {
    refuse("run.time_limit_s", text(params.run.time_limit),
           "is " + text(steps, 6) + " steps of run.step_s = " + text(params.run.step) +
               "; at most " + std::to_string(kMostSteps) + " are supported");
  }
}

}  // namespace gatewalk::dynamics
