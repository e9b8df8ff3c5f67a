// SPDX-License-Identifier: MIT
#pragma once
/// The effect of beams that keep moving, and of the beams of neighbouring gates, on the final
/// gates, and their cost: the full dynamics at every fidelity under the same noise.

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/base/work.h"
#include "lattice/field/field_trials.h"
#include "lattice/scene/scene.h"
#include "lattice/statistics/paired_change.h"

namespace gatewalk::lattice {

/// A scene with one fidelity and method.
struct FidelityVariant {
  Scene scene;

  [[nodiscard]] std::string name() const;  // "active (moreau)"
};
/// The scene at fidelity active, remember and all by method moreau, and at active by the default
/// method, which shows the effect of another integrator. The first variant is the reference. The
/// step is run.step_s if the scene gives it, else the method's default. Throws InvalidParameter if
/// a variant cannot be run.
[[nodiscard]] std::vector<FidelityVariant> fidelity_variants(const Scene& scene);

/// The trials of one variant from one start.
struct FidelityRun {
  FieldTally tally;
  std::vector<std::int32_t> final_gates{};  // (trials) row * columns + column
  double seconds_per_trial = 0.0;           // wall clock
  std::optional<PairedChange> change{};     // against the first variant, which itself has none
};

/// The trials of all variants from one start.
struct FidelityOfStart {
  dynamics::BodyState start;
  std::vector<FidelityRun> runs;  // one per variant

  /// Whether fidelity active is enough from this start: the worse of the verdicts of remember and
  /// all.
  [[nodiscard]] Sufficiency active_is() const {
    return std::max(runs[1].change->without_is(), runs[2].change->without_is());
  }
};

/// The results of compare_fidelities().
struct FidelityStudy {
  std::vector<FidelityVariant> variants;
  std::int64_t trials = 0;              // per start and variant
  int threads = 0;                      // while seconds_per_trial was measured
  std::vector<FidelityOfStart> starts;  // one per start of the options

  [[nodiscard]] dynamics::Health health(std::size_t variant) const;  // over all starts
  [[nodiscard]] bool clean() const;  // true if all variants are clean
};

struct FidelityOptions {
  std::vector<dynamics::BodyState> starts;
  std::int64_t trials = 100;  // per start and variant
  std::uint64_t seed = 1;
};
/// The time per trial is the least of this number of repeats; the variants take turns.
inline constexpr std::int64_t kFidelityRepeats = 5;

/// Runs the variants (fidelity_variants) from every start, and times them. Only the times depend on
/// the number of threads.
[[nodiscard]] FidelityStudy compare_fidelities(const std::vector<FidelityVariant>& variants,
                                               const FidelityOptions& options,
                                               const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
