// SPDX-License-Identifier: MIT
#pragma once
/// One word for how far a method can be trusted on a scene: the worst that its runs showed.

#include <array>
#include <cstdint>
#include <string_view>

#include "dynamics/disc/ensemble.h"

namespace gatewalk::dynamics {

/// From good to bad. `missed_hit` is for scenes whose hits are known beforehand.
enum class Verdict : std::uint8_t {
  fine,
  missed_hit,    // a hit that should have been was not, or the other way round
  no_formula,    // contacts for which the method has no formula
  too_fast,      // disc or beam moved so far in a step that hits may have been missed
  outcomes,      // a better method gives other outcomes
  energy,        // energy from nothing
  penetration,   // the disc sank into a beam by more than 1 % of its radius
  beyond_bound,  // steps longer than the method's stability bound for free beams: explains the
                 // above
  stuck,         // hits piled up or the run took more work than it was granted
  not_finite,
  refused,  // the method does not take the scene: InvalidParameter
};
inline constexpr std::array<std::string_view, 11> kVerdictNames{
    "ok",          "missed hit",   "no formula", "too fast",   "outcomes off", "energy",
    "penetration", "beyond bound", "stuck",      "not finite", "refused"};
[[nodiscard]] inline std::string_view name_of(Verdict v) {
  return kVerdictNames[static_cast<std::size_t>(v)];
}

/// How a user of `gate` and its like recognises a verdict: the number of the status, and what the
/// warning says. Of a missed hit there is no sign; who is refused gets no result.
struct Sign {
  std::string_view key, words;
};
inline constexpr std::array<Sign, kVerdictNames.size()> kSigns{
    {{"", ""},
     {"", "hits shorter than a step are missed, without a sign"},
     {"contacts_without_a_formula", "steps overlapped a joint, for which it has no formula"},
     {"runs_too_fast_for_the_step", "disc or beam moved over half a radius in one step"},
     {"outcome_error_seen", "a better method gives other outcomes"},
     {"runs_creating_energy", "energy appeared from nothing"},
     {"runs_penetrating_over_1_percent", "the disc sank into a beam"},
     {"runs_beyond_the_stability_bound", "the step is longer than the method's stability bound"},
     {"steps_forced_to_hold", "hits piled up and were forced to end, or runs take very long"},
     {"runs_not_finite", "runs stopped being finite numbers"},
     {"", "the method refuses the scene"}}};
[[nodiscard]] inline const Sign& sign_of(Verdict v) { return kSigns[static_cast<std::size_t>(v)]; }

/// The worst fault that more than `permitted` (a share) of the runs showed. No run may break or be
/// cut short; contacts without a formula are compared with the number of steps.
[[nodiscard]] Verdict judge(const Health& health, std::int64_t out_of_work, double permitted);

}  // namespace gatewalk::dynamics
