// SPDX-License-Identifier: MIT
#pragma once
/// One run in full: every step of the method, with the forces and energies behind it.

#include <array>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <vector>

#include "dynamics/disc/gate.h"

namespace gatewalk::dynamics {

/// Energies (J) at one moment; work and losses since the run began.
struct Energies {
  double body = 0.0;                // kinetic
  std::array<double, 2> beams{};    // kinetic
  std::array<double, 2> elastic{};  // Eq. (14), beam by beam
  double propulsion_work = 0.0;
  double random_work = 0.0;
  double hit_loss = 0.0;  // taken by hits
  double lost = 0.0;      // by hits, dampers and drag together: what came in less what is there

  [[nodiscard]] double mechanical() const {
    return body + beams[kLeft] + beams[kRight] + elastic[kLeft] + elastic[kRight];
  }
};

/// What a beam and the disc do to each other in a step.
enum class ContactMode : std::uint8_t {
  free,
  hit,   // the impact law acted
  held,  // a constraint at the end of the step (Sec. II-B, "constraint method")
};

/// How things stand at the end of a step; the first sample is the start.
struct TraceSample {
  double time = 0.0;  // s since the run began
  GateState state;    // in the gate's own frame
  // During the step that ends here:
  double random_force = 0.0;  // N
  std::array<double, 2> beam_force{
      0.0, 0.0};  // N (x, y), mean force of both beams on the disc, hits included
  std::array<double, 2> impulse{0.0, 0.0};  // N s, of its hits, left and right
  std::array<ContactMode, 2> contact{};
  // Now:
  std::array<ContactKind, 2> nearest{};  // the part of each beam that is nearest to the disc
  std::array<double, 2> gap{};           // m
  Energies energy;
};

struct GateTrace {
  GateRun run;
  std::vector<TraceSample> samples;
};

/// A trace has more samples than were allowed for.
class TraceTooLong : public std::length_error {
 public:
  using std::length_error::length_error;
};

/// run_gate, the same to the last bit, with everything that it passes over. Of contacts in method
/// `penalty`, which are springs, it only has beam_force; their energy counts as lost while it is in
/// them. Throws TraceTooLong instead of the sample after the `most_samples`-th.
[[nodiscard]] GateTrace trace_gate(
    const GateParams& p, const Method& method, const BodyState& start, RandomForce& force,
    std::size_t most_samples = std::numeric_limits<std::size_t>::max());

}  // namespace gatewalk::dynamics
