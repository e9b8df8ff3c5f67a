// SPDX-License-Identifier: MIT
#pragma once
/// One run in full detail: every step of the method with its forces and energies.

#include <array>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <vector>

#include "dynamics/disc/gate.h"

namespace gatewalk::dynamics {

/// Energies (J) at one moment. Work and losses are counted from the start of the run.
struct Energies {
  double body = 0.0;                // kinetic
  std::array<double, 2> beams{};    // kinetic
  std::array<double, 2> elastic{};  // Eq. (14), for each beam
  double propulsion_work = 0.0;
  double random_work = 0.0;
  double hit_loss = 0.0;  // lost in hits
  double lost = 0.0;      // by hits, dampers and drag: work done less the energy present

  [[nodiscard]] double mechanical() const {
    return body + beams[kLeft] + beams[kRight] + elastic[kLeft] + elastic[kRight];
  }
};

/// The contact between a beam and the disc during a step.
enum class ContactMode : std::uint8_t {
  free,
  hit,   // the impact law acted
  held,  // a constraint at the end of the step (Sec. II-B, "constraint method")
};

/// The state at the end of a step; the first sample is the start.
struct TraceSample {
  double time = 0.0;  // s since the run began
  GateState state;    // in the gate's own frame
  // The next members describe the step that ends here.
  double random_force = 0.0;  // N
  std::array<double, 2> beam_force{
      0.0, 0.0};  // N (x, y), mean force of both beams on the disc, hits included
  std::array<double, 2> impulse{0.0, 0.0};  // N s, of the hits, left and right
  std::array<ContactMode, 2> contact{};
  // The next members describe the moment at the end.
  std::array<ContactKind, 2> nearest{};  // part of each beam that is nearest to the disc
  std::array<double, 2> gap{};           // m
  Energies energy;
};

struct GateTrace {
  GateRun run;
  std::vector<TraceSample> samples;
};

/// Thrown when a trace has more samples than allowed.
class TraceTooLong : public std::length_error {
 public:
  using std::length_error::length_error;
};

/// Simulates a run as run_gate does, to the last bit, and records every step. For method `penalty`,
/// whose contacts are springs, only beam_force describes the contacts, and the energy in the
/// springs counts as lost. Throws TraceTooLong in place of sample number `most_samples` + 1.
[[nodiscard]] GateTrace trace_gate(
    const GateParams& p, const Method& method, const BodyState& start, RandomForce& force,
    std::size_t most_samples = std::numeric_limits<std::size_t>::max());

}  // namespace gatewalk::dynamics
