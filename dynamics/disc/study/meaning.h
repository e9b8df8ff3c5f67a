// SPDX-License-Identifier: MIT
#pragma once
/// What the numbers of a scene amount to: how fast its body is, how far noise shakes it sideways,
/// what holds it, how long it may take. All of it follows from the scene in closed form, but for
/// two roots; only deciding_numbers() runs the gate.

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "dynamics/disc/params.h"

namespace gatewalk::dynamics {

/// Standard gravity (m/s^2; 3rd General Conference on Weights and Measures, 1901). The model has no
/// weight: this only tells how a scene compares with what walks on Earth.
inline constexpr double kGravity = 9.80665;

/// How a beam that was let go comes to rest.
struct RingDown {
  double period = 0.0;  // s, from swing to swing on the same side; infinite where it only creeps
  double kept = 0.0;    // of a swing's angle in the next one; 0 where it only creeps
  double half = 0.0;    // s in which its angle, or that of its swings, halves in the long run;
                        // infinite where nothing brings it back or stops it
};
[[nodiscard]] RingDown ring_down(const GateParams& p, Side side);

/// A body on the middle line that presses both beams forward, slowly.
struct BeamsOnTheMiddle {
  double resistance = 0.0;  // N, the most they resist with; infinite where it covers their joints
  double angle = 0.0;       // rad, of a beam there
  double held_angle = 0.0;  // rad at which they balance the propulsion; NaN where it gets past
};
[[nodiscard]] BeamsOnTheMiddle beams_on_the_middle(const GateParams& p);

/// What the random force does to a body that is at rest sideways: the standard deviation of x (m)
/// after `seconds`, without beams. Draws are held for 1/random_rate from the first moment on;
/// more than a million of them are taken in groups.
[[nodiscard]] double shaken_sideways(const GateParams& p, double seconds);

struct Meaning {
  double top_speed = 0.0;       // m/s, propulsion over drag: the open's; infinite without drag
  double top_speed_time = 0.0;  // s from rest to 95 % of it
  double passage = 0.0;         // s from the start through a gate without beams; infinite: never
  double passage_speed = 0.0;   // m/s at its end; NaN: never there
  double shaken = 0.0;  // m: shaken_sideways within the passage, or the time limit if that is less
  double draws_per_length = 0.0;  // of the random force while the body goes its own length, 2 R
  double froude = 0.0;  // v^2 / (g R), the radius for a leg's length: of the top speed, or of the
                        // passage's where there is none
  double push_per_weight = 0.0, random_per_weight = 0.0;
  double passages_waited = 0.0;  // time limit over passage
  BeamsOnTheMiddle beams;
  std::array<RingDown, 2> ring_down;  // by Side
};
/// Throws InvalidParameter as validate().
[[nodiscard]] Meaning meaning_of(const GateParams& p, const BodyState& start);

/// What becomes of a body, whichever side it takes.
enum class GateFate : std::uint8_t { crosses, leaves, trapped };

/// A number that sits on a step: 1 % more or less of it turns a gate that bodies cross into one
/// that keeps them. Little noise makes such steps; a measured number is seldom known to 1 %.
struct Deciding {
  std::string_view words;  // "the stiffness", of both beams
  GateFate less, more;     // of every run with 1 % less, 1 % more of it
};
/// Runs the gate from `start` with 1 % less and 1 % more of each number by itself: once without a
/// random force, else up to 20 times. Numbers with which runs end differently among themselves
/// decide nothing.
[[nodiscard]] std::vector<Deciding> deciding_numbers(const GateParams& p, const BodyState& start);

}  // namespace gatewalk::dynamics
