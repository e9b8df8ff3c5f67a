// SPDX-License-Identifier: MIT
#pragma once
/// run.method = "auto": the cheapest method and setting that a scene can do with.

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "dynamics/disc/study/accuracy.h"

namespace gatewalk::dynamics {

/// What a short pilot found.
struct Choice {
  struct Tried {
    Setting setting;
    double work = 0.0;  // expected microseconds per trial, from counted evaluations
    /// Of the outcomes, against `reference`: the mean over the starts, so that an error from one
    /// start cannot make up for another's. NaN when faults ruled the setting out before.
    WeakError error{.total_variation = std::numeric_limits<double>::quiet_NaN()};
    /// One standard error of it, from above; also says how little so many trials can show.
    double uncertainty = std::numeric_limits<double>::quiet_NaN();
    Verdict verdict = Verdict::fine;
    bool fits = false;  // fine, and total variation + uncertainty <= run.tolerance
  };
  GateParams params;         // the scene with the method and setting chosen
  std::vector<Tried> tried;  // cheapest first; the last one was chosen if `met`
  /// What all were compared with, chosen if not `met`: `event` at 1e-5 units of length (Scale) or,
  /// where that cannot run the scene, `stable` at 1/50 of a hold, which then vouches for itself.
  Setting reference;
  Verdict reference_verdict = Verdict::fine;  // otherwise nothing fits
  std::int64_t trials = 0;                    // of the pilot
  bool met = false;                           // false: nothing was shown to fit
};

/// Told after each piece of a pilot; may throw to stop.
using PilotProgress =
    std::function<void(const Setting& setting, std::int64_t done, std::int64_t trials)>;

/// Tries settings of stable, moreau and event, cheapest first, on the same pilot trials from
/// `starts` (shared out evenly) as a reference, until one is accurate enough. Settings that a
/// method refuses are left out. Cost is counted, not timed, so that the same scene and seed give
/// the same choice on any machine. Throws InvalidParameter when the scene is impossible, no method
/// can run it or no reference can; std::invalid_argument for no start or one outside the gate.
[[nodiscard]] Choice choose_method(const GateParams& p, std::span<const BodyState> starts,
                                   std::uint64_t seed, const PilotProgress& progress = {});

}  // namespace gatewalk::dynamics
