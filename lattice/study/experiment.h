// SPDX-License-Identifier: MIT
#pragma once
/// How many trials an experiment needs to detect a difference from a scene's prediction, or between
/// two scenes.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "lattice/pool/pooled_prediction.h"
#include "lattice/statistics/ending_shares.h"
#include "lattice/statistics/power.h"

namespace gatewalk::lattice {

/// Power, level and number of trials of an experiment.
struct ExperimentOptions {
  PowerGoal goal{};
  /// Planned number of trials (per scene); then results tell what they detect.
  std::optional<std::int64_t> trials{};
  std::uint64_t seed = 1;  // of simulated experiments
};

/// The number of trials that detect a difference. For an ending's share: the larger number of those
/// for more and for fewer than predicted.
struct Effect {
  double difference = 0.0;  // of a share, or total variation
  /// nullopt: more than kMostPlanned, or there is no such difference. `trials`: one ending tested
  /// alone, or the final gates. `trials_of_all`: all endings tested, each at its part of the level.
  std::optional<std::int64_t> trials{}, trials_of_all{};
  std::optional<double> power{};  // of the options' trials, tested alone
  bool within_error = false;      // the prediction's own error may be as large
};

inline constexpr std::array kShareDifferences{0.02, 0.05, 0.10, 0.20};
inline constexpr std::array kTotalVariations{0.05, 0.10, 0.20};
inline constexpr std::array kGroupDifferences{0.05, 0.10, 0.20};  // between two groups

/// Numbers of trials for one ending.
struct EndingPlan {
  std::array<Effect, kShareDifferences.size()> effects;
  SmallestDifference least{}, least_of_all{};  // that the options' trials detect
  /// Trials per group to detect that one of two groups differs from the prediction by this many
  /// points, more or fewer (Fisher's exact test).
  std::array<Effect, kGroupDifferences.size()> of_groups;
};

/// Indices in kAllEndingNames of the endings that at least one of the two predictions does not rule
/// out.
[[nodiscard]] std::vector<std::size_t> endings_to_look_at(const StartAnswer& a,
                                                          const StartAnswer& b);

/// Numbers of trials for one experiment against a prediction.
struct ExperimentPlan {
  std::array<EndingPlan, kAllEndingNames.size()> endings;   // by kAllEndingNames
  std::array<Effect, kTotalVariations.size()> final_gates;  // by hardest_to_see
  std::optional<double> least_total_variation{};            // that the options' trials detect
};
[[nodiscard]] ExperimentPlan plan_experiment(const StartAnswer& prediction,
                                             const ExperimentOptions& options);

/// Numbers of trials for two experiments against each other, per experiment.
struct TwoScenesPlan {
  std::array<Effect, kAllEndingNames.size()> endings;  // second minus first; by kAllEndingNames
  Effect final_gates;
};
/// Throws std::invalid_argument for fields of different sizes.
[[nodiscard]] TwoScenesPlan tell_apart(const StartAnswer& first, const StartAnswer& second,
                                       const ExperimentOptions& options);

}  // namespace gatewalk::lattice
