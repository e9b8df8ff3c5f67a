// SPDX-License-Identifier: MIT
#pragma once
/// What beams that remember, and beams of neighbouring gates, change in the final gates, and what
/// they cost: the full dynamics at every fidelity under the same noise.

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

/// What is run.
struct FidelityVariant {
  Scene scene;

  [[nodiscard]] std::string name() const;  // "active (moreau)"
};
/// The scene at fidelity active, remember and all by method moreau, and at active by the default
/// method, which shows what another integrator changes. The first one is what the others are
/// compared with. Their step is the scene's if it names run.step_s, else the method's default.
/// Throws InvalidParameter when one of them cannot be run.
[[nodiscard]] std::vector<FidelityVariant> fidelity_variants(const Scene& scene);

/// One variant from one start.
struct FidelityRun {
  FieldTally tally;
  std::vector<std::int32_t> final_gates{};  // of each trial, as FieldTrials has them
  double seconds_per_trial = 0.0;           // wall clock
  std::optional<PairedChange> change{};     // against the first variant, which has none
};

struct FidelityOfStart {
  dynamics::BodyState start;
  std::vector<FidelityRun> runs;  // as the variants

  /// Whether active is enough from here: the worse of what remember and all say.
  [[nodiscard]] Sufficiency active_is() const {
    return std::max(runs[1].change->without_is(), runs[2].change->without_is());
  }
};

struct FidelityStudy {
  std::vector<FidelityVariant> variants;
  std::int64_t trials = 0;              // per start and variant
  int threads = 0;                      // that seconds_per_trial had
  std::vector<FidelityOfStart> starts;  // as the options'

  [[nodiscard]] dynamics::Health health(std::size_t variant) const;  // over all starts
  [[nodiscard]] bool clean() const;                                  // of every variant
};

struct FidelityOptions {
  std::vector<dynamics::BodyState> starts;
  std::int64_t trials = 100;  // per start and variant
  std::uint64_t seed = 1;
};
/// A time per trial is the least of so many repeats, the variants' in turn.
inline constexpr std::int64_t kFidelityRepeats = 5;

/// Runs the variants (fidelity_variants) from every start, and times them. All but the times is the
/// same for any number of threads.
[[nodiscard]] FidelityStudy compare_fidelities(const std::vector<FidelityVariant>& variants,
                                               const FidelityOptions& options,
                                               const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
