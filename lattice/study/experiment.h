// SPDX-License-Identifier: MIT
#pragma once
/// How many trials an experiment needs to tell a scene from its prediction, or two scenes apart.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "lattice/pool/pooled_prediction.h"
#include "lattice/statistics/ending_shares.h"
#include "lattice/statistics/power.h"

namespace gatewalk::lattice {

struct ExperimentOptions {
  PowerGoal goal{};
  std::optional<std::int64_t> trials{};  // that there will be (of each scene): what do they show?
  std::uint64_t seed = 1;                // of simulated experiments
};

/// What it takes to see a difference. Of an ending's share, more or fewer than predicted: the worse
/// of both.
struct Effect {
  double difference = 0.0;  // of a share, or total variation
  /// None: more than kMostPlanned, or there is no such difference. Of an ending by itself, or of
  /// the final gates; and where all endings are looked at, each at its part of the level.
  std::optional<std::int64_t> trials{}, trials_of_all{};
  std::optional<double> power{};  // of the options' trials, by itself
  bool within_error = false;      // the prediction itself may be as much off
};

inline constexpr std::array kShareDifferences{0.02, 0.05, 0.10, 0.20};
inline constexpr std::array kTotalVariations{0.05, 0.10, 0.20};
inline constexpr std::array kGroupDifferences{0.05, 0.10, 0.20};  // between two groups

struct EndingPlan {
  std::array<Effect, kShareDifferences.size()> effects;
  SmallestDifference least{}, least_of_all{};  // that the options' trials show
  /// Two groups, one of which ends as predicted, the other so many points more or less often:
  /// trials of each (Fisher's exact test).
  std::array<Effect, kGroupDifferences.size()> of_groups;
};

/// Places in kAllEndingNames of the endings that one of the two predictions does not rule out.
[[nodiscard]] std::vector<std::size_t> endings_to_look_at(const StartAnswer& a,
                                                          const StartAnswer& b);

/// One experiment against a prediction.
struct ExperimentPlan {
  std::array<EndingPlan, kAllEndingNames.size()> endings;   // as kAllEndingNames
  std::array<Effect, kTotalVariations.size()> final_gates;  // hardest_to_see
  std::optional<double> least_total_variation{};            // that the options' trials show
};
[[nodiscard]] ExperimentPlan plan_experiment(const StartAnswer& prediction,
                                             const ExperimentOptions& options);

/// Two experiments against each other, with so many trials each.
struct TwoScenesPlan {
  std::array<Effect, kAllEndingNames.size()> endings;  // second less first; as kAllEndingNames
  Effect final_gates;
};
/// Throws std::invalid_argument for fields of different sizes.
[[nodiscard]] TwoScenesPlan tell_apart(const StartAnswer& first, const StartAnswer& second,
                                       const ExperimentOptions& options);

}  // namespace gatewalk::lattice
