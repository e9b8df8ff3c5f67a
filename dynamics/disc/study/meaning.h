// SPDX-License-Identifier: MIT
#pragma once
/// What the numbers of a scene mean: the speed of its body, the lateral spread by the random force,
/// the resistance of the beams, the time available. Everything is computed in closed form except
/// two roots; only deciding_numbers() simulates the gate.

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "dynamics/disc/params.h"

namespace gatewalk::dynamics {

/// Standard gravity (m/s^2; 3rd General Conference on Weights and Measures, 1901). The model has no
/// weight; gravity only serves to compare a scene with walkers on Earth.
inline constexpr double kGravity = 9.80665;

/// How a deflected beam comes to rest once it is released.
struct RingDown {
  double period = 0.0;  // s, time between swings on the same side; infinite if the beam creeps
  double kept = 0.0;    // angle of the next swing / angle of a swing; 0 if the beam creeps
  /// s, half-life of the angle, or of the swings, in the long run; infinite if undamped or not
  /// driven back
  double half = 0.0;
};
[[nodiscard]] RingDown ring_down(const GateParams& p, Side side);

/// A body on the middle line that slowly presses both beams forward.
struct BeamsOnTheMiddle {
  /// N, largest resistance of the beams; infinite if the body covers the joints
  double resistance = 0.0;
  double angle = 0.0;  // rad, angle of a beam at the largest resistance
  /// rad, angle where the beams balance the propulsion; NaN if the body gets past
  double held_angle = 0.0;
};
[[nodiscard]] BeamsOnTheMiddle beams_on_the_middle(const GateParams& p);

/// The standard deviation of x (m) after `seconds` for a body at rest sideways, under the random
/// force and without beams. Each draw is held for 1/random_rate from the start on. More than a
/// million draws are computed in groups.
[[nodiscard]] double shaken_sideways(const GateParams& p, double seconds);

struct Meaning {
  double top_speed = 0.0;       // m/s, propulsion / drag, far from gates; infinite without drag
  double top_speed_time = 0.0;  // s, from rest to 95 % of the top speed
  double passage = 0.0;         // s, from the start through a gate without beams; infinite: never
  double passage_speed = 0.0;   // m/s, speed at the end of the passage; NaN: never there
  double shaken = 0.0;  // m, shaken_sideways over the passage, or over the time limit if shorter
  double draws_per_length = 0.0;  // draws of the random force while the body moves by 2 R
  /// v^2 / (g R), R in place of a leg's length, v the top speed, else the passage's
  double froude = 0.0;
  double push_per_weight = 0.0, random_per_weight = 0.0;
  double passages_waited = 0.0;  // time limit / passage
  BeamsOnTheMiddle beams;
  std::array<RingDown, 2> ring_down;  // by Side
};
/// Computes the meaning of a scene. Throws InvalidParameter as validate() does.
[[nodiscard]] Meaning meaning_of(const GateParams& p, const BodyState& start);

/// What becomes of a body at a gate, on either side.
enum class GateFate : std::uint8_t { crosses, leaves, trapped };

/// A number of the scene near a threshold: all runs with 1 % less of it end in one way, all runs
/// with 1 % more in another. Such thresholds occur with little noise; a measured number is seldom
/// known to 1 %.
struct Deciding {
  std::string_view words;  // "the stiffness" (of both beams)
  GateFate less, more;     // fate of all runs with 1 % less, with 1 % more
};
/// Finds the deciding numbers: runs the gate from `start` with 1 % less and 1 % more of each number
/// in turn, once without a random force, else up to 20 times. A number is not deciding if its runs
/// end differently among themselves.
[[nodiscard]] std::vector<Deciding> deciding_numbers(const GateParams& p, const BodyState& start);

}  // namespace gatewalk::dynamics
