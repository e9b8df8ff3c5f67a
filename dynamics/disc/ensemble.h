// SPDX-License-Identifier: MIT
#pragma once
/// Many trials of a single gate.

#include <array>
#include <cstdint>
#include <limits>

#include "dynamics/base/work.h"
#include "dynamics/cells/health.h"
#include "dynamics/disc/gate.h"

namespace gatewalk::dynamics {

/// The random force of trial number `trial` from one start.
[[nodiscard]] RandomForce gate_force(const GateParams& p, std::uint64_t seed, std::int64_t trial);

/// Runs trial number `trial` from one start. The number alone determines the random force.
/// `most_work` as in run_gate.
[[nodiscard]] GateRun run_gate_trial(
    const GateParams& p, const Method& method, const BodyState& start, std::uint64_t seed,
    std::int64_t trial, std::int64_t most_work = std::numeric_limits<std::int64_t>::max());

/// Counts of the outcomes of single-gate trials. Tallies can be added in any order.
struct GateTally {
  std::int64_t trials = 0;
  TrialSet held;                                 // numbers of the trials, if run by range
  std::array<std::int64_t, kOutcomes> counts{};  // by Outcome
  Health health;

  [[nodiscard]] std::int64_t operator[](Outcome outcome) const {
    return counts[static_cast<std::size_t>(outcome)];
  }
  [[nodiscard]] std::int64_t traversed() const {
    return (*this)[Outcome::traversed_left] + (*this)[Outcome::traversed_right] +
           (*this)[Outcome::traversed_even];
  }
  [[nodiscard]] std::int64_t exited() const {
    return (*this)[Outcome::exited_left] + (*this)[Outcome::exited_right];
  }
  void add(const GateParams& p, const GateRun& run);
  /// Adds other trials. Throws std::invalid_argument, and changes nothing, if a trial would be
  /// counted twice.
  GateTally& operator+=(const GateTally& other);
};
/// Writes or reads a tally as bytes (base/bytes.h).
template <class Archive>
void each_part(Archive& archive, GateTally& tally) {
  archive(tally.trials, tally.held, tally.counts, tally.health);
}

/// Runs the trials of `range` from one start, on all threads of the current TBB arena. Throws
/// InvalidParameter for a scene that cannot be simulated.
[[nodiscard]] GateTally run_gate_trials(const GateParams& p, const BodyState& start,
                                        std::uint64_t seed, TrialRange range);

}  // namespace gatewalk::dynamics
