// SPDX-License-Identifier: MIT
#include "cli/render/crossings.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "cli/fields/text.h"
#include "cli/render/final_gates.h"
#include "cli/render/health.h"

namespace gatewalk::cli {

void describe_crossed(Fields& out, std::string_view meaning, const lattice::Crossings& c) {
  out.estimate({"crossed", "1", meaning}, c.share(), c.interval_95());
}

void describe_chance(Fields& out, const lattice::Crossings& c, double chain) {
  describe_crossed(out, "share of new trials that crossed; the search did not use these trials", c);
  out.count({"trials", "1",
             "new trials of the result, and of each action or start that it is compared with"},
            c.trials);
  out.number({"chain", "1",
              "chance to cross by the chain of the last search; null: one action all the time, or "
              "--robust"},
             chain);
}

void describe_gain(Fields& out, std::string_view meaning, const lattice::Gain& gain) {
  out.estimate({"gain", "1", meaning}, gain.difference, gain.interval_95);
}

void describe_search(Fields& out, const lattice::ChoiceSummary& search, double seconds) {
  out.count({"rounds", "1", "rounds of the search: trials, then a new choice"}, search.rounds);
  out.flag(
      {"settled",
       "whether the last round gained less than half the accuracy, or less than sampling noise"},
      search.settled);
  out.count({"gate_runs", "1", "gate runs of all trials"}, search.gate_runs);
  out.number({"seconds", "s", "wall-clock time of the command's work"}, seconds);
  describe_status(out, search.health);
}

std::string chance_text(const lattice::Crossings& c, std::string_view of) {
  return wrapped(
      fmt::format("Chance to cross{}: {} % in {} new trials that were not used in the search.", of,
                  with_interval(c.share(), c.interval_95()), c.trials));
}

std::string gain_text(const lattice::Gain& gain) {
  // The interval is of a normal distribution, which knows no end; a gain has one at 100 points.
  const auto points = [](double x) { return fixed(100.0 * std::clamp(x, -1.0, 1.0), 2); };
  if (std::isnan(gain.interval_95[0])) return points(gain.difference);
  return fmt::format("{}{} [{}, {}]", gain.difference > 0.0 ? "+" : "", points(gain.difference),
                     points(gain.interval_95[0]), points(gain.interval_95[1]));
}

std::string gain_sentence(const lattice::Gain& gain, const std::string& what,
                          const std::string& other) {
  if (gain.interval_95[0] > 0.0)
    return wrapped(fmt::format("{} gains {} points over {}.", what, gain_text(gain), other));
  return wrapped(
      fmt::format("{} is not shown to be better than {}: {} points. A smaller --accuracy can show "
                  "a smaller gain.",
                  what, other, gain_text(gain)));
}

std::string basis_text(const lattice::ChoiceSummary& search) {
  return fmt::format("From {} gate runs in {} of choosing.\n", search.gate_runs,
                     counted(search.rounds, "round", "rounds"));
}

std::string few_crossings(const lattice::Crossings& c) {
  constexpr std::int64_t kFew = 30;
  if (c.crossed >= kFew) return "";
  if (c.crossed == 0)
    return fmt::format(
        "none of {} trials crossed: too rare to choose by; take a smaller field.rows, or ask "
        "gatewalk rare how rare crossings are",
        c.trials);
  return fmt::format(
      "only {} of {} trials crossed, which are few to choose by; a smaller --accuracy runs more",
      c.crossed, c.trials);
}

markov::CellProbabilities by_gate(const double* numbers, const lattice::FieldParams& field) {
  return Eigen::Map<const markov::CellProbabilities>(numbers, field.rows, field.columns);
}

double add_crossings(Panels& out, double top, const Caption& caption,
                     const std::vector<std::pair<std::string, lattice::Crossings>>& all) {
  std::vector<ShareBar> bars;
  for (const auto& [name, crossings] : all)
    bars.push_back({name, crossings.share(), crossings.interval_95()});
  const double bottom = top + height_of_bars(bars.size());
  add_share_bars(out, {130, 330, top, bottom}, "$crossed", bars).say(caption, 8, top - 14);
  return bottom;
}

}  // namespace gatewalk::cli
