// SPDX-License-Identifier: MIT
#pragma once
/// The scene of one gate: who pushes, what is in the way, how time is stepped.
/// Defaults are the paper's field study (Sec. III-C, Tables I and IV) where it says, else the
/// decisions of the "Departures" table in README.md here.

#include <cmath>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace gatewalk::dynamics {

enum Side : int { kLeft = 0, kRight = 1 };

struct Disc {
  double mass = 1.0;     // kg
  double radius = 10.0;  // m
};

struct Beams {
  double length = 25.0;            // m
  double mass = 0.1;               // kg
  double stiffness_left = 400.0;   // N m / rad
  double stiffness_right = 400.0;  // N m / rad
  double damping = 50.0;           // N m s / rad
  double joint_x = 25.0;           // m; joints at (+-joint_x, joint_y), also half the gate's width
  double joint_y = 30.0;           // m

  [[nodiscard]] double stiffness(Side side) const {
    return side == kLeft ? stiffness_left : stiffness_right;
  }
  /// Moment of inertia of one beam about its joint (kg m^2): a uniform rod, m L^2 / 3.
  [[nodiscard]] double inertia() const { return mass * length * length / 3.0; }
};

struct Forces {
  double propulsion = 8.0;    // N, along +y
  double random = 40.0;       // N, Rm of Eq. (1), along x
  double random_rate = 50.0;  // Hz; one draw is held for 1/random_rate
  double drag = 0.06;         // N s / m, D of Sec. III-C
};

struct ContactParams {
  double restitution = 0.8;         // -, interior of a beam and joint pin, Sec. II-A
  double tip_restitution = 1.0;     // -, free end, Eq. (6): elastic
  double impulse_threshold = 0.04;  // N s, epsilon of Sec. II-B: below it contact is a constraint
};

inline constexpr double kPaperStep = 0.004;  // s, Sec. II-B; units of time (Scale) in other scenes

struct RunParams {
  std::string method = "stable";  // a name of method_names()
  double step = 0.02;  // s, one per draw of the random force; the paper's own is kPaperStep
  double time_limit =
      12.0;  // s, 3000 steps of the paper; method paper ends a step later if need be
  double traverse_y = 60.0;       // m; traversed beyond it, and the length of a gate in the field
  double event_tolerance = 1e-2;  // m; method event: local error and lowest rebound that is flown
  double tolerance = 0.005;       // -; method auto: total variation of the outcomes it may cost
};

struct GateParams {
  Disc body;
  Beams beams;
  Forces forces;
  ContactParams contact;
  RunParams run;

  /// Between the joints, and from gate to gate: a cell of the field.
  [[nodiscard]] double gate_width() const { return 2.0 * beams.joint_x; }
  [[nodiscard]] double gate_length() const { return run.traverse_y; }
};

/// Where and how fast the disc's centre is, in a gate's own frame (joints at (+-joint_x, joint_y)).
struct BodyState {
  double x = 0.0, y = 0.0;    // m
  double vx = 0.0, vy = 0.0;  // m/s
};

/// The scene's own units, in which every limit of the program that has a unit is a plain number: a
/// tenth of the radius, the body's mass, fifty holds of the random force. That time is kept within
/// a factor 4 of sqrt(M R / F), in which the larger of both forces moves the body by half a radius.
/// 1 m, 1 kg and 1 s, exactly, in the paper's scenes. A scene whose lengths, times and masses are
/// multiplied by powers of 4 has its units multiplied so, without any other rounding: what it
/// computes is the same bits but for these factors.
struct Scale {
  double length = 1.0;                                                                    // m
  double mass = 1.0;                                                                      // kg
  double time = 1.0;                                                                      // s
  [[nodiscard]] double speed() const { return length / time; }                            // m/s
  [[nodiscard]] double impulse() const { return mass * length / time; }                   // N s
  [[nodiscard]] double force() const { return mass * length / (time * time); }            // N
  [[nodiscard]] double energy() const { return mass * length * length / (time * time); }  // J
};
[[nodiscard]] Scale scale_of(const GateParams& params);

/// One numeric key of a scene: its public name with unit, where it lives, what is allowed.
struct ParamInfo {
  std::string_view key;  // "body.mass_kg"
  double& (*ref)(GateParams&);
  double low, high;  // permitted range
  bool low_open;     // true: `low` itself is not permitted
  std::string_view meaning;

  [[nodiscard]] double get(const GateParams& p) const { return ref(const_cast<GateParams&>(p)); }
  [[nodiscard]] bool permits(double v) const {
    return std::isfinite(v) && v <= high && (low_open ? v > low : v >= low);
  }
  /// "(0, 1e+06]" or "[0, 1]"
  [[nodiscard]] std::string range() const;
};

/// Every numeric key of GateParams: the one table that the scene reader, validate(), the
/// provenance of a matrix and the comparison of two scenes all use.
[[nodiscard]] std::span<const ParamInfo> gate_param_table();

/// What `run.method` may be, beside "auto".
[[nodiscard]] std::span<const std::string_view> method_names();

/// A value that no scene may have. `key()` names it as the scene file does.
class InvalidParameter : public std::invalid_argument {
 public:
  InvalidParameter(std::string key, const std::string& what)
      : std::invalid_argument(what), key_(std::move(key)) {}
  [[nodiscard]] const std::string& key() const { return key_; }

 private:
  std::string key_;
};

/// Throws InvalidParameter naming key, value and what is allowed: ranges of the table, a known
/// method, and a step that fits a whole number of times into one hold of the random force.
void validate(const GateParams& params);

/// The step (s) of a scene that names none: what suits params.run.method, 0.02 units of time
/// (Scale) for `stable` and kPaperStep of them for the others, shortened to fit a whole number of
/// times into one hold of the random force.
[[nodiscard]] double default_step(const GateParams& params);

/// The other settings of a scene that names none, in its own units (Scale), as the paper's scenes
/// have them: contact.impulse_threshold_Ns, but not more than three times what the propulsion (or a
/// tenth of the random force) does in the paper's step; and run.event_tolerance_m, smaller by the
/// same factor where that holds the threshold down: errors add up over a slow way, and count for
/// more beside a small speed.
[[nodiscard]] double default_impulse_threshold(const GateParams& params);
[[nodiscard]] double default_event_tolerance(const GateParams& params);

/// True for a key that a scene gives.
using IsNamed = std::function<bool(std::string_view key)>;

/// Gives the keys that a scene leaves out the values that follow from those that it names, and
/// returns these keys. With a body of its own (mass or radius) all that has a unit keeps the
/// paper's proportions: lengths to the radius, masses to the body's, times by the propulsion or, if
/// that is not named, by the random force, a stiffness or the rate. Tips meet, both beams are
/// alike, a gate is twice as long as its joints lie deep, and the time limit is the paper's
/// multiple of what the propulsion takes from rest through an open gate. A scene without a body of
/// its own has the paper's values, but a gate as long as its joints ask for; the impulse threshold,
/// the tolerance and the step of a scene are always its own. `start` comes with the paper's: its vy
/// follows from the scene too, the rest is zero everywhere.
std::vector<std::string_view> fill_in(GateParams& params, BodyState& start, const IsNamed& named);

/// Steps in one hold of the random force: 1 / (random_rate * step), a whole number.
[[nodiscard]] int steps_per_hold(const GateParams& params);

}  // namespace gatewalk::dynamics
