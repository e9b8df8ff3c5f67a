// SPDX-License-Identifier: MIT
#pragma once
/// Speed against accuracy on one scene: every method over its own settings, the time of a trial on
/// one thread, and the error against a reference under the same noise (accuracy.h).

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/disc/study/accuracy.h"

namespace gatewalk::dynamics {

struct WorkPrecisionOptions {
  std::string label;                 // what the scene is called
  std::vector<std::string> methods;  // of chart_methods()
  std::int64_t trials = 100'000;     // per setting
  std::int64_t rounds = 10;          // of timing, after one that warms up
  std::uint64_t seed = 1;
};

/// How far trials are from others under the same noise.
struct Errors {
  WeakError outcomes, columns;
  StrongError strong;
};

/// What one setting costs and how wrong it is.
struct ChartPoint {
  Setting setting;
  Verdict verdict = Verdict::refused;
  std::string refusal;  // why, if it was refused; then nothing else is known
  Health health;
  std::int64_t out_of_work = 0;
  Errors errors;                     // against the reference
  std::vector<double> microseconds;  // per trial, one value per round

  [[nodiscard]] bool ran() const { return verdict != Verdict::refused; }
  /// NaN where nothing was timed or run.
  [[nodiscard]] double least_microseconds() const;
  [[nodiscard]] double median_microseconds() const;
  [[nodiscard]] double steps_per_trial() const;
  [[nodiscard]] double evaluations_per_trial() const;
};

/// What all settings are compared with, and how far it can be trusted.
struct Reference {
  Setting setting;       // reference_setting
  Setting second;        // ten times coarser
  Setting other_method;  // `stable` at its finest
  Verdict verdict = Verdict::fine;
  double evaluations_per_trial = 0.0;
  std::array<std::int64_t, kOutcomes> outcomes{};  // trials, by Outcome
  Errors own;                                      // of the second one
  /// Of the other method; outcomes.total_variation is NaN where it refuses the scene.
  Errors other;

  [[nodiscard]] std::int64_t operator[](Outcome outcome) const {
    return outcomes[static_cast<std::size_t>(outcome)];
  }
};

struct WorkPrecision {
  std::string label;
  GateParams params;
  std::int64_t trials = 0, timed_trials = 0;  // settings that take long: fewer are timed
  Reference reference;
  std::vector<ChartPoint> points;  // method by method, from coarse to fine

  /// What cannot be told from the reference's own error.
  [[nodiscard]] double outcome_limit() const;
  [[nodiscard]] double column_limit() const;
  /// Of one of StrongError's medians; infinite when the reference has parted from itself.
  [[nodiscard]] double strong_limit(double StrongError::*median) const;
  /// The same for positions (m), and not below what is rounding.
  [[nodiscard]] double position_limit() const;
  /// What a setting's error must reach to stand out from that limit and from chance.
  [[nodiscard]] double outcome_bound(const Errors& e) const;
  [[nodiscard]] double column_bound(const Errors& e) const;

  /// The cheapest setting without faults whose outcomes are shown to be within run.tolerance; null
  /// if none is.
  [[nodiscard]] const ChartPoint* cheapest() const;
};

/// Throws InvalidParameter where a scene can have no reference: a gate too short for its beams, or
/// a method `event` that refuses it.
void require_reference(const GateParams& p);

/// Runs every setting of the methods from `start`, and times them round by round on this thread;
/// all else is done on all threads of the current TBB arena and the same for any number of them.
/// `work` is told of each setting, and looked up to some five times a second while times are
/// taken. Throws as require_reference, and std::invalid_argument for a method without settings, or
/// no trials.
[[nodiscard]] WorkPrecision work_precision(const GateParams& p, const BodyState& start,
                                           const WorkPrecisionOptions& options,
                                           const Work& work = {});

}  // namespace gatewalk::dynamics
