// SPDX-License-Identifier: MIT
#pragma once
/// The scene of one gate: body, beams, forces, contacts and time stepping. Defaults are those of
/// the paper's field study (Sec. III-C, Tables I and IV); where the paper is silent, the
/// documentation ("Departures from the paper") has the reasons.

#include <cmath>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace gatewalk::dynamics {

enum Side : int { kLeft = 0, kRight = 1 };

/// The body: a disc that slides over the ground without rotation.
struct Disc {
  double mass = 1.0;     // kg
  double radius = 10.0;  // m
};

/// The two hinged beams of a gate. Each turns about its joint against a spring and a damper.
struct Beams {
  double length = 25.0;            // m
  double mass = 0.1;               // kg
  double stiffness_left = 400.0;   // N m / rad
  double stiffness_right = 400.0;  // N m / rad
  double damping = 50.0;           // N m s / rad
  double joint_x = 25.0;           // m; joints at (+-joint_x, joint_y); half the gate's width
  double joint_y = 30.0;           // m

  [[nodiscard]] double stiffness(Side side) const {
    return side == kLeft ? stiffness_left : stiffness_right;
  }
  /// Moment of inertia of one beam about its joint (kg m^2): m L^2 / 3, that of a uniform rod.
  [[nodiscard]] double inertia() const { return mass * length * length / 3.0; }
};

/// The forces on the disc besides contact.
struct Forces {
  double propulsion = 8.0;    // N, along +y
  double random = 40.0;       // N, Rm of Eq. (1), along x
  double random_rate = 50.0;  // Hz; each draw is held for 1/random_rate
  double drag = 0.06;         // N s / m, D of Sec. III-C
};

/// The laws of contact.
struct ContactParams {
  double restitution = 0.8;         // -, side of a beam and joint pin, Sec. II-A
  double tip_restitution = 1.0;     // -, free end, Eq. (6): elastic
  double impulse_threshold = 0.04;  // N s, epsilon of Sec. II-B: weaker hits become constraints
};

inline constexpr double kPaperStep =
    0.004;  // s, Sec. II-B; in units of time (Scale) in other scenes

/// How a run is computed and when it ends.
struct RunParams {
  std::string method = "stable";  // a name of method_names()
  double step = 0.02;        // s, one step per draw of the random force; the paper's is kPaperStep
  double time_limit = 12.0;  // s, 3000 of the paper's steps; `paper` may end a step later
  double traverse_y = 60.0;  // m; beyond it a body has traversed; also the length of a gate
  double event_tolerance = 1e-2;  // m; for `event`: local error, and the lowest rebound simulated
  double tolerance = 0.005;       // -; for `auto`: permitted total variation of the outcomes
};

/// All numbers of the scene of one gate.
struct GateParams {
  Disc body;
  Beams beams;
  Forces forces;
  ContactParams contact;
  RunParams run;

  /// Distance between the joints (m): the width of a cell of the field.
  [[nodiscard]] double gate_width() const { return 2.0 * beams.joint_x; }
  /// Length of a gate along y (m): the length of a cell of the field.
  [[nodiscard]] double gate_length() const { return run.traverse_y; }
};

/// Position and velocity of the disc's centre, in the gate's own frame (joints at (+-joint_x,
/// joint_y)).
struct BodyState {
  double x = 0.0, y = 0.0;    // m
  double vx = 0.0, vy = 0.0;  // m/s
};

/// The scene's own units: a tenth of the radius, the body's mass, and fifty holds of the random
/// force. The unit of time is kept within a factor 4 of sqrt(M R / F), where F is the larger of
/// propulsion and random force. Every limit of the program that has a unit is a plain number in
/// these units. They are exactly 1 m, 1 kg and 1 s in the paper's scenes. If lengths, times and
/// masses of a scene are multiplied by powers of 4, so are the units and all results, bit for bit.
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

/// One numeric key of a scene: its public name with unit, its place in GateParams, its permitted
/// range and its meaning.
struct ParamInfo {
  std::string_view key;  // "body.mass_kg"
  double& (*ref)(GateParams&);
  double low, high;  // permitted range
  bool low_open;     // `low` itself is not permitted
  std::string_view meaning;

  [[nodiscard]] double get(const GateParams& p) const { return ref(const_cast<GateParams&>(p)); }
  [[nodiscard]] bool permits(double v) const {
    return std::isfinite(v) && v <= high && (low_open ? v > low : v >= low);
  }
  /// The permitted range in words: "(0, 1e+06]" or "[0, 1]".
  [[nodiscard]] std::string range() const;
};

/// The table of all numeric keys of GateParams. The scene reader, validate(), the provenance of a
/// matrix and the comparison of two scenes all use this table.
[[nodiscard]] std::span<const ParamInfo> gate_param_table();

/// The permitted values of `run.method`, apart from "auto".
[[nodiscard]] std::span<const std::string_view> method_names();

/// The exception for a value that no scene may have. `key()` is the key as the scene file names it.
class InvalidParameter : public std::invalid_argument {
 public:
  InvalidParameter(std::string key, const std::string& what)
      : std::invalid_argument(what), key_(std::move(key)) {}
  [[nodiscard]] const std::string& key() const { return key_; }

 private:
  std::string key_;
};

/// Throws InvalidParameter naming key, value and permitted values unless all numbers lie in the
/// ranges of the table, the method is known, the numbers fit together without overflow, and the
/// step fits a whole number of times into one hold of the random force.
void validate(const GateParams& params);

/// The time step (s) for a scene that gives none: 0.02 units of time (Scale) for `stable` and
/// `auto`, else kPaperStep of these units, shortened to fit a whole number of times into one hold
/// of the random force.
[[nodiscard]] double default_step(const GateParams& params);

/// The default of contact.impulse_threshold_Ns (N s): the paper's threshold in the scene's own
/// units (Scale), but at most three times the impulse that the propulsion (or a tenth of the random
/// force) gives in the paper's step.
[[nodiscard]] double default_impulse_threshold(const GateParams& params);
/// The default of run.event_tolerance_m (m), in the scene's own units (Scale). It is reduced by the
/// same factor as the impulse threshold where the latter is held down, because on a slow way errors
/// add up, and weigh more beside a small speed.
[[nodiscard]] double default_event_tolerance(const GateParams& params);

/// Whether the scene gives a key.
using IsNamed = std::function<bool(std::string_view key)>;

/// Sets the keys that a scene leaves out, derived from the keys that it gives, and returns their
/// names.
///
/// A scene that gives the body's mass or radius keeps the paper's proportions: lengths relative to
/// the radius, masses relative to the body's mass, and times set by the propulsion or, if not
/// given, by the random force, a stiffness or the rate. Beam tips meet, both beams are alike, a
/// gate is twice as long as its joints are deep, and the time limit is the paper's multiple of the
/// time that the propulsion takes from rest through an open gate.
///
/// A scene that gives neither has the paper's values, but the length of a gate follows from the
/// joints. Impulse threshold, event tolerance and step always follow from the scene. `start` holds
/// the paper's start on entry; its vy is scaled to the scene.
std::vector<std::string_view> fill_in(GateParams& params, BodyState& start, const IsNamed& named);

/// The number of steps in one hold of the random force: 1 / (random_rate * step). Throws
/// InvalidParameter unless this is a whole number.
[[nodiscard]] int steps_per_hold(const GateParams& params);

}  // namespace gatewalk::dynamics
