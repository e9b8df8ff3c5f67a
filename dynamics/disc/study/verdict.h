// SPDX-License-Identifier: MIT
#pragma once
/// A one-word verdict on a method for a scene: the worst fault of its runs.

#include <array>
#include <cstdint>
#include <string_view>

#include "dynamics/disc/ensemble.h"

namespace gatewalk::dynamics {

/// The verdicts, from good to bad. `missed_hit` is for scenes whose hits are known in advance.
enum class Verdict : std::uint8_t {
  fine,
  missed_hit,    // an expected hit did not occur, or an unexpected hit did
  no_formula,    // contacts for which the method has no formula occurred
  too_fast,      // disc or beam moved so far in a step that hits may be missed
  outcomes,      // a better method gives other outcomes
  energy,        // energy was created
  penetration,   // the disc sank into a beam by more than 1 % of its radius
  beyond_bound,  // steps beyond the method's stability bound; may cause those above
  stuck,         // hits accumulated, or the run reached the limit of work
  not_finite,
  refused,  // the method refuses the scene (InvalidParameter)
};
inline constexpr std::array<std::string_view, 11> kVerdictNames{
    "ok",          "missed hit",   "no formula", "too fast",   "outcomes off", "energy",
    "penetration", "beyond bound", "stuck",      "not finite", "refused"};
[[nodiscard]] inline std::string_view name_of(Verdict v) {
  return kVerdictNames[static_cast<std::size_t>(v)];
}

/// The sign by which a user of `gate` and similar commands recognises a verdict: the key in the
/// status and the words of the warning. A missed hit has no sign; a refused scene has no result.
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

/// The worst fault that more than `permitted` (a share) of the runs showed. Broken runs and runs at
/// the limit of work are never permitted. Contacts without a formula are compared with the number
/// of steps.
[[nodiscard]] Verdict judge(const Health& health, std::int64_t out_of_work, double permitted);

}  // namespace gatewalk::dynamics
