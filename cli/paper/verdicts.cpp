#include "cli/paper/verdicts.h"

#include <algorithm>
#include <cmath>

#include "cli/render/text.h"
#include "dynamics/share.h"

namespace gatewalk::cli {

Share share_of(std::int64_t part, std::int64_t whole) {
  if (whole == 0) return {std::nan(""), 0.0, 1.0, 0, 0};
  const auto [low, high] = dynamics::share_interval(part, whole);
  return {static_cast<double>(part) / static_cast<double>(whole), low, high, part, whole};
}

std::string percent_text(const Share& s) {
  if (s.whole == 0) return "none of none";
  const int decimals = s.whole < 1000 ? 0 : s.high < 0.001 || s.low > 0.999 ? 2 : 1;
  return fixed(100 * s.value, decimals) + " % [" + fixed(100 * s.low, decimals) + ", " +
         fixed(100 * s.high, decimals) + "]";
}

Verdict against(std::int64_t paper_count, const Share& ours) {
  const Share paper = share_of(paper_count, kPaperTrials);
  if (ours.whole == 0) return Verdict::cannot_tell;
  return verdict_of(ours.high < paper.low || ours.low > paper.high,
                    paper.low <= ours.low && ours.high <= paper.high, ours.whole >= kEnoughTrials);
}

bool rises(const Share& a, const Share& b) { return a.whole > 0 && b.whole > 0 && a.high < b.low; }

bool seen_with_100(const Share& a, const Share& b, double counted_a, double counted_b) {
  const auto variance = [](double p, double counted) {
    return p * (1 - p) / std::max(1.0, counted * static_cast<double>(kPaperTrials));
  };
  return std::abs(a.value - b.value) >
         2.0 * std::sqrt(variance(a.value, counted_a) + variance(b.value, counted_b));
}

void Trend::add(const std::vector<double>& axis, const std::vector<Share>& s,
                const std::vector<double>& counted) {
  ++series;
  up += rises(s.front(), s.back());
  down += falls(s.front(), s.back());
  for (std::size_t i = 0; i < s.size(); ++i) {
    const auto trials = static_cast<std::int64_t>(static_cast<double>(s[i].whole) /
                                                  (counted.empty() ? 1.0 : counted[i]));
    least_trials_ = least_trials_ == 0 ? trials : std::min(least_trials_, trials);
    if (i + 1 == s.size()) break;
    ++steps;
    if (!falls(s[i], s[i + 1])) continue;
    ++falling;
    seen += counted.empty() ? seen_with_100(s[i], s[i + 1])
                            : seen_with_100(s[i], s[i + 1], counted[i], counted[i + 1]);
    if (const double fall = s[i].value - s[i + 1].value; fall > largest_fall) {
      largest_fall = fall;
      at = axis[i];
    }
  }
}

Verdict Trend::verdict(bool wiggles) const {
  const bool enough = least_trials_ >= kEnoughTrials;
  const bool differs = more_than_chance(down, series) || (enough && up == 0) ||
                       (!wiggles && enough && more_than_chance(seen, steps));
  return verdict_of(differs, enough && 2 * up > series && (wiggles || falling == 0), enough);
}

}  // namespace gatewalk::cli
