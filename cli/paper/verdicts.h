// SPDX-License-Identifier: MIT
#pragma once
/// Rules by which a claim of the paper counts as reproduced. With fewer trials a verdict is never
/// more certain.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace gatewalk::cli {

/// From best to worst.
enum class Verdict : std::uint8_t {
  reproduced,
  agrees,       // deviates by no more than the paper's 100 trials would show
  cannot_tell,  // there are too few trials here
  differs,
};
inline constexpr std::array<std::string_view, 4> kVerdictNames{"reproduced", "agrees",
                                                               "cannot tell", "differs"};
[[nodiscard]] inline std::string_view name_of(Verdict v) {
  return kVerdictNames[static_cast<std::size_t>(v)];
}
/// The verdict on a claim, by the first condition that is true: contradicted, confirmed, or
/// consistent with the paper's 100 trials (`agrees`); else cannot_tell.
[[nodiscard]] inline Verdict verdict_of(bool differs, bool reproduced, bool agrees = false) {
  if (differs) return Verdict::differs;
  if (reproduced) return Verdict::reproduced;
  return agrees ? Verdict::agrees : Verdict::cannot_tell;
}

/// The verdict on a claim without chance.
[[nodiscard]] inline Verdict holds_or_differs(bool holds) {
  return holds ? Verdict::reproduced : Verdict::differs;
}

inline constexpr std::int64_t kPaperTrials = 100;
/// Trials needed to reproduce a statement without a number, such as "never falls".
inline constexpr std::int64_t kEnoughTrials = 1000;

/// A share of trials with its 95 % interval.
struct Share {
  double value = 0.0, low = 0.0, high = 1.0;
  std::int64_t part = 0, whole = 0;  // whole = 0: value is NaN
};
[[nodiscard]] Share share_of(std::int64_t part, std::int64_t whole);
/// "46.3 % [45.6, 47.0]"
[[nodiscard]] std::string percent_text(const Share& s);

/// Compares our share with a number that the paper counted in 100 trials. Reproduced: our interval
/// lies within that of the paper's count. Differs: the intervals do not overlap. Otherwise it
/// agrees, if we have enough trials.
[[nodiscard]] Verdict against(std::int64_t paper_count, const Share& ours);

/// Whether b lies above a beyond chance: their 95 % intervals do not overlap.
[[nodiscard]] bool rises(const Share& a, const Share& b);
[[nodiscard]] inline bool falls(const Share& a, const Share& b) { return rises(b, a); }

/// Whether the paper's 100 trials would show the difference between two shares (two standard
/// errors). `counted_a` and `counted_b` are the shares of the 100 trials to which a and b refer.
[[nodiscard]] bool seen_with_100(const Share& a, const Share& b, double counted_a = 1.0,
                                 double counted_b = 1.0);

/// Whether more comparisons are significant than chance explains. Without any difference, two 95 %
/// intervals fail to overlap in one of a few hundred comparisons.
[[nodiscard]] inline bool more_than_chance(int found, int compared) {
  return found > 0.02 * compared;
}

/// A statement without a number, tested in many places.
struct Places {
  int of = 0;
  int hold = 0, fail = 0;  // beyond chance: confirmed, contradicted
  int seen = 0;            // of those that fail: visible in the paper's 100 trials

  /// With enough trials: differs if the statement holds in at most half of the places, or if more
  /// failures than chance explains are visible in 100 trials; reproduced if no more fail than
  /// chance explains (none, if `strict`); else agrees. With few trials: differs if more places fail
  /// than hold, and more than chance explains; else cannot_tell.
  [[nodiscard]] Verdict verdict(bool enough, bool strict = false) const;
};

/// Tests that traversal is rare (share `traversed`) and equally likely on both sides (share `right`
/// of the traversals). The paper's own numbers, 13 and 8 of 100, set the bounds: rare is below the
/// upper limit of 21 of 100; even is within two standard errors of one half for 21 traversals.
/// Reproduced: both intervals lie within these bounds, and `right` includes one half. Agrees:
/// within, without one half. Differs: an interval lies beyond its bounds.
[[nodiscard]] Verdict rare_and_even(const Share& traversed, const Share& right);

/// Several series along one axis, which rise according to the paper.
class Trend {
 public:
  /// Adds a series. `counted`: the share of all trials to which each share refers; empty: all.
  void add(const std::vector<double>& axis, const std::vector<Share>& s,
           const std::vector<double>& counted = {});
  /// Differs if more series than chance explains end below their start. With enough trials also
  /// differs if not most series end above their start, or if the paper's 100 trials would show a
  /// fall between two places of a series; reproduced if no place lies significantly below an
  /// earlier one; else agrees. With few trials otherwise: cannot_tell. `wiggles`: the paper allows
  /// falls, but fewer steps down than up.
  [[nodiscard]] Verdict verdict(bool wiggles = false) const;

  int series = 0, up = 0, down = 0;        // from first to last place, beyond chance
  int steps = 0, rising = 0, falling = 0;  // between neighbours, beyond chance
  int lower = 0, seen = 0;                 // falling pairs; of these, visible in 100 trials
  double largest_fall = 0.0, at = 0.0;     // the largest step down and where it begins

 private:
  std::int64_t least_trials_ = 0;
};

/// Several series that first rise, then fall according to the paper.
class RiseThenFall {
 public:
  void add(const std::vector<Share>& s);
  /// With enough trials: differs if no series significantly rises and falls, or if 100 trials would
  /// show more series going the other way than chance explains (falling before the top, rising
  /// after it, rising up to the last place, or only falling); reproduced if most rise and fall and
  /// none goes the other way; else agrees. With few trials: cannot_tell.
  [[nodiscard]] Verdict verdict() const;

  int series = 0, up = 0, both = 0,
      only_down = 0;           // to the top; also from there to the end; only falling
  int contrary = 0, seen = 0;  // series that go the other way; of these, visible in 100 trials

 private:
  std::int64_t least_trials_ = 0;
};

}  // namespace gatewalk::cli
