// SPDX-License-Identifier: MIT
#pragma once
/// run.method = "auto": chooses the cheapest method and setting that is accurate enough for a
/// scene.

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "dynamics/disc/study/accuracy.h"

namespace gatewalk::dynamics {

/// The result of a pilot study.
struct Choice {
  struct Tried {
    Setting setting;
    double work = 0.0;  // expected microseconds per trial, from the number of evaluations
    /// Weak error of the outcomes against `reference`: the mean over the starts, so that errors of
    /// different starts cannot cancel. NaN if faults ruled the setting out before.
    WeakError error{.total_variation = std::numeric_limits<double>::quiet_NaN()};
    /// Upper bound of the standard error of `error`; also the smallest error that this number of
    /// trials can show.
    double uncertainty = std::numeric_limits<double>::quiet_NaN();
    Verdict verdict = Verdict::fine;
    bool fits = false;  // fine, and total variation + uncertainty <= run.tolerance
  };
  GateParams params;         // the scene with the method and setting chosen
  std::vector<Tried> tried;  // cheapest first; if `met`, the last one is chosen
  /// The reference of all comparisons, chosen if not `met`: `event` at 1e-5 units of length
  /// (Scale); if `event` cannot run the scene, `stable` at 1/50 of a hold, which then has no
  /// independent check.
  Setting reference;
  Verdict reference_verdict = Verdict::fine;  // if not fine, nothing fits
  std::int64_t trials = 0;                    // trials of the pilot
  bool met = false;                           // whether a setting was shown to be accurate enough
};

/// Called after each piece of a pilot; may throw to stop.
using PilotProgress =
    std::function<void(const Setting& setting, std::int64_t done, std::int64_t trials)>;

/// Chooses a method. Tries settings of stable, moreau and event, cheapest first, on the same pilot
/// trials from `starts` (divided evenly) as a reference, until one is accurate enough. Settings
/// that a method refuses are skipped. Costs are counted, not timed, so the same scene and seed give
/// the same choice on any machine. Throws InvalidParameter if the scene is impossible, or no method
/// or no reference can run it; std::invalid_argument without starts or for a start outside the
/// gate.
[[nodiscard]] Choice choose_method(const GateParams& p, std::span<const BodyState> starts,
                                   std::uint64_t seed, const PilotProgress& progress = {});

}  // namespace gatewalk::dynamics
