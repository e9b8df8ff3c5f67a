// SPDX-License-Identifier: MIT
#pragma once
/// Speed against accuracy on one scene: for every setting of every method, the time of a trial on
/// one thread and the error against a reference under the same noise (accuracy.h).

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/disc/study/accuracy.h"

namespace gatewalk::dynamics {

struct WorkPrecisionOptions {
  std::string label;                 // name of the scene
  std::vector<std::string> methods;  // from chart_methods()
  std::int64_t trials = 100'000;     // per setting
  std::int64_t rounds = 10;          // rounds of timing, after one warm-up round
  std::uint64_t seed = 1;
};

/// The errors of trials against other trials under the same noise.
struct Errors {
  WeakError outcomes, columns;
  StrongError strong;
};

/// The cost and the error of one setting.
struct ChartPoint {
  Setting setting;
  Verdict verdict = Verdict::refused;
  std::string refusal;  // why the setting was refused; then all else is unset
  Health health;
  std::int64_t out_of_work = 0;
  Errors errors;                     // against the reference
  std::vector<double> microseconds;  // per trial, one value per round

  [[nodiscard]] bool ran() const { return verdict != Verdict::refused; }
  /// The least time of a trial (microseconds) over the rounds; NaN if nothing was timed.
  [[nodiscard]] double least_microseconds() const;
  /// The median time of a trial (microseconds) over the rounds; NaN if nothing was timed.
  [[nodiscard]] double median_microseconds() const;
  /// The mean number of steps of a trial; NaN if nothing ran.
  [[nodiscard]] double steps_per_trial() const;
  /// The mean number of evaluations of a trial; NaN if nothing ran.
  [[nodiscard]] double evaluations_per_trial() const;
};

/// The reference of all settings, with its own error.
struct Reference {
  Setting setting;       // reference_setting
  Setting second;        // a tolerance ten times coarser
  Setting other_method;  // `stable` at its finest
  Verdict verdict = Verdict::fine;
  double evaluations_per_trial = 0.0;
  std::array<std::int64_t, kOutcomes> outcomes{};  // trials, by Outcome
  Errors own;                                      // errors of the second setting
  /// Errors of the other method; outcomes.total_variation is NaN if that method refuses the scene.
  Errors other;

  [[nodiscard]] std::int64_t operator[](Outcome outcome) const {
    return outcomes[static_cast<std::size_t>(outcome)];
  }
};

struct WorkPrecision {
  std::string label;
  GateParams params;
  std::int64_t trials = 0, timed_trials = 0;  // slow settings time fewer trials
  Reference reference;
  std::vector<ChartPoint> points;  // method by method, from coarse to fine

  /// The smallest total variation that the reference's own error allows to be shown, for outcomes
  /// and for columns.
  [[nodiscard]] double outcome_limit() const;
  [[nodiscard]] double column_limit() const;
  /// The smallest strong error that can be shown, for one of StrongError's medians; infinite if the
  /// two references have parted.
  [[nodiscard]] double strong_limit(double StrongError::*median) const;
  /// The smallest strong error of positions (m) that can be shown, at least rounding error.
  [[nodiscard]] double position_limit() const;
  /// The smallest total variation of a setting that stands out from the reference's error and from
  /// chance.
  [[nodiscard]] double outcome_bound(const Errors& e) const;
  [[nodiscard]] double column_bound(const Errors& e) const;

  /// The cheapest setting without faults whose outcomes are shown to be within run.tolerance; null
  /// if there is none.
  [[nodiscard]] const ChartPoint* cheapest() const;
};

/// Throws InvalidParameter if the scene can have no reference: the gate is too short for its beams,
/// or `event` refuses the scene.
void require_reference(const GateParams& p);

/// Runs every setting of the methods from `start`, and times them round by round on this thread.
/// All else runs on all threads of the current TBB arena, with the same results for any number of
/// them. `work` hears of each setting, and up to about five times a second during timing. Throws as
/// require_reference, and std::invalid_argument for a method without settings or for no trials.
[[nodiscard]] WorkPrecision work_precision(const GateParams& p, const BodyState& start,
                                           const WorkPrecisionOptions& options,
                                           const Work& work = {});

}  // namespace gatewalk::dynamics
