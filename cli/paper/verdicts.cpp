// SPDX-License-Identifier: MIT
#include "cli/paper/verdicts.h"

#include <algorithm>
#include <cmath>

#include "cli/fields/text.h"
#include "dynamics/base/share.h"

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

Verdict Places::verdict(bool enough, bool strict) const {
  const bool failing = strict ? fail > 0 : more_than_chance(fail, of);
  const bool differs = enough ? 2 * hold <= of || more_than_chance(seen, of)
                              : fail > hold && more_than_chance(fail, of);
  return verdict_of(differs, enough && !failing, enough);
}

Verdict rare_and_even(const Share& traversed, const Share& right) {
  constexpr std::int64_t kLeft = 13, kRight = 8;  // per cent in the paper
  const double rare = share_of(kLeft + kRight, kPaperTrials).high;
  const double uneven = 2.0 * std::sqrt(0.25 / static_cast<double>(kLeft + kRight));
  const bool differs =
      traversed.low > rare || right.high < 0.5 - uneven || right.low > 0.5 + uneven;
  const bool within =
      traversed.high < rare && right.low >= 0.5 - uneven && right.high <= 0.5 + uneven;
  return verdict_of(differs, within && right.low <= 0.5 && right.high >= 0.5, within);
}

namespace {
/// Updates the least number of trials so far; 0: none yet.
void note_trials(std::int64_t& least, std::int64_t trials) {
  least = least == 0 ? trials : std::min(least, trials);
}
}  // namespace

void Trend::add(const std::vector<double>& axis, const std::vector<Share>& s,
                const std::vector<double>& counted) {
  const auto counted_at = [&](std::size_t i) { return counted.empty() ? 1.0 : counted[i]; };
  ++series;
  up += rises(s.front(), s.back());
  down += falls(s.front(), s.back());
  for (std::size_t i = 0; i < s.size(); ++i) {
    note_trials(least_trials_, std::llround(static_cast<double>(s[i].whole) / counted_at(i)));
    for (std::size_t j = i + 1; j < s.size(); ++j) {
      if (!falls(s[i], s[j])) continue;
      ++lower;
      seen += seen_with_100(s[i], s[j], counted_at(i), counted_at(j));
    }
    if (i + 1 == s.size()) break;
    ++steps;
    rising += rises(s[i], s[i + 1]);
    if (!falls(s[i], s[i + 1])) continue;
    ++falling;
    if (const double fall = s[i].value - s[i + 1].value; fall > largest_fall) {
      largest_fall = fall;
      at = axis[i];
    }
  }
}

Verdict Trend::verdict(bool wiggles) const {
  const bool enough = least_trials_ >= kEnoughTrials, most_up = 2 * up > series;
  // With enough trials, a fall that the paper's 100 trials would show is not due to chance.
  const bool falls = wiggles ? falling > 0 && falling >= rising : seen > 0;
  return verdict_of(more_than_chance(down, series) || (enough && (!most_up || falls)),
                    enough && (wiggles || lower == 0), enough);
}

void RiseThenFall::add(const std::vector<Share>& s) {
  const auto top = static_cast<std::size_t>(
      std::max_element(s.begin(), s.end(),
                       [](const Share& a, const Share& b) { return a.value < b.value; }) -
      s.begin());
  const bool rose = rises(s.front(), s[top]), fell = falls(s[top], s.back());
  bool against = false, shown = false;
  for (std::size_t i = 0; i < s.size(); ++i) {
    note_trials(least_trials_, s[i].whole);
    for (std::size_t j = i + 1; j < s.size(); ++j) {
      const bool down = falls(s[i], s[j]) && (j <= top || (!rose && i == 0)),
                 up_again = rises(s[i], s[j]) && i >= top,
                 up_at_end = rises(s[i], s[j]) && top + 1 == s.size() && i + 1 == top;
      if (!down && !up_again && !up_at_end) continue;
      against = true;
      shown |= seen_with_100(s[i], s[j]);
    }
  }
  ++series;
  up += rose;
  both += rose && fell;
  only_down += !rose && fell;
  contrary += against;
  seen += shown;
}

Verdict RiseThenFall::verdict() const {
  const bool enough = least_trials_ >= kEnoughTrials;
  return verdict_of(enough && (both == 0 || more_than_chance(seen, series)),
                    enough && 2 * both > series && contrary == 0, enough);
}

}  // namespace gatewalk::cli
