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

/// Several series along one axis, on which the paper says that they rise.
class Trend {
 public:
  /// `counted`: what share of all trials each share is of; empty: of all.
  void add(const std::vector<double>& axis, const std::vector<Share>& s,
           const std::vector<double>& counted = {});
  /// Differs when a series ends beyond chance below its start, and, on enough trials, when none
  /// ends above it or the paper would see more steps down than chance makes. Reproduced, on enough
  /// trials, when most end above their start and no step goes down beyond chance (or the paper
  /// allows that: `wiggles`). Else, on enough trials, it agrees.
  [[nodiscard]] Verdict verdict(bool wiggles = false) const;

  int series = 0, up = 0, down = 0;  // from end to end, beyond chance
  int steps = 0, falling = 0, seen = 0;
  double largest_fall = 0.0, at = 0.0;  // the largest step down and where it begins

 private:
  std::int64_t least_trials_ = 0;
};

}  // namespace gatewalk::cli
