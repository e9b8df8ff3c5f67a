// SPDX-License-Identifier: MIT
#pragma once
/// The record of how far runs can be trusted.

#include <array>
#include <cstdint>

namespace gatewalk::dynamics {

/// What went wrong, or nearly, over many runs. A run is counted as
/// - penetrating: the disc sank into a beam by more than 1 % of its radius;
/// - creating energy: energy less work done rose by more than 1e-4 of propulsion * traverse_y plus
///   the largest kinetic energy of the body;
/// - fast: disc or beam tip moved over half a radius in one step, so hits may have been missed;
/// - unstable: steps longer than the method's stability bound for free beams were taken;
/// - broken: the state stopped being finite.
/// What no single run can show, that the method itself shapes the outcomes, a sample shows that is
/// run again by a better method (Problem::check): outcome_error, if somebody looked.
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

/// One number of Health: a count or a largest value (the other is null), with its name in files,
/// unit and meaning.
struct HealthNumber {
  const char *key, *unit, *meaning;
  std::int64_t Health::*count = nullptr;
  double Health::*largest = nullptr;
  bool is_recent = false;  // older files have none
};
/// All of them, in the order of files. Counts add, of the others the largest stays.
inline constexpr std::array<HealthNumber, 16> kHealthNumbers{{
    {"runs", "1", "number of gate runs", &Health::runs},
    {"runs_penetrating_over_1_percent", "1",
     "gate runs in which the body sank into a beam by more than 1 % of its radius",
     &Health::penetrating},
    {"runs_creating_energy", "1", "gate runs in which energy appeared from nothing",
     &Health::creating_energy},
    {"runs_too_fast_for_the_step", "1",
     "gate runs in which body or beam moved over half a radius in one step", &Health::fast},
    {"runs_beyond_the_stability_bound", "1",
     "gate runs with steps longer than the method's bound of stability", &Health::unstable},
    {"runs_not_finite", "1", "gate runs whose state stopped being finite numbers", &Health::broken},
    {"contacts_without_a_formula", "1",
     "steps that overlapped a joint, for which the method has no formula",
     &Health::undefined_contacts},
    {"steps_forced_to_hold", "1", "steps in which hits piled up and were forced to end",
     &Health::forced_holds},
    {"worst_penetration_m", "m", "deepest overlap of body and beam", nullptr,
     &Health::worst_penetration},
    {"worst_energy_created_J", "J", "largest energy that appeared from nothing in a gate run",
     nullptr, &Health::worst_energy_created},
    {"worst_speed_m_per_s", "m/s", "highest speed of the body", nullptr, &Health::worst_speed},
    {"steps", "1", "number of time steps of all gate runs", &Health::steps},
    {"evaluations", "1", "number of evaluations of the forces in all gate runs",
     &Health::evaluations},
    {"impacts", "1", "number of impacts of body and beams in all gate runs", &Health::impacts},
    {"trials_checked", "1", "trials that were run again by a better method",
     &Health::checked_trials, nullptr, true},
    {"outcome_error_seen", "1",
     "total variation of outcomes between both methods, less two standard errors", nullptr,
     &Health::outcome_error, true},
}};

}  // namespace gatewalk::dynamics
