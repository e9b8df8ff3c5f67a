#pragma once
/// Many gate runs at once, and the record of how far they can be trusted.

#include <cstdint>
#include <limits>

#include "dynamics/gate.h"

namespace gatewalk::dynamics {

/// Trials first, first + 1, ... first + count - 1. A trial is named by its number, so any split
/// over calls, threads or machines gives the same trials.
struct TrialRange {
  std::int64_t first = 0;
  std::int64_t count = 0;
};

/// The force of trial number `trial` from one start.
[[nodiscard]] RandomForce gate_force(const GateParams& p, std::uint64_t seed, std::int64_t trial);

/// Trial number `trial` from one start: the same run whoever asks for it. `most_work` as in
/// run_gate.
[[nodiscard]] GateRun run_gate_trial(
    const GateParams& p, const Method& method, const BodyState& start, std::uint64_t seed,
    std::int64_t trial, std::int64_t most_work = std::numeric_limits<std::int64_t>::max());

/// What went wrong, or nearly, over many runs. A run is counted as
/// - penetrating: the disc sank into a beam by more than 1 % of its radius;
/// - creating energy: energy less work done rose by more than 1e-4 of propulsion * traverse_y plus
///   the largest kinetic energy of the body;
/// - fast: disc or beam tip moved over half a radius in one step, so hits may have been missed;
/// - unstable: steps longer than the method's stability bound for free beams were taken;
/// - broken: the state stopped being finite.
/// What no single run can show, that the method itself shapes the outcomes, a sample shows that is
/// run again by a better method (check_outcomes in accuracy.h): outcome_error, if somebody looked.
struct Health {
  /// Share of the steps in which hits may pile up until they are forced to end; `stable` needs it
  /// about once in a million steps where it is sound.
  static constexpr double kPermittedHolds = 1e-3;

  std::int64_t runs = 0;
  std::int64_t penetrating = 0;
  std::int64_t creating_energy = 0;
  std::int64_t fast = 0;
  std::int64_t unstable = 0;
  std::int64_t broken = 0;
  std::int64_t undefined_contacts = 0;
  std::int64_t forced_holds = 0;
  std::int64_t impacts = 0;
  std::int64_t steps = 0;
  std::int64_t evaluations = 0;
  double worst_penetration = 0.0;     // m
  double worst_energy_created = 0.0;  // J
  double worst_speed = 0.0;           // m/s
  std::int64_t checked_trials = 0;    // run again by a better method
  double outcome_error = 0.0;  // total variation of their outcomes that chance does not explain

  void add(const GateParams& p, const GateRun& run);
  Health& operator+=(const Health& other);
  [[nodiscard]] bool piled_up() const {
    return static_cast<double>(forced_holds) > kPermittedHolds * static_cast<double>(steps);
  }
  /// Outcomes that are off by more than this are a fault.
  static constexpr double kPermittedOutcomeError = 0.02;
  [[nodiscard]] bool outcomes_off() const { return outcome_error > kPermittedOutcomeError; }
  /// No run penetrated, created energy, was too fast for its step, took unstable steps, broke or
  /// met a contact that its method has no formula for, hits did not pile up, and a better method
  /// was not seen to give other outcomes.
  [[nodiscard]] bool clean() const {
    return penetrating == 0 && creating_energy == 0 && fast == 0 && unstable == 0 && broken == 0 &&
           undefined_contacts == 0 && !piled_up() && !outcomes_off();
  }
};

/// Outcomes of single-gate trials.
struct GateTally {
  std::int64_t trials = 0;
  std::int64_t traversed_left = 0;  // the left beam had the larger deflection (Sec. III-B)
  std::int64_t traversed_right = 0;
  std::int64_t traversed_even = 0;  // both deflected equally, to the last bit
  std::int64_t exited_left = 0;
  std::int64_t exited_right = 0;
  std::int64_t trapped = 0;
  std::int64_t broken = 0;
  Health health;

  [[nodiscard]] std::int64_t traversed() const {
    return traversed_left + traversed_right + traversed_even;
  }
  void add(const GateParams& p, const GateRun& run);
  GateTally& operator+=(const GateTally& other);
};

/// Runs `range` from one start, on all threads of the current TBB arena. Throws InvalidParameter
/// for a scene that cannot be run.
[[nodiscard]] GateTally run_gate_trials(const GateParams& p, const BodyState& start,
                                        std::uint64_t seed, TrialRange range);

}  // namespace gatewalk::dynamics
