#pragma once
/// What beams that remember, and beams of neighbouring gates, change in the final gates, and what
/// they cost: the full dynamics at every fidelity under the same noise.

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/base/work.h"
#include "lattice/reference.h"
#include "lattice/scene/scene.h"
#include "lattice/scene/table4.h"
#include "lattice/statistics/compare.h"

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

/// `active` is enough while the total variation that it costs is no more than this: what is asked
/// of a good chain.
inline constexpr double kFidelityBound = 0.03;
/// What trials say about doing without memory or neighbours.
enum class Sufficiency { enough, cannot_tell, not_enough };

/// What a variant changes, of the final gates of the same trials.
struct FidelityChange {
  std::int64_t trials = 0;
  double changed = 0.0;   // share of the trials whose final gate is another one
  Comparison apart{};     // as if the noise were not shared
  Comparison in_pairs{};  // trial by trial

  /// How far the total variation seen may be from that of infinitely many trials, at 95 %: as much
  /// as chance makes of the pairs that differ (triangle inequality), and what 3 of N trials change
  /// when none of N shows it.
  [[nodiscard]] double uncertainty() const {
    return in_pairs.floor_total_variation_95 + 3.0 / static_cast<double>(trials);
  }
  /// Whether the total variation is within kFidelityBound with the uncertainty added, or beyond it
  /// with that taken off.
  [[nodiscard]] Sufficiency active_is() const;
};

/// One variant from one start.
struct FidelityRun {
  FieldTally tally;
  std::vector<std::int32_t> final_gates;   // of each trial, as FieldTrials has them
  double seconds_per_trial = 0.0;          // wall clock
  std::optional<FidelityChange> change{};  // against the first variant, which has none
};

/// `variant` against `base`, the same trials.
[[nodiscard]] FidelityChange fidelity_change(const FidelityRun& variant, const FidelityRun& base,
                                             std::uint64_t seed);

struct FidelityOfStart {
  PaperStart start;
  std::vector<FidelityRun> runs;  // as the variants

  /// Whether active is enough from here: the worse of what remember and all say.
  [[nodiscard]] Sufficiency active_is() const {
    return std::max(runs[1].change->active_is(), runs[2].change->active_is());
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
  std::vector<PaperStart> starts;
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
