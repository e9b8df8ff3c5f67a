#pragma once
/// run.method = "auto": the cheapest method and setting that a scene can do with.

#include <cstdint>
#include <span>
#include <vector>

#include "dynamics/accuracy.h"

namespace gatewalk::dynamics {

/// What a short pilot found.
struct Choice {
  struct Tried {
    Setting setting;
    double work = 0.0;  // expected microseconds per trial, from counted evaluations
    WeakError error;    // of the outcomes, against `event` at a tight tolerance
    Verdict verdict = Verdict::fine;
    bool fits = false;  // fine, and total variation + one standard error <= run.tolerance
  };
  GateParams params;         // the scene with the method and setting chosen
  std::vector<Tried> tried;  // cheapest first; the last one was chosen
  std::int64_t trials = 0;   // of the pilot
  bool met = false;          // false: nothing fits, the most accurate setting was taken
};

/// Tries settings of stable, moreau and event, cheapest first, on the same pilot trials from
/// `starts` (in turn) as a reference, until one is accurate enough. Cost is counted, not timed, so
/// that the same scene and seed give the same choice on any machine. Throws InvalidParameter when
/// no method can run the scene.
[[nodiscard]] Choice choose_method(const GateParams& p, std::span<const BodyState> starts,
                                   std::uint64_t seed);

}  // namespace gatewalk::dynamics
