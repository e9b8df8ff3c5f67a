// SPDX-License-Identifier: MIT
#pragma once
/// The record of numerical faults, which says how far results can be trusted.

#include <array>
#include <cstdint>

namespace gatewalk::dynamics {

/// Numerical faults and near-faults, counted over many runs. A run counts as
/// - penetrating: the disc sank into a beam by more than 1 % of the disc's radius;
/// - creating energy: energy minus work done rose by more than 1e-4 of (propulsion * traverse_y +
///   the largest kinetic energy of the body);
/// - fast: the disc or a beam tip moved by more than half a radius in one step, so hits may have
///   been missed;
/// - unstable: steps were longer than the method's stability bound for free beams;
/// - broken: the state stopped being finite.
/// A single run cannot show that the numerical method itself distorts the outcomes. A sample of
/// trials repeated with a better method (Problem::check) shows such distortion: outcome_error.
struct Health {
  /// The largest permitted share of steps in which accumulating hits are forced to end. Sound runs
  /// of `stable` need one such step in about a million.
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
  std::int64_t checked_trials = 0;    // trials repeated with a better method
  double outcome_error = 0.0;  // total variation between the two methods' outcomes beyond chance

  Health& operator+=(const Health& other);
  [[nodiscard]] bool piled_up() const {
    return static_cast<double>(forced_holds) > kPermittedHolds * static_cast<double>(steps);
  }
  /// An outcome_error above this total variation is a fault.
  static constexpr double kPermittedOutcomeError = 0.02;
  [[nodiscard]] bool outcomes_off() const { return outcome_error > kPermittedOutcomeError; }
  /// Whether no fault was found: no run penetrated, created energy, moved too fast for the step,
  /// took unstable steps, broke, or met a contact for which the method has no formula; few steps
  /// were forced to end accumulating hits; and a better method gave no other outcomes.
  [[nodiscard]] bool clean() const {
    return penetrating == 0 && creating_energy == 0 && fast == 0 && unstable == 0 && broken == 0 &&
           undefined_contacts == 0 && !piled_up() && !outcomes_off();
  }
};

/// One number of Health with its name in files, unit and meaning. The number is either a count or a
/// largest value; the other pointer is null.
struct HealthNumber {
  const char *key, *unit, *meaning;
  std::int64_t Health::*count = nullptr;
  double Health::*largest = nullptr;
  bool is_recent = false;  // older files lack this number
};
/// All numbers of Health, in the order in which files list them. Adding two Health records sums the
/// counts and keeps the larger of the largest values.
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
