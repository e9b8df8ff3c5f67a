// SPDX-License-Identifier: MIT
#pragma once
/// When a claim of the paper counts as reproduced: fewer trials never make a verdict surer.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace gatewalk::cli {

/// From best to worst.
enum class Verdict : std::uint8_t {
  reproduced,
  agrees,       // it deviates by no more than the paper's 100 trials would show
  cannot_tell,  // the trials here are too few
  differs,
};
inline constexpr std::array<std::string_view, 4> kVerdictNames{"reproduced", "agrees",
                                                               "cannot tell", "differs"};
[[nodiscard]] inline std::string_view name_of(Verdict v) {
  return kVerdictNames[static_cast<std::size_t>(v)];
}
/// Of a claim that is seen not to hold, or else seen to hold, or else not by the paper's trials
/// (`agrees`), or nothing of this.
[[nodiscard]] inline Verdict verdict_of(bool differs, bool reproduced, bool agrees = false) {
  if (differs) return Verdict::differs;
  if (reproduced) return Verdict::reproduced;
  return agrees ? Verdict::agrees : Verdict::cannot_tell;
}

/// Of a claim that no chance decides.
[[nodiscard]] inline Verdict holds_or_differs(bool holds) {
  return holds ? Verdict::reproduced : Verdict::differs;
}

inline constexpr std::int64_t kPaperTrials = 100;
/// A statement without a number, such as "never falls", is reproduced only by so many trials.
inline constexpr std::int64_t kEnoughTrials = 1000;

/// A share of trials with its 95 % interval.
struct Share {
  double value = 0.0, low = 0.0, high = 1.0;
  std::int64_t part = 0, whole = 0;  // of none at all: value is not a number
};
[[nodiscard]] Share share_of(std::int64_t part, std::int64_t whole);
/// "46.3 % [45.6, 47.0]"
[[nodiscard]] std::string percent_text(const Share& s);

/// A number that the paper counted in 100 trials: reproduced when all of our interval lies within
/// that of the paper's count, differs when they do not meet; else, on enough trials, it agrees.
[[nodiscard]] Verdict against(std::int64_t paper_count, const Share& ours);

/// b lies above a beyond chance: their 95 % intervals do not meet.
[[nodiscard]] bool rises(const Share& a, const Share& b);
[[nodiscard]] inline bool falls(const Share& a, const Share& b) { return rises(b, a); }

/// Whether the paper would see the difference (two standard errors), if each share is one of its
/// 100 trials, or of those that are `counted` of them (shares of all trials).
[[nodiscard]] bool seen_with_100(const Share& a, const Share& b, double counted_a = 1.0,
                                 double counted_b = 1.0);

/// Of many comparisons some come out beyond chance by chance: two intervals of 95 % that do not
/// meet are one in a few hundred where nothing differs.
[[nodiscard]] inline bool more_than_chance(int found, int compared) {
  return found > 0.02 * compared;
}

/// A statement without a number, looked at in many places.
struct Places {
  int of = 0;
  int hold = 0, fail = 0;  // beyond chance: as said, the other way round
  int seen = 0;            // of those that fail: the paper would see it

  /// Differs, on enough trials, when it does not hold in most places (nowhere, if there are none)
  /// or the paper would see more of them fail than chance makes; on few, when more fail than hold
  /// and than chance makes. Reproduced, on enough trials, when no more fail than by chance, or none
  /// (`strict`). Else, on enough trials, it agrees.
  [[nodiscard]] Verdict verdict(bool enough, bool strict = false) const;
};

/// That traversal is rare and as likely on both sides, of all and of the traversals on the right.
/// Each is measured by what the paper calls so, 13 and 8 of 100: rare is what lies below the
/// interval's upper end of 21 of 100; even, what 21 traversals do not tell from one half by two
/// standard errors. Reproduced when both intervals lie within these bounds and the second holds one
/// half, agrees when it does not hold one half, differs when one lies beyond its bounds.
[[nodiscard]] Verdict rare_and_even(const Share& traversed, const Share& right);

/// Several series along one axis, on which the paper says that they rise.
class Trend {
 public:
  /// `counted`: what share of all trials each share is of; empty: of all.
  void add(const std::vector<double>& axis, const std::vector<Share>& s,
           const std::vector<double>& counted = {});
  /// Differs when more series than by chance end beyond chance below their start; and on enough
  /// trials, when not most end above it or the paper would see a fall between two places of a
  /// series. Reproduced, on enough trials, when no place lies beyond chance below an earlier one.
  /// Else, on enough trials, it agrees. `wiggles`: the paper allows falls, but not as many steps
  /// down as up.
  [[nodiscard]] Verdict verdict(bool wiggles = false) const;

  int series = 0, up = 0, down = 0;        // from end to end, beyond chance
  int steps = 0, rising = 0, falling = 0;  // between neighbours, beyond chance
  int lower = 0, seen = 0;                 // pairs of places that fall; the paper would see that
  double largest_fall = 0.0, at = 0.0;     // the largest step down and where it begins

 private:
  std::int64_t least_trials_ = 0;
};

/// Several series of which the paper says that they first rise, then fall.
class RiseThenFall {
 public:
  void add(const std::vector<Share>& s);
  /// Differs, on enough trials, when no series does both beyond chance, or when the paper would see
  /// one go the other way: fall before its top, rise after it, rise up to its last place, or only
  /// fall. Reproduced, on enough trials, when most do both and none goes the other way beyond
  /// chance. Else, on enough trials, it agrees: what fails to fall, 100 trials would not show.
  [[nodiscard]] Verdict verdict() const;

  int series = 0, up = 0, both = 0,
      only_down = 0;           // from the start to the top, from there to the end
  int contrary = 0, seen = 0;  // series that go the other way

 private:
  std::int64_t least_trials_ = 0;
};

}  // namespace gatewalk::cli
